//! The tree of a grid: a root, two levels of internal nodes with 32 and 16 places a side, and
//! leaves of 8x8x8 voxels. First comes its topology with all tiles, then the leaves' values.
//!
//! A walk finds every node without unpacking a value, and hands it to a [`Visitor`]; so it also
//! steps over grids that are not loaded.

use glam::IVec3;

use super::reader::Reader;
use super::stream::{Fault, Result, Stream};
use super::values::{Mask, PackedValues, ValueLayout};
use crate::error::Progress;

/// log2 of the places along the edge of a node, and of the voxels along one of them.
#[derive(Clone, Copy)]
pub(super) struct TreeLevel {
    places: u32,
    voxels: u32,
}

/// The children of the root, 4096 voxels a side.
const UPPER: TreeLevel = TreeLevel { places: 5, voxels: 7 };
/// The children of the upper nodes, 128 voxels a side.
const LOWER: TreeLevel = TreeLevel { places: 4, voxels: 3 };
/// log2 of the voxels along the edge of a tile at the root.
pub(super) const ROOT_BITS: u32 = 12;
pub(super) const LEAF_VOXELS: usize = 512;
/// Leaves visited at a time.
const LEAVES_PER_STEP: usize = 4096;

impl TreeLevel {
    pub fn count(self) -> usize {
        1 << (3 * self.places)
    }

    /// Edge of the voxels at a place.
    pub fn edge(self) -> u32 {
        1 << self.voxels
    }

    /// The first voxel of a place.
    pub fn origin(self, node: IVec3, place: usize) -> IVec3 {
        let edge = (1 << self.places) - 1;
        let place = [place >> (2 * self.places), place >> self.places, place];
        node + (IVec3::from_array(place.map(|c| (c & edge) as i32)) << self.voxels as i32)
    }
}

/// A tile at the root.
pub(super) struct RootTile<'a> {
    pub origin: IVec3,
    pub value: &'a [u8],
    pub active: bool,
}

/// An internal node with the tiles among its places.
pub(super) struct InternalNode<'a> {
    pub level: TreeLevel,
    pub origin: IVec3,
    pub children: Mask<'a>,
    pub active: Mask<'a>,
    pub values: PackedValues<'a>,
}

/// A leaf.
pub(super) struct LeafNode<'a> {
    pub origin: IVec3,
    pub active: Mask<'a>,
    pub values: PackedValues<'a>,
}

/// Receives the nodes of a tree in the order of the file; by default it passes them over.
pub(super) trait Visitor {
    /// The value outside of all nodes.
    fn background(&mut self, _value: &[u8]) {}

    fn root_tile(&mut self, _tile: &RootTile) -> Result<()> {
        Ok(())
    }

    fn internal(&mut self, _node: &InternalNode) -> Result<()> {
        Ok(())
    }

    fn leaves(&mut self, _leaves: &[LeafNode]) -> Result<()> {
        Ok(())
    }
}

/// Passes every node over.
pub(super) struct PassOver;

impl Visitor for PassOver {}

/// Visits all nodes of the tree at the reader's position, and leaves the reader behind it.
pub(super) fn walk(
    reader: &mut Reader,
    layout: ValueLayout,
    visitor: &mut dyn Visitor,
    progress: Progress,
) -> Result<()> {
    let start = reader.position();
    let mut walk = TreeWalk { reader, layout, visitor, leaf_origins: vec![], start, progress };
    walk.root()?;
    walk.leaves()
}

struct TreeWalk<'r, 'a, 'v, 'p> {
    reader: &'r mut Reader<'a>,
    layout: ValueLayout,
    visitor: &'v mut dyn Visitor,
    leaf_origins: Vec<IVec3>,
    start: usize,
    progress: Progress<'p>,
}

impl TreeWalk<'_, '_, '_, '_> {
    fn root(&mut self) -> Result<()> {
        let Self { layout, visitor, .. } = self;
        let children = self.reader.step("tree", |stream| {
            if stream.u32()? != 1 {
                return Err(Fault::Unsupported(
                    "a tree with several buffers; save the file again with OpenVDB 2.0 or newer"
                        .into(),
                ));
            }
            let background = stream.take(layout.value_bytes())?;
            let (tiles, children) = read_root(stream, layout)?;
            visitor.background(background);
            tiles.iter().try_for_each(|tile| visitor.root_tile(tile))?;
            Ok(children)
        })?;
        for _ in 0..children {
            let origin = self.reader.step("tree", root_origin)?;
            for lower in self.internal(UPPER, origin)? {
                let leaves = self.internal(LOWER, lower)?;
                // The masks come again with the values.
                let masks = leaves.len() * (LEAF_VOXELS / 8);
                self.reader.step("tree", |stream| stream.take(masks).map(|_| ()))?;
                self.leaf_origins.extend(leaves);
            }
        }
        Ok(())
    }

    /// Visits an internal node and returns where its children start.
    fn internal(&mut self, level: TreeLevel, origin: IVec3) -> Result<Vec<IVec3>> {
        self.check_progress()?;
        let Self { layout, visitor, .. } = self;
        self.reader.step("tree", |stream| {
            let node = InternalNode::read(stream, layout, level, origin)?;
            visitor.internal(&node)?;
            let places = (0..level.count()).filter(|&place| node.children.is_on(place));
            Ok(places.map(|place| level.origin(origin, place)).collect())
        })
    }

    fn leaves(&mut self) -> Result<()> {
        let origins = std::mem::take(&mut self.leaf_origins);
        let mut left = &origins[..];
        while !left.is_empty() {
            self.check_progress()?;
            let Self { layout, visitor, .. } = self;
            let visited = self.reader.step("values", |stream| {
                let leaves = read_leaves(stream, layout, left)?;
                visitor.leaves(&leaves)?;
                Ok(leaves.len())
            })?;
            left = &left[visited..];
        }
        Ok(())
    }

    fn check_progress(&self) -> Result<()> {
        match (self.progress)(self.reader.fraction(self.start)) {
            true => Ok(()),
            false => Err(Fault::Cancelled),
        }
    }
}

/// The tiles of the root and the number of its children.
fn read_root<'a>(
    stream: &mut Stream<'a>,
    layout: &ValueLayout,
) -> Result<(Vec<RootTile<'a>>, usize)> {
    let origin_bytes = 12;
    let value_bytes = layout.value_bytes();
    let count = stream.u32()? as usize;
    // Two masks at least make a child.
    let children = stream.count(origin_bytes + UPPER.count() / 4)?;
    if count.saturating_mul(origin_bytes + value_bytes + 1) > stream.remaining() {
        return Err(stream.broken(format!(
            "{count} tiles announced where {} bytes are left; the file is damaged, export or copy \
             it again",
            stream.remaining()
        )));
    }
    let mut tiles = Vec::new();
    for _ in 0..count {
        let origin = root_origin(stream)?;
        let value = stream.take(value_bytes)?;
        let active = stream.u8()? != 0;
        tiles.push(RootTile { origin, value, active });
    }
    Ok((tiles, children))
}

fn root_origin(stream: &mut Stream) -> Result<IVec3> {
    let origin = IVec3::new(stream.i32()?, stream.i32()?, stream.i32()?);
    if origin & ((1 << ROOT_BITS) - 1) != IVec3::ZERO {
        return Err(stream.broken(format!(
            "a node at {origin}, which is no multiple of 4096; the file is damaged, export or copy \
             it again"
        )));
    }
    Ok(origin)
}

impl<'a> InternalNode<'a> {
    fn read(
        stream: &mut Stream<'a>,
        layout: &ValueLayout,
        level: TreeLevel,
        origin: IVec3,
    ) -> Result<Self> {
        let children = Mask::read(stream, level.count())?;
        let active = Mask::read(stream, level.count())?;
        let stored = match layout.node_masks {
            true => level.count(),
            false => level.count() - children.count(),
        };
        let values = PackedValues::read(stream, layout, &active, stored)?;
        Ok(Self { level, origin, children, active, values })
    }
}

/// The leaves that start at `origins`, as many of them as are in memory.
fn read_leaves<'a>(
    stream: &mut Stream<'a>,
    layout: &ValueLayout,
    origins: &[IVec3],
) -> Result<Vec<LeafNode<'a>>> {
    let mut leaves = Vec::new();
    for &origin in origins.iter().take(LEAVES_PER_STEP) {
        let before = stream.clone();
        match LeafNode::read(stream, layout, origin) {
            Ok(leaf) => leaves.push(leaf),
            Err(Fault::Beyond(_)) if !leaves.is_empty() => {
                *stream = before;
                break;
            }
            Err(fault) => return Err(fault),
        }
    }
    Ok(leaves)
}

impl<'a> LeafNode<'a> {
    fn read(stream: &mut Stream<'a>, layout: &ValueLayout, origin: IVec3) -> Result<Self> {
        let active = Mask::read(stream, LEAF_VOXELS)?;
        let mut buffers = 1;
        if !layout.node_masks {
            let _origin_again = stream.take(12)?;
            buffers = stream.u8()?;
        }
        let values = PackedValues::read(stream, layout, &active, LEAF_VOXELS)?;
        for _ in 1..buffers {
            PackedValues::read(stream, layout, &active, LEAF_VOXELS)?;
        }
        Ok(Self { origin, active, values })
    }
}
