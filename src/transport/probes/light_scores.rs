//! LightScores of the lights around a probe, by shadow rays from points in it: hidden lights score
//! nothing, lights dimmed by smoke score less.

use glam::{UVec2, Vec3A};

use crate::{
    light::{LightScores, Receiver, Visibility},
    math::{Aabb, PathRng, mean},
    transport::{direct, scene::Scene},
};

/// Shadow rays to lights from each probe.
const SHADOW_RAYS: u32 = 32;
/// Most random points that are tried for the start of a shadow ray, until one of them scatters.
const TRIES: u32 = 3;

/// LightScores of the lights around `bounds`, for the probe of a node; `None` where no light is
/// visible. The lights are chosen by the hierarchy, evenly spread over its choices.
pub(super) fn light_scores(scene: &Scene, node: u32, bounds: &Aabb) -> Option<LightScores> {
    let mut rng = PathRng::new(super::stages::SEED, UVec2::new(node, 1), 1);
    let offset = f64::from(rng.uniform());
    let shadow_ray = |index: u32| {
        let pick = (f64::from(index) + offset) / f64::from(SHADOW_RAYS);
        let from = Receiver { position: place(scene, bounds, &mut rng), normal: None };
        direct::visibility(scene, &from, pick, &mut rng)
    };
    let mut visibilities: Vec<Visibility> = (0..SHADOW_RAYS).filter_map(shadow_ray).collect();
    LightScores::new(&mut visibilities)
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
