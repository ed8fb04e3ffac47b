//! Loading volumes and looking values up in them.
//!
//! `cargo bench --no-default-features --bench volumes`

use std::path::{Path, PathBuf};

use divan::counter::{BytesCount, ItemsCount};
use divan::{Bencher, black_box};
use flambeau::error::NO_PROGRESS;
use flambeau::volume::grid::{SparseGrid, VoxelValues};
use flambeau::volume::vdb;
use glam::{IVec3, UVec3, Vec3A};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

fn main() {
    divan::main();
}

/// The shipped volumes, from the repository or the folder beside it.
const VOLUMES: [&str; 7] = [
    "assets/torch_hd.vdb",
    "assets/campfire_hd.vdb",
    "assets/explosion_hd.vdb",
    "assets/plume.vdb",
    "assets/cloud.vdb",
    "assets/fog.vdb",
    "volumes/smoke.vdb",
];

fn find(name: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let shared =
        std::env::var_os("FLAMBEAU_SHARED").map_or_else(|| root.join("../shared"), PathBuf::from);
    [root, &shared].into_iter().map(|folder| folder.join(name)).find(|path| path.exists())
}

/// A whole file, all its grids, on all threads.
#[divan::bench(args = VOLUMES)]
fn load(bencher: Bencher, name: &str) {
    let Some(path) = find(name) else { return };
    let bytes = std::fs::metadata(&path).map_or(0, |file| file.len());
    bencher.counter(BytesCount::new(bytes)).bench(|| vdb::read(&path, NO_PROGRESS));
}

const LOOKUPS: usize = 1 << 14;
const EDGE: usize = 160;

/// A field of 160 voxels a side with about half of its bricks empty.
fn field() -> Vec<f32> {
    let value = |n: usize| {
        let at = [n / EDGE / EDGE, n / EDGE % EDGE, n % EDGE].map(|c| c as f32 * 0.1);
        let wave = at[0].sin() + at[1].sin() + at[2].sin();
        wave.max(0.0)
    };
    (0..EDGE * EDGE * EDGE).map(value).collect()
}

/// Positions all over the field, each independent of the one before.
fn random_positions() -> Vec<Vec3A> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut coordinate = || rng.random::<f32>() * (EDGE as f32 - 2.0);
    (0..LOOKUPS).map(|_| Vec3A::new(coordinate(), coordinate(), coordinate())).collect()
}

/// Positions along rays, a third of a voxel apart, as tracking visits them.
fn coherent_positions() -> Vec<Vec3A> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut positions = Vec::with_capacity(LOOKUPS);
    while positions.len() < LOOKUPS {
        let mut coordinate = || rng.random::<f32>() * (EDGE as f32 - 2.0);
        let start = Vec3A::new(coordinate(), coordinate(), coordinate());
        let end = Vec3A::new(coordinate(), coordinate(), coordinate());
        let steps = (3.0 * start.distance(end)).ceil();
        positions.extend((0..steps as usize).map(|n| start.lerp(end, n as f32 / steps)));
    }
    positions.truncate(LOOKUPS);
    positions
}

fn run(bencher: Bencher, positions: &[Vec3A], sample: impl Fn(Vec3A) -> f32 + Sync) {
    let sum = || black_box(positions).iter().map(|&position| sample(position)).sum::<f32>();
    bencher.counter(ItemsCount::new(positions.len())).bench(sum);
}

mod sparse {
    use super::*;

    fn grid_of(values: &[f32]) -> SparseGrid<f32> {
        let size = UVec3::splat(EDGE as u32);
        SparseGrid::from_dense(IVec3::ZERO, size, values, 0.0).expect("sizes agree")
    }

    fn grid() -> SparseGrid<f32> {
        grid_of(&field())
    }

    /// The field rounded to half floats, as most files have it.
    fn halves() -> SparseGrid<f32> {
        let rounded = |value: f32| half::f16::from_f32(value).to_f32();
        grid_of(&field().into_iter().map(rounded).collect::<Vec<_>>())
    }

    #[divan::bench]
    fn halves_random(bencher: Bencher) {
        let grid = halves();
        run(bencher, &random_positions(), |position| grid.sample(position));
    }

    #[divan::bench]
    fn halves_coherent(bencher: Bencher) {
        let grid = halves();
        run(bencher, &coherent_positions(), |position| grid.sample(position));
    }

    #[divan::bench]
    fn random(bencher: Bencher) {
        let grid = grid();
        run(bencher, &random_positions(), |position| grid.sample(position));
    }

    #[divan::bench]
    fn coherent(bencher: Bencher) {
        let grid = grid();
        run(bencher, &coherent_positions(), |position| grid.sample(position));
    }

    /// Ranges of boxes of 8 voxels a side, as majorants ask for them.
    #[divan::bench]
    fn ranges(bencher: Bencher) {
        let grid = grid();
        let positions = random_positions();
        run(bencher, &positions, |position| grid.range(position.into(), (position + 8.0).into()).1);
    }
}

/// A plain array, clamped at its faces, as a baseline: what sparseness costs.
mod dense {
    use super::*;

    fn sample(values: &[f32], position: Vec3A) -> f32 {
        let floor = position.max(Vec3A::ZERO).floor();
        let t = position - floor;
        let [x, y, z] = floor.to_array().map(|c| (c as usize).min(EDGE - 2));
        let first = (x * EDGE + y) * EDGE + z;
        let c = &values[first..=first + (EDGE + 1) * EDGE + 1];
        let lerp = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let along_x = |k: usize| lerp(c[k], c[k + EDGE * EDGE], t.x);
        let low = lerp(along_x(0), along_x(EDGE), t.y);
        let high = lerp(along_x(1), along_x(EDGE + 1), t.y);
        lerp(low, high, t.z)
    }

    #[divan::bench]
    fn random(bencher: Bencher) {
        let values = field();
        run(bencher, &random_positions(), |position| sample(&values, position));
    }

    #[divan::bench]
    fn coherent(bencher: Bencher) {
        let values = field();
        run(bencher, &coherent_positions(), |position| sample(&values, position));
    }
}

/// Loaded as the renderer would, to see what a real field costs.
#[divan::bench]
fn sample_cloud(bencher: Bencher) {
    let Some(path) = find("assets/cloud.vdb") else { return };
    let Ok(file) = vdb::read(path, NO_PROGRESS) else { return };
    let Some(VoxelValues::Float(grid)) = file.grids.first().map(|grid| grid.values.clone()) else {
        return;
    };
    run(bencher, &coherent_positions(), |position| grid.sample(position));
}
