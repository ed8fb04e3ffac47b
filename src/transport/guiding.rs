//! Where a path should turn to, beside where chance takes it: to the glow around a light, and to
//! bundles of light that metals throw.

use std::f32::consts::PI;

use glam::Vec3A;

use super::{
    probes::{Focus, Probes, Surroundings},
    strategy::Advanced,
    vertex::Vertex,
};
use crate::sampling::airlight::Halo;
use crate::sampling::guiding_mixture::{Lobe, Towards};
use crate::sampling::von_mises_fisher::Fisher;

/// Share of the directions that go to bundles of light where nothing else is.
const MOST_BUNDLES: f32 = 0.5;

/// Part of the light that has to come straight from lights for their glow to get all of its share.
const STRAIGHT: f32 = 0.3;

/// The directions to draw at a vertex that looked at `light`, a point of one, if it has a place.
pub(super) fn towards(
    advanced: &Advanced,
    probes: &Probes,
    vertex: &Vertex,
    light: Option<Vec3A>,
) -> Towards {
    let mut towards = Towards::default();
    let from = vertex.receiver().position;
    let Some(around) = probes.around(from) else { return towards };
    if advanced.guide_caustics && vertex.is_broad() {
        add_bundles(&mut towards, &around, vertex, from);
    }
    if advanced.guide_directions && !vertex.is_surface() {
        let left = 1.0 - towards.share();
        let share = left * probes.share_of_halo() * worth_of_halo(&around);
        if let Some(axis) = light.and_then(|point| (point - from).try_normalize()) {
            towards.add(share, Lobe::Halo(Halo::new(axis, probes.mean_cosine())));
        }
    }
    towards
}

/// How much of its share the glow around a light gets: all, unless most light has scattered on its
/// way. Then it comes from all around, the light is no better guess than any, and guesses in vain
/// add to the spread of the path's weight.
fn worth_of_halo(around: &Surroundings<'_>) -> f32 {
    let straight = around.direct / (around.direct + around.indirect);
    if straight.is_finite() { (straight / STRAIGHT).min(1.0) } else { 0.0 }
}

/// Bundles of light by what they bring, relative to all that comes indirectly.
fn add_bundles(towards: &mut Towards, around: &Surroundings<'_>, vertex: &Vertex, from: Vec3A) {
    let aim = |focus: &Focus| {
        let axis = (focus.point - from).try_normalize()?;
        Some((axis, focus.fluence * vertex.rough_value(axis)))
    };
    let bundled: f32 = around.foci.iter().filter_map(aim).map(|(_, value)| value).sum();
    let scale = MOST_BUNDLES / (bundled + around.indirect / (4.0 * PI));
    if !(bundled > 0.0 && scale.is_finite()) {
        return;
    }
    for focus in around.foci {
        if let Some((axis, value)) = aim(focus) {
            let bundle = Fisher::new(axis, focus.concentration);
            towards.add(scale * value, Lobe::Bundle(bundle));
        }
    }
}
