//! Storage of the values: blocks of 8x8x8 voxels, as half floats where every value is exactly one.
//!
//! A block holds nothing but its own voxels, so that memory is that of the values. Seven eighths
//! of the cells along each axis lie within one block; the others look up the next ones as well.
//! In small grids, where memory does not matter, a block is *padded* with the first voxels of the
//! next ones, and a look-up touches no other. Vectors have a block of numbers for each component,
//! one after another.

use glam::{IVec3, Vec3A, Vec4, Vec4Swizzles};

use super::block_id::{BlockId, BlockKind};
use super::index::Index;
use super::voxel::Voxel;
use crate::volume::half::{is_half, narrow, widen, widen_pairs};

/// Voxels along the edge of a block.
pub(super) const BLOCK_EDGE: i32 = 8;
/// Values of a block, z fastest.
pub(super) const BLOCK_VALUES: usize = 512;
/// Distance in memory between voxels that are neighbors along x, y and z.
const STRIDES: [usize; 3] = [64, 8, 1];
/// Voxels along the edge of a padded block, and the distances in it.
pub(super) const PADDED_EDGE: usize = 9;
const PADDED_STRIDES: [usize; 3] = [PADDED_EDGE * PADDED_EDGE, PADDED_EDGE, 1];
/// Values of a padded block.
pub(super) const PADDED_VALUES: usize = PADDED_EDGE * PADDED_EDGE * PADDED_EDGE;

/// The values of all blocks.
pub(super) struct Blocks<V> {
    /// Values of the constant blocks; the first is the background.
    pub constants: Vec<V>,
    /// Blocks of half floats and of floats; the first of each is the background, so that it can be
    /// read like its neighbors.
    pub halves: Vec<[u16; BLOCK_VALUES]>,
    pub floats: Vec<[f32; BLOCK_VALUES]>,
    pub padded: Vec<[f32; PADDED_VALUES]>,
    /// Whether the background is exactly a half float, and the first of `halves` is right.
    half_background: bool,
}

/// The place of a voxel in its block.
#[inline(always)]
pub(super) fn offset(voxel: IVec3) -> usize {
    let [x, y, z] = (voxel & (BLOCK_EDGE - 1)).to_array().map(|c| c as usize);
    x * STRIDES[0] + y * STRIDES[1] + z * STRIDES[2]
}

/// The place in a padded block of what is at `offset` in others.
#[inline(always)]
fn padded_offset(offset: usize) -> usize {
    (offset >> 6) * PADDED_STRIDES[0] + (offset >> 3 & 7) * PADDED_STRIDES[1] + (offset & 7)
}

impl<V: Voxel> Blocks<V> {
    /// Nothing but the background.
    pub fn new(background: V) -> Self {
        let components = || (0..V::COMPONENTS).map(|c| background.component(c));
        Self {
            constants: vec![background],
            halves: components().map(|value| [narrow(value); BLOCK_VALUES]).collect(),
            floats: components().map(|value| [value; BLOCK_VALUES]).collect(),
            padded: Vec::new(),
            half_background: components().all(is_half),
        }
    }

    /// The blocks after all others were replaced by padded ones, if there are any; the constant
    /// ones by `constants`.
    pub fn assembled(mut self, constants: Vec<V>, padded: Vec<[f32; PADDED_VALUES]>) -> Self {
        if !padded.is_empty() {
            self.halves.truncate(V::COMPONENTS);
            self.floats.truncate(V::COMPONENTS);
            self.halves.shrink_to_fit();
            self.floats.shrink_to_fit();
        }
        Self { constants, padded, ..self }
    }

    pub fn memory_bytes(&self) -> usize {
        size_of_val(&*self.constants)
            + size_of_val(&*self.halves)
            + size_of_val(&*self.floats)
            + size_of_val(&*self.padded)
    }

    /// The value at a place of a block.
    #[inline(always)]
    pub fn value(&self, block: BlockId, offset: usize) -> V {
        let first = block.number() * V::COMPONENTS;
        match block.kind() {
            BlockKind::Constant => self.constants[block.number()],
            BlockKind::Half => by_component(|c| widen(self.halves[first + c][offset])),
            BlockKind::Float => by_component(|c| self.floats[first + c][offset]),
            BlockKind::Padded => by_component(|c| self.padded[first + c][padded_offset(offset)]),
        }
    }

    /// Eight values along z, the first at `offset`.
    pub fn row(&self, block: BlockId, offset: usize) -> [V; 8] {
        let first = block.number() * V::COMPONENTS;
        match block.kind() {
            BlockKind::Constant => [self.constants[block.number()]; 8],
            BlockKind::Half => {
                let rows: [[u16; 8]; 3] = rows::<V, _, _>(&self.halves, first, offset);
                std::array::from_fn(|z| by_component(|c| widen(rows[c][z])))
            }
            BlockKind::Float => {
                let rows: [[f32; 8]; 3] = rows::<V, _, _>(&self.floats, first, offset);
                std::array::from_fn(|z| by_component(|c| rows[c][z]))
            }
            BlockKind::Padded => {
                let offset = padded_offset(offset);
                let rows: [[f32; 8]; 3] = rows::<V, _, _>(&self.padded, first, offset);
                std::array::from_fn(|z| by_component(|c| rows[c][z]))
            }
        }
    }

    /// Trilinear interpolation at `t` in 0..=1 within `cell`, whose first corner lies in `block`.
    #[inline(always)]
    pub fn interpolate(&self, index: &Index, block: BlockId, cell: IVec3, t: Vec3A) -> V {
        if block == BlockId::BACKGROUND {
            return self.constants[0];
        }
        let number = block.number() * V::COMPONENTS;
        let inner = cell & (BLOCK_EDGE - 1);
        if block.kind() == BlockKind::Padded {
            let [x, y, z] = inner.to_array().map(|c| c as usize);
            let first = x * PADDED_STRIDES[0] + y * PADDED_STRIDES[1] + z;
            return by_component(|c| {
                let plane = within(&self.padded[number + c], first, &PADDED_STRIDES);
                trilinear(|corner| plane[corner_offset(corner, &PADDED_STRIDES)], t)
            });
        }
        let next = inner + 1;
        if (next.x | next.y | next.z) & BLOCK_EDGE != 0 {
            return self.interpolate_across(index, block, cell, t);
        }
        let first = offset(cell);
        match block.kind() {
            BlockKind::Constant => self.constants[block.number()],
            BlockKind::Half => by_component(|c| {
                let plane = within(&self.halves[number + c], first, &STRIDES);
                trilinear_halves(|corner| plane[corner_offset(corner, &STRIDES)], t)
            }),
            _ => by_component(|c| {
                let plane = within(&self.floats[number + c], first, &STRIDES);
                trilinear(|corner| plane[corner_offset(corner, &STRIDES)], t)
            }),
        }
    }

    /// Interpolation where some corners of the cell lie in the next blocks. Most often the cell
    /// lies across one face, and in two blocks.
    #[inline(never)]
    fn interpolate_across(&self, index: &Index, block: BlockId, cell: IVec3, t: Vec3A) -> V {
        let places = Places::new(cell);
        let faces = places.faces();
        if !faces.is_power_of_two() {
            return self.interpolate_at_edge(index, block, cell, t);
        }
        let step = IVec3::new((faces >> 2) as i32, (faces >> 1 & 1) as i32, (faces & 1) as i32);
        let Some((kind, [near, far])) =
            self.common_kind(block, index.block(cell.wrapping_add(step)))
        else {
            return self.interpolate_at_edge(index, block, cell, t);
        };
        match kind {
            BlockKind::Constant => self.constants[near],
            BlockKind::Half => by_component(|c| {
                let planes = [&self.halves[near + c], &self.halves[far + c]];
                trilinear_halves(|n| planes[usize::from(n & faces != 0)][places.of(n)], t)
            }),
            _ => by_component(|c| {
                let planes = [&self.floats[near + c], &self.floats[far + c]];
                trilinear(|n| planes[usize::from(n & faces != 0)][places.of(n)], t)
            }),
        }
    }

    /// Interpolation where the corners lie in up to eight blocks of any kinds.
    #[inline(never)]
    fn interpolate_at_edge(&self, index: &Index, block: BlockId, cell: IVec3, t: Vec3A) -> V {
        let places = Places::new(cell);
        let faces = places.faces();
        let mut blocks = [block; 8];
        for (corner, block) in blocks.iter_mut().enumerate().skip(1) {
            if corner & !faces == 0 {
                let step = [corner >> 2, corner >> 1 & 1, corner & 1].map(|step| step as i32);
                *block = index.block(cell.wrapping_add(IVec3::from_array(step)));
            }
        }
        if blocks.iter().all(|block| block.kind() == BlockKind::Half) {
            return by_component(|c| {
                let plane = |n: usize| &self.halves[blocks[n & faces].number() * V::COMPONENTS + c];
                trilinear_halves(|n| plane(n)[places.of(n)], t)
            });
        }
        let value = |corner: usize| self.value(blocks[corner & faces], places.of(corner));
        let values: [V; 8] = std::array::from_fn(value);
        by_component(|c| trilinear(|corner| values[corner].component(c), t))
    }

    /// A way in which both blocks can be read, and their numbers there; of what is constant, the
    /// numbers of the same constant.
    #[inline(always)]
    fn common_kind(&self, a: BlockId, b: BlockId) -> Option<(BlockKind, [usize; 2])> {
        if a.kind() == BlockKind::Half && b.kind() == BlockKind::Half {
            return Some((BlockKind::Half, [a, b].map(|block| block.number() * V::COMPONENTS)));
        }
        let kind = if a.is_constant() { b.kind() } else { a.kind() };
        if kind == BlockKind::Constant {
            let same = self.constants[a.number()].bits() == self.constants[b.number()].bits();
            return same.then_some((kind, [a.number(); 2]));
        }
        if kind == BlockKind::Padded {
            return None;
        }
        let number = |block: BlockId| {
            if block.kind() == kind {
                return Some(block.number() * V::COMPONENTS);
            }
            let background = block.is_constant()
                && self.constants[block.number()].bits() == self.constants[0].bits();
            (background && (kind == BlockKind::Float || self.half_background)).then_some(0)
        };
        Some((kind, [number(a)?, number(b)?]))
    }
}

/// Places of a cell's corners in their blocks: along each axis of the first and of the next voxel.
struct Places([[usize; 2]; 3]);

impl Places {
    #[inline(always)]
    fn new(cell: IVec3) -> Self {
        let along = |axis: usize| {
            let ends = [cell[axis], cell[axis].wrapping_add(1)];
            ends.map(|end| (end & (BLOCK_EDGE - 1)) as usize * STRIDES[axis])
        };
        Self([along(0), along(1), along(2)])
    }

    /// The axes along which the cell lies across a face, as the corner beyond them all.
    #[inline(always)]
    fn faces(&self) -> usize {
        let [x, y, z] = self.0.map(|[_, next]| usize::from(next == 0));
        x << 2 | y << 1 | z
    }

    #[inline(always)]
    fn of(&self, corner: usize) -> usize {
        let [x, y, z] = &self.0;
        (x[corner >> 2 & 1] + y[corner >> 1 & 1] + z[corner & 1]) % BLOCK_VALUES
    }
}

/// The value with the given components.
#[inline(always)]
fn by_component<V: Voxel>(component: impl Fn(usize) -> f32) -> V {
    let component = |c: usize| if c < V::COMPONENTS { component(c) } else { 0.0 };
    V::from_components([component(0), component(1), component(2)])
}

fn rows<V: Voxel, T: Copy + Default, const N: usize>(
    planes: &[[T; N]],
    number: usize,
    offset: usize,
) -> [[T; 8]; 3] {
    let mut rows = [[T::default(); 8]; 3];
    for (row, plane) in rows.iter_mut().zip(&planes[number..number + V::COMPONENTS]) {
        row.copy_from_slice(&plane[offset..offset + 8]);
    }
    rows
}

/// Distance in memory from the first corner of a cell to the one of this number, counted in
/// binary, z lowest.
#[inline(always)]
const fn corner_offset(corner: usize, strides: &[usize; 3]) -> usize {
    (corner >> 2) * strides[0] + (corner >> 1 & 1) * strides[1] + (corner & 1) * strides[2]
}

/// The values from the first corner of a cell to the last.
#[inline(always)]
fn within<'a, T>(plane: &'a [T], first: usize, strides: &[usize; 3]) -> &'a [T] {
    &plane[first..=first + corner_offset(7, strides)]
}

/// A nested linear interpolation of the corners of a cell, along x, then y, then z.
#[inline(always)]
fn trilinear(c: impl Fn(usize) -> f32, t: Vec3A) -> f32 {
    let low = Vec4::new(c(0), c(1), c(2), c(3));
    interpolate_along(low, Vec4::new(c(4), c(5), c(6), c(7)), t)
}

/// As [`trilinear`], from half floats.
#[inline(always)]
fn trilinear_halves(c: impl Fn(usize) -> u16, t: Vec3A) -> f32 {
    let pair = |first: usize| u32::from(c(first)) | u32::from(c(first + 1)) << 16;
    let [z0, z1] = widen_pairs([pair(0), pair(2), pair(4), pair(6)]).map(Vec4::from_array);
    let low = Vec4::new(z0.x, z1.x, z0.y, z1.y);
    interpolate_along(low, Vec4::new(z0.z, z1.z, z0.w, z1.w), t)
}

/// Interpolates between the corners with the smaller x and those with the larger one, y before z.
#[inline(always)]
fn interpolate_along(low: Vec4, high: Vec4, t: Vec3A) -> f32 {
    let x = low + (high - low) * t.x;
    let y = x.xy() + (x.zw() - x.xy()) * t.y;
    f32::lerp(y.x, y.y, t.z)
}

#[cfg(test)]
mod tests {
    use glam::UVec3;
    use half::f16;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::super::builder::dense;
    use super::super::{GridBuilder, Leaf, SparseGrid};
    use super::*;
    use crate::error::NO_PROGRESS;

    const EDGE: i32 = 40;

    /// Random values of one kind for each block of 8 voxels a side, at the position of a voxel.
    struct Field {
        values: Vec<f32>,
        background: f32,
    }

    impl Field {
        /// Each block is drawn from `kinds`: 0 is background, 1 a constant, 2 half floats, 3
        /// floats.
        fn new(kinds: std::ops::Range<u32>, background: f32, seed: u64) -> Self {
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
            let blocks: Vec<u32> = (0..125).map(|_| rng.random_range(kinds.clone())).collect();
            let value = |n: i32| {
                let [x, y, z] = [n / EDGE / EDGE, n / EDGE % EDGE, n % EDGE].map(|c| c as usize);
                match blocks[((x >> 3) * 5 + (y >> 3)) * 5 + (z >> 3)] {
                    0 => background,
                    1 => 0.75,
                    2 => any_half(&mut rng),
                    _ => rng.random::<f32>() - 0.5,
                }
            };
            Self { values: (0..EDGE * EDGE * EDGE).map(value).collect(), background }
        }

        fn grid(&self, padded: bool) -> SparseGrid<f32> {
            build(EDGE as u32, &self.values, self.background, padded)
        }

        fn value(&self, voxel: IVec3) -> f32 {
            if voxel.min_element() < 0 || voxel.max_element() >= EDGE {
                return self.background;
            }
            self.values[((voxel.x * EDGE + voxel.y) * EDGE + voxel.z) as usize]
        }

        /// The nested interpolation, in the order that look-ups promise.
        fn sample(&self, position: Vec3A) -> f32 {
            let floor = position.floor();
            let (cell, t) = (floor.as_ivec3(), position - floor);
            let at = |x, y, z| self.value(cell + IVec3::new(x, y, z));
            let along_x = |y, z| f32::lerp(at(0, y, z), at(1, y, z), t.x);
            let along_y = |z| f32::lerp(along_x(0, z), along_x(1, z), t.y);
            f32::lerp(along_y(0), along_y(1), t.z)
        }
    }

    fn build<V: Voxel>(edge: u32, values: &[V], background: V, padded: bool) -> SparseGrid<V> {
        let mut builder = dense(IVec3::ZERO, UVec3::splat(edge), values, background).unwrap();
        if !padded {
            builder.set_most_padded(0);
        }
        builder.finish(NO_PROGRESS).unwrap()
    }

    /// A finite half float of any sign and exponent, subnormal ones and minus zero included.
    fn any_half(rng: &mut Xoshiro256PlusPlus) -> f32 {
        let bits = rng.random_range(0..0x7c00) | rng.random_range(0..2) << 15;
        f16::from_bits(bits).to_f32()
    }

    #[test]
    fn every_value_and_sample_is_that_of_the_array_bit_for_bit() {
        let cases =
            [(0..4, 0.0), (0..4, 0.1), (0..4, 0.25), (2..3, 0.0), (3..4, 0.3), (0..3, -0.5)];
        let both = cases.into_iter().flat_map(|case| [case.clone(), case]);
        for (seed, (kinds, background)) in both.enumerate() {
            let field = Field::new(kinds, background, seed as u64);
            let grid = field.grid(seed % 2 == 0);
            assert_eq!(grid.blocks.padded.is_empty(), seed % 2 != 0);
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
            for n in 0..(EDGE + 2).pow(3) {
                let edge = EDGE + 2;
                let voxel = IVec3::new(n / edge / edge, n / edge % edge, n % edge) - 1;
                let (got, want) = (grid.value(voxel), field.value(voxel));
                assert_eq!(got.to_bits(), want.to_bits(), "{voxel} of case {seed}");
                let t = Vec3A::new(rng.random(), rng.random(), rng.random());
                let position = voxel.as_vec3a() + t;
                let (got, want) = (grid.sample(position), field.sample(position));
                // Where all corners are one constant, a zero may differ in its sign.
                let same = got.to_bits() == want.to_bits() || (got == 0.0 && want == 0.0);
                assert!(same, "{position} of case {seed}: {got} instead of {want}");
            }
        }
    }

    #[test]
    fn vectors_are_exact_too() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        for only_halves in [true, false] {
            let mut component = || match only_halves {
                true => any_half(&mut rng),
                false => rng.random(),
            };
            let values: Vec<Vec3A> = (0..20 * 20 * 20)
                .map(|_| Vec3A::new(component(), component(), component()))
                .collect();
            let grid = build(20, &values, Vec3A::ZERO, false);
            let padded = build(20, &values, Vec3A::ZERO, true);
            assert_eq!(grid.blocks.halves.len() > 3, only_halves);
            for (n, value) in values.iter().enumerate() {
                let voxel = IVec3::new(n as i32 / 400, n as i32 / 20 % 20, n as i32 % 20);
                assert_eq!(grid.value(voxel).to_array(), value.to_array());
                let position = voxel.as_vec3a() + 0.375;
                assert_eq!(grid.sample(position), padded.sample(position));
            }
        }
    }

    #[test]
    fn memory_is_that_of_the_values() {
        const EDGE: u32 = 120;
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut held = |only_halves: bool| {
            let value = |_| if only_halves { any_half(&mut rng) } else { rng.random() };
            let values: Vec<f32> = (0..EDGE.pow(3)).map(value).collect();
            let grid = build(EDGE, &values, 0.0, false);
            grid.stats().memory_bytes as f64 / grid.stats().active_voxels as f64
        };
        let [halves, floats] = [held(true), held(false)];
        assert!(halves < 3.0, "{halves} bytes a voxel of half floats");
        assert!(floats < 5.0, "{floats} bytes a voxel of floats");
    }

    #[test]
    fn constants_are_not_stored_voxel_by_voxel() {
        let mut builder = GridBuilder::new(0.0);
        let leaf = |n: i32| Leaf {
            origin: IVec3::new(8 * n, 0, 0),
            values: [n as f32 * 0.1; BLOCK_VALUES],
            active: [u64::MAX; 8],
        };
        builder.add_leaves((0..16).map(leaf).collect());
        let grid = builder.finish(NO_PROGRESS).unwrap();
        assert_eq!((grid.blocks.halves.len(), grid.blocks.floats.len()), (1, 1));
        assert_eq!(grid.value(IVec3::new(81, 3, 3)), 1.0);
        assert_eq!(grid.stats().active_voxels, 16 * 512);
    }
}
