//! Scores of the lights around a probe, by looks at them from places in it: what is hidden scores
//! nothing, and what smoke dims scores less.

use glam::{UVec2, Vec3A};

use crate::{
    light::{Receiver, Scores, Visibility},
    math::{Aabb, PathRng, mean},
    transport::{direct, scene::Scene},
};

/// Looks at the lights from each probe.
const LOOKS: u32 = 32;
/// Places that are tried for one that scatters before a look is taken from any.
const TRIES: u32 = 3;

/// Those of the lights around `bounds`, for the probe of a node; `None` where none is seen. The
/// lights are chosen by the hierarchy, evenly spread over its choices.
pub(super) fn scores(scene: &Scene, node: u32, bounds: &Aabb) -> Option<Scores> {
    let mut rng = PathRng::new(super::stages::SEED, UVec2::new(node, 1), 1);
    let offset = f64::from(rng.uniform());
    let look = |look: u32| {
        let pick = (f64::from(look) + offset) / f64::from(LOOKS);
        let from = Receiver { position: place(scene, bounds, &mut rng), normal: None };
        direct::visibility(scene, &from, pick, &mut rng)
    };
    let mut visibilities: Vec<Visibility> = (0..LOOKS).filter_map(look).collect();
    Scores::new(&mut visibilities)
}

/// A random point that scatters, if one is found.
fn place(scene: &Scene, bounds: &Aabb, rng: &mut PathRng) -> Vec3A {
    let mut point = bounds.center();
    for _ in 0..TRIES {
        let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
        point = bounds.min + u * bounds.size();
        if scene.world.matter_at(point).is_some_and(|matter| mean(matter.mu_s) > 0.0) {
            break;
        }
    }
    point
}
