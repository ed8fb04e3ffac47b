//! Ray marching with a table of importance along each ray: the old system, kept for comparison.
//!
//! The medium along a ray is cut into steps. Each is read at one jittered place and taken to be
//! uniform, so that with T̂ at its beginning a it contributes T̂(a) ε (1 − exp(−μ_t Δ))/μ_t of
//! emission, and as much of scattering with μ_s in place of ε. The table holds the steps that
//! scatter: the place of a scattering event is drawn from it, p(t) ∝ T̂ μ_s, and where nothing
//! behind the medium needs to be reached, the ray always scatters. The emission is the sum of all
//! steps: to draw one of them by its share and to divide by that would give the very same.
//!
//! Biased: each read is one of μ_t at a place drawn from its step, so that τ̂ has mean τ, but by
//! Jensen's inequality exp(−τ̂) has a larger mean than exp(−τ), by half the variance of τ̂, which
//! falls with the third power of the step where the medium is smooth. Uniform segments are one
//! step, however long, and exact. Sampling is unbiased given the table.

use std::ops::ControlFlow;

use super::{
    emission::ray::{RayEmission, attenuated},
    tracking::event::{Event, Flight},
    tracking::{MOST_COLLISIONS, exp_neg, roulette_below},
    transmittance::GOLDEN,
};
use crate::{
    math::{PathRng, Rgb, Slot, mean},
    volume::{
        medium::{Coefficients, Segment},
        phase::PhaseMix,
        world::MediumRay,
    },
};

/// Transmittance below which a march meets Russian roulette.
const ROULETTE_BELOW: f32 = 1e-3;
/// Voxels that a segment counts as where nothing has voxels.
const VOXELS_PER_SEGMENT: f32 = 4.0;

/// One step of a march: a piece of the ray that is taken to be uniform.
#[derive(Clone, Copy, Debug)]
struct MarchStep {
    /// Ray parameter at which the step begins.
    t0: f32,
    length: f32,
    /// Ray parameter at which the medium is read.
    at: f32,
    /// Number of the segment that the step lies in.
    segment: u32,
    /// Whether anything emits in the segment.
    emits: bool,
}

/// Calls `take` for each step along the medium, from near to far, and returns how many there were.
/// `jitter` places the first read; later ones advance by the golden ratio. A march of
/// [`MOST_COLLISIONS`] steps is cut.
fn march(
    mut medium: MediumRay<'_>,
    voxels: f32,
    mut jitter: f32,
    mut take: impl FnMut(&MediumRay<'_>, &MarchStep) -> ControlFlow<()>,
) -> u32 {
    let (mut steps, mut number) = (0, 0);
    while let Some(segment) = medium.next_segment() {
        let parts = parts_of(&segment, voxels);
        let length = (segment.t1 - segment.t0) / parts as f32;
        for part in 0..parts {
            let t0 = if part == 0 { segment.t0 } else { segment.t0 + part as f32 * length };
            let at = if segment.uniform { t0 } else { (t0 + jitter * length).min(segment.t1) };
            let emits = segment.emission_rate > 0.0;
            steps += 1;
            let taken = take(&medium, &MarchStep { t0, length, at, segment: number, emits });
            if taken.is_break() || steps == MOST_COLLISIONS {
                return steps;
            }
            jitter = (jitter + GOLDEN).fract();
        }
        number += 1;
    }
    steps
}

/// Number of steps of so many voxels that a segment is cut into.
fn parts_of(segment: &Segment, voxels: f32) -> u32 {
    let length = segment.t1 - segment.t0;
    if segment.uniform || !length.is_finite() {
        return 1;
    }
    let voxels_across = match segment.voxel_rate > 0.0 {
        true => length * segment.voxel_rate,
        false => VOXELS_PER_SEGMENT,
    };
    ((voxels_across / voxels).ceil() as u32).max(1)
}

/// Transmittance and emission of the part of the ray marched so far.
struct MarchState {
    transmittance: Rgb,
    emission: Rgb,
}

impl MarchState {
    fn new() -> Self {
        Self { transmittance: Rgb::ONE, emission: Rgb::ZERO }
    }

    /// Passes a step of coefficients `c`.
    #[inline]
    fn pass(&mut self, step: &MarchStep, c: &Coefficients, rng: &mut PathRng) -> ControlFlow<()> {
        if c.emission != Rgb::ZERO {
            self.emission += self.transmittance * attenuated(c.emission, c.mu_t, step.length);
        }
        self.transmittance *= exp_neg(c.mu_t, step.length);
        roulette_below(&mut self.transmittance, ROULETTE_BELOW, rng)
    }

    fn gathered(&self, collisions: u32) -> RayEmission {
        RayEmission { emission: self.emission, transmittance: self.transmittance, collisions }
    }
}

/// The coefficients of a step; ε is read where there is any.
#[inline]
fn read(medium: &MediumRay<'_>, step: &MarchStep) -> Coefficients {
    if step.emits {
        return medium.coefficients(step.at);
    }
    let (mu_t, mu_s) = medium.extinction(step.at);
    Coefficients { mu_t, mu_s, emission: Rgb::ZERO }
}

/// Emission and transmittance along a shadow ray to a volume, by steps of so many voxels.
pub(super) fn gather(medium: MediumRay<'_>, voxels: f32, rng: &mut PathRng) -> RayEmission {
    let mut state = MarchState::new();
    let jitter = rng.at(Slot::LightEmission);
    let steps =
        march(medium, voxels, jitter, |medium, step| state.pass(step, &read(medium, step), rng));
    state.gathered(steps)
}

/// Transmittance along a shadow ray, and the number of steps.
pub(super) fn transmittance(medium: MediumRay<'_>, voxels: f32, rng: &mut PathRng) -> (Rgb, u32) {
    let mut state = MarchState::new();
    let jitter = rng.at(Slot::LightEmission);
    let steps = march(medium, voxels, jitter, |medium, step| {
        let mu_t = medium.mu_t(step.at);
        state.pass(step, &Coefficients { mu_t, ..Coefficients::default() }, rng)
    });
    (state.transmittance, steps)
}

/// The steps of one ray that scatter. Its memory serves all rays of a path.
#[derive(Clone, Debug, Default)]
pub(super) struct MarchTable {
    rows: Vec<MarchRow>,
    /// The path's throughput over its mean: the weights of the channels.
    color: Rgb,
    /// T̂ of the whole ray.
    transmittance: Rgb,
}

#[derive(Clone, Copy, Debug)]
struct MarchRow {
    step: MarchStep,
    /// T̂ at the beginning of the step.
    transmittance: Rgb,
    mu_t: Rgb,
    mu_s: Rgb,
    /// Importance of all rows up to the end of this one.
    sum: f32,
}

impl MarchRow {
    /// ∫ T̂ μ_s dt.
    fn scattered(&self) -> Rgb {
        self.transmittance * attenuated(self.mu_s, self.mu_t, self.step.length)
    }

    /// T̂ μ_s, up to a factor, at this distance behind the beginning of the step.
    fn density(&self, distance: f32) -> Rgb {
        // In proportion to the largest, which single precision may hold but not a multiple of.
        let mu_s = self.mu_s / self.mu_s.max_element();
        self.transmittance * mu_s * exp_neg(self.mu_t, distance)
    }

    /// A distance behind the beginning of the step with density ∝ the mean over the channels of
    /// color · T̂ μ_s: a channel by its share, then an exponential distance cut at the end of the
    /// step.
    fn sample(&self, color: Rgb, u: f32) -> f32 {
        let shares = color * self.scattered();
        let mut left = u * shares.element_sum();
        let channel = (0..2).find(|&channel| {
            let inside = left < shares[channel];
            if !inside {
                left -= shares[channel];
            }
            inside
        });
        let channel = channel.unwrap_or(2);
        let u = (left / shares[channel]).clamp(0.0, 1.0 - f32::EPSILON);
        let (mu, length) = (self.mu_t[channel], self.step.length);
        if mu * length < 1e-4 {
            return u * length;
        }
        (-(u * (-mu * length).exp_m1()).ln_1p() / mu).min(length)
    }
}

impl MarchTable {
    /// Marches along a ray of a path and tabulates the steps that scatter; returns emission and
    /// transmittance of the whole ray.
    pub(super) fn fill(
        &mut self,
        medium: MediumRay<'_>,
        voxels: f32,
        throughput: Rgb,
        rng: &mut PathRng,
    ) -> RayEmission {
        self.rows.clear();
        self.color = throughput / mean(throughput);
        let (mut state, mut sum) = (MarchState::new(), 0.0);
        let jitter = rng.at(Slot::Emission);
        let steps = march(medium, voxels, jitter, |medium, step| {
            let c = read(medium, step);
            if c.mu_s != Rgb::ZERO {
                let Coefficients { mu_t, mu_s, .. } = c;
                let mut row =
                    MarchRow { step: *step, transmittance: state.transmittance, mu_t, mu_s, sum };
                sum += mean(self.color * row.scattered());
                row.sum = sum;
                self.rows.push(row);
            }
            state.pass(step, &c, rng)
        });
        self.transmittance = state.transmittance;
        state.gathered(steps)
    }

    /// Draws the flight's event: scattering, or the end of the ray if the path `goes_on` there.
    /// `medium` is the one the table was filled from.
    ///
    /// Unbiased given the table: with f_c the contribution of a place to channel c, its density is
    /// mean (color · f) / Σ, its weight f_c over that.
    pub(super) fn draw(&self, medium: MediumRay<'_>, goes_on: bool, rng: &mut PathRng) -> Flight {
        let beyond = if goes_on { self.transmittance } else { Rgb::ZERO };
        let scattered = self.rows.last().map_or(0.0, |row| row.sum);
        let reached = mean(self.color * beyond);
        let total = scattered + reached;
        let flight = |event, weight| Flight {
            event,
            weight,
            emission: Rgb::ZERO,
            pdf_null: 0.0,
            collisions: 0,
        };
        if !total.is_finite() {
            // Leads nowhere, and is counted with the sample it spoils.
            return flight(Event::Reached, Rgb::splat(total));
        }
        let x = rng.at(Slot::Distance) * total;
        let index = self.rows.partition_point(|row| row.sum <= x);
        let Some(row) = self.rows.get(index) else {
            let weight = if reached > 0.0 { total / reached } else { 0.0 };
            return flight(Event::Reached, beyond * weight);
        };
        let before = index.checked_sub(1).map_or(0.0, |last| self.rows[last].sum);
        let distance = row.sample(self.color, (x - before) / (row.sum - before));
        let density = row.density(distance);
        let weight = density / mean(self.color * density) * total;
        let event = Event::Scattered { t: row.step.t0 + distance, phase: phase(medium, &row.step) };
        flight(event, weight)
    }
}

/// The phase function at the place where a step was read.
fn phase(mut medium: MediumRay<'_>, step: &MarchStep) -> PhaseMix {
    for _ in 0..=step.segment {
        medium.next_segment();
    }
    medium.phase(step.at)
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::{math::Ray, sampling::chi2::assert_numbers_follow, transport::Scene};

    const SMOKE: &str = r#"
        [[volume]]
        shape = "noise"
        half_size = 1.0
        frequency = 2.0
        contrast = 2.0
        density = { scale = [1.0, 2.0, 4.0] }
        albedo = [0.9, 0.7, 0.5]
        [[volume]]
        shape = "box"
        half_size = 0.4
        translate = [2.0, 0, 0]
        density = { scale = 1.5 }
        albedo = 0.8
    "#;

    /// Distances drawn from the table are as dense as the mean over the channels of what the path's
    /// color makes of T̂ μ_s, whether the path may go on at the end of the ray or not.
    #[test]
    fn draws_follow_the_table() {
        let scene = Scene::of_text(SMOKE);
        let ray = Ray::new(glam::Vec3A::new(-3.0, 0.1, 0.2), glam::Vec3A::X);
        let medium = || scene.world.along(ray, f32::INFINITY);
        for (throughput, goes_on) in [(Rgb::ONE, false), (Rgb::new(0.2, 0.5, 2.0), true)] {
            let mut table = MarchTable::default();
            table.fill(medium(), 4.0, throughput, &mut PathRng::new(0, UVec2::ONE, 0));
            let reached = if goes_on { mean(table.color * table.transmittance) } else { 0.0 };
            let total = table.rows.last().unwrap().sum + reached;
            let row_at = |t: f32| {
                let inside =
                    |row: &&MarchRow| (row.step.t0..row.step.t0 + row.step.length).contains(&t);
                table.rows.iter().find(inside)
            };
            let pdf = |t: f32| {
                row_at(t).map_or(0.0, |row| {
                    let through = exp_neg(row.mu_t, t - row.step.t0) * row.transmittance;
                    mean(table.color * row.mu_s * through) / total
                })
            };
            let ends =
                table.rows.iter().flat_map(|row| [row.step.t0, row.step.t0 + row.step.length]);
            let mut edges: Vec<f32> = ends.collect();
            edges.dedup();
            let draw = |rng: &mut PathRng| match table.draw(medium(), goes_on, rng).event {
                Event::Scattered { t, .. } => Some(t),
                _ => None,
            };
            let name = format!("table of {throughput}");
            assert_numbers_follow(&name, &edges, draw, pdf);
        }
    }
}
