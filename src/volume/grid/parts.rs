//! The parts that a grid is assembled from.

use std::collections::HashMap;

use glam::IVec3;

use super::index::NODE_BRICKS;
use super::leaf::Leaf;
use super::stats::GridSummary;

/// Source of the values of a block of 8 voxels a side: a leaf or, with the top bit clear, a
/// constant.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct BlockOrigin(u32);

impl BlockOrigin {
    const LEAF: u32 = 1 << 31;
    /// The constant that is the background.
    pub const BACKGROUND: Self = Self(0);

    /// The leaf of this number.
    pub fn of_leaf(number: usize) -> Self {
        Self(Self::LEAF | number as u32)
    }

    /// The constant of this number.
    pub fn of_constant(number: usize) -> Self {
        Self(number as u32)
    }

    /// The number of the leaf, if it is one.
    pub fn leaf(self) -> Option<usize> {
        (self.0 & Self::LEAF != 0).then_some((self.0 & !Self::LEAF) as usize)
    }

    /// The number of the constant; only for what is not a leaf.
    pub fn constant(self) -> usize {
        self.0 as usize
    }
}

/// The content of a node's region of 128 voxels a side.
#[derive(Clone)]
pub(super) enum NodeRegion {
    Constant(BlockOrigin),
    Blocks(Box<[BlockOrigin; NODE_BRICKS]>),
}

/// Everything that the grid is assembled from.
pub(super) struct Parts<V> {
    /// Values of the constants; the first is the background.
    pub constants: Vec<V>,
    pub leaves: Vec<Leaf<V>>,
    pub regions: HashMap<IVec3, NodeRegion>,
    pub summary: GridSummary<V>,
}
