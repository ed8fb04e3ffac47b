//! Histogram of the values of a grid.

use rayon::prelude::*;

use super::bricks::{BRICK_EDGE, Brick, sample_at};
use super::sparse_grid::SparseGrid;
use super::voxel::Voxel;
use glam::IVec3;

/// Parts of equal width that a range of values is divided into.
pub const BINS: usize = 32;

/// Number of values in each part.
pub type Histogram = [u64; BINS];

impl<V: Voxel> SparseGrid<V> {
    /// Number of voxels with a value in each of [`BINS`] equal parts of `low..=high`; for vectors
    /// the largest component counts. Voxels that hold the background are passed over, as most of
    /// space does.
    pub fn histogram(&self, [low, high]: [f32; 2]) -> Histogram {
        let uses = self.index.brick_uses(self.bricks.len());
        let scale = BINS as f32 / (high - low).max(f32::MIN_POSITIVE);
        let bin = |value: f32| {
            let inside = value >= low && value <= high;
            inside.then(|| (((value - low) * scale) as usize).min(BINS - 1))
        };
        let count = |mut histogram: Histogram, (brick, &uses): (&Brick<V>, &u64)| {
            if uses > 0 {
                let values = own_values(brick).filter(|value| *value != self.background);
                for index in values.filter_map(|value| bin(largest(value))) {
                    histogram[index] += uses;
                }
            }
            histogram
        };
        let merge = |a: Histogram, b: Histogram| std::array::from_fn(|index| a[index] + b[index]);
        let empty = || [0; BINS];
        self.bricks.par_iter().zip(&uses).fold(empty, count).reduce(empty, merge)
    }
}

/// The voxels of a brick without the first ones of the next bricks.
fn own_values<V: Voxel>(brick: &Brick<V>) -> impl Iterator<Item = V> {
    let places = 0..BRICK_EDGE.pow(3);
    places.map(move |at| sample_at(brick, IVec3::new(at >> 6, at >> 3 & 7, at & 7)))
}

fn largest<V: Voxel>(value: V) -> f32 {
    let components = value.to_f64();
    let components = components.iter().take(V::COMPONENTS);
    components.copied().fold(f64::NEG_INFINITY, f64::max) as f32
}
