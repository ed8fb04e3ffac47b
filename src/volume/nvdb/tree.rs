//! The tree of a grid: a root, two levels of nodes with 32 and 16 places a side, and leaves of
//! 8x8x8 voxels. A scan follows the offsets from the root down and adds all tiles; then the leaves
//! are decoded on all threads.

use glam::IVec3;
use rayon::prelude::*;

use super::bytes::{Bytes, broken, origin_of_key};
use super::layout::{GRID_HEADER, LOWER_PLACES, NODE_MASKS, NodeLayout, UPPER_PLACES, ValueLayout};
use super::leaf;
use crate::error::{Progress, Result, report};
use crate::volume::grid::{GridBuilder, Leaf, SparseGrid, Voxel};

/// The offset of the root, counted from the tree.
const ROOT_OFFSET: usize = GRID_HEADER + 24;
/// The root's number of entries.
const ENTRY_COUNT: usize = 24;
const ROOT_BITS: u32 = 12;
/// Leaves decoded by one thread at a time.
const DECODE_STEP: usize = 64;
/// Leaves decoded before they are packed, so that few are in memory unpacked.
const LEAVES_PER_STEP: usize = 4096;

/// One of the two levels of nodes with children.
#[derive(Clone, Copy)]
struct Level {
    /// log2 of the places along an edge, and of the voxels along one of them.
    places: u32,
    voxels: u32,
    count: usize,
    table: usize,
    size: usize,
}

impl Level {
    fn upper(nodes: &NodeLayout) -> Self {
        let (table, size) = (nodes.upper_table, nodes.upper);
        Self { places: 5, voxels: 7, count: UPPER_PLACES, table, size }
    }

    fn lower(nodes: &NodeLayout) -> Self {
        let (table, size) = (nodes.lower_table, nodes.lower);
        Self { places: 4, voxels: 3, count: LOWER_PLACES, table, size }
    }

    /// The first voxel of a place.
    fn origin(self, node: IVec3, place: usize) -> IVec3 {
        let edge = (1 << self.places) - 1;
        let place = [place >> (2 * self.places), place >> self.places, place];
        node + (IVec3::from_array(place.map(|c| (c & edge) as i32)) << self.voxels as i32)
    }
}

/// A place of a grid where a node lies.
struct Place<'a> {
    origin: IVec3,
    bytes: &'a [u8],
}

/// Results of a scan.
struct Scan<'a, 'p, V> {
    grid: Bytes<'a>,
    layout: ValueLayout,
    nodes: NodeLayout,
    /// The background as the root has it.
    background: &'a [u8],
    builder: GridBuilder<V>,
    leaves: Vec<Place<'a>>,
    /// Bytes of the nodes found; more than the grid has if nodes are shared or lie in each other.
    found: usize,
    progress: Progress<'p>,
}

/// Builds a grid from its bytes.
pub(super) fn load<V: Voxel>(
    grid: Bytes,
    layout: ValueLayout,
    progress: Progress,
) -> Result<SparseGrid<V>> {
    let nodes = layout.nodes();
    let root = grid.target(ROOT_OFFSET, GRID_HEADER)?;
    let background = grid.slice(root + nodes.root_background, layout.value_bytes())?;
    let builder = GridBuilder::new(leaf::value(background, layout));
    let leaves = Vec::new();
    let mut scan = Scan { grid, layout, nodes, background, builder, leaves, found: 0, progress };
    scan.root(root)?;
    let Scan { mut builder, leaves, .. } = scan;
    for (step, places) in leaves.chunks(LEAVES_PER_STEP).enumerate() {
        let done = (step * LEAVES_PER_STEP) as f32 / leaves.len() as f32;
        report(progress, 0.1 + 0.5 * done)?;
        let decode = |place: &Place| decode_leaf(place, layout, &nodes);
        builder.add_leaves(places.par_iter().with_min_len(DECODE_STEP).map(decode).collect());
    }
    builder.finish(&|fraction| progress(0.6 + 0.4 * fraction))
}

impl<'a, V: Voxel> Scan<'a, '_, V> {
    fn root(&mut self, root: usize) -> Result<()> {
        let count = self.grid.u32(root + ENTRY_COUNT)? as usize;
        let first = root + self.nodes.root;
        self.grid.slice(first, count.saturating_mul(self.nodes.entry))?;
        for number in 0..count {
            let at = first + number * self.nodes.entry;
            let origin = origin_of_key(self.grid.u64(at)?);
            if self.grid.i64(at + 8)? != 0 {
                let upper = self.grid.target(at + 8, root)?;
                self.node(Level::upper(&self.nodes), upper, origin)?;
                continue;
            }
            let active = self.grid.u32(at + 16)? != 0;
            self.tile(origin, ROOT_BITS, at + self.nodes.entry_value, active)?;
        }
        Ok(())
    }

    /// Goes through the node at `at`, and the nodes below it.
    fn node(&mut self, level: Level, at: usize, origin: IVec3) -> Result<()> {
        report(self.progress, 0.1)?;
        self.grid.slice(at, level.size)?;
        self.count(at, level.size)?;
        let masks = self.grid.slice(at + NODE_MASKS, level.count / 4)?;
        let (active, children) = masks.split_at(level.count / 8);
        for place in 0..level.count {
            let is_on = |mask: &[u8]| mask[place >> 3] >> (place & 7) & 1 == 1;
            let entry = at + level.table + place * self.nodes.place;
            if !is_on(children) {
                self.tile(level.origin(origin, place), level.voxels, entry, is_on(active))?;
                continue;
            }
            let child = self.grid.target(entry, at)?;
            let origin = level.origin(origin, place);
            match level.count {
                UPPER_PLACES => self.node(Level::lower(&self.nodes), child, origin)?,
                _ => self.leaf(child, origin)?,
            }
        }
        Ok(())
    }

    fn leaf(&mut self, at: usize, origin: IVec3) -> Result<()> {
        let bytes = leaf::bytes(self.grid, at, self.layout, &self.nodes)?;
        self.count(at, bytes.len())?;
        self.leaves.push(Place { origin, bytes });
        Ok(())
    }

    /// Adds a tile of 2^`bits` voxels a side, unless it is as what surrounds it.
    fn tile(&mut self, origin: IVec3, bits: u32, at: usize, active: bool) -> Result<()> {
        let value = self.grid.slice(at, self.layout.value_bytes())?;
        if !active && value == self.background {
            return Ok(());
        }
        let value = leaf::value(value, self.layout);
        self.builder.add_tile(origin, 1 << bits, value, active)
    }

    /// Counts the bytes of a node. Nodes that are found more than once would let a small file fill
    /// all memory.
    fn count(&mut self, at: usize, bytes: usize) -> Result<()> {
        self.found += bytes;
        match self.found > self.grid.len() {
            true => Err(broken(
                at,
                "nodes that lie in each other; the file is damaged, export or copy it again",
            )),
            false => Ok(()),
        }
    }
}

fn decode_leaf<V: Voxel>(place: &Place, layout: ValueLayout, nodes: &NodeLayout) -> Leaf<V> {
    let active = leaf::active(place.bytes);
    let mut leaf = Leaf { origin: place.origin, values: [V::ZERO; 512], active };
    leaf::decode(place.bytes, layout, nodes, &mut leaf.values);
    leaf
}
