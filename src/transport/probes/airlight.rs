//! The fraction of the lights' power that the medium scatters, which decides how many directions
//! are drawn towards airlight.

use std::f32::consts::TAU;

use glam::{UVec2, Vec3A};

use crate::{
    error::{Progress, Result, report},
    light::Emitter,
    math::{PathRng, Ray, Rgb, mean},
    sampling::warp::spherical,
    surface,
    transport::{
        scene::Scene,
        strategy::Preset,
        tracking::{event::Event, scattering::scatter},
    },
};

/// Rays that are followed from the lights.
const RAYS: u32 = 256;

/// The fraction of the power of all lights at finite distances that is scattered at least once,
/// attenuation by the albedo included; 0 without such lights.
pub(super) fn scattered_share(scene: &Scene, progress: Progress) -> Result<f32> {
    let emitters = scene.lights.emitters(&scene.world);
    let intensity = |emitter: &Emitter| f64::from(emitter.intensity.clamp(0.0, f32::MAX));
    let total: f64 = emitters.iter().map(intensity).sum();
    if total <= 0.0 {
        return Ok(0.0);
    }
    let (mut chosen, mut passed) = (0, 0.0);
    let of_ray = |i: u32| {
        report(progress, 0.0)?;
        let wanted = (f64::from(i) + 0.5) / f64::from(RAYS) * total;
        while chosen + 1 < emitters.len() && passed + intensity(&emitters[chosen]) < wanted {
            passed += intensity(&emitters[chosen]);
            chosen += 1;
        }
        let mut rng = PathRng::new(super::stages::SEED, UVec2::Y, i);
        Ok(scattered_of(scene, &emitters[chosen], &mut rng))
    };
    let scattered: f32 = (0..RAYS).map(of_ray).sum::<Result<f32>>()?;
    let share = scattered / RAYS as f32;
    Ok(if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 })
}

/// The fraction of the power along one ray from a light that is scattered.
fn scattered_of(scene: &Scene, emitter: &Emitter, rng: &mut PathRng) -> f32 {
    let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
    let origin = emitter.bounds.min + u * emitter.bounds.size();
    let direction = match emitter.cone {
        Some((axis, _)) => axis,
        None => spherical(1.0 - 2.0 * rng.uniform(), TAU * rng.uniform()),
    };
    // The light's own surface does not end the ray.
    let size = emitter.bounds.diagonal();
    let outside = Ray::new(origin + size * direction, direction);
    let end = surface::intersect(&scene.surfaces, &outside);
    let t_max = end.map_or(f32::INFINITY, |end| size + end.hit.t);
    let medium = scene.world.along(Ray::new(origin, direction), t_max);
    let strategy = Preset::Full.strategy();
    let flight = scatter(medium, &strategy, Rgb::ONE, rng.exponential(), rng);
    match flight.event {
        Event::Scattered { .. } => mean(flight.weight),
        _ => 0.0,
    }
}
