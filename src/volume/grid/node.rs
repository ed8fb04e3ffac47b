//! A node while the grid is assembled: its blocks and the ranges of their bricks.

use std::collections::HashMap;

use glam::IVec3;

use super::block_id::{BlockId, BlockKind};
use super::blocks::Blocks;
use super::bricks::{Brick, BrickRange, Octet, gather, union};
use super::index::{NODE_BRICKS, NODE_EDGE, NodeBlocks};
use super::parts::{Around, NodeRegion};
use super::voxel::Voxel;

/// Blocks along the edge of a node with the first of the next one.
const REACH: usize = NODE_EDGE as usize + 1;
const NOTHING: Octet = [BlockId::BACKGROUND; 8];

/// A node that is not yet part of an index.
pub(super) struct Node<V> {
    /// The blocks; constant ones but the background are numbered from 1 in `constants`.
    pub blocks: Box<NodeBlocks>,
    /// Constant blocks: the value, and the range of the brick that starts there.
    pub constants: Vec<(V, BrickRange<V>)>,
    /// Ranges of the bricks of all other blocks.
    pub stored: Vec<(BlockId, BrickRange<V>)>,
    /// Padded blocks, which stand in for the others where they are wanted.
    pub padded: Vec<(Brick<V>, BrickRange<V>)>,
    /// Range of the whole node.
    pub range: (V, V),
    /// Constant blocks whose followers are constant too.
    shared: HashMap<Octet, BlockId>,
}

/// The step to follower `corner` of an octet.
pub(super) fn step(corner: usize) -> IVec3 {
    IVec3::new((corner >> 2) as i32, (corner >> 1 & 1) as i32, (corner & 1) as i32)
}

impl<V: Voxel> Node<V> {
    /// The node of a region, with the seven that follow it; `pad` has all blocks padded that are
    /// not among constants.
    pub fn new(around: &Around, blocks: &Blocks<V>, pad: bool) -> Self {
        let reach = blocks_of(around);
        let at = |x: usize, y: usize, z: usize| reach[(x * REACH + y) * REACH + z];
        let mut node = Self {
            blocks: Box::new([BlockId::BACKGROUND; NODE_BRICKS]),
            constants: Vec::new(),
            stored: Vec::new(),
            padded: Vec::new(),
            range: (blocks.constants[0], blocks.constants[0]),
            shared: HashMap::new(),
        };
        let edge = NODE_EDGE as usize;
        let mut range = None;
        for place in 0..NODE_BRICKS {
            let [x, y, z] = [place / edge / edge, place / edge % edge, place % edge];
            let octet: Octet = std::array::from_fn(|corner| {
                at(x + (corner >> 2), y + (corner >> 1 & 1), z + (corner & 1))
            });
            let (block, more) = node.brick(&octet, blocks, pad);
            node.blocks[place] = block;
            range = Some(range.map_or(more, |range| union(range, more)));
        }
        node.range = range.unwrap_or(node.range);
        node
    }

    /// Whether every brick is background throughout.
    pub fn is_background(&self) -> bool {
        self.constants.is_empty() && self.stored.is_empty() && self.padded.is_empty()
    }

    /// The block of a brick and the brick's whole range.
    fn brick(&mut self, octet: &Octet, blocks: &Blocks<V>, pad: bool) -> (BlockId, (V, V)) {
        if *octet == NOTHING {
            return (BlockId::BACKGROUND, (blocks.constants[0], blocks.constants[0]));
        }
        let shared = octet.iter().all(|block| block.is_constant());
        if shared && let Some(&block) = self.shared.get(octet) {
            return (block, self.constants[block.number() - 1].1.whole());
        }
        let brick = gather(blocks, octet);
        let range = BrickRange::of(&brick);
        let block = if pad && !shared {
            self.padded.push((brick, range));
            BlockId::new(BlockKind::Padded, self.padded.len() - 1)
        } else if octet[0].is_constant() {
            self.constants.push((blocks.constants[octet[0].number()], range));
            BlockId::new(BlockKind::Constant, self.constants.len())
        } else {
            self.stored.push((octet[0], range));
            octet[0]
        };
        if shared {
            self.shared.insert(*octet, block);
        }
        (block, range.whole())
    }
}

/// The blocks of a node and the first of the next ones, from the node's region and its followers.
fn blocks_of(around: &Around) -> Vec<BlockId> {
    let edge = NODE_EDGE as usize;
    let mut blocks = Vec::with_capacity(REACH * REACH * REACH);
    for x in 0..REACH {
        for y in 0..REACH {
            for z in 0..REACH {
                let corner = ((x / edge) << 2) | ((y / edge) << 1) | (z / edge);
                blocks.push(match around[corner] {
                    NodeRegion::Constant(constant) => *constant,
                    NodeRegion::Blocks(blocks) => {
                        blocks[((x % edge) * edge + y % edge) * edge + z % edge]
                    }
                });
            }
        }
    }
    blocks
}
