//! Next-event estimation, and the radiance a ray finds with its share of the MIS.
//!
//! What both a look at a light and a scattered ray can find is shared by the balance heuristic.
//! The weight multiplies the radiance found, never the path's throughput. Environment, emitters
//! and suns are shared light by light. Emissive volumes share one density, Σ q_v p_v over all of
//! them along the line: that is how often any look at any of them goes there, so that a look
//! gathers the emission of all, and where they overlap nothing needs to be kept apart.

use super::{
    emission::{Errand, Gatherer},
    scene::Scene,
    strategy::{LightSelection, NeeEvaluation, Strategy},
    tracking,
    vertex::Vertex,
};
use crate::{
    light::{Choice, Light, Receiver},
    math::{PathRng, Ray, Rgb, Slot},
    sampling::mis,
    surface::{self, Intersection, occluded},
};

/// Shadow rays stop short of their light by this share, so that they don't meet the light itself.
const SHORT_OF_LIGHT: f32 = 1.0 - 1e-4;

/// The vertex a ray left from and the density over solid angle it was drawn with there.
#[derive(Clone, Copy, Debug)]
pub struct Departure {
    /// Where looks at lights would have gone from.
    pub from: Receiver,
    /// Density of the direction it took.
    pub pdf_solid_angle: f32,
}

/// Which lights take part, by the toggles.
fn choice(strategy: &Strategy) -> Choice {
    let uniform = strategy.advanced.light_selection == LightSelection::Uniform;
    Choice { volumes: strategy.nee, uniform }
}

/// Light that a sampled light sends to `vertex` and on along the path, and the collisions of the
/// walk towards it. `gatherer` looks at volumes.
pub fn sample_lights(
    scene: &Scene,
    gatherer: &Gatherer,
    vertex: &Vertex,
    rng: &mut PathRng,
) -> (Rgb, u32) {
    let from = vertex.receiver();
    match scene.lights.choose(&from, choice(&scene.strategy), rng) {
        None => (Rgb::ZERO, 0),
        Some((Light::Volume(instance), _)) => {
            sample_volume(scene, gatherer, vertex, *instance, rng)
        }
        Some((light, probability)) => sample_solid(scene, vertex, light, probability, rng),
    }
}

/// A look at a light with a place of its own; transmittance is ratio tracked.
fn sample_solid(
    scene: &Scene,
    vertex: &Vertex,
    light: &Light,
    probability: f32,
    rng: &mut PathRng,
) -> (Rgb, u32) {
    let Some(light) = light.sample(vertex.receiver().position, rng) else { return (Rgb::ZERO, 0) };
    let (value, vertex_pdf) = vertex.eval(light.direction);
    let light_pdf = probability * light.pdf;
    if value.max_element() <= 0.0 || light_pdf <= 0.0 {
        return (Rgb::ZERO, 0);
    }
    let ray = vertex.ray(light.direction);
    let distance = SHORT_OF_LIGHT * light.distance;
    if occluded(&scene.surfaces, &ray, distance) {
        return (Rgb::ZERO, 0);
    }
    let (transmittance, collisions) =
        tracking::transmittance(scene.world.along(ray, light.distance), rng);
    let weight = if light.can_be_met { mis::balance(light_pdf, vertex_pdf) } else { 1.0 };
    (value * light.radiance * transmittance * (weight / light_pdf), collisions)
}

/// A look at an emissive volume: a direction towards where its power comes from.
fn sample_volume(
    scene: &Scene,
    gatherer: &Gatherer,
    vertex: &Vertex,
    instance: u32,
    rng: &mut PathRng,
) -> (Rgb, u32) {
    let from = vertex.receiver();
    let pick = rng.at64(Slot::LightCell);
    let u = [Slot::LightX, Slot::LightY, Slot::LightZ].map(|slot| rng.at(slot)).into();
    let volume = &scene.world.instances()[instance as usize];
    let Some(point) = volume.sample_emission(pick, u) else { return (Rgb::ZERO, 0) };
    let Some(direction) = (point - from.position).try_normalize() else { return (Rgb::ZERO, 0) };
    let (value, vertex_pdf) = vertex.eval(direction);
    if value.max_element() <= 0.0 {
        return (Rgb::ZERO, 0);
    }
    let ray = vertex.ray(direction);
    let light_pdf = pdf_of_volumes(scene, &ray, &from);
    if light_pdf <= 0.0 {
        return (Rgb::ZERO, 0);
    }
    let value = value * mis::balance(light_pdf, vertex_pdf);
    // Points are drawn inside of the lights only. Glow beyond them, which lines of sight bring as
    // well, shares their weights, so that it takes the line.
    let evaluation = match scene.strategy.advanced.nee_evaluation {
        NeeEvaluation::Point if !scene.world.glows_beyond_lights() => NeeEvaluation::Point,
        _ => NeeEvaluation::Line,
    };
    let (found, collisions) = match evaluation {
        NeeEvaluation::Line => {
            let t_max =
                surface::intersect(&scene.surfaces, &ray).map_or(f32::INFINITY, |end| end.hit.t);
            let medium = scene.world.along(ray, t_max);
            let glow = gatherer.gather(medium, Errand::Light, rng);
            (glow.emission / light_pdf, glow.collisions)
        }
        NeeEvaluation::Point => {
            let distance = (point - ray.origin).length();
            emission_at_point(scene, &ray, distance, &from, rng)
        }
    };
    (value * found, collisions)
}

/// The emission at one point of the ray through the medium before it, over the density with which
/// looks at volumes end there (Villemin and Hery 2013): Σ q_v p_v over volume, times the squared
/// distance.
fn emission_at_point(
    scene: &Scene,
    ray: &Ray,
    distance: f32,
    from: &Receiver,
    rng: &mut PathRng,
) -> (Rgb, u32) {
    if occluded(&scene.surfaces, ray, distance) {
        return (Rgb::ZERO, 0);
    }
    let point = ray.at(distance);
    let choice = choice(&scene.strategy);
    let mut pdf_volume = 0.0;
    scene.world.emissive_along(ray, |instance, _| {
        let probability = scene.lights.probability_of_volume(instance, from, choice);
        let volume = &scene.world.instances()[instance as usize];
        pdf_volume += probability * volume.emission_pdf_at(point);
    });
    let emission = scene.world.emission_at(point, ray.direction);
    if pdf_volume <= 0.0 || emission == Rgb::ZERO {
        return (Rgb::ZERO, 0);
    }
    let medium = scene.world.along(*ray, distance);
    let (transmittance, collisions) = tracking::transmittance(medium, rng);
    (emission * transmittance / (pdf_volume * distance * distance), collisions)
}

/// Density over solid angle with which a look at some emissive volume goes along `ray`.
fn pdf_of_volumes(scene: &Scene, ray: &Ray, from: &Receiver) -> f32 {
    let choice = choice(&scene.strategy);
    let mut sum = 0.0;
    scene.world.emissive_along(ray, |instance, pdf| {
        if pdf > 0.0 {
            sum += pdf * scene.lights.probability_of_volume(instance, from, choice);
        }
    });
    sum
}

/// The MIS weight of the volume emission found along a ray that scattering sent; 1 for camera rays
/// (no departure), where nothing else could have found it.
pub fn weight_of_emission(scene: &Scene, ray: &Ray, departure: Option<&Departure>) -> f32 {
    match departure {
        Some(departure) if scene.strategy.nee => {
            mis::balance(departure.pdf_solid_angle, pdf_of_volumes(scene, ray, &departure.from))
        }
        _ => 1.0,
    }
}

/// Radiance that arrives at the start of `ray` from the surface it ends on or the environment
/// behind everything, the medium in between apart, weighted by what light samples at its departure
/// find of the same.
pub fn at_the_end(
    scene: &Scene,
    ray: &Ray,
    end: Option<&Intersection>,
    departure: Option<&Departure>,
) -> Rgb {
    let choice = choice(&scene.strategy);
    let shared = |radiance: Rgb, light_pdf: &dyn Fn(&Receiver) -> f32| match departure {
        None => radiance,
        Some(Departure { from, pdf_solid_angle }) => {
            radiance * mis::balance(*pdf_solid_angle, light_pdf(from))
        }
    };
    match end {
        Some(end) if end.surface.emits() => shared(end.surface.emission, &|from| {
            scene.lights.pdf_of_surface(end.index, from, choice, &end.hit)
        }),
        Some(_) => Rgb::ZERO,
        None => {
            let from = departure.map(|departure| departure.from);
            let suns = scene.lights.suns_behind(from, choice, ray.direction);
            suns.fold(scene.lights.environment, |sum, (sun, pdf)| {
                sum + shared(sun.radiance(), &|_| pdf)
            })
        }
    }
}
