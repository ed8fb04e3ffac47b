//! Assembles blocks and tiles into nodes and their index.
//!
//! A brick takes its samples from the block that it covers and the seven blocks after it. Nodes
//! whose region and whose seven followers are all constants are determined by these eight, and
//! shared by all that have the same ones. A tile of any size thus costs little more than its place
//! in the table of nodes, its faces included.

use std::collections::{HashMap, HashSet};

use glam::IVec3;
use rayon::prelude::*;

use super::block_id::{BlockId, BlockKind};
use super::blocks::PADDED_VALUES;
use super::bricks::{Octet, Ranges};
use super::index::{Index, NODE_BRICKS, NodeBlocks, node_of};
use super::node::{Node, step};
use super::parts::{Around, NodeRegion, Parts};
use super::sparse_grid::SparseGrid;
use super::voxel::Voxel;
use crate::error::{Error, Progress, Result};

/// Nodes made before they are gathered, so that what they are made of takes little memory.
const NODES_PER_STEP: usize = 64;

/// Builds the grid.
pub(super) fn assemble<V: Voxel>(parts: Parts<V>, progress: Progress) -> Result<SparseGrid<V>> {
    let plan = Plan::new(&parts.regions);
    let mut gathered = Gathered::new(&parts, plan.made.len());
    let mut done = 0.0;
    for around in plan.made.chunks(NODES_PER_STEP) {
        let make = |around: &Around| match progress(done / plan.made.len() as f32) {
            true => Ok(Node::new(around, &parts.blocks, parts.pad)),
            false => Err(Error::Cancelled),
        };
        let nodes = around.par_iter().map(make).collect::<Result<Vec<_>>>()?;
        nodes.into_iter().for_each(|node| gathered.add(node));
        done += around.len() as f32;
    }
    let number = |&(position, made): &(IVec3, usize)| (position, gathered.ids[made]);
    let entries: Vec<_> = plan.places.iter().map(number).filter(|&(_, id)| id != 0).collect();
    Ok(gathered.finish(&entries, parts))
}

/// The nodes to make, and which of them stands at each position.
struct Plan<'a> {
    made: Vec<Around<'a>>,
    places: Vec<(IVec3, usize)>,
}

impl<'a> Plan<'a> {
    fn new(regions: &'a HashMap<IVec3, NodeRegion>) -> Self {
        const EMPTY: NodeRegion = NodeRegion::Constant(BlockId::BACKGROUND);
        let mut plan = Self { made: Vec::new(), places: Vec::new() };
        let mut shared: HashMap<Octet, usize> = HashMap::new();
        for position in node_positions(regions) {
            let region = |corner| regions.get(&(position + step(corner))).unwrap_or(&EMPTY);
            let around: Around = std::array::from_fn(region);
            let next = plan.made.len();
            let made = match constants(&around) {
                Some([BlockId::BACKGROUND, ref rest @ ..])
                    if rest.iter().all(|&block| block == BlockId::BACKGROUND) =>
                {
                    continue;
                }
                Some(octet) => *shared.entry(octet).or_insert(next),
                None => next,
            };
            if made == next {
                plan.made.push(around);
            }
            plan.places.push((position, made));
        }
        plan
    }
}

/// The constants of eight regions, if they are nothing else.
fn constants(around: &Around) -> Option<Octet> {
    let mut octet = [BlockId::BACKGROUND; 8];
    for (block, region) in octet.iter_mut().zip(around) {
        let NodeRegion::Constant(constant) = region else { return None };
        *block = *constant;
    }
    Some(octet)
}

/// Every node that may hold more than background: those with data and the seven before each,
/// whose last samples belong to it. Sorted. Nodes before the smallest coordinate hold no voxel.
fn node_positions(regions: &HashMap<IVec3, NodeRegion>) -> Vec<IVec3> {
    let mut positions: HashSet<IVec3> = HashSet::with_capacity(2 * regions.len());
    for &position in regions.keys() {
        positions.extend((0..8).map(|corner| position - step(corner)));
    }
    let first = node_of(IVec3::MIN);
    let mut positions: Vec<_> =
        positions.into_iter().filter(|position| position.cmpge(first).all()).collect();
    positions.sort_unstable_by_key(IVec3::to_array);
    positions
}

/// Nodes made so far.
struct Gathered<V> {
    nodes: Vec<NodeBlocks>,
    node_ranges: Vec<(V, V)>,
    ranges: Ranges<V>,
    /// Values of the constant blocks that the nodes refer to.
    constants: Vec<V>,
    padded: Vec<[f32; PADDED_VALUES]>,
    /// Number in `nodes` of each node in the order of making.
    ids: Vec<u32>,
}

impl<V: Voxel> Gathered<V> {
    /// Nothing but the node and the block that are background throughout.
    fn new(parts: &Parts<V>, capacity: usize) -> Self {
        let background = parts.blocks.constants[0];
        let [halves, floats] = match parts.pad {
            true => [0, 0],
            false => [parts.blocks.halves.len(), parts.blocks.floats.len()],
        };
        let mut nodes = Vec::with_capacity(capacity + 1);
        nodes.push([BlockId::BACKGROUND; NODE_BRICKS]);
        Self {
            nodes,
            node_ranges: vec![(background, background)],
            ranges: Ranges::new(background, halves / V::COMPONENTS, floats / V::COMPONENTS),
            constants: vec![background],
            padded: Vec::new(),
            ids: Vec::with_capacity(capacity),
        }
    }

    /// Adds a node, whose constant blocks are numbered on its own.
    fn add(&mut self, node: Node<V>) {
        if node.is_background() {
            self.ids.push(0);
            return;
        }
        let constants = self.constants.len() - 1;
        let padded = self.padded.len() / V::COMPONENTS;
        let mut blocks = *node.blocks;
        for block in blocks.iter_mut().filter(|&&mut block| block != BlockId::BACKGROUND) {
            match block.kind() {
                kind @ BlockKind::Constant => {
                    *block = BlockId::new(kind, block.number() + constants)
                }
                kind @ BlockKind::Padded => *block = BlockId::new(kind, block.number() + padded),
                BlockKind::Half | BlockKind::Float => {}
            }
        }
        self.ids.push(self.nodes.len() as u32);
        self.nodes.push(blocks);
        self.node_ranges.push(node.range);
        node.stored.into_iter().for_each(|(block, range)| self.ranges.set(block, range));
        for (value, range) in node.constants {
            self.constants.push(value);
            self.ranges.push(BlockKind::Constant, range);
        }
        for (brick, range) in node.padded {
            let component = |c| brick.map(|value| value.component(c));
            self.padded.extend((0..V::COMPONENTS).map(component));
            self.ranges.push(BlockKind::Padded, range);
        }
    }

    fn finish(mut self, entries: &[(IVec3, u32)], parts: Parts<V>) -> SparseGrid<V> {
        self.constants.shrink_to_fit();
        self.ranges.shrink();
        self.nodes.shrink_to_fit();
        self.padded.shrink_to_fit();
        let blocks = parts.blocks.assembled(self.constants, self.padded);
        let index = Index::new(entries, self.nodes);
        SparseGrid::from_parts(index, blocks, self.ranges, self.node_ranges, &parts.summary)
    }
}
