//! Integrals of a grid's values along parallel lines through it (its columns), for its thickness
//! and brightness as seen from outside, and the bounds of the part that is seen.

use glam::Vec3A;

use crate::math::Aabb;
use crate::scene::cache::{GridValues, PlacedGrid};
use crate::scene::describe::grid_bounds;

/// Lines across each of the two other axes.
const LINES: usize = 32;
/// Samples along each line.
const SAMPLES: usize = 64;
/// Samples along each edge of the lattice that finds what is seen.
const LATTICE: usize = 48;
/// The share of the mean from which on something is seen.
const VISIBLE: f32 = 0.1;

/// The lines of sight that count as fairly thick and fairly bright.
pub(super) const FAIRLY: f32 = 0.8;

/// ∫ of `measure` of the grid's value along lines through `bounds` (in the file's space) in the
/// direction of `axis`, of every line that meets anything, in ascending order.
pub(super) fn columns(
    grid: &PlacedGrid,
    bounds: &Aabb,
    axis: usize,
    measure: impl Fn(Vec3A) -> f32,
) -> Vec<f32> {
    let value = reader(grid);
    let step = bounds.size()[axis] / SAMPLES as f32;
    let fraction = |index: usize, count: usize| (index as f32 + 0.5) / count as f32;
    let line = |u: f32, v: f32| {
        let sum: f32 = (0..SAMPLES)
            .map(|i| {
                let mut place = Vec3A::ZERO;
                place[axis] = fraction(i, SAMPLES);
                place[(axis + 1) % 3] = u;
                place[(axis + 2) % 3] = v;
                measure(value(bounds.min + place * bounds.size()))
            })
            .sum();
        sum * step
    };
    let mut sums: Vec<f32> = (0..LINES * LINES)
        .map(|i| line(fraction(i % LINES, LINES), fraction(i / LINES, LINES)))
        .filter(|sum| *sum > 0.0)
        .collect();
    sums.sort_by(f32::total_cmp);
    sums
}

/// The box around what is seen of a grid: the samples that reach a tenth of its `mean`.
pub(super) fn visible_bounds(grid: &PlacedGrid, mean: f32) -> Option<Aabb> {
    let bounds = grid_bounds(grid)?;
    let value = reader(grid);
    let half_cell = 0.5 * bounds.size() / LATTICE as f32;
    let mut visible = Aabb::EMPTY;
    for index in 0..LATTICE * LATTICE * LATTICE {
        let cell = [index % LATTICE, index / LATTICE % LATTICE, index / (LATTICE * LATTICE)];
        let center = bounds.min + Vec3A::from_array(cell.map(|i| (2 * i + 1) as f32)) * half_cell;
        if value(center).max_element() > VISIBLE * mean {
            visible = visible.union(&Aabb::new(center - half_cell, center + half_cell));
        }
    }
    (!visible.is_empty()).then_some(visible)
}

/// The grid's value at a place in the file's space; single numbers are splat.
fn reader(grid: &PlacedGrid) -> impl Fn(Vec3A) -> Vec3A {
    let index_from_file = grid.world_from_index.inverse().as_affine3a();
    move |place| {
        let index = index_from_file.transform_point3a(place);
        match &grid.values {
            GridValues::Float(values) => Vec3A::splat(values.sample(index)),
            GridValues::Vector(values) => values.sample(index),
        }
    }
}

/// The value below which the share `part` of the sorted sums lies; those under 1 percent of the
/// largest count as nothing.
pub(super) fn quantile(sorted: &[f32], part: f32) -> Option<f32> {
    let largest = *sorted.last()?;
    let something = sorted.partition_point(|sum| *sum < 0.01 * largest);
    let seen = sorted.get(something..)?;
    let index = (part * seen.len() as f32) as usize;
    seen.get(index.min(seen.len().saturating_sub(1))).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_pass_over_next_to_nothing() {
        let sums = [0.001, 0.002, 1.0, 2.0, 3.0, 4.0];
        assert_eq!(quantile(&sums, 0.0), Some(1.0));
        assert_eq!(quantile(&sums, 0.5), Some(3.0));
        assert_eq!(quantile(&sums, 1.0), Some(4.0));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
