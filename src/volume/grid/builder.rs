//! Building a grid from leaves and tiles.

use std::collections::HashMap;

use glam::{IVec3, UVec3};
use rayon::prelude::*;

use super::assemble::assemble;
use super::index::{NODE_BRICKS, brick_in_node, node_of};
use super::index_box::IndexBox;
use super::leaf::Leaf;
use super::parts::{BlockOrigin, NodeRegion, Parts};
use super::sparse_grid::SparseGrid;
use super::stats::GridSummary;
use super::voxel::Voxel;
use crate::error::{Error, NO_PROGRESS, Progress, Result};

/// Voxels along the edge of a leaf.
const LEAF_EDGE: i32 = 8;
/// Nodes that a grid's tiles may touch, 128 voxels a side each: 128 tiles of 4096 voxels a side.
/// A node costs a few hundred bytes while the grid is built, so this keeps tiles near 1 GiB.
const MAX_TILE_NODES: u64 = 1 << 22;

/// Leaves summed up between two checks for cancellation.
const LEAVES_PER_STEP: usize = 256;

/// Gathers the leaves and tiles of a grid, which are not meant to overlap; leaves win over tiles.
pub struct GridBuilder<V> {
    leaves: Vec<Leaf<V>>,
    constants: Vec<V>,
    constant_ids: HashMap<[u32; 3], BlockOrigin>,
    regions: HashMap<IVec3, NodeRegion>,
    summary: GridSummary<V>,
}

impl<V: Voxel> GridBuilder<V> {
    /// An empty grid. A background that is not finite is replaced by zero, and counted.
    pub fn new(background: V) -> Self {
        let mut summary = GridSummary::empty();
        let usable = background.is_usable();
        if !usable {
            summary.count_replaced();
        }
        let background = if usable { background } else { V::ZERO };
        Self {
            leaves: Vec::new(),
            constants: vec![background],
            constant_ids: HashMap::from([(background.bits(), BlockOrigin::BACKGROUND)]),
            regions: HashMap::new(),
            summary,
        }
    }

    /// The value outside everything added.
    pub fn background(&self) -> V {
        self.constants[0]
    }

    /// Adds leaves; their origins must be multiples of 8.
    pub fn add_leaves(&mut self, mut leaves: Vec<Leaf<V>>) {
        self.leaves.append(&mut leaves);
    }

    /// Adds a box of equal voxels with its first voxel at `origin` and `edge` voxels a side.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless both are multiples of 8, or if the box reaches past the largest
    /// coordinate; [`Error::Unsupported`] if the tiles would take absurd memory.
    pub fn add_tile(&mut self, origin: IVec3, edge: u32, value: V, active: bool) -> Result<()> {
        let last = origin.as_i64vec3() + (i64::from(edge) - 1);
        if edge == 0 || last.max_element() > i64::from(i32::MAX) {
            return Err(Error::invalid("", "", "a tile that reaches past the largest coordinate"));
        }
        let bounds = IndexBox { min: origin, max: last.as_ivec3() };
        if !edge.is_multiple_of(LEAF_EDGE as u32) || (origin & (LEAF_EDGE - 1)) != IVec3::ZERO {
            return Err(Error::invalid("", "", "a tile that is not aligned to 8 voxels"));
        }
        let background = self.background();
        self.summary.merge(&GridSummary::of_tile(bounds, value, active, background));
        let value = if value.is_usable() { value } else { background };
        if value == background {
            return Ok(());
        }
        let nodes = IndexBox { min: node_of(bounds.min), max: node_of(bounds.max) };
        let total = nodes.voxel_count().saturating_add(self.regions.len() as u64);
        if total > MAX_TILE_NODES {
            return Err(Error::unsupported(
                "",
                "",
                format!(
                    "tiles over {total} blocks of 128x128x128 voxels, at most {MAX_TILE_NODES} fit \
                     in memory; resample the grid more coarsely or prune its tiles"
                ),
            ));
        }
        let constant = self.constant(value);
        nodes.positions().for_each(|node| self.fill_region(node, &bounds, constant));
        Ok(())
    }

    /// Builds the grid.
    ///
    /// # Errors
    /// [`Error::Cancelled`] when `progress` says so.
    pub fn finish(mut self, progress: Progress) -> Result<SparseGrid<V>> {
        let summaries = self.summarize(progress)?;
        for (number, (summary, is_constant)) in summaries.iter().enumerate() {
            self.summary.merge(summary);
            let Leaf { origin, values, .. } = &self.leaves[number];
            let (origin, value) = (*origin, values[0]);
            let from = match is_constant {
                true => self.constant(value),
                false => BlockOrigin::of_leaf(number),
            };
            self.set_block(origin, from);
        }
        let Self { leaves, constants, regions, summary, .. } = self;
        assemble(Parts { constants, leaves, regions, summary }, progress)
    }

    /// The sums of each leaf, and whether all its values are one.
    fn summarize(&mut self, progress: Progress) -> Result<Vec<(GridSummary<V>, bool)>> {
        let background = self.background();
        let mut summaries = vec![(GridSummary::empty(), false); self.leaves.len()];
        self.leaves
            .par_chunks_mut(LEAVES_PER_STEP)
            .zip(summaries.par_chunks_mut(LEAVES_PER_STEP))
            .try_for_each(|(leaves, summaries)| {
                if !progress(0.0) {
                    return Err(Error::Cancelled);
                }
                for (leaf, (summary, is_constant)) in leaves.iter_mut().zip(summaries) {
                    *summary = GridSummary::of_leaf(leaf, background);
                    *is_constant = leaf.values.iter().all(|value| *value == leaf.values[0]);
                }
                Ok(())
            })?;
        Ok(summaries)
    }

    /// The number of a constant, the same for the same value.
    fn constant(&mut self, value: V) -> BlockOrigin {
        if value == self.constants[0] {
            return BlockOrigin::BACKGROUND;
        }
        *self.constant_ids.entry(value.bits()).or_insert_with(|| {
            self.constants.push(value);
            BlockOrigin::of_constant(self.constants.len() - 1)
        })
    }

    /// Sets the part of a node's region that lies in `bounds`.
    fn fill_region(&mut self, node: IVec3, bounds: &IndexBox, constant: BlockOrigin) {
        let whole = super::index::node_box(node);
        if bounds.contains(&whole) {
            self.regions.insert(node, NodeRegion::Constant(constant));
            return;
        }
        let part = bounds.intersection(&whole);
        let blocks = IndexBox { min: part.min >> 3, max: part.max >> 3 };
        for block in blocks.positions() {
            self.set_block(block * LEAF_EDGE, constant);
        }
    }

    /// Sets the block of 8 voxels a side that starts at `voxel`.
    fn set_block(&mut self, voxel: IVec3, from: BlockOrigin) {
        let node = node_of(voxel);
        let region = match self.regions.get_mut(&node) {
            Some(region) => region,
            None if from == BlockOrigin::BACKGROUND => return,
            None => {
                self.regions.entry(node).or_insert(NodeRegion::Constant(BlockOrigin::BACKGROUND))
            }
        };
        if let NodeRegion::Constant(constant) = *region {
            if constant == from {
                return;
            }
            *region = NodeRegion::Blocks(Box::new([constant; NODE_BRICKS]));
        }
        if let NodeRegion::Blocks(blocks) = region {
            blocks[brick_in_node(voxel)] = from;
        }
    }
}

impl<V: Voxel> SparseGrid<V> {
    /// A grid from a dense box of active voxels that starts at `origin`; `values` has z fastest,
    /// then y, then x.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless there are `dims.x * dims.y * dims.z` values within the range of
    /// coordinates.
    pub fn from_dense(origin: IVec3, dims: UVec3, values: &[V], background: V) -> Result<Self> {
        let count = dims.as_u64vec3().to_array().into_iter().try_fold(1, u64::checked_mul);
        if count != Some(values.len() as u64) {
            let reason = format!("{dims} voxels were announced and {} values given", values.len());
            return Err(Error::invalid("", "", reason));
        }
        let mut builder = GridBuilder::new(background);
        if values.is_empty() {
            return builder.finish(NO_PROGRESS);
        }
        let last = origin.as_i64vec3() + dims.as_i64vec3() - 1;
        if last.max_element() > i64::from(i32::MAX) {
            return Err(Error::invalid("", "", "the box reaches past the largest coordinate"));
        }
        let bounds = IndexBox { min: origin, max: last.as_ivec3() };
        let leaves = IndexBox { min: bounds.min >> 3, max: bounds.max >> 3 };
        let dense = DenseBox { bounds, dims, values, background };
        builder.add_leaves(leaves.positions().map(|leaf| dense.leaf(leaf * LEAF_EDGE)).collect());
        builder.finish(NO_PROGRESS)
    }
}

/// A dense array and where it lies.
struct DenseBox<'a, V> {
    bounds: IndexBox,
    dims: UVec3,
    values: &'a [V],
    background: V,
}

impl<V: Voxel> DenseBox<'_, V> {
    fn leaf(&self, origin: IVec3) -> Leaf<V> {
        let mut leaf = Leaf { origin, values: [self.background; 512], active: [0; 8] };
        for offset in 0..leaf.values.len() {
            let voxel = leaf.voxel(offset);
            if self.bounds.contains(&IndexBox::of_voxel(voxel)) {
                let [x, y, z] = (voxel - self.bounds.min).to_array().map(|c| c as usize);
                let at = (x * self.dims.y as usize + y) * self.dims.z as usize + z;
                leaf.values[offset] = self.values[at];
                leaf.active[offset >> 6] |= 1 << (offset & 63);
            }
        }
        leaf
    }
}
