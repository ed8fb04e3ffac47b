//! Guiding of a path by the probes: the light to sample at a vertex, the distance to scatter at
//! along a ray, and directions beside those of BSDF or phase sampling: airlight and caustics.

use std::f32::consts::PI;

use glam::Vec3A;

use super::context::PathContext;
use super::direct;
use super::distance::{self, DistanceGuide};
use super::probes::{CausticLobe, Probes, Surroundings};
use super::scene::Scene;
use super::strategy::Advanced;
use super::vertex::{DirectionSample, Vertex};
use crate::light::{LightChoice, LightGroup, Receiver};
use crate::math::{PathRng, Ray};
use crate::sampling::airlight::Airlight;
use crate::sampling::equiangular::Equiangular;
use crate::sampling::guiding_mixture::{GuidingLobe, GuidingMixture};
use crate::sampling::von_mises_fisher::VonMisesFisher;
use crate::volume::world::MediumRay;

/// Most rays of a path that are guided: later ones contribute so little that guiding costs more
/// than it gains, and each adds to the spread of the path's weight.
const GUIDED_RAYS: u32 = 4;
/// Number of the random numbers that a point of a light is drawn by where no light sample is drawn.
const GUIDING_SAMPLE: u32 = 16;
/// Share of the directions drawn towards caustics where there is no other indirect light.
const MOST_CAUSTICS: f32 = 0.5;

/// Share of direct light, in light as a whole, from which on airlight gets all of its share.
const STRAIGHT: f32 = 0.3;

/// Choice among a group of the lights at a vertex: by the scores of the probe around it, if there
/// is one.
pub(super) fn light_choice(
    scene: &Scene,
    context: &PathContext,
    vertex: &Vertex,
    among: LightGroup,
) -> LightChoice {
    let choice = direct::choice_among(&scene.strategy, among);
    let from = vertex.receiver();
    match context.probes_for_lights().and_then(|probes| probes.light_scores(from.position)) {
        Some(scores) => {
            scene.lights.choice_by(scores, &from, among, |direction| vertex.rough_value(direction))
        }
        None => choice,
    }
}

/// Draws p_select of ray number `scatters` of a path, if anything guides it, and the point of a
/// light that guides the ray. `light_point` is the one that was sampled at the vertex before; it is
/// returned unless the ray is a camera ray, for which one is drawn here.
pub(super) fn draw_guide(
    scene: &Scene,
    context: &PathContext,
    (scatters, ray): (u32, &Ray),
    medium: &MediumRay,
    light_point: Option<Vec3A>,
    rng: &mut PathRng,
) -> (Option<DistanceGuide>, Option<Vec3A>) {
    let unguided = (None, light_point);
    let guides = context.probes_for_distances(&scene.strategy);
    let Some(probes) = guides.filter(|_| scatters < GUIDED_RAYS) else { return unguided };
    let Some((t0, t1)) = medium.extent() else { return unguided };
    let advanced = &scene.strategy.advanced;
    let mut distance_pdf = None;
    if scatters == 0 || advanced.guide_all_vertices {
        distance_pdf = probes.along(medium.clone(), ray);
        if distance_pdf.is_none() {
            return unguided;
        }
    }
    if !advanced.equiangular {
        return (DistanceGuide::new(distance_pdf, None), light_point);
    }
    let light_point = match scatters {
        0 => {
            let from = Receiver { position: distance::middle(ray, t0, t1), normal: None };
            direct::point_of_light(scene, &from, &direct::choice(&scene.strategy), rng)
        }
        _ => light_point,
    };
    let equiangular =
        light_point.and_then(|point| Equiangular::new(ray, point, probes.mean_cosine(), t0, t1));
    (DistanceGuide::new(distance_pdf, equiangular), light_point)
}

/// The point of a light that guides the path beyond its vertex number `scatters`, where no light
/// sample was drawn that has one; `None` where none guides.
pub(super) fn light_point(
    scene: &Scene,
    context: &PathContext,
    scatters: u32,
    vertex: &Vertex,
    rng: &mut PathRng,
) -> Option<Vec3A> {
    context.probes_for_distances(&scene.strategy).filter(|_| scatters < GUIDED_RAYS)?;
    let advanced = &scene.strategy.advanced;
    if !advanced.guide_directions && !advanced.equiangular {
        return None;
    }
    rng.enter_light_sample(GUIDING_SAMPLE);
    let choice = light_choice(scene, context, vertex, direct::choice(&scene.strategy).among);
    direct::point_of_light(scene, &vertex.receiver(), &choice, rng)
}

/// Draws the direction in which a path continues from its vertex number `scatters`, with a share
/// for the directions of light that the probes estimate.
pub(super) fn direction(
    scene: &Scene,
    context: &PathContext,
    scatters: u32,
    vertex: &Vertex,
    light_point: Option<Vec3A>,
    rng: &mut PathRng,
) -> Option<DirectionSample> {
    let strategy = &scene.strategy;
    match context.probes_for_directions(strategy).filter(|_| scatters < GUIDED_RAYS) {
        Some(probes) => {
            // Without guided flights there are no splits to even out the weights of airlight.
            let light_point = light_point.filter(|_| context.counts.guided_flights > 0.0);
            vertex.sample_guided(&mixture(&strategy.advanced, probes, vertex, light_point), rng)
        }
        None => vertex.sample(rng),
    }
}

/// Mixture of guided directions at a vertex; `light_point` is the sampled point of a light, if it
/// has one.
fn mixture(
    advanced: &Advanced,
    probes: &Probes,
    vertex: &Vertex,
    light_point: Option<Vec3A>,
) -> GuidingMixture {
    let mut guiding = GuidingMixture::default();
    let from = vertex.receiver().position;
    let Some(around) = probes.around(from) else { return guiding };
    if advanced.guide_caustics && vertex.is_broad() {
        add_caustics(&mut guiding, &around, vertex, from);
    }
    if advanced.guide_directions && !vertex.is_surface() {
        let left = 1.0 - guiding.share();
        let share = left * probes.share_of_airlight() * worth_of_airlight(&around);
        if let Some(axis) = light_point.and_then(|point| (point - from).try_normalize()) {
            guiding.add(share, GuidingLobe::Airlight(Airlight::new(axis, probes.mean_cosine())));
        }
    }
    guiding
}

/// Factor, 0 to 1, of the share of airlight: 1, unless most light has been scattered before. Such
/// light comes from all around, so that the light's own direction is no better than any, and
/// guiding in vain adds to the spread of the path's weight.
fn worth_of_airlight(around: &Surroundings<'_>) -> f32 {
    let straight = around.direct / (around.direct + around.indirect);
    if straight.is_finite() { (straight / STRAIGHT).min(1.0) } else { 0.0 }
}

/// Adds the caustics by their contributions, relative to all indirect light.
fn add_caustics(
    guiding: &mut GuidingMixture,
    around: &Surroundings<'_>,
    vertex: &Vertex,
    from: Vec3A,
) {
    let axis_of = |lobe: &CausticLobe| {
        let axis = (lobe.point - from).try_normalize()?;
        Some((axis, lobe.fluence * vertex.rough_value(axis)))
    };
    let total: f32 = around.caustic_lobes.iter().filter_map(axis_of).map(|(_, value)| value).sum();
    let scale = MOST_CAUSTICS / (total + around.indirect / (4.0 * PI));
    if !(total > 0.0 && scale.is_finite()) {
        return;
    }
    for lobe in around.caustic_lobes {
        if let Some((axis, value)) = axis_of(lobe) {
            let distribution = VonMisesFisher::new(axis, lobe.concentration);
            guiding.add(scale * value, GuidingLobe::Caustic(distribution));
        }
    }
}
