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
use crate::light::{LightChoice, Receiver};
use crate::math::{PathRng, Ray};
use crate::sampling::airlight::Airlight;
use crate::sampling::equiangular::Equiangular;
use crate::sampling::guiding_mixture::{GuidingLobe, GuidingMixture};
use crate::sampling::von_mises_fisher::VonMisesFisher;
use crate::volume::world::MediumRay;

/// Most rays of a path that are guided: later ones contribute so little that guiding costs more
/// than it gains, and each adds to the spread of the path's weight.
const GUIDED_RAYS: u32 = 4;
/// Share of the directions drawn towards caustics where there is no other indirect light.
const MOST_CAUSTICS: f32 = 0.5;

/// Share of direct light, in light as a whole, from which on airlight gets all of its share.
const STRAIGHT: f32 = 0.3;

/// Choice among the lights at a vertex: by the scores of the probe around it, if there is one.
pub(super) fn light_choice(scene: &Scene, context: &PathContext, vertex: &Vertex) -> LightChoice {
    let choice = direct::choice(&scene.strategy);
    let from = vertex.receiver();
    match context.probes.and_then(|probes| probes.light_scores(from.position)) {
        Some(scores) => scene
            .lights
            .choice_by(scores, &from, choice.volumes, |direction| vertex.rough_value(direction)),
        None => choice,
    }
}

/// p_select of ray number `scatters` of a path, if anything guides it. `light` is the point of a
/// light that was sampled at the vertex before; for a camera ray one is drawn here.
pub(super) fn distances(
    scene: &Scene,
    context: &PathContext,
    (scatters, ray): (u32, &Ray),
    medium: &MediumRay,
    light: &mut Option<Vec3A>,
    rng: &mut PathRng,
) -> Option<DistanceGuide> {
    let guides = context.guides(&scene.strategy);
    let probes = guides.filter(|_| scatters < GUIDED_RAYS)?;
    let advanced = &scene.strategy.advanced;
    let (t0, t1) = medium.extent()?;
    let asks = scatters == 0 || advanced.guide_all_vertices;
    let distance_pdf = if asks { Some(probes.along(medium.clone(), ray)?) } else { None };
    if !advanced.equiangular {
        return DistanceGuide::new(distance_pdf, None);
    }
    if scatters == 0 {
        let from = Receiver { position: distance::middle(ray, t0, t1), normal: None };
        let choice = direct::choice(&scene.strategy);
        *light = direct::point_of_light(scene, &from, &choice, rng);
    }
    let equiangular =
        light.and_then(|point| Equiangular::new(ray, point, probes.mean_cosine(), t0, t1));
    DistanceGuide::new(distance_pdf, equiangular)
}

/// Draws the direction in which a path continues from its vertex number `scatters`, with a share
/// for the directions of light that the probes estimate.
pub(super) fn direction(
    scene: &Scene,
    context: &PathContext,
    scatters: u32,
    vertex: &Vertex,
    light: Option<Vec3A>,
    rng: &mut PathRng,
) -> Option<DirectionSample> {
    let strategy = &scene.strategy;
    match context.probes.filter(|_| scatters < GUIDED_RAYS && strategy.guides()) {
        Some(probes) => {
            // Without guided flights there are no splits to even out the weights of airlight.
            let light = light.filter(|_| context.flights > 0.0);
            vertex.sample_guided(&mixture(&strategy.advanced, probes, vertex, light), rng)
        }
        None => vertex.sample(rng),
    }
}

/// Mixture of guided directions at a vertex; `light` is the sampled point of a light, if it has
/// one.
fn mixture(
    advanced: &Advanced,
    probes: &Probes,
    vertex: &Vertex,
    light: Option<Vec3A>,
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
        if let Some(axis) = light.and_then(|point| (point - from).try_normalize()) {
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
