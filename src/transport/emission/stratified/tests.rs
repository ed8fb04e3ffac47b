//! The mean over all jitters is ∫ T ε dt, and T at the end: the jitters are independent.

use std::sync::Arc;

use glam::{Affine3A, DVec3, UVec2, Vec3A};

use super::*;
use crate::error::NO_PROGRESS;
use crate::math::{Aabb, Ray};
use crate::volume::emission::Emission;
use crate::volume::field::{RgbField, ScalarField};
use crate::volume::phase::Phase;
use crate::volume::procedural::Noise;
use crate::volume::world::{Instance, World};
use crate::volume::{MediumProperties, Volume};

/// Largest |z|: of the 108 comparisons here one fails at random once in 16 000 sets of jitters.
const Z_LIMIT: f64 = 5.0;
/// Walks that each mean is taken over.
const WALKS: u32 = 40_000;
const RAY_KINDS: [RayKind; 3] = [RayKind::Camera, RayKind::Scattered, RayKind::Light];
/// Reads of the emission along the brightest chord: as few as the majorants allow, so that reads of
/// ε and combs of μ_t have the same pace where they are equally many, and a few more.
const READS: [f32; 2] = [0.0, 64.0];

fn noise(seed: u32) -> ScalarField {
    ScalarField::Noise(Noise { frequency: 3.0, octaves: 3, contrast: 4.0, seed })
}

/// Noise of high contrast in cells far larger than its details.
fn medium(density_scale: Rgb, emission: Emission) -> Instance {
    let albedo = RgbField::Constant(Rgb::ZERO);
    let properties = MediumProperties {
        density: noise(5),
        density_scale,
        albedo,
        phase: Phase::default(),
        emission,
    };
    let bounds = Aabb::centered(Vec3A::ONE);
    let volume =
        Volume::varying(bounds, properties, Vec3A::splat(0.45), None, NO_PROGRESS).unwrap();
    Instance::new(Arc::new(volume), Affine3A::IDENTITY)
}

/// ∫ T ε dt and T by the midpoint rule.
fn expected(instance: &Instance, ray: &Ray) -> [DVec3; 2] {
    const STEPS: u32 = 40_000;
    let region = instance.volume().region();
    let (t0, t1) = region.intersect(ray, f32::INFINITY).unwrap();
    let length = f64::from(t1 - t0) / f64::from(STEPS);
    let (mut gathered, mut transmittance) = (DVec3::ZERO, DVec3::ONE);
    for i in 0..STEPS {
        let point = ray.at((f64::from(t0) + (f64::from(i) + 0.5) * length) as f32);
        let c = instance.volume().properties().at(point);
        let half = (-0.5 * length * c.mu_t.as_dvec3()).exp();
        gathered += length * transmittance * half * c.emission.as_dvec3();
        transmittance *= half * half;
    }
    [gathered, transmittance]
}

/// One walk with random numbers of its own, spread evenly as in a render.
fn walk(world: &World, ray: Ray, reads: f32, ray_kind: RayKind, index: u32) -> [DVec3; 2] {
    let mut rng = PathRng::stratified(u64::from(index), UVec2::ZERO, 0);
    if ray_kind != RayKind::Camera {
        rng.enter_vertex(1);
    }
    let gathered = gather(world.along(ray, f32::INFINITY), reads, ray_kind, &mut rng);
    [gathered.emission.as_dvec3(), gathered.transmittance.as_dvec3()]
}

fn check(density_scale: Rgb, emission: Emission) {
    let instance = medium(density_scale, emission);
    let ray = Ray::new(Vec3A::new(-1.6, 0.11, -0.23), Vec3A::new(1.0, 0.06, 0.04).normalize());
    let expected = expected(&instance, &ray);
    let world = World::new(vec![instance]);
    for (ray_kind, reads) in RAY_KINDS.into_iter().flat_map(|e| READS.map(|reads| (e, reads))) {
        let (mut sums, mut squares) = ([DVec3::ZERO; 2], [DVec3::ZERO; 2]);
        for index in 0..WALKS {
            for (i, value) in walk(&world, ray, reads, ray_kind, index).into_iter().enumerate() {
                sums[i] += value;
                squares[i] += value * value;
            }
        }
        let n = f64::from(WALKS);
        for (i, what) in ["emission", "transmittance"].into_iter().enumerate() {
            let mean = sums[i] / n;
            let variance = (squares[i] / n - mean * mean).max(DVec3::ZERO) / (n - 1.0);
            for channel in 0..3 {
                let (mean, expected) = (mean[channel], expected[i][channel]);
                // The quadrature errs where the noise has kinks.
                let error = variance[channel].sqrt().hypot(2e-4 * expected);
                let z = (mean - expected) / error;
                let label = format!(
                    "{what} of {density_scale}, {ray_kind:?}, {reads} reads, channel {channel}: \
                     {mean:.6} ± {error:.6}, expected {expected:.6}, z {z:.2}"
                );
                println!("{label}");
                assert!(z.abs() < Z_LIMIT, "{label}");
                assert!(error < 0.01 * expected.max(1e-3), "too weak, {label}");
            }
        }
    }
}

/// Emission where the extinction is.
#[test]
fn emission_where_the_smoke_is() {
    check(Rgb::new(0.5, 2.0, 6.0), Emission::Source { le: Rgb::new(1.0, 2.0, 0.5) });
}

/// Emission and extinction with details in different places.
#[test]
fn emission_apart_from_the_smoke() {
    let field = RgbField::Tinted(noise(9), Rgb::new(2.0, 1.0, 0.5));
    check(Rgb::new(2.0, 0.5, 4.0), Emission::Field { field, scale: Rgb::ONE });
}

/// Combs under majorants far above the extinction.
#[test]
fn hardly_any_smoke() {
    let field = RgbField::Tinted(noise(9), Rgb::new(2.0, 1.0, 0.5));
    check(Rgb::new(0.2, 0.1, 0.0), Emission::Field { field, scale: Rgb::ONE });
}
