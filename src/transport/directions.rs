//! Where a path should turn to, beside where chance takes it: to the glow around a light, and to
//! bundles of light that metals throw.

use glam::Vec3A;

use super::{
    probes::{Focus, Probes},
    strategy::Advanced,
    vertex::Vertex,
};
use crate::{
    light::Receiver,
    sampling::{
        fisher::Fisher,
        halo::Halo,
        towards::{Lobe, Towards},
    },
};

/// Share of the directions that go to bundles of light where nothing else is.
const MOST_BUNDLES: f32 = 0.5;

/// The directions to draw at a vertex that looked at `light`, a point of one, if it has a place.
pub(super) fn towards(
    advanced: &Advanced,
    probes: &Probes,
    vertex: &Vertex,
    light: Option<Vec3A>,
) -> Towards {
    let mut towards = Towards::default();
    let from = vertex.receiver();
    if advanced.guide_caustics && vertex.is_broad() {
        add_bundles(&mut towards, probes, vertex, &from);
    }
    if advanced.guide_directions && !vertex.is_surface() {
        let share = probes.share_of_halo() * (1.0 - towards.share());
        if let Some(axis) = light.and_then(|point| (point - from.position).try_normalize()) {
            towards.add(share, Lobe::Halo(Halo::new(axis, probes.mean_cosine())));
        }
    }
    towards
}

/// Bundles of light by what they bring, relative to all that comes indirectly.
fn add_bundles(towards: &mut Towards, probes: &Probes, vertex: &Vertex, from: &Receiver) {
    let (foci, indirect) = probes.bundles(from.position);
    if foci.is_empty() {
        return;
    }
    let aim = |focus: &Focus| {
        let axis = (focus.point - from.position).try_normalize()?;
        Some((axis, focus.fluence * vertex.rough_value(axis)))
    };
    let bundled: f32 = foci.iter().filter_map(aim).map(|(_, value)| value).sum();
    let rest = indirect / (4.0 * std::f32::consts::PI);
    let scale = MOST_BUNDLES / (bundled + rest);
    if !(scale > 0.0 && scale.is_finite()) {
        return;
    }
    for focus in foci {
        if let Some((axis, value)) = aim(focus) {
            let bundle = Fisher::new(axis, focus.concentration);
            towards.add(scale * value, Lobe::Bundle(bundle));
        }
    }
}
