//! Unpacks the nodes of a tree, on all threads, into a grid.

use rayon::prelude::*;

use super::compression::Codec;
use super::reader::Reader;
use super::stream::{Fault, Result};
use super::tree::{self, InternalNode, LEAF_VOXELS, LeafNode, ROOT_BITS, RootTile, Visitor};
use super::values::ValueLayout;
use crate::error::Progress;
use crate::volume::grid::{GridBuilder, Leaf, SparseGrid, Voxel};

/// Leaves decoded by one thread at a time.
const DECODE_STEP: usize = 64;
/// Share of reading and unpacking in the time that a grid takes; the rest is assembling.
const SHARE_OF_READING: f32 = 0.8;

/// Loads the tree at the reader's position.
pub(super) fn load<V: Voxel>(
    reader: &mut Reader,
    layout: ValueLayout,
    progress: Progress,
) -> Result<SparseGrid<V>> {
    let reading = |fraction: f32| progress(SHARE_OF_READING * fraction);
    let mut loader = Loader::<V> {
        layout,
        builder: GridBuilder::new(V::ZERO),
        codec: Codec::default(),
        values: Vec::new(),
        progress: &reading,
    };
    tree::walk(reader, layout, &mut loader, &reading)?;
    let assembling = |fraction| progress(SHARE_OF_READING + (1.0 - SHARE_OF_READING) * fraction);
    Ok(loader.builder.finish(&assembling)?)
}

/// Adds all nodes to a grid.
struct Loader<'p, V> {
    layout: ValueLayout,
    builder: GridBuilder<V>,
    codec: Codec,
    /// Working memory: values of an internal node.
    values: Vec<V>,
    progress: Progress<'p>,
}

impl<V: Voxel> Visitor for Loader<'_, V> {
    fn background(&mut self, value: &[u8]) {
        self.builder = GridBuilder::new(self.layout.value(value));
    }

    fn root_tile(&mut self, tile: &RootTile) -> Result<()> {
        let value = self.layout.value(tile.value);
        Ok(self.builder.add_tile(tile.origin, 1 << ROOT_BITS, value, tile.active)?)
    }

    fn internal(&mut self, node: &InternalNode) -> Result<()> {
        let background = self.builder.background();
        let values = &mut self.values;
        values.clear();
        values.resize(node.level.count(), background);
        node.values.decode(&self.layout, &node.active, background, &mut self.codec, values)?;
        let mut stored = values.iter();
        for place in 0..node.level.count() {
            let is_child = node.children.is_on(place);
            // Before version 222 only the places without a child had a value.
            let value = match (self.layout.node_masks, is_child) {
                (false, true) => continue,
                _ => stored.next().copied().unwrap_or(background),
            };
            let active = node.active.is_on(place);
            if !is_child && (active || value != background) {
                let origin = node.level.origin(node.origin, place);
                self.builder.add_tile(origin, node.level.edge(), value, active)?;
            }
        }
        Ok(())
    }

    fn leaves(&mut self, nodes: &[LeafNode]) -> Result<()> {
        let background = self.builder.background();
        let blank = |node: &LeafNode| Leaf {
            origin: node.origin,
            values: [background; LEAF_VOXELS],
            active: node.active.words(),
        };
        let mut leaves: Vec<Leaf<V>> = nodes.par_iter().map(blank).collect();
        leaves.par_chunks_mut(DECODE_STEP).zip(nodes.par_chunks(DECODE_STEP)).try_for_each_init(
            Codec::default,
            |codec, (leaves, nodes)| {
                if !(self.progress)(0.0) {
                    return Err(Fault::Cancelled);
                }
                leaves.iter_mut().zip(nodes).try_for_each(|(leaf, node)| {
                    let values = &mut leaf.values;
                    node.values.decode(&self.layout, &node.active, background, codec, values)
                })
            },
        )?;
        self.builder.add_leaves(leaves);
        Ok(())
    }
}
