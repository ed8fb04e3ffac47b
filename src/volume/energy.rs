//! An emissive volume as a light: the coarse distribution of its emitted power over its own space
//! (Villemin and Hery 2013), and the density over directions that follows from it.
//!
//! A point is drawn from the distribution and only the direction to it is kept. All points of a
//! direction lead to it, so that its density is ∫ p_V t² dt over the ray (Simon et al. 2017): in a
//! cell of constant p_V between t0 and t1, p_V (t1³ − t0³)/3.

use std::f32::consts::TAU;

use glam::{DVec3, IVec3, Vec3A};
use rayon::prelude::*;

use super::cells::CellGrid;
use super::majorant::MajorantGrid;
use super::region::Region;
use crate::{
    error::{Progress, Result, report},
    math::{Aabb, Ray},
    sampling::warp::spherical,
};

/// Points of a cell at which the emission is read. They form a rank-1 lattice with as many
/// different coordinates on each axis, the outermost 1/32 from the faces.
const POINTS: i32 = 16;
/// Generators of the lattice in space and time, the first of them 1.
const GENERATORS: [i32; 4] = [1, 3, 7, 5];
/// Share of its upper bound that every cell gets beside the emission read: sparks between the
/// points must not be missed. A spark of one voxel in a cell of 4³ has a mean of 1/64 of its peak.
const SHARE_OF_BOUND: f64 = 1.0 / 64.0;
/// Smallest density relative to the largest, so that single precision holds both.
const FAINTEST: f64 = 1e-30;

/// Distribution of a volume's emitted power: a density over its own space.
#[derive(Clone, Debug)]
pub struct Energy {
    bounds: Aabb,
    /// ∫ lum ε dV.
    total: f64,
    support: Support,
}

#[derive(Clone, Debug)]
enum Support {
    /// Uniform density over a region.
    Region(Region, f64),
    /// One density per cell.
    Cells(Cells),
}

#[derive(Clone, Debug)]
struct Cells {
    grid: CellGrid,
    /// Density of each cell relative to the largest, by cell index; 0 where nothing emits.
    relative: Vec<f32>,
    /// The largest density, 1/volume.
    largest: f64,
    /// Cells that emit, in an order in which neighbors are near each other.
    emitting: Vec<u32>,
    /// Sums of the probabilities of `emitting`, up to and with each.
    cumulative: Vec<f64>,
}

impl Energy {
    /// The distribution over a region that emits `emission`, lum ε, throughout; `None` without
    /// emission or finite volume.
    pub(super) fn uniform(region: Region, emission: f32) -> Option<Self> {
        let volume = match region {
            Region::Box(bounds) => volume_of(&bounds),
            Region::Sphere { radius } => {
                4.0 / 3.0 * std::f64::consts::PI * f64::from(radius).powi(3)
            }
            Region::Everywhere => return None,
        };
        let occurs = volume > 0.0 && volume.is_finite() && emission > 0.0;
        occurs.then(|| Self {
            bounds: region.bounds(),
            total: f64::from(emission.min(f32::MAX)) * volume,
            support: Support::Region(region, 1.0 / volume),
        })
    }

    /// The distribution over a volume whose `emission`, lum ε, is bounded by `majorants`; `None`
    /// without emission. The emission is that at a point and at a fraction, 0 to 1, of the
    /// shutter's time: the distribution is one for all times, and covers all that is lit at any.
    ///
    /// A cell's density is the mean of its emission and a small share of its upper bound, zero
    /// only where the upper bound is.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub(super) fn varying(
        majorants: &MajorantGrid,
        emission: impl Fn(Vec3A, f32) -> f32 + Sync,
        progress: Progress,
    ) -> Result<Option<Self>> {
        let all = majorants.grid();
        let occupied: Vec<usize> =
            (0..all.len()).filter(|&index| majorants.cells()[index].emission != 0.0).collect();
        let Some(&first) = occupied.first() else { return Ok(None) };
        let first = all.cell(first);
        let (low, high) = occupied.iter().fold((first, first), |(low, high), &index| {
            (low.min(all.cell(index)), high.max(all.cell(index)))
        });
        let grid = all.cropped(low, high);
        let emitting = |index: usize| {
            report(progress, index as f32 / all.len() as f32)?;
            let cell = all.cell(index);
            let bounds = all.clipped(cell);
            let mean = mean_over(&bounds, &emission);
            let upper_bound = magnitude(majorants.cells()[index].emission);
            Ok(Cell {
                index: grid.index(cell - low),
                order: morton(cell - low),
                volume: volume_of(&bounds),
                emission: (1.0 - SHARE_OF_BOUND) * mean + SHARE_OF_BOUND * upper_bound,
            })
        };
        let cells = occupied.into_par_iter().with_min_len(64).map(emitting);
        let mut cells = cells.collect::<Result<Vec<Cell>>>()?;
        cells.par_sort_unstable_by_key(|cell| cell.order);
        let of_cells = |(cells, total): (Cells, f64)| Self {
            bounds: *cells.grid.bounds(),
            total,
            support: Support::Cells(cells),
        };
        Ok(Cells::new(grid, &cells).map(of_cells))
    }

    /// About ∫ lum ε dV over the volume: local length³ × radiance per world length.
    pub fn power(&self) -> f32 {
        finite(self.total)
    }

    /// A box around the emission, in the volume's space.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// A point of the volume's space with density [`Energy::pdf_at`]. `pick` in [0, 1) chooses the
    /// cell, near values near cells; `u` in [0, 1)³ the point in it.
    pub fn sample(&self, pick: f64, u: Vec3A) -> Vec3A {
        match &self.support {
            Support::Region(Region::Sphere { radius }, _) => {
                radius * u.z.cbrt() * spherical(1.0 - 2.0 * u.x, TAU * u.y)
            }
            Support::Region(..) => inside(&self.bounds, u),
            Support::Cells(cells) => cells.sample(pick, u),
        }
    }

    /// Density of [`Energy::sample`] at a point, 1/local volume.
    pub fn pdf_at(&self, local: Vec3A) -> f32 {
        finite(self.density_at(local))
    }

    /// ∫ p_V(ray(t)) t² dt over the whole ray, t in the ray's own parameter; its direction need
    /// not be a unit vector.
    pub fn pdf_along(&self, local: &Ray) -> f32 {
        finite(self.cone_along(local))
    }

    /// Calls `visit` with the box and the power of every cell that emits; the powers sum to
    /// [`Energy::power`]. A uniform volume is one cell.
    pub fn for_each_cell(&self, mut visit: impl FnMut(&Aabb, f32)) {
        match &self.support {
            Support::Region(..) => visit(&self.bounds, self.power()),
            Support::Cells(cells) => {
                for &index in &cells.emitting {
                    let bounds = cells.grid.clipped(cells.grid.cell(index as usize));
                    let density = cells.largest * f64::from(cells.relative[index as usize]);
                    visit(&bounds, finite(self.total * density * volume_of(&bounds)));
                }
            }
        }
    }

    pub(super) fn total(&self) -> f64 {
        self.total
    }

    pub(super) fn density_at(&self, local: Vec3A) -> f64 {
        let outside = (local.cmplt(self.bounds.min) | local.cmpgt(self.bounds.max)).any();
        match &self.support {
            _ if outside => 0.0,
            Support::Region(Region::Sphere { radius }, _) if local.length() > *radius => 0.0,
            Support::Region(_, density) => *density,
            Support::Cells(cells) => cells.density_at(local),
        }
    }

    pub(super) fn cone_along(&self, local: &Ray) -> f64 {
        match &self.support {
            Support::Region(region, density) => {
                let chord = region.intersect(local, f32::INFINITY);
                chord.map_or(0.0, |(t0, t1)| density * cone(t0, t1))
            }
            Support::Cells(cells) => cells.cone_along(local),
        }
    }
}

/// A cell that emits.
struct Cell {
    index: usize,
    /// Position of the cell in the order along a Morton curve.
    order: u64,
    volume: f64,
    /// Mean emission, with its share of the upper bound.
    emission: f64,
}

impl Cells {
    /// The distribution, and the total of emission times volume. Only the ratio of the emissions
    /// matters, so that neither huge nor tiny ones leave the range of the numbers.
    fn new(grid: CellGrid, emitting: &[Cell]) -> Option<(Self, f64)> {
        let brightest = emitting.iter().fold(0.0, |most: f64, cell| most.max(cell.emission));
        let mut relative = vec![0.0; grid.len()];
        let mut cumulative = Vec::with_capacity(emitting.len());
        let mut sum = 0.0;
        for cell in emitting {
            let density = (cell.emission / brightest).max(FAINTEST) as f32;
            relative[cell.index] = density;
            sum += f64::from(density) * cell.volume;
            cumulative.push(sum);
        }
        if !(brightest > 0.0 && sum > 0.0 && sum.is_finite()) {
            return None;
        }
        cumulative.iter_mut().for_each(|upto| *upto /= sum);
        let emitting = emitting.iter().map(|cell| cell.index as u32).collect();
        let cells = Self { grid, relative, largest: 1.0 / sum, emitting, cumulative };
        Some((cells, brightest * sum))
    }

    fn sample(&self, pick: f64, u: Vec3A) -> Vec3A {
        let chosen = self.cumulative.partition_point(|&upto| upto <= pick);
        let index = self.emitting[chosen.min(self.emitting.len() - 1)];
        inside(&self.grid.clipped(self.grid.cell(index as usize)), u)
    }

    fn density_at(&self, local: Vec3A) -> f64 {
        let index = self.grid.index(self.grid.cell_at(local));
        self.largest * f64::from(self.relative[index])
    }

    fn cone_along(&self, local: &Ray) -> f64 {
        let Some((t0, t1)) = self.grid.bounds().intersect(local, 0.0, f32::INFINITY) else {
            return 0.0;
        };
        let mut walk = self.grid.walk(local, t0, t1);
        let density = |index: usize| Some(self.relative[index]).filter(|&density| density > 0.0);
        let mut sum = 0.0;
        while let Some((t0, t1, density)) = walk.next_where(density) {
            sum += f64::from(density) * cone(t0, t1);
        }
        self.largest * sum
    }
}

/// ∫ t² dt from `t0` to `t1`: the volume of a cone of one steradian between them. Written so that
/// the cubes, which nearly cancel, do not appear.
#[inline]
fn cone(t0: f32, t1: f32) -> f64 {
    let (t0, t1) = (f64::from(t0), f64::from(t1));
    (t1 - t0) * (t1 * t1 + t1 * t0 + t0 * t0) * (1.0 / 3.0)
}

/// A point of a box; never on its upper faces, which belong to the next box, unless it is too
/// small for single precision.
fn inside(bounds: &Aabb, u: Vec3A) -> Vec3A {
    let rounding = f32::EPSILON * bounds.min.abs().max(bounds.max.abs());
    let point = bounds.min + u * bounds.size();
    point.min(bounds.max - rounding).max(bounds.min)
}

fn volume_of(bounds: &Aabb) -> f64 {
    let size = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    size.max(DVec3::ZERO).element_product()
}

fn mean_over(bounds: &Aabb, emission: &impl Fn(Vec3A, f32) -> f32) -> f64 {
    let sum: f64 = (0..POINTS)
        .map(|point| {
            let [x, y, z, time] = GENERATORS.map(|g| ((point * g) % POINTS) as f32 + 0.5);
            let u = Vec3A::new(x, y, z) / POINTS as f32;
            magnitude(emission(bounds.min + u * bounds.size(), time / POINTS as f32))
        })
        .sum();
    sum / f64::from(POINTS)
}

/// Finite magnitude of a value, for sums and quotients: NaN becomes 0, infinity the largest number.
fn magnitude(value: f32) -> f64 {
    if value.is_nan() { 0.0 } else { f64::from(value.clamp(0.0, f32::MAX)) }
}

/// Rounds a value to single precision, neither to infinity nor to zero where it is above zero.
pub(super) fn finite(value: f64) -> f32 {
    if value > 0.0 {
        value.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32
    } else {
        0.0
    }
}

/// Position of a cell on a Morton curve, its coordinates' bits interleaved.
fn morton(cell: IVec3) -> u64 {
    let spread = |coordinate: i32| {
        let mut bits = u64::from(coordinate as u32 & 0x1f_ffff);
        bits = (bits | bits << 32) & 0x001f_0000_0000_ffff;
        bits = (bits | bits << 16) & 0x001f_0000_ff00_00ff;
        bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
        bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
        (bits | bits << 2) & 0x1249_2492_4924_9249
    };
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}
