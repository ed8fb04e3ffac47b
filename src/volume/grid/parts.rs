//! The parts that a grid is assembled from.

use std::collections::HashMap;

use glam::IVec3;

use super::block_id::BlockId;
use super::blocks::Blocks;
use super::index::NodeBlocks;
use super::stats::GridSummary;

/// The content of a node's region of 128 voxels a side.
#[derive(Clone)]
pub(super) enum NodeRegion {
    Constant(BlockId),
    Blocks(Box<NodeBlocks>),
}

/// The region of a node and its seven followers, counted in binary, z lowest.
pub(super) type Around<'a> = [&'a NodeRegion; 8];

/// Everything that the grid is assembled from.
pub(super) struct Parts<V> {
    /// The blocks; each of their constants is there once.
    pub blocks: Blocks<V>,
    pub regions: HashMap<IVec3, NodeRegion>,
    pub summary: GridSummary<V>,
    /// Whether the blocks are to be padded.
    pub pad: bool,
}
