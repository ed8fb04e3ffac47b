//! Grids against a dense array that is interpolated without any of their machinery.

use glam::{IVec3, UVec3, Vec3, Vec3A};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::*;
use crate::error::{Error, NO_PROGRESS};

/// A dense field around the origin with a background outside, and nothing clever.
struct Oracle {
    origin: IVec3,
    dims: IVec3,
    values: Vec<f32>,
    background: f32,
}

impl Oracle {
    /// Values in 0..1, three in ten of them the background.
    fn random(rng: &mut Xoshiro256PlusPlus, background: f32) -> Self {
        let origin = IVec3::from_array(std::array::from_fn(|_| rng.random_range(-150..150)));
        let dims = IVec3::from_array(std::array::from_fn(|_| rng.random_range(1..40)));
        let value = |_| if rng.random_bool(0.3) { background } else { rng.random() };
        let values = (0..dims.element_product()).map(value).collect();
        Self { origin, dims, values, background }
    }

    fn grid(&self) -> SparseGrid<f32> {
        SparseGrid::from_dense(self.origin, self.dims.as_uvec3(), &self.values, self.background)
            .unwrap()
    }

    fn value(&self, voxel: IVec3) -> f32 {
        let local = voxel - self.origin;
        if local.min_element() < 0 || (self.dims - local).min_element() <= 0 {
            return self.background;
        }
        self.values[((local.x * self.dims.y + local.y) * self.dims.z + local.z) as usize]
    }

    /// The weighted sum over the eight corners, in double precision.
    fn sample(&self, position: Vec3A) -> f64 {
        let cell = position.floor();
        let t = (position - cell).as_dvec3();
        let mut sum = 0.0;
        for corner in 0..8 {
            let step = IVec3::new(corner >> 2, corner >> 1 & 1, corner & 1);
            let weight = |axis: usize| if step[axis] == 1 { t[axis] } else { 1.0 - t[axis] };
            let value = self.value(cell.as_ivec3() + step);
            sum += weight(0) * weight(1) * weight(2) * f64::from(value);
        }
        sum
    }

    fn position(&self, rng: &mut Xoshiro256PlusPlus, margin: f32) -> Vec3 {
        let low = self.origin.as_vec3() - margin;
        let size = self.dims.as_vec3() + 2.0 * margin;
        low + size * Vec3::new(rng.random(), rng.random(), rng.random())
    }
}

fn rng(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

#[test]
fn samples_and_voxels_agree_with_a_dense_array() {
    let mut rng = rng(1);
    for case in 0..40 {
        let background = if case % 2 == 0 { 0.0 } else { 0.25 };
        let oracle = Oracle::random(&mut rng, background);
        let grid = oracle.grid();
        for _ in 0..2000 {
            let position = Vec3A::from(oracle.position(&mut rng, 12.0));
            let (got, want) = (grid.sample(position), oracle.sample(position));
            assert!((f64::from(got) - want).abs() < 1e-5, "{position}: {got} instead of {want}");
            let voxel = position.as_ivec3();
            assert_eq!(grid.value(voxel), oracle.value(voxel), "{voxel}");
        }
    }
}

#[test]
fn ranges_hold_every_sample_and_are_tight() {
    let mut rng = rng(2);
    let mut slack = 0.0;
    for case in 0..40 {
        let background = if case % 2 == 0 { 0.0 } else { 0.25 };
        let oracle = Oracle::random(&mut rng, background);
        let grid = oracle.grid();
        for _ in 0..100 {
            let corner = oracle.position(&mut rng, 12.0);
            let size = rng.random::<f32>() * 12.0;
            let extent = size * Vec3::new(rng.random(), rng.random(), rng.random());
            let (low, high) = grid.range(corner, corner + extent);
            for _ in 0..100 {
                let t = Vec3::new(rng.random(), rng.random(), rng.random());
                let value = grid.sample(Vec3A::from(corner + t * extent));
                assert!(low <= value && value <= high, "{value} outside {low}..{high}");
            }
            slack += f64::from(high - low) - f64::from(brute_range(&oracle, corner, extent));
        }
    }
    assert!(slack / 4000.0 < 0.35, "ranges are too wide by {} on average", slack / 4000.0);
}

/// Extent of the samples that a box needs.
fn brute_range(oracle: &Oracle, corner: Vec3, extent: Vec3) -> f32 {
    let cells =
        IndexBox { min: corner.floor().as_ivec3(), max: (corner + extent).ceil().as_ivec3() };
    let values: Vec<f32> = cells.positions().map(|voxel| oracle.value(voxel)).collect();
    let high = values.iter().copied().fold(f32::MIN, f32::max);
    high - values.iter().copied().fold(f32::MAX, f32::min)
}

#[test]
fn ranges_of_whole_blocks_are_exact() {
    let values: Vec<f32> = (0..64 * 64 * 64).map(|i| (i % 977) as f32).collect();
    let grid = SparseGrid::from_dense(IVec3::ZERO, UVec3::splat(64), &values, 0.0).unwrap();
    let at = |x: usize, y: usize, z: usize| values[(x * 64 + y) * 64 + z];
    let mut want = (f32::MAX, f32::MIN);
    for x in 8..=12 {
        for y in 16..=20 {
            for z in 20..=24 {
                want = (want.0.min(at(x, y, z)), want.1.max(at(x, y, z)));
            }
        }
    }
    assert_eq!(grid.range(Vec3::new(8.0, 16.0, 20.0), Vec3::new(12.0, 20.0, 24.0)), want);
    assert_eq!(grid.range(Vec3::splat(-1e9), Vec3::splat(1e9)), (0.0, 976.0));
    assert_eq!(grid.range(Vec3::splat(f32::NAN), Vec3::ONE), (0.0, 976.0));
    assert_eq!(grid.range(Vec3::splat(-90.0), Vec3::splat(-1.0)), (0.0, 0.0));
    let spill = grid.range(Vec3::new(-0.5, 0.0, 0.0), Vec3::new(-0.25, 4.0, 4.0));
    assert_eq!(spill.0, 0.0);
    assert!(spill.1 >= at(0, 4, 4), "the spill before the first voxels was missed");
}

#[test]
fn vectors_interpolate_by_component() {
    let mut rng = rng(3);
    let oracle = Oracle::random(&mut rng, 0.0);
    let values: Vec<Vec3A> = oracle.values.iter().map(|&v| Vec3A::new(v, 2.0 * v, -v)).collect();
    let grid = SparseGrid::from_dense(oracle.origin, oracle.dims.as_uvec3(), &values, Vec3A::ZERO)
        .unwrap();
    for _ in 0..1000 {
        let position = Vec3A::from(oracle.position(&mut rng, 4.0));
        let want = oracle.sample(position) as f32 * Vec3A::new(1.0, 2.0, -1.0);
        assert!(grid.sample(position).abs_diff_eq(want, 1e-5));
        let (low, high) = grid.range(position.into(), position.into());
        assert!(low.cmple(want + 1e-5).all() && high.cmpge(want - 1e-5).all());
    }
}

#[test]
fn a_huge_tile_takes_little_memory_and_ends_where_it_should() {
    let mut builder = GridBuilder::new(0.0);
    builder.add_tile(IVec3::new(-4096, 0, 0), 4096, 3.0, true).unwrap();
    builder.add_tile(IVec3::new(128, 0, 0), 128, 5.0, false).unwrap();
    builder.add_tile(IVec3::new(512, 0, 8), 8, 7.0, true).unwrap();
    let grid = builder.finish(NO_PROGRESS).unwrap();
    assert!(grid.stats().memory_bytes < 4 << 20, "{} bytes", grid.stats().memory_bytes);
    assert_eq!(grid.stats().active_voxels, (1 << 36) + 512);
    let bounds = IndexBox { min: IVec3::new(-4096, 0, 0), max: IVec3::new(519, 4095, 4095) };
    assert_eq!(grid.bounds(), Some(bounds));
    let samples = [
        ([-4096.0, 0.0, 0.0], 3.0),
        ([-4096.75, 5.0, 5.0], 0.75),
        ([-1.0, 4095.0, 4095.0], 3.0),
        ([-0.5, 100.0, 100.0], 1.5),
        ([-2000.0, 4095.5, 4095.5], 0.75),
        ([0.0, 100.0, 100.0], 0.0),
        ([127.5, 50.0, 50.0], 2.5),
        ([255.5, 50.0, 127.5], 1.25),
        ([513.0, 7.5, 8.0], 3.5),
        ([511.5, 0.0, 7.5], 1.75),
    ];
    for (position, want) in samples {
        assert_eq!(grid.sample(position.into()), want, "{position:?}");
    }
    assert_eq!(grid.range(Vec3::new(-3e3, 0.0, 0.0), Vec3::new(-1e3, 2e3, 2e3)), (3.0, 3.0));
    assert_eq!(grid.range(Vec3::splat(-1e9), Vec3::splat(1e9)), (0.0, 7.0));
}

#[test]
fn tiles_beyond_memory_are_refused() {
    let mut builder = GridBuilder::new(0.0);
    let refused = (0..4096)
        .map(|n| IVec3::new(n % 64, n / 64, 0) * 4096)
        .find_map(|origin| builder.add_tile(origin, 4096, 1.0, true).err());
    assert!(matches!(refused, Some(Error::Unsupported { .. })), "{refused:?}");
}

#[test]
fn voxels_at_the_ends_of_the_range_of_coordinates() {
    let far = [i32::MIN, -2_000_000_000, 0, 2_000_000_000, i32::MAX - 7];
    let mut builder = GridBuilder::new(0.0);
    let leaf = |(n, &at): (usize, &i32)| {
        let mut leaf = Leaf { origin: IVec3::splat(at), values: [0.0; 512], active: [0; 8] };
        leaf.values[0] = n as f32 + 1.0;
        leaf.active[0] = 1;
        leaf
    };
    builder.add_leaves(far.iter().enumerate().map(leaf).collect());
    let grid = builder.finish(NO_PROGRESS).unwrap();
    for (n, &at) in far.iter().enumerate() {
        assert_eq!(grid.value(IVec3::splat(at)), n as f32 + 1.0);
        assert_eq!(grid.value(IVec3::splat(at) + IVec3::X), 0.0);
    }
    assert!(grid.stats().memory_bytes < 4 << 20, "{} bytes", grid.stats().memory_bytes);
    assert_eq!(grid.sample(Vec3A::splat(-0.5)), 0.375);
    assert_eq!(grid.range(Vec3::splat(-3e9), Vec3::splat(3e9)), (0.0, 5.0));
    assert_eq!(grid.range(Vec3::splat(-0.5), Vec3::splat(-0.25)), (0.0, 3.0));
    assert_eq!(grid.range(Vec3::splat(50.0), Vec3::splat(1e6)), (0.0, 0.0));
}

#[test]
fn a_grid_at_either_end_of_the_coordinates() {
    for at in [i32::MIN, i32::MAX - 7] {
        let mut builder = GridBuilder::new(0.0);
        builder.add_tile(IVec3::splat(at), 8, 3.0, true).unwrap();
        let grid = builder.finish(NO_PROGRESS).unwrap();
        assert_eq!(grid.value(IVec3::splat(at)), 3.0);
        assert_eq!(grid.value(IVec3::splat(!at)), 0.0);
        let end = Vec3::splat(at as f32);
        assert_eq!(grid.range(end - 500.0, end + 500.0), (0.0, 3.0));
        assert_eq!(grid.range(-end - 500.0, -end + 500.0), (0.0, 0.0));
    }
}

#[test]
fn unusable_values_become_background_and_are_counted() {
    let values = [f32::NAN, 1.0, f32::INFINITY, -3.0, f32::NEG_INFINITY, f32::MAX];
    let grid = SparseGrid::from_dense(IVec3::ZERO, UVec3::new(6, 1, 1), &values, 0.5).unwrap();
    let stats = grid.stats();
    assert_eq!((stats.replaced_values, stats.active_voxels), (4, 6));
    assert_eq!((stats.min, stats.max, stats.mean), (-3.0, 1.0, -1.0));
    assert_eq!(grid.value(IVec3::ZERO), 0.5);
    let builder = GridBuilder::new(f32::NAN);
    assert_eq!(builder.background(), 0.0);
    assert_eq!(builder.finish(NO_PROGRESS).unwrap().stats().replaced_values, 1);
}

#[test]
fn an_empty_grid_is_background_everywhere() {
    let grid = GridBuilder::new(0.5).finish(NO_PROGRESS).unwrap();
    assert_eq!(grid.bounds(), None);
    assert_eq!(grid.sample(Vec3A::new(1.0, -2.0, 1e20)), 0.5);
    assert_eq!(grid.range(Vec3::splat(-1e20), Vec3::splat(1e20)), (0.5, 0.5));
    assert_eq!(grid.stats().mean, 0.0);
}

#[test]
fn wrong_sizes_are_refused_and_work_can_be_cancelled() {
    let values = vec![1.0_f32; 1000];
    assert!(SparseGrid::from_dense(IVec3::ZERO, UVec3::new(10, 10, 11), &values, 0.0).is_err());
    assert!(SparseGrid::from_dense(IVec3::ZERO, UVec3::MAX, &values, 0.0).is_err());
    let end = IVec3::splat(i32::MAX - 3);
    assert!(SparseGrid::from_dense(end, UVec3::splat(10), &values, 0.0).is_err());
    let mut builder = GridBuilder::new(0.0);
    assert!(builder.add_tile(IVec3::splat(4), 8, 1.0, true).is_err());
    assert!(builder.add_tile(IVec3::ZERO, 0, 1.0, true).is_err());
    builder.add_tile(IVec3::ZERO, 8, 1.0, true).unwrap();
    assert!(matches!(builder.finish(&|_| false), Err(Error::Cancelled)));
}

#[test]
fn a_histogram_counts_every_voxel_but_the_background() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    for background in [0.0, 0.7] {
        let oracle = Oracle::random(&mut rng, background);
        let mut expected = [0; BINS];
        for value in oracle.values.iter().filter(|value| **value != background) {
            expected[((value * BINS as f32) as usize).min(BINS - 1)] += 1;
        }
        assert_eq!(oracle.grid().histogram([0.0, 1.0]), expected);
    }
    // A tile counts as the voxels it stands for, though they are stored once.
    let mut builder = GridBuilder::new(0.0_f32);
    builder.add_tile(IVec3::ZERO, 256, 2.0, true).unwrap();
    let histogram = builder.finish(NO_PROGRESS).unwrap().histogram([0.0, 2.0]);
    assert_eq!(histogram[BINS - 1], 1 << 24);
    assert_eq!(histogram.iter().sum::<u64>(), 1 << 24);
}

#[test]
fn vectors_are_counted_by_their_largest_component() {
    let values = [Vec3A::new(0.1, 0.9, 0.2), Vec3A::new(-3.0, -1.0, -2.0), Vec3A::ZERO];
    let dims = UVec3::new(1, 1, 3);
    let grid = SparseGrid::from_dense(IVec3::ZERO, dims, &values, Vec3A::ZERO).unwrap();
    let histogram = grid.histogram([-1.0, 1.0]);
    assert_eq!((histogram[0], histogram[30], histogram.iter().sum()), (1, 1, 2));
}
