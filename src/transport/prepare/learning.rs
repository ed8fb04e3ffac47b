//! Indirect light of probes, learned from paths: light scattered or reflected before it reaches a
//! place, which no light sample estimates.
//!
//! Rays leave points in each probe in directions spread over the sphere. The radiance scattered and
//! reflected into them is the radiance that arrives indirectly, hidden lights and walls included.
//! Its fluence and mean direction are kept. The pre-pass is fixed by the scene alone, so that every
//! render of it has the same probes; the paths of the picture change nothing.

use std::f32::consts::{PI, TAU};

use glam::{UVec2, Vec3A};
use rayon::prelude::*;

use super::cost::Cost;
use crate::transport::context::PathContext;
use crate::transport::emission::EmissionEstimator;
use crate::transport::learned_counts::LearnedCounts;
use crate::transport::path;
use crate::transport::probes::stages::{CAUSTICS_FOUND, SEED};
use crate::transport::probes::{Brightness, Indirect, PathSums, Probes};
use crate::transport::scene::Scene;
use crate::transport::strategy::{Advanced, Preset, Strategy};
use crate::{
    error::{Progress, Result, report},
    math::{Aabb, PathRng, Ray, luminance},
    sampling::warp::spherical,
};

/// Most paths from each probe.
const PATHS: u32 = 16;
/// Cost of the paths of all probes, in tracking steps, after which no others set out.
const COST_BUDGET: f64 = 2e6;
/// Scattering events and reflections after which the paths end: later ones contribute little that
/// would change a probe.
const MOST_SCATTERS: u32 = 64;
/// Leaves from which paths set out one after the other lie so far apart in the order of the octree.
const STRIDE: usize = 64;
/// Paths that set out before their cost is counted.
const AT_ONCE: usize = 256;
/// Steps of two numbers that fill the unit square evenly, however many there are (Roberts 2018).
const EVEN_STEPS: [f32; 2] = [0.754_877_7, 0.569_840_3];

/// Indirect light in the leaves of `probes`, found by paths that start there.
pub(super) fn indirect_light(
    probes: &Probes,
    scene: &Scene,
    progress: Progress,
) -> Result<Vec<PathSums>> {
    let max_scatters = match scene.max_scatters {
        0 => MOST_SCATTERS,
        most => most.min(MOST_SCATTERS),
    };
    let advanced = Advanced {
        light_selection: scene.strategy.advanced.light_selection,
        ..Advanced::default()
    };
    let strategy = Strategy { advanced, ..Preset::Full.strategy() };
    let scene = Scene { max_scatters, ..scene.clone() }.with_strategy(strategy);
    let emission_estimator = EmissionEstimator::coarse();
    let brightness = Brightness::default();
    let context = PathContext {
        emission_estimator: &emission_estimator,
        probes: Some(probes),
        brightness,
        counts: &LearnedCounts::first(1.0),
    };
    let leaves = probes.leaves();
    // Neighbors are far apart, so that few paths are spread over all of the medium.
    let spread = (0..STRIDE).flat_map(|first| leaves.iter().skip(first).step_by(STRIDE));
    let mut leaves: Vec<Leaf> = spread.map(Leaf::new).collect();
    let mut spent = 0.0;
    for _ in 0..PATHS {
        for leaves in leaves.chunks_mut(AT_ONCE) {
            if spent >= COST_BUDGET {
                break;
            }
            let follow = |leaf: &mut Leaf| {
                report(progress, CAUSTICS_FOUND)?;
                Ok(leaf.follow_path(&scene, context))
            };
            let costs: Result<Vec<f64>> = leaves.par_iter_mut().map(follow).collect();
            spent += costs?.iter().sum::<f64>();
        }
    }
    Ok(leaves.into_iter().map(|leaf| leaf.found).collect())
}

/// A leaf of the octree, and what paths have found there.
struct Leaf {
    bounds: Aabb,
    found: PathSums,
}

impl Leaf {
    fn new(&(node, bounds): &(u32, Aabb)) -> Self {
        Self { bounds, found: PathSums { node, paths: 0, sum: Indirect::default() } }
    }

    /// Follows the next path from the leaf; returns its cost.
    fn follow_path(&mut self, scene: &Scene, context: PathContext<'_>) -> f64 {
        let PathSums { node, paths, .. } = self.found;
        let mut rng = PathRng::new(SEED, UVec2::new(node, 2), PATHS);
        let begin = [rng.uniform(), rng.uniform()];
        let mut rng = PathRng::new(SEED, UVec2::new(node, 2), paths);
        let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
        let even = |k: usize| (begin[k] + paths as f32 * EVEN_STEPS[k]).fract();
        let direction = spherical(1.0 - 2.0 * even(0), TAU * even(1));
        let ray = Ray::new(self.bounds.min + u * self.bounds.size(), direction);
        let mut cost = Cost::new(scene);
        let sample = path::trace(scene, context, ray, &mut rng, &mut cost);
        self.found.sum.add(direction, 4.0 * PI * luminance(sample.direct + sample.indirect));
        self.found.paths += 1;
        cost.of(&sample)
    }
}
