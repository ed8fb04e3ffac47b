//! Next-event estimation, and the radiance at the end of a ray with its share of the MIS.
//!
//! A light that both a light sample and a scattered ray can find is shared by the balance
//! heuristic. The weight multiplies the radiance found, never the path's throughput.

use glam::Vec3A;

use super::{scene::Scene, tracking, vertex::Vertex};
use crate::{
    math::{PathRng, Ray, Rgb},
    sampling::mis,
    surface::{Intersection, occluded},
};

/// Shadow rays stop short of their light by this share, so that they don't meet the light itself.
const SHORT_OF_LIGHT: f32 = 1.0 - 1e-4;

/// The vertex a ray left from and the density it was drawn with there; `None` in place of it for
/// camera rays, where nothing else could have found what the ray finds.
pub type Departure = Option<(Vec3A, f32)>;

/// Light that a sampled light sends to `vertex` and on along the path, and the collisions of its
/// shadow ray. Transmittance is ratio tracked.
pub fn sample_lights(scene: &Scene, vertex: &Vertex, rng: &mut PathRng) -> (Rgb, u32) {
    let Some(light) = scene.lights.sample(vertex.position, rng) else { return (Rgb::ZERO, 0) };
    let (value, vertex_pdf) = vertex.eval(light.direction);
    if value.max_element() <= 0.0 {
        return (Rgb::ZERO, 0);
    }
    let ray = vertex.ray(light.direction);
    let distance = SHORT_OF_LIGHT * light.distance;
    if occluded(&scene.surfaces, &ray, distance) {
        return (Rgb::ZERO, 0);
    }
    let (transmittance, collisions) =
        tracking::transmittance(scene.world.along(ray, light.distance), rng);
    let weight = if light.can_be_met { mis::balance(light.pdf, vertex_pdf) } else { 1.0 };
    (value * light.radiance * transmittance * (weight / light.pdf), collisions)
}

/// Radiance that arrives at the start of `ray` from the surface it ends on or the environment
/// behind everything, the medium in between apart, weighted by what light samples at its departure
/// find of the same.
pub fn at_the_end(
    scene: &Scene,
    ray: &Ray,
    end: Option<&Intersection>,
    departure: Departure,
) -> Rgb {
    let shared = |radiance: Rgb, light_pdf: &dyn Fn(Vec3A) -> f32| match departure {
        None => radiance,
        Some((from, pdf)) => radiance * mis::balance(pdf, light_pdf(from)),
    };
    match end {
        Some(end) if end.surface.emits() => shared(end.surface.emission, &|from| {
            scene.lights.pdf_of_surface(end.index, from, &end.hit)
        }),
        Some(_) => Rgb::ZERO,
        None => {
            let from = departure.map_or(ray.origin, |(from, _)| from);
            let suns = scene.lights.suns_behind(from, ray.direction);
            suns.fold(scene.lights.environment, |sum, (sun, pdf)| {
                sum + shared(sun.radiance(), &|_| pdf)
            })
        }
    }
}
