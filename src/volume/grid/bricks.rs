//! Bricks: 8x8x8 cells with the 9x9x9 samples that interpolating in them takes.

use glam::{IVec3, Vec3A};

use super::voxel::Voxel;

/// Cells along the edge of a brick.
pub(super) const BRICK_EDGE: i32 = 8;
/// Samples along the edge of a brick: one more than cells, the first of the next brick.
const EDGE: usize = 9;
/// Distance in memory between samples that are neighbors along x and y (along z it is 1).
const STRIDE_X: usize = EDGE * EDGE;
const STRIDE_Y: usize = EDGE;
const SAMPLES: usize = EDGE * EDGE * EDGE;
/// Offset in memory of the last of the eight corners of a cell from the first.
const CELL_SPAN: usize = STRIDE_X + STRIDE_Y + 1;

/// The samples of a brick, z fastest.
pub(super) type Brick<V> = [V; SAMPLES];

/// Source of the values of a block of 8x8x8 voxels.
#[derive(Clone, Copy)]
pub(super) enum BrickSource<'a, V> {
    Constant(V),
    /// 512 values, z fastest.
    Leaf(&'a [V; 512]),
}

/// The position of a cell's first corner in its brick.
#[inline(always)]
fn offset(cell: IVec3) -> usize {
    let [x, y, z] = (cell & (BRICK_EDGE - 1)).to_array().map(|c| c as usize);
    x * STRIDE_X + y * STRIDE_Y + z
}

/// The sample at the first corner of `cell`.
#[inline(always)]
pub(super) fn sample_at<V: Voxel>(brick: &Brick<V>, cell: IVec3) -> V {
    brick[offset(cell)]
}

/// Trilinear interpolation at `t` in 0..=1 within `cell`, a nested [`Voxel::lerp`].
#[inline(always)]
pub(super) fn interpolate<V: Voxel>(brick: &Brick<V>, cell: IVec3, t: Vec3A) -> V {
    let first = offset(cell);
    let c = &brick[first..=first + CELL_SPAN];
    let along_x = |k: usize| V::lerp(c[k], c[k + STRIDE_X], t.x);
    let low = V::lerp(along_x(0), along_x(STRIDE_Y), t.y);
    let high = V::lerp(along_x(1), along_x(STRIDE_Y + 1), t.y);
    V::lerp(low, high, t.z)
}

/// Fills a brick from the block that it covers and the seven after it; `sources` counts in
/// binary, z lowest.
pub(super) fn fill<V: Voxel>(brick: &mut Brick<V>, sources: &[BrickSource<'_, V>; 8]) {
    for x in 0..EDGE {
        for y in 0..EDGE {
            let pair = (x >> 3) << 2 | (y >> 3) << 1;
            let row = &mut brick[x * STRIDE_X + y * STRIDE_Y..][..EDGE];
            let start = (x & 7) << 6 | (y & 7) << 3;
            match sources[pair] {
                BrickSource::Constant(value) => row[..8].fill(value),
                BrickSource::Leaf(values) => row[..8].copy_from_slice(&values[start..start + 8]),
            }
            row[8] = match sources[pair | 1] {
                BrickSource::Constant(value) => value,
                BrickSource::Leaf(values) => values[start],
            };
        }
    }
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
        Self(std::array::from_fn(|part| {
            let first = [part >> 2, part >> 1 & 1, part & 1].map(|half| half * 4);
            let mut low = brick[first[0] * STRIDE_X + first[1] * STRIDE_Y + first[2]];
            let mut high = low;
            for x in first[0]..=first[0] + 4 {
                for y in first[1]..=first[1] + 4 {
                    let row = x * STRIDE_X + y * STRIDE_Y + first[2];
                    for &value in &brick[row..row + 5] {
                        low = low.component_min(value);
                        high = high.component_max(value);
                    }
                }
            }
            (low, high)
        }))
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

/// The smallest range around both.
pub(super) fn union<V: Voxel>(a: (V, V), b: (V, V)) -> (V, V) {
    (a.0.component_min(b.0), a.1.component_max(b.1))
}
