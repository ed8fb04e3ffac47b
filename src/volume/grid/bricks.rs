//! Bricks: 8x8x8 cells with the 9x9x9 samples that interpolating in them takes, and their ranges.

use glam::IVec3;

use super::block_id::{BlockId, BlockKind};
use super::blocks::{Blocks, PADDED_EDGE, PADDED_VALUES};
use super::voxel::Voxel;

/// Cells along the edge of a brick.
pub(super) const BRICK_EDGE: i32 = 8;
/// Samples along the edge of a brick: one more than cells, the first of the next brick.
const EDGE: usize = PADDED_EDGE;
/// Samples of a layer of equal x.
const LAYER: usize = EDGE * EDGE;

/// The samples of a brick, z fastest.
pub(super) type Brick<V> = [V; PADDED_VALUES];

/// A block and the seven that follow it, counted in binary, z lowest.
pub(super) type Octet = [BlockId; 8];

/// Gathers a brick from the block that it covers and the seven after it.
pub(super) fn gather<V: Voxel>(blocks: &Blocks<V>, octet: &Octet) -> Brick<V> {
    let mut brick = [V::ZERO; EDGE * LAYER];
    for x in 0..EDGE {
        for y in 0..EDGE {
            let pair = (x >> 3) << 2 | (y >> 3) << 1;
            let row = &mut brick[x * LAYER + y * EDGE..][..EDGE];
            let start = (x & 7) << 6 | (y & 7) << 3;
            row[..8].copy_from_slice(&blocks.row(octet[pair], start));
            row[8] = blocks.value(octet[pair | 1], start);
        }
    }
    brick
}

/// Smallest and largest value, by component, of each of the 2x2x2 parts of 4x4x4 cells.
#[derive(Clone, Copy)]
pub(super) struct BrickRange<V>([(V, V); 8]);

impl<V: Voxel> BrickRange<V> {
    pub fn constant(value: V) -> Self {
        Self([(value, value); 8])
    }

    /// The ranges of the samples that interpolating in each part takes.
    pub fn of(brick: &Brick<V>) -> Self {
        let mut ranges = [(V::ZERO, V::ZERO); 8];
        for (half, parts) in ranges.chunks_exact_mut(4).enumerate() {
            // Along x first: whole layers side by side are what the processor does fastest.
            let layers = &brick[half * 4 * LAYER..][..5 * LAYER];
            let mut low: [V; LAYER] = std::array::from_fn(|n| layers[n]);
            let mut high = low;
            for layer in layers.chunks_exact(LAYER).skip(1) {
                for ((low, high), &value) in low.iter_mut().zip(&mut high).zip(layer) {
                    *low = low.component_min(value);
                    *high = high.component_max(value);
                }
            }
            for (part, range) in parts.iter_mut().enumerate() {
                *range = range_of_square(&low, &high, part >> 1, part & 1);
            }
        }
        Self(ranges)
    }

    /// The range of the whole brick.
    pub fn whole(&self) -> (V, V) {
        self.within(IVec3::ZERO, IVec3::splat(BRICK_EDGE - 1))
    }

    /// The range of the parts that hold the cells `low..=high`, each in 0..8.
    pub fn within(&self, low: IVec3, high: IVec3) -> (V, V) {
        let [low, high] =
            [low, high].map(|cell: IVec3| (cell >> 2_i32).to_array().map(|c| c as usize & 1));
        let mut range = self.0[low[0] << 2 | low[1] << 1 | low[2]];
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    range = union(range, self.0[x << 2 | y << 1 | z]);
                }
            }
        }
        range
    }
}

/// The range of a part's samples, from the smallest and largest ones along x.
fn range_of_square<V: Voxel>(low: &[V; LAYER], high: &[V; LAYER], y: usize, z: usize) -> (V, V) {
    let first = y * 4 * EDGE + z * 4;
    let mut range = (low[first], high[first]);
    for row in (first..).step_by(EDGE).take(5) {
        for place in row..row + 5 {
            range = union(range, (low[place], high[place]));
        }
    }
    range
}

/// The smallest range around both.
pub(super) fn union<V: Voxel>(a: (V, V), b: (V, V)) -> (V, V) {
    (a.0.component_min(b.0), a.1.component_max(b.1))
}

/// The ranges of all bricks, by the block that each covers.
pub(super) struct Ranges<V> {
    by_kind: [Vec<BrickRange<V>>; 4],
}

impl<V: Voxel> Ranges<V> {
    /// Ranges of no brick but those that are background throughout, with room for the blocks of
    /// half floats and of floats.
    pub fn new(background: V, halves: usize, floats: usize) -> Self {
        let background = BrickRange::constant(background);
        let room = |blocks| vec![background; blocks];
        Self { by_kind: [room(1), room(halves), room(floats), Vec::new()] }
    }

    #[inline]
    pub fn of(&self, block: BlockId) -> &BrickRange<V> {
        &self.by_kind[block.kind() as usize][block.number()]
    }

    /// Sets the range of a brick whose block is stored.
    pub fn set(&mut self, block: BlockId, range: BrickRange<V>) {
        self.by_kind[block.kind() as usize][block.number()] = range;
    }

    /// Adds the range of the next constant or padded block.
    pub fn push(&mut self, kind: BlockKind, range: BrickRange<V>) {
        self.by_kind[kind as usize].push(range);
    }

    /// Gives back what memory is not needed.
    pub fn shrink(&mut self) {
        self.by_kind.iter_mut().for_each(Vec::shrink_to_fit);
    }

    pub fn memory_bytes(&self) -> usize {
        self.by_kind.iter().map(|ranges| size_of_val(&**ranges)).sum()
    }
}
