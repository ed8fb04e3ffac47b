//! The tree of a grid: a root, two levels of internal nodes with 32 and 16 places a side, and
//! leaves of 8x8x8 voxels. First comes its topology with all tiles, then the leaves' values.
//!
//! A scan finds every node without unpacking a value; it also steps over grids that are not
//! loaded. Then the buffers are unpacked on all threads.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::IVec3;
use rayon::prelude::*;

use super::compression::Codec;
use super::stream::{Fault, Result, Stream};
use super::values::{Mask, PackedValues, ValueLayout};
use crate::error::Progress;
use crate::volume::grid::{GridBuilder, Leaf, SparseGrid, Voxel};

/// log2 of the places along the edge of a node, and of the voxels along one of them.
#[derive(Clone, Copy)]
struct TreeLevel {
    places: u32,
    voxels: u32,
}

/// The children of the root, 4096 voxels a side.
const UPPER: TreeLevel = TreeLevel { places: 5, voxels: 7 };
/// The children of the upper nodes, 128 voxels a side.
const LOWER: TreeLevel = TreeLevel { places: 4, voxels: 3 };
const ROOT_BITS: u32 = 12;
const LEAF_VOXELS: usize = 512;
/// Nodes scanned, or leaves decoded by one thread, between two checks whether to stop.
const SCAN_STEP: usize = 1024;
const DECODE_STEP: usize = 128;

impl TreeLevel {
    fn count(self) -> usize {
        1 << (3 * self.places)
    }

    /// The first voxel of a place.
    fn origin(self, node: IVec3, place: usize) -> IVec3 {
        let edge = (1 << self.places) - 1;
        let place = [place >> (2 * self.places), place >> self.places, place];
        node + (IVec3::from_array(place.map(|c| (c & edge) as i32)) << self.voxels as i32)
    }
}

/// A tile at the root.
struct RootTile<'a> {
    origin: IVec3,
    value: &'a [u8],
    active: bool,
}

/// An internal node with the tiles among its places.
struct InternalNode<'a> {
    level: TreeLevel,
    origin: IVec3,
    children: Mask<'a>,
    active: Mask<'a>,
    values: PackedValues<'a>,
}

struct LeafNode<'a> {
    origin: IVec3,
    active: Mask<'a>,
    values: PackedValues<'a>,
}

/// A tree whose nodes have been found but not unpacked.
pub(super) struct Tree<'a> {
    layout: ValueLayout,
    background: &'a [u8],
    root_tiles: Vec<RootTile<'a>>,
    internal: Vec<InternalNode<'a>>,
    leaves: Vec<LeafNode<'a>>,
}

/// Finds all nodes of the tree at the stream's position, and leaves the stream behind it.
pub(super) fn scan<'a>(
    stream: &mut Stream<'a>,
    layout: ValueLayout,
    progress: Progress,
) -> Result<Tree<'a>> {
    stream.enter("tree");
    if stream.u32()? != 1 {
        return Err(Fault::Unsupported(
            "a tree with several buffers; save the file again with OpenVDB 2.0 or newer".into(),
        ));
    }
    let background = stream.take(layout.value_bytes())?;
    let tree = Tree { layout, background, root_tiles: vec![], internal: vec![], leaves: vec![] };
    let mut scan = Scan { stream, tree, leaf_origins: vec![], steps: 0, progress };
    scan.root()?;
    scan.leaves()?;
    Ok(scan.tree)
}

struct Scan<'a, 's, 'p> {
    stream: &'s mut Stream<'a>,
    tree: Tree<'a>,
    leaf_origins: Vec<IVec3>,
    steps: usize,
    progress: Progress<'p>,
}

impl<'a> Scan<'a, '_, '_> {
    fn root(&mut self) -> Result<()> {
        let origin_bytes = 12;
        let value_bytes = self.tree.layout.value_bytes();
        let tiles = self.stream.u32()? as usize;
        // Two masks at least make a child.
        let children = self.stream.count(origin_bytes + UPPER.count() / 4)?;
        if tiles.saturating_mul(origin_bytes + value_bytes + 1) > self.stream.remaining() {
            return Err(self.stream.broken(format!(
                "{tiles} tiles announced where {} bytes are left; the file is damaged, export or \
                 copy it again",
                self.stream.remaining()
            )));
        }
        for _ in 0..tiles {
            let origin = self.root_origin()?;
            let value = self.stream.take(value_bytes)?;
            let active = self.stream.u8()? != 0;
            self.tree.root_tiles.push(RootTile { origin, value, active });
        }
        for _ in 0..children {
            let origin = self.root_origin()?;
            self.internal(UPPER, origin)?;
        }
        Ok(())
    }

    fn root_origin(&mut self) -> Result<IVec3> {
        let origin = IVec3::new(self.stream.i32()?, self.stream.i32()?, self.stream.i32()?);
        if origin & ((1 << ROOT_BITS) - 1) != IVec3::ZERO {
            return Err(self.stream.broken(format!(
                "a node at {origin}, which is no multiple of 4096; the file is damaged, export or \
                 copy it again"
            )));
        }
        Ok(origin)
    }

    fn internal(&mut self, level: TreeLevel, origin: IVec3) -> Result<()> {
        self.step()?;
        let layout = self.tree.layout;
        let children = Mask::read(self.stream, level.count())?;
        let active = Mask::read(self.stream, level.count())?;
        let stored = match layout.node_masks {
            true => level.count(),
            false => level.count() - children.count(),
        };
        let values = PackedValues::read(self.stream, &layout, &active, stored)?;
        self.tree.internal.push(InternalNode { level, origin, children, active, values });
        for place in (0..level.count()).filter(|&place| children.is_on(place)) {
            let origin = level.origin(origin, place);
            if level.voxels == LOWER.voxels {
                // The mask comes again with the values.
                Mask::read(self.stream, LEAF_VOXELS)?;
                self.leaf_origins.push(origin);
            } else {
                self.internal(LOWER, origin)?;
            }
        }
        Ok(())
    }

    fn leaves(&mut self) -> Result<()> {
        self.stream.enter("values");
        for origin in std::mem::take(&mut self.leaf_origins) {
            self.step()?;
            let layout = self.tree.layout;
            let active = Mask::read(self.stream, LEAF_VOXELS)?;
            let mut buffers = 1;
            if !layout.node_masks {
                let _origin_again = self.stream.take(12)?;
                buffers = self.stream.u8()?;
            }
            let values = PackedValues::read(self.stream, &layout, &active, LEAF_VOXELS)?;
            for _ in 1..buffers {
                PackedValues::read(self.stream, &layout, &active, LEAF_VOXELS)?;
            }
            self.tree.leaves.push(LeafNode { origin, active, values });
        }
        Ok(())
    }

    fn step(&mut self) -> Result<()> {
        self.steps += 1;
        match self.steps.is_multiple_of(SCAN_STEP) && !(self.progress)(0.0) {
            true => Err(Fault::Cancelled),
            false => Ok(()),
        }
    }
}

impl Tree<'_> {
    /// Unpacks the values and builds the grid.
    pub fn build<V: Voxel>(&self, progress: Progress) -> Result<SparseGrid<V>> {
        let mut builder = GridBuilder::new(self.layout.value(self.background));
        let background: V = builder.background();
        for tile in &self.root_tiles {
            let value = self.layout.value(tile.value);
            builder.add_tile(tile.origin, 1 << ROOT_BITS, value, tile.active)?;
        }
        let mut codec = Codec::default();
        for node in &self.internal {
            if !progress(0.1) {
                return Err(Fault::Cancelled);
            }
            self.add_tiles(node, background, &mut codec, &mut builder)?;
        }
        builder.add_leaves(self.decode_leaves(background, progress)?);
        Ok(builder.finish(&|fraction| progress(0.6 + 0.4 * fraction))?)
    }

    fn add_tiles<V: Voxel>(
        &self,
        node: &InternalNode,
        background: V,
        codec: &mut Codec,
        builder: &mut GridBuilder<V>,
    ) -> Result<()> {
        let mut values = vec![background; node.level.count()];
        node.values.decode(&self.layout, &node.active, background, codec, &mut values)?;
        let mut stored = values.iter();
        for place in 0..values.len() {
            let is_child = node.children.is_on(place);
            // Before version 222 only the places without a child had a value.
            let value = match (self.layout.node_masks, is_child) {
                (false, true) => continue,
                _ => stored.next().copied().unwrap_or(background),
            };
            let active = node.active.is_on(place);
            if !is_child && (active || value != background) {
                let origin = node.level.origin(node.origin, place);
                builder.add_tile(origin, 1 << node.level.voxels, value, active)?;
            }
        }
        Ok(())
    }

    fn decode_leaves<V: Voxel>(&self, background: V, progress: Progress) -> Result<Vec<Leaf<V>>> {
        let blank = |node: &LeafNode| Leaf {
            origin: node.origin,
            values: [background; LEAF_VOXELS],
            active: node.active.words(),
        };
        let mut leaves: Vec<Leaf<V>> = self.leaves.iter().map(blank).collect();
        let done = AtomicUsize::new(0);
        let steps = leaves.len().div_ceil(DECODE_STEP) as f32;
        leaves
            .par_chunks_mut(DECODE_STEP)
            .zip(self.leaves.par_chunks(DECODE_STEP))
            .try_for_each_init(Codec::default, |codec, (leaves, nodes)| {
                let done = done.fetch_add(1, Ordering::Relaxed) as f32;
                if !progress(0.1 + 0.5 * done / steps) {
                    return Err(Fault::Cancelled);
                }
                leaves.iter_mut().zip(nodes).try_for_each(|(leaf, node)| {
                    let values = &mut leaf.values;
                    node.values.decode(&self.layout, &node.active, background, codec, values)
                })
            })?;
        Ok(leaves)
    }
}
