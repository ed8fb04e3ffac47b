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

use crate::transport::context::PathContext;
use crate::transport::emission::EmissionEstimator;
use crate::transport::learned_counts::LearnedCounts;
use crate::transport::observer::{Observer, PathStep};
use crate::transport::path;
use crate::transport::probes::stages::{CAUSTICS_FOUND, SEED};
use crate::transport::probes::{Brightness, Indirect, Probes};
use crate::transport::sample::PathSample;
use crate::transport::scene::Scene;
use crate::transport::strategy::{Advanced, Preset, Strategy};
use crate::{
    error::{Progress, Result, report},
    math::{Aabb, PathRng, Ray, luminance},
    sampling::warp::spherical,
};

/// Most paths from each probe.
const PATHS: u32 = 16;
/// Cost of a ray or a vertex beside the tracking steps, in tracking steps.
const RAY_COST: f64 = 11.0;
/// Cost of a probe's paths, in tracking steps, after which no other sets out.
const COST_BUDGET: f64 = 1536.0;
/// Scattering events and reflections after which the paths end: later ones contribute little that
/// would change a probe.
const MOST_SCATTERS: u32 = 64;
/// Steps of two numbers that fill the unit square evenly, however many there are (Roberts 2018).
const EVEN_STEPS: [f32; 2] = [0.754_877_7, 0.569_840_3];

/// Indirect light in each leaf of `probes`, estimated by paths that start there.
pub(super) fn indirect_light(
    probes: &Probes,
    scene: &Scene,
    progress: Progress,
) -> Result<Vec<(u32, Indirect)>> {
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
    let learn = |(node, bounds): &(u32, Aabb)| {
        Ok((*node, around(&scene, context, (*node, bounds), progress)?))
    };
    probes.leaves().par_iter().map(learn).collect()
}

/// Indirect light in a leaf.
fn around(
    scene: &Scene,
    context: PathContext<'_>,
    (node, bounds): (u32, &Aabb),
    progress: Progress,
) -> Result<Indirect> {
    let mut indirect = Indirect::default();
    let mut rng = PathRng::new(SEED, UVec2::new(node, 2), PATHS);
    let begin = [rng.uniform(), rng.uniform()];
    let (mut paths, mut spent) = (0, 0.0);
    while paths < PATHS && spent < COST_BUDGET {
        report(progress, CAUSTICS_FOUND)?;
        let mut rng = PathRng::new(SEED, UVec2::new(node, 2), paths);
        let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
        let even = |k: usize| (begin[k] + paths as f32 * EVEN_STEPS[k]).fract();
        let direction = spherical(1.0 - 2.0 * even(0), TAU * even(1));
        let ray = Ray::new(bounds.min + u * bounds.size(), direction);
        let mut cost = RoughCost::default();
        let sample = path::trace(scene, context, ray, &mut rng, &mut cost);
        indirect.add(direction, 4.0 * PI * luminance(sample.direct + sample.indirect));
        paths += 1;
        spent += cost.of(&sample);
    }
    Ok(indirect.scaled(1.0 / paths.max(1) as f32))
}

/// Cost of a path by its rays, vertices and tracking steps, which is good enough to bound it.
#[derive(Debug, Default)]
struct RoughCost {
    rays_and_vertices: u32,
}

impl RoughCost {
    /// Cost of the path of `sample`, in tracking steps.
    fn of(&self, sample: &PathSample) -> f64 {
        f64::from(sample.tracking_steps) + RAY_COST * f64::from(self.rays_and_vertices)
    }
}

impl Observer for RoughCost {
    fn step(&mut self, step: PathStep) {
        if matches!(step, PathStep::Ray { .. } | PathStep::Vertex { .. }) {
            self.rays_and_vertices += 1;
        }
    }
}
