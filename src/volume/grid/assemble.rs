//! Assembles leaves and tiles into bricks and their index.
//!
//! A brick takes its samples from the block that it covers and the seven blocks after it. Where
//! these are all constants, the brick is determined by the eight constants and shared by all that
//! have the same ones; so are nodes among constant regions. A tile of any size thus costs little
//! more than its place in the table of nodes, its faces included.

use std::collections::{HashMap, HashSet};

use glam::IVec3;
use rayon::prelude::*;

use super::bricks::{Brick, BrickRange, BrickSource, fill, union};
use super::index::{BrickNumbers, Index, NODE_BRICKS, NODE_EDGE, node_of};
use super::parts::{BlockOrigin, NodeRegion, Parts};
use super::sparse_grid::SparseGrid;
use super::voxel::Voxel;
use crate::error::{Error, Progress, Result};

/// Blocks along the edge of a node with the first of the next one.
const REACH: usize = NODE_EDGE as usize + 1;
/// Bricks filled between two checks for cancellation.
const BRICKS_PER_STEP: usize = 256;

/// A block or node and its seven followers, counted in binary, z lowest.
type Octet = [BlockOrigin; 8];

/// The octets that make the bricks and nodes, numbered in the order of their first appearance.
struct Plan {
    bricks: Vec<Octet>,
    shared_bricks: HashMap<Octet, u32>,
    nodes: Vec<BrickNumbers>,
    shared_nodes: HashMap<Octet, u32>,
}

/// Builds the grid.
pub(super) fn assemble<V: Voxel>(parts: Parts<V>, progress: Progress) -> Result<SparseGrid<V>> {
    let mut plan = Plan::new();
    let positions = node_positions(&parts.regions);
    let mut entries = Vec::with_capacity(positions.len());
    for (done, &position) in positions.iter().enumerate() {
        if done % 16 == 0 && !progress(0.2 + 0.3 * done as f32 / positions.len() as f32) {
            return Err(Error::Cancelled);
        }
        let id = plan.node(position, &parts.regions);
        if id != 0 {
            entries.push((position, id));
        }
    }
    let (bricks, ranges) = fill_bricks(&plan.bricks, &parts, progress)?;
    let node_ranges = plan.nodes.par_iter().map(|node| node_range(node, &ranges)).collect();
    let index = Index::new(&entries, plan.nodes);
    Ok(SparseGrid::from_parts(index, bricks, ranges, node_ranges, &parts.summary))
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

/// The step to follower `corner` of an octet.
fn step(corner: usize) -> IVec3 {
    IVec3::new((corner >> 2) as i32, (corner >> 1 & 1) as i32, (corner & 1) as i32)
}

impl Plan {
    fn new() -> Self {
        let background = [BlockOrigin::BACKGROUND; 8];
        Self {
            bricks: vec![background],
            shared_bricks: HashMap::from([(background, 0)]),
            nodes: vec![[0; NODE_BRICKS]],
            shared_nodes: HashMap::from([(background, 0)]),
        }
    }

    /// The number of the node at `position`.
    fn node(&mut self, position: IVec3, regions: &HashMap<IVec3, NodeRegion>) -> u32 {
        const EMPTY: NodeRegion = NodeRegion::Constant(BlockOrigin::BACKGROUND);
        let around: [&NodeRegion; 8] =
            std::array::from_fn(|corner| regions.get(&(position + step(corner))).unwrap_or(&EMPTY));
        let constants: Option<Vec<BlockOrigin>> = around
            .iter()
            .map(|region| match region {
                NodeRegion::Constant(origin) => Some(*origin),
                NodeRegion::Blocks(_) => None,
            })
            .collect();
        let shared: Option<Octet> = constants.and_then(|octet| octet.try_into().ok());
        if let Some(&id) = shared.and_then(|octet| self.shared_nodes.get(&octet)) {
            return id;
        }
        let node = self.bricks_of(&around);
        if shared.is_none() && node.iter().all(|&brick| brick == 0) {
            return 0;
        }
        self.nodes.push(node);
        let id = self.nodes.len() as u32 - 1;
        if let Some(octet) = shared {
            self.shared_nodes.insert(octet, id);
        }
        id
    }

    fn bricks_of(&mut self, around: &[&NodeRegion; 8]) -> BrickNumbers {
        let blocks = blocks_of(around);
        let at = |x: usize, y: usize, z: usize| blocks[(x * REACH + y) * REACH + z];
        let mut node = [0; NODE_BRICKS];
        let edge = NODE_EDGE as usize;
        for (place, brick) in node.iter_mut().enumerate() {
            let [x, y, z] = [place / edge / edge, place / edge % edge, place % edge];
            let octet: Octet = std::array::from_fn(|corner| {
                at(x + (corner >> 2), y + (corner >> 1 & 1), z + (corner & 1))
            });
            *brick = self.brick(octet);
        }
        node
    }

    fn brick(&mut self, octet: Octet) -> u32 {
        if octet == [BlockOrigin::BACKGROUND; 8] {
            return 0;
        }
        let shared = octet.iter().all(|origin| origin.leaf().is_none());
        if shared && let Some(&id) = self.shared_bricks.get(&octet) {
            return id;
        }
        self.bricks.push(octet);
        let id = self.bricks.len() as u32 - 1;
        if shared {
            self.shared_bricks.insert(octet, id);
        }
        id
    }
}

/// The blocks of a node and the first of the next ones, from the node's region and its followers.
fn blocks_of(around: &[&NodeRegion; 8]) -> Vec<BlockOrigin> {
    let edge = NODE_EDGE as usize;
    let mut blocks = Vec::with_capacity(REACH * REACH * REACH);
    for x in 0..REACH {
        for y in 0..REACH {
            for z in 0..REACH {
                let corner = ((x / edge) << 2) | ((y / edge) << 1) | (z / edge);
                blocks.push(match around[corner] {
                    NodeRegion::Constant(origin) => *origin,
                    NodeRegion::Blocks(blocks) => {
                        blocks[((x % edge) * edge + y % edge) * edge + z % edge]
                    }
                });
            }
        }
    }
    blocks
}

type Filled<V> = (Vec<Brick<V>>, Vec<BrickRange<V>>);

fn fill_bricks<V: Voxel>(
    octets: &[Octet],
    parts: &Parts<V>,
    progress: Progress,
) -> Result<Filled<V>> {
    let background = parts.constants[0];
    let mut bricks = vec![[V::ZERO; _]; octets.len()];
    let mut ranges = vec![BrickRange::constant(background); octets.len()];
    let done = std::sync::atomic::AtomicUsize::new(0);
    let steps = octets.len().div_ceil(BRICKS_PER_STEP) as f32;
    bricks
        .par_chunks_mut(BRICKS_PER_STEP)
        .zip(ranges.par_chunks_mut(BRICKS_PER_STEP))
        .zip(octets.par_chunks(BRICKS_PER_STEP))
        .try_for_each(|((bricks, ranges), octets)| {
            let done = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            if !progress(0.5 + 0.5 * done as f32 / steps) {
                return Err(Error::Cancelled);
            }
            for ((brick, range), octet) in bricks.iter_mut().zip(ranges).zip(octets) {
                fill(brick, &octet.map(|origin| source(origin, parts)));
                *range = BrickRange::of(brick);
            }
            Ok(())
        })?;
    Ok((bricks, ranges))
}

fn source<V: Voxel>(origin: BlockOrigin, parts: &Parts<V>) -> BrickSource<'_, V> {
    match origin.leaf() {
        Some(leaf) => BrickSource::Leaf(&parts.leaves[leaf].values),
        None => BrickSource::Constant(parts.constants[origin.constant()]),
    }
}

fn node_range<V: Voxel>(node: &BrickNumbers, ranges: &[BrickRange<V>]) -> (V, V) {
    let mut last = node[0];
    let mut range = ranges[last as usize].whole();
    for &brick in node {
        if brick != last {
            last = brick;
            range = union(range, ranges[brick as usize].whole());
        }
    }
    range
}
