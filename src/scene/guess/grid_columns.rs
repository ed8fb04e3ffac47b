//! Integrals of a grid's values along parallel lines through it (its columns), for its thickness
//! and brightness as seen from outside, and the bounds of the part that is seen.

use glam::{DVec3, Vec3A};

use super::candidate::Candidate;
use crate::scene::cache::{GridValues, PlacedGrid};
use crate::scene::file_box::FileBox;

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

/// ∫ of `measure` of the values of all `grids` along lines through `bounds` (in the file's space)
/// in the direction of `axis`, of every line that meets anything, in ascending order.
pub(super) fn columns(
    grids: &[&Candidate],
    bounds: &FileBox,
    axis: usize,
    measure: impl Fn(Vec3A) -> f32,
) -> Vec<f32> {
    let values: Vec<_> = grids.iter().map(|candidate| reader(&candidate.grid)).collect();
    let step = (bounds.size()[axis] / SAMPLES as f64) as f32;
    let fraction = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
    let line = |u: f64, v: f64| {
        let sum: f32 = (0..SAMPLES)
            .map(|i| {
                let mut place = DVec3::ZERO;
                place[axis] = fraction(i, SAMPLES);
                place[(axis + 1) % 3] = u;
                place[(axis + 2) % 3] = v;
                let place = bounds.min + place * bounds.size();
                values.iter().map(|value| measure(value(place))).sum::<f32>()
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

/// The box around what is seen of a grid: the samples that reach a tenth of its mean.
pub(super) fn visible_bounds(candidate: &Candidate) -> Option<FileBox> {
    let bounds = candidate.core;
    let value = reader(&candidate.grid);
    let half_cell = 0.5 * bounds.size() / LATTICE as f64;
    let cells = (0..LATTICE * LATTICE * LATTICE).filter_map(|index| {
        let cell = [index % LATTICE, index / LATTICE % LATTICE, index / (LATTICE * LATTICE)];
        let center = bounds.min + DVec3::from_array(cell.map(|i| (2 * i + 1) as f64)) * half_cell;
        let is_seen = value(center).max_element() > VISIBLE * candidate.mean;
        is_seen.then(|| FileBox { min: center - half_cell, max: center + half_cell })
    });
    cells.reduce(FileBox::union)
}

/// The grid's value at a place in the file's space; single numbers are splat.
fn reader(grid: &PlacedGrid) -> impl Fn(DVec3) -> Vec3A {
    let index_from_file = grid.world_from_index.inverse();
    move |place| {
        let index = index_from_file.transform_point3(place);
        let index = match &grid.taper {
            None => index,
            Some(taper) => match taper.gather(index) {
                Some(index) => index,
                None => return Vec3A::ZERO,
            },
        };
        let index = index.as_vec3a();
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
