//! Guidance of a path by the probes: which light to sample at a vertex, where to scatter along a
//! ray, and which directions to draw beside those of BSDF or phase sampling: the glow around a
//! light, and caustics.

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

/// Rays of a path that are guided at most: later ones bring so little that guides cost more than
/// they gain, and each adds to the spread of the path's weight.
const GUIDED_RAYS: u32 = 4;
/// Share of the directions that go to bundles of light where nothing else is.
const MOST_CAUSTICS: f32 = 0.5;

/// Part of the light that has to come straight from lights for their glow to get all of its share.
const STRAIGHT: f32 = 0.3;

/// How a vertex chooses the light it samples: by the scores of the probe around it, if there is one.
pub(super) fn light_choice(scene: &Scene, context: &PathContext, vertex: &Vertex) -> LightChoice {
    let choice = direct::choice(&scene.strategy);
    let from = vertex.receiver();
    match context.probes.and_then(|probes| probes.scores(from.position)) {
        Some(scores) => scene
            .lights
            .choice_by(scores, &from, choice.volumes, |direction| vertex.rough_value(direction)),
        None => choice,
    }
}

/// p_select of the ray number `scatters` of a path, if anything guides it. `light` is the point of a
/// light that the vertex before has sampled; for a camera ray one is chosen here.
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

/// Draws the direction in which a path goes on from its vertex number `scatters`: sometimes to
/// where the probes know of light.
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
            // Without guided flights there are no splits that would even out what the glow brings.
            let light = light.filter(|_| context.flights > 0.0);
            vertex.sample_guided(&mixture(&strategy.advanced, probes, vertex, light), rng)
        }
        None => vertex.sample(rng),
    }
}

/// The directions to draw at a vertex that sampled `light`, a point of one, if it has a place.
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

/// How much of its share the glow around a light gets: all, unless most light has scattered on its
/// way. Then it comes from all around, the light is no better guess than any, and guesses in vain
/// add to the spread of the path's weight.
fn worth_of_airlight(around: &Surroundings<'_>) -> f32 {
    let straight = around.direct / (around.direct + around.indirect);
    if straight.is_finite() { (straight / STRAIGHT).min(1.0) } else { 0.0 }
}

/// Bundles of light by what they bring, relative to all that comes indirectly.
fn add_caustics(
    guiding: &mut GuidingMixture,
    around: &Surroundings<'_>,
    vertex: &Vertex,
    from: Vec3A,
) {
    let aim = |lobe: &CausticLobe| {
        let axis = (lobe.point - from).try_normalize()?;
        Some((axis, lobe.fluence * vertex.rough_value(axis)))
    };
    let bundled: f32 = around.caustic_lobes.iter().filter_map(aim).map(|(_, value)| value).sum();
    let scale = MOST_CAUSTICS / (bundled + around.indirect / (4.0 * PI));
    if !(bundled > 0.0 && scale.is_finite()) {
        return;
    }
    for lobe in around.caustic_lobes {
        if let Some((axis, value)) = aim(lobe) {
            let caustic = VonMisesFisher::new(axis, lobe.concentration);
            guiding.add(scale * value, GuidingLobe::Caustic(caustic));
        }
    }
}
