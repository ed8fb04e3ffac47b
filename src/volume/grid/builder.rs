//! Building a grid from leaves and tiles.

use std::collections::{HashMap, HashSet};

use glam::{IVec3, UVec3};
use rayon::prelude::*;

use super::assemble::assemble;
use super::block_id::{BlockId, BlockKind};
use super::blocks::{BLOCK_EDGE, BLOCK_VALUES, Blocks, PADDED_VALUES};
use super::index::{NODE_BRICKS, brick_in_node, node_of};
use super::index_box::IndexBox;
use super::leaf::Leaf;
use super::node::step;
use super::parts::{NodeRegion, Parts};
use super::sparse_grid::SparseGrid;
use super::stats::GridSummary;
use super::voxel::Voxel;
use crate::error::{Error, NO_PROGRESS, Progress, Result};
use crate::volume::half::{is_half, narrow};

/// Nodes that a grid's tiles may touch, 128 voxels a side each: 128 tiles of 4096 voxels a side.
/// A node costs a few hundred bytes while the grid is built, so this keeps tiles near 1 GiB.
const MAX_TILE_NODES: u64 = 1 << 22;

/// Leaves that one thread packs at a time.
const LEAVES_PER_STEP: usize = 32;

/// Leaves of a dense array that are unpacked at a time.
const DENSE_LEAVES_PER_STEP: usize = 4096;

/// Memory of padded blocks that a grid may take: where it is little anyway, look-ups are to be as
/// fast as they can be.
const MOST_PADDED_BYTES: usize = 32 << 20;

/// Gathers the leaves and tiles of a grid, which are not meant to overlap; leaves win over tiles.
pub struct GridBuilder<V> {
    /// The blocks; each constant is there once.
    blocks: Blocks<V>,
    constant_ids: HashMap<[u32; 3], BlockId>,
    /// First voxel and block of each leaf.
    leaves: Vec<(IVec3, BlockId)>,
    regions: HashMap<IVec3, NodeRegion>,
    summary: GridSummary<V>,
    /// Number of blocks up to which they are padded.
    most_padded: usize,
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
            blocks: Blocks::new(background),
            constant_ids: HashMap::from([(background.bits(), BlockId::BACKGROUND)]),
            leaves: Vec::new(),
            regions: HashMap::new(),
            summary,
            most_padded: MOST_PADDED_BYTES / (size_of::<[f32; PADDED_VALUES]>() * V::COMPONENTS),
        }
    }

    /// The value outside everything added.
    pub fn background(&self) -> V {
        self.blocks.constants[0]
    }

    /// Adds leaves; their origins must be multiples of 8. They are packed at once, on all threads:
    /// who adds a few thousand at a time never holds the whole grid unpacked.
    pub fn add_leaves(&mut self, mut leaves: Vec<Leaf<V>>) {
        let background = self.background();
        let leaves_par = leaves.par_iter_mut().with_min_len(LEAVES_PER_STEP);
        let summaries: Vec<_> = leaves_par
            .map(|leaf| (GridSummary::of_leaf(leaf, background), kind_of(&leaf.values)))
            .collect();
        let counts = [&self.blocks.halves.len(), &self.blocks.floats.len()];
        let [half_count, float_count] = counts.map(|planes| planes / V::COMPONENTS);
        let (mut halves, mut floats) = (Vec::new(), Vec::new());
        for (leaf, (summary, kind)) in leaves.iter().zip(&summaries) {
            self.summary.merge(summary);
            let number = match kind {
                BlockKind::Constant => self.constant(leaf.values[0]).number(),
                BlockKind::Half => half_count + push(&mut halves, leaf),
                BlockKind::Float | BlockKind::Padded => float_count + push(&mut floats, leaf),
            };
            self.leaves.push((leaf.origin, BlockId::new(*kind, number)));
        }
        self.blocks.halves.par_extend(planes(&halves, narrow));
        self.blocks.floats.par_extend(planes(&floats, |value| value));
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
        if !edge.is_multiple_of(BLOCK_EDGE as u32) || (origin & (BLOCK_EDGE - 1)) != IVec3::ZERO {
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
        let pad = self.is_to_pad();
        self.blocks.halves.shrink_to_fit();
        self.blocks.floats.shrink_to_fit();
        for (origin, block) in std::mem::take(&mut self.leaves) {
            self.set_block(origin, block);
        }
        let Self { blocks, regions, summary, .. } = self;
        assemble(Parts { blocks, regions, summary, pad }, progress)
    }

    /// Whether all bricks that read leaves, those before the leaves included, may be padded.
    fn is_to_pad(&self) -> bool {
        let stored = self.leaves.iter().filter(|(_, block)| !block.is_constant());
        if stored.clone().take(self.most_padded + 1).count() > self.most_padded {
            return false;
        }
        let bricks: HashSet<IVec3> = stored
            .flat_map(|&(origin, _)| (0..8).map(move |corner| origin / BLOCK_EDGE - step(corner)))
            .collect();
        bricks.len() <= self.most_padded
    }

    /// Sets the number of blocks up to which they are padded.
    #[cfg(test)]
    pub(super) fn set_most_padded(&mut self, most_padded: usize) {
        self.most_padded = most_padded;
    }

    /// The constant block of a value, the same for the same value.
    fn constant(&mut self, value: V) -> BlockId {
        let constants = &mut self.blocks.constants;
        *self.constant_ids.entry(value.bits()).or_insert_with(|| {
            constants.push(value);
            BlockId::new(BlockKind::Constant, constants.len() - 1)
        })
    }

    /// Sets the part of a node's region that lies in `bounds`.
    fn fill_region(&mut self, node: IVec3, bounds: &IndexBox, constant: BlockId) {
        let whole = super::index::node_box(node);
        if bounds.contains(&whole) {
            self.regions.insert(node, NodeRegion::Constant(constant));
            return;
        }
        let part = bounds.intersection(&whole);
        let blocks = IndexBox { min: part.min >> 3, max: part.max >> 3 };
        for block in blocks.positions() {
            self.set_block(block * BLOCK_EDGE, constant);
        }
    }

    /// Sets the block of 8 voxels a side that starts at `voxel`.
    fn set_block(&mut self, voxel: IVec3, from: BlockId) {
        let node = node_of(voxel);
        let region = match self.regions.get_mut(&node) {
            Some(region) => region,
            None if from == BlockId::BACKGROUND => return,
            None => self.regions.entry(node).or_insert(NodeRegion::Constant(BlockId::BACKGROUND)),
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

/// The smallest way to store these values exactly.
fn kind_of<V: Voxel>(values: &[V; BLOCK_VALUES]) -> BlockKind {
    let first = values[0].bits();
    if values.iter().all(|value| value.bits() == first) {
        return BlockKind::Constant;
    }
    let all_half = |row: &[V]| {
        // Without an early end within the row, so that it is tested as a whole.
        row.iter().fold(true, |all, value| {
            (0..V::COMPONENTS).fold(all, |all, c| all & is_half(value.component(c)))
        })
    };
    if values.chunks_exact(64).all(all_half) { BlockKind::Half } else { BlockKind::Float }
}

/// Appends an item and returns its number.
fn push<T>(items: &mut Vec<T>, item: T) -> usize {
    items.push(item);
    items.len() - 1
}

/// The components of leaves, one after another, each packed.
fn planes<'a, V: Voxel, T: Send + Copy>(
    leaves: &'a [&Leaf<V>],
    pack: impl Fn(f32) -> T + Sync + Send + 'a,
) -> impl IndexedParallelIterator<Item = [T; BLOCK_VALUES]> + 'a {
    let count = leaves.len() * V::COMPONENTS;
    (0..count).into_par_iter().with_min_len(LEAVES_PER_STEP).map(move |number| {
        let (leaf, component) = (leaves[number / V::COMPONENTS], number % V::COMPONENTS);
        leaf.values.map(|value| pack(value.component(component)))
    })
}

impl<V: Voxel> SparseGrid<V> {
    /// A grid from a dense box of active voxels that starts at `origin`; `values` has z fastest,
    /// then y, then x.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless there are `dims.x * dims.y * dims.z` values within the range of
    /// coordinates.
    pub fn from_dense(origin: IVec3, dims: UVec3, values: &[V], background: V) -> Result<Self> {
        dense(origin, dims, values, background)?.finish(NO_PROGRESS)
    }
}

/// The leaves of a dense box; as [`SparseGrid::from_dense`].
pub(super) fn dense<V: Voxel>(
    origin: IVec3,
    dims: UVec3,
    values: &[V],
    background: V,
) -> Result<GridBuilder<V>> {
    let count = dims.as_u64vec3().to_array().into_iter().try_fold(1, u64::checked_mul);
    if count != Some(values.len() as u64) {
        let reason = format!("{dims} voxels were announced and {} values given", values.len());
        return Err(Error::invalid("", "", reason));
    }
    let mut builder = GridBuilder::new(background);
    if values.is_empty() {
        return Ok(builder);
    }
    let last = origin.as_i64vec3() + dims.as_i64vec3() - 1;
    if last.max_element() > i64::from(i32::MAX) {
        return Err(Error::invalid("", "", "the box reaches past the largest coordinate"));
    }
    let bounds = IndexBox { min: origin, max: last.as_ivec3() };
    let leaves = IndexBox { min: bounds.min >> 3, max: bounds.max >> 3 };
    let dense = DenseBox { bounds, dims, values, background };
    let origins: Vec<_> = leaves.positions().map(|leaf| leaf * BLOCK_EDGE).collect();
    for origins in origins.chunks(DENSE_LEAVES_PER_STEP) {
        builder.add_leaves(origins.par_iter().map(|&origin| dense.leaf(origin)).collect());
    }
    Ok(builder)
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
