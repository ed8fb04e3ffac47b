//! The mean over all jitters is exp(−τ), at every point of a ray and whatever the majorants.

use std::sync::Arc;

use glam::{Affine3A, DVec3, UVec2, Vec3A};

use super::*;
use crate::error::NO_PROGRESS;
use crate::math::{Aabb, Ray, Slot};
use crate::volume::emission::Emission;
use crate::volume::field::{RgbField, ScalarField};
use crate::volume::phase::Phase;
use crate::volume::procedural::Noise;
use crate::volume::world::{Instance, World};
use crate::volume::{MediumProperties, Region, Volume};

/// Largest |z|: of the 150 comparisons here one fails at random once in 10 000 sets of jitters.
const Z_LIMIT: f64 = 5.0;
/// Ray parameters at which T̂ is read.
const PLACES: [f32; 5] = [0.9, 1.4, 2.05, 2.6, 3.2];
/// Independent estimates.
const ESTIMATES: u32 = 60_000;

/// Noise of high contrast in cells far larger than its details, and a uniform ball in its middle.
fn world(noise_scale: Rgb, ball: f32) -> World {
    let noise = Noise { frequency: 3.0, octaves: 3, contrast: 4.0, seed: 5 };
    let properties = |density, density_scale| MediumProperties {
        density,
        density_scale,
        albedo: RgbField::Constant(Rgb::ZERO),
        phase: Phase::default(),
        emission: Emission::None,
    };
    let bounds = Aabb::centered(Vec3A::ONE);
    let noisy = properties(ScalarField::Noise(noise), noise_scale);
    let even = properties(ScalarField::Constant(1.0), Rgb::splat(ball));
    let volumes = [
        Volume::varying(bounds, noisy, Vec3A::splat(0.45), None, NO_PROGRESS).unwrap(),
        Volume::uniform(Region::Sphere { radius: 0.6 }, even),
    ];
    World::new(volumes.map(|v| Instance::new(Arc::new(v), Affine3A::IDENTITY)).into())
}

/// exp(−τ) up to each of the places, by the midpoint rule.
fn expected(world: &World, ray: &Ray) -> [DVec3; 5] {
    const STEPS: u32 = 40_000;
    let end = PLACES[4];
    let length = f64::from(end) / f64::from(STEPS);
    let (mut tau, mut place) = (DVec3::ZERO, 0);
    let mut found = [DVec3::ZERO; 5];
    for i in 0..=STEPS {
        let t = (f64::from(i) + 0.5) * length;
        while place < PLACES.len() && t > f64::from(PLACES[place]) {
            found[place] = (-tau).exp();
            place += 1;
        }
        let point = ray.at(t as f32);
        for instance in world.instances() {
            let inside = match instance.volume().region() {
                Region::Sphere { radius } => point.length() < *radius,
                region => {
                    let bounds = region.bounds();
                    (point.cmpgt(bounds.min) & point.cmplt(bounds.max)).all()
                }
            };
            if inside {
                tau += length * instance.volume().properties().mu_t(point).as_dvec3();
            }
        }
    }
    found
}

/// One estimate at each of the places, under majorants `loose` times as large as they must be.
fn estimates(world: &World, ray: Ray, reads: f32, loose: f32, index: u32) -> [DVec3; 5] {
    let mut rng = PathRng::new(0, UVec2::ZERO, index);
    let jitters = [rng.at(Slot::TransmittanceA), rng.at(Slot::TransmittanceB)];
    let mut estimate = Transmittance::new(reads, jitters, &mut rng);
    let mut medium = world.along(ray, f32::INFINITY);
    let mut found = [DVec3::ZERO; 5];
    let mut place = 0;
    while let Some(segment) = medium.next_segment() {
        let mut t = segment.t0;
        loop {
            // Gaps before the segment add nothing.
            while place < PLACES.len() && PLACES[place] <= t {
                found[place] = estimate.estimate().as_dvec3();
                place += 1;
            }
            let next = PLACES.get(place).map_or(segment.t1, |&p| p.min(segment.t1));
            let goes_on = if segment.uniform {
                let part = Segment { t0: t, t1: next, ..segment };
                estimate.cross_uniform(medium.coefficients(t).mu_t, &part, &mut rng)
            } else {
                estimate.advance(&medium, loose * segment.majorant, t, next, &mut rng)
            };
            if goes_on.is_break() {
                // The walk has ended.
                return found;
            }
            t = next;
            if t >= segment.t1 {
                break;
            }
        }
    }
    found[place..].fill(estimate.estimate().as_dvec3());
    found
}

fn check(noise_scale: Rgb, ball: f32, reads: f32, loose: f32) {
    let world = world(noise_scale, ball);
    let ray = Ray::new(Vec3A::new(-1.6, 0.11, -0.23), Vec3A::new(1.0, 0.06, 0.04).normalize());
    let expected = expected(&world, &ray);
    let (mut sums, mut squares) = ([DVec3::ZERO; 5], [DVec3::ZERO; 5]);
    for index in 0..ESTIMATES {
        let found = estimates(&world, ray, reads, loose, index);
        for (place, value) in found.into_iter().enumerate() {
            sums[place] += value;
            squares[place] += value * value;
        }
    }
    let n = f64::from(ESTIMATES);
    for (place, expected) in expected.into_iter().enumerate() {
        let mean = sums[place] / n;
        let variance = (squares[place] / n - mean * mean).max(DVec3::ZERO) / (n - 1.0);
        for channel in 0..3 {
            let (mean, expected) = (mean[channel], expected[channel]);
            // The quadrature errs where the noise has kinks and the ball its border.
            let error = variance[channel].sqrt().hypot(2e-4 * expected);
            let z = (mean - expected) / error;
            let label = format!(
                "{noise_scale} and {ball}, {reads} reads, majorants x {loose}, place {place}, \
                 channel {channel}: {mean:.6} ± {error:.6}, expected {expected:.6}, z {z:.2}"
            );
            println!("{label}");
            assert!(z.abs() < Z_LIMIT, "{label}");
            assert!(error < 0.01 * expected.max(1e-3), "too weak, {label}");
        }
    }
}

#[test]
fn thin_chromatic() {
    check(Rgb::new(0.2, 1.0, 2.5), 0.0, 1.0, 1.0);
    check(Rgb::new(0.2, 1.0, 2.5), 0.0, 6.0, 1.0);
}

#[test]
fn thick() {
    check(Rgb::splat(8.0), 0.0, 1.0, 1.0);
    check(Rgb::new(8.0, 2.0, 0.0), 0.0, 2.0, 1.0);
}

#[test]
fn loose_majorants() {
    check(Rgb::new(3.0, 1.0, 0.5), 0.0, 1.0, 8.0);
}

#[test]
fn a_uniform_ball_in_the_noise() {
    check(Rgb::new(1.0, 2.0, 0.5), 1.5, 1.0, 1.0);
}

/// A comb has one place in each unit of its measure, wherever the ray is cut.
#[test]
fn combs_read_once_in_each_unit() {
    for jitter in [0.0, 0.3, 0.99] {
        let mut comb = Comb::new(jitter);
        let mut places = Vec::new();
        let mut measure = 0.0;
        for (t, end, rate) in [(0.0, 0.7, 3.0), (0.7, 0.71, 40.0), (0.71, 5.0, 2.0_f32)] {
            let mut at = t;
            while let Some(place) = comb.next(rate, at, end) {
                assert!(at < place && place < end);
                places.push(measure + rate * (place - t));
                at = place;
            }
            measure += rate * (end - t);
        }
        for (unit, place) in places.iter().enumerate() {
            assert!((unit as f32 - 1e-3..unit as f32 + 1.001).contains(place), "{places:?}");
        }
        assert!(places.len() as f32 > measure - 1.001, "{places:?} up to {measure}");
    }
}
