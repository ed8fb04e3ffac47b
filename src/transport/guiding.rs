//! Where a path should turn to, beside where chance takes it: to the glow around a light, and to
//! bundles of light that metals throw.

use std::f32::consts::PI;

use glam::Vec3A;

use super::{
    probes::{CausticLobe, Probes, Surroundings},
    strategy::Advanced,
    vertex::Vertex,
};
use crate::sampling::airlight::Airlight;
use crate::sampling::guiding_mixture::{GuidingLobe, GuidingMixture};
use crate::sampling::von_mises_fisher::VonMisesFisher;

/// Share of the directions that go to bundles of light where nothing else is.
const MOST_CAUSTICS: f32 = 0.5;

/// Part of the light that has to come straight from lights for their glow to get all of its share.
const STRAIGHT: f32 = 0.3;

/// The directions to draw at a vertex that looked at `light`, a point of one, if it has a place.
pub(super) fn guiding(
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
