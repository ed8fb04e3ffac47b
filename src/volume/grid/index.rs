//! Index of blocks: the block that holds a voxel, in memory that grows with the stored data.

use glam::{IVec3, UVec3};

use super::block_id::BlockId;
use super::index_box::IndexBox;

/// log2 of the bricks along the edge of a node; below, of a brick's edge and of a node's in voxels.
const NODE_BITS: i32 = 4;
const BRICK_BITS: i32 = 3;
pub(super) const NODE_VOXEL_BITS: i32 = NODE_BITS + BRICK_BITS;
/// Bricks along the edge of a node.
pub(super) const NODE_EDGE: i32 = 1 << NODE_BITS;
/// Bricks in a node.
pub(super) const NODE_BRICKS: usize = 1 << (3 * NODE_BITS);

/// The blocks of the 16x16x16 bricks of a node, z fastest.
pub(super) type NodeBlocks = [BlockId; NODE_BRICKS];

/// A dense table of nodes may always have this many entries, and ...
const DENSE_ENTRIES: u64 = 1 << 16;
/// ... this many for each node that is there (4 bytes beside a node's 16 KiB).
const DENSE_ENTRIES_PER_NODE: u64 = 64;
/// A dense table must count voxels in 31 bits, so each edge is at most this many nodes.
const DENSE_EDGE: u64 = 1 << (31 - NODE_VOXEL_BITS);

/// The node position of a voxel.
pub(super) fn node_of(voxel: IVec3) -> IVec3 {
    voxel >> NODE_VOXEL_BITS
}

/// The voxels of the node at `position`.
pub(super) fn node_box(position: IVec3) -> IndexBox {
    let min = position << NODE_VOXEL_BITS;
    IndexBox { min, max: min + ((1 << NODE_VOXEL_BITS) - 1) }
}

/// Index of a voxel's brick in its node.
#[inline(always)]
pub(super) fn brick_in_node(voxel: IVec3) -> usize {
    let [x, y, z] =
        ((voxel >> BRICK_BITS) & (NODE_EDGE - 1)).to_array().map(|c| c as usize % NODE_BRICKS);
    (x << (2 * NODE_BITS) | y << NODE_BITS | z) & (NODE_BRICKS - 1)
}

/// Two-level index: nodes of 16x16x16 bricks, and a table of nodes over the data's box or, where
/// the data is scattered too far apart for that, a sorted list of them. Node 0 is background.
pub(super) struct Index {
    table: IndexTable,
    pub nodes: Vec<NodeBlocks>,
}

enum IndexTable {
    Dense {
        /// First voxel of the table.
        origin: IVec3,
        /// Edges in voxels.
        size: UVec3,
        /// Nodes along y times z, and along z.
        strides: [usize; 2],
        ids: Vec<u32>,
    },
    /// A list of nodes, sorted by position.
    Sparse { positions: Vec<[i32; 3]>, ids: Vec<u32> },
}

impl Index {
    /// An index over `entries`, positions and numbers of nodes, sorted by [x, y, z], none twice.
    pub fn new(entries: &[(IVec3, u32)], nodes: Vec<NodeBlocks>) -> Self {
        let bounds = entries
            .iter()
            .map(|&(position, _)| IndexBox::of_voxel(position))
            .fold(None, |bounds, one| IndexBox::union(bounds, Some(one)));
        let table = match bounds {
            Some(bounds) if is_compact(&bounds, entries.len()) => dense(&bounds, entries),
            _ => IndexTable::Sparse {
                positions: entries.iter().map(|(position, _)| position.to_array()).collect(),
                ids: entries.iter().map(|&(_, id)| id).collect(),
            },
        };
        Self { table, nodes }
    }

    /// The block that holds `voxel`.
    #[inline(always)]
    pub fn block(&self, voxel: IVec3) -> BlockId {
        let node = match &self.table {
            IndexTable::Dense { origin, size, strides, ids } => {
                // Wrapping, so that one comparison finds what lies before and beyond the table.
                let local = voxel.wrapping_sub(*origin).as_uvec3();
                if local.x >= size.x || local.y >= size.y || local.z >= size.z {
                    return BlockId::BACKGROUND;
                }
                let [x, y, z] = local.to_array().map(|c| (c >> NODE_VOXEL_BITS) as usize);
                ids.get(x * strides[0] + y * strides[1] + z).copied().unwrap_or(0)
            }
            IndexTable::Sparse { positions, ids } => find(positions, ids, node_of(voxel)),
        };
        let node = self.nodes.get(node as usize);
        node.map_or(BlockId::BACKGROUND, |node| node[brick_in_node(voxel)])
    }

    /// Calls `visit` with the position and number of the nodes in `bounds` (node positions) that
    /// are not plain background, and perhaps of some that are. Returns whether some positions
    /// were left out, all of which are background. Takes time in proportion to what is stored.
    pub fn visit(&self, bounds: &IndexBox, mut visit: impl FnMut(IVec3, u32)) -> bool {
        match &self.table {
            IndexTable::Dense { origin, size, strides, ids } => {
                let first = node_of(*origin);
                let last = first + node_of(size.as_ivec3()) - 1;
                let table = IndexBox { min: first, max: last };
                let inside = bounds.intersection(&table);
                for position in inside.positions() {
                    let [x, y, z] = (position - first).to_array().map(|c| c as usize);
                    visit(position, ids[x * strides[0] + y * strides[1] + z]);
                }
                inside != *bounds
            }
            IndexTable::Sparse { positions, ids } => {
                let wanted = bounds.voxel_count();
                if wanted <= positions.len() as u64 {
                    bounds.positions().for_each(|at| visit(at, find(positions, ids, at)));
                    return false;
                }
                let mut found = 0;
                for (&position, &id) in positions.iter().zip(ids) {
                    let position = IVec3::from_array(position);
                    if bounds.contains(&IndexBox::of_voxel(position)) {
                        visit(position, id);
                        found += 1;
                    }
                }
                found < wanted
            }
        }
    }

    /// Moves every node by `-shift` nodes, where all stay in the range of coordinates.
    pub fn shift(&mut self, shift: IVec3) {
        match &mut self.table {
            IndexTable::Dense { origin, .. } => *origin -= shift << NODE_VOXEL_BITS,
            IndexTable::Sparse { positions, .. } => {
                // The order is by position, and the same move of all keeps it.
                for position in positions {
                    *position = (IVec3::from_array(*position) - shift).to_array();
                }
            }
        }
    }

    /// Number of places that each node stands at; that of the background is not counted.
    pub fn node_uses(&self) -> Vec<u64> {
        let (IndexTable::Dense { ids, .. } | IndexTable::Sparse { ids, .. }) = &self.table;
        let mut uses = vec![0; self.nodes.len()];
        for &id in ids.iter().filter(|&&id| id != 0) {
            uses[id as usize] += 1;
        }
        uses
    }

    /// Memory of the index, in bytes.
    pub fn memory_bytes(&self) -> usize {
        let table = match &self.table {
            IndexTable::Dense { ids, .. } => size_of_val(&**ids),
            IndexTable::Sparse { positions, ids } => {
                size_of_val(&**positions) + size_of_val(&**ids)
            }
        };
        table + size_of_val(&*self.nodes)
    }
}

fn is_compact(bounds: &IndexBox, nodes: usize) -> bool {
    let edges = bounds.max.as_i64vec3() - bounds.min.as_i64vec3() + 1;
    let limit = DENSE_ENTRIES.max(nodes as u64 * DENSE_ENTRIES_PER_NODE);
    edges.max_element() as u64 <= DENSE_EDGE && bounds.voxel_count() <= limit
}

fn dense(bounds: &IndexBox, entries: &[(IVec3, u32)]) -> IndexTable {
    let edges = bounds.max - bounds.min + 1;
    let [nx, ny, nz] = edges.to_array().map(|edge| edge as usize);
    let strides = [ny * nz, nz];
    let mut ids = vec![0; nx * ny * nz];
    for &(position, id) in entries {
        let [x, y, z] = (position - bounds.min).to_array().map(|c| c as usize);
        ids[x * strides[0] + y * strides[1] + z] = id;
    }
    let origin = bounds.min << NODE_VOXEL_BITS;
    IndexTable::Dense { origin, size: edges.as_uvec3() << NODE_VOXEL_BITS, strides, ids }
}

/// Looks up a node in the sorted list; kept out of line so that look-ups in the usual table stay
/// short.
#[inline(never)]
fn find(positions: &[[i32; 3]], ids: &[u32], position: IVec3) -> u32 {
    positions.binary_search(&position.to_array()).map_or(0, |at| ids[at])
}
