//! Paths that are traced before the picture to prepare it: k of the optimal majorant, the indirect
//! light of probes, the number of samples of each technique.
//!
//! All of it is fixed by the scene, the strategy and the size of the film, never by the seed, the
//! time or the number of threads, and costs are counted in steps, so that the same picture is
//! always prepared in the same way.

mod cost;
mod learning;
mod light_counts;
mod optimal_majorant;
pub(super) mod pilot;
pub(super) mod pilot_film;
mod pilot_pixel;
mod scene_probes;
mod spending;
mod trial;

pub use scene_probes::SceneProbes;

use glam::UVec2;

use super::emission::EmissionEstimator;
use super::scene::Scene;
use crate::error::{Progress, Result};

/// The emission walk for a picture of `size` pixels. To fit the optimal majorant takes a few
/// milliseconds; the other walks need no measurement.
pub(super) fn emission_estimator(
    scene: &Scene,
    size: UVec2,
    progress: Progress,
) -> Result<EmissionEstimator> {
    let fitted = match EmissionEstimator::is_fitted(&scene.strategy) {
        true => optimal_majorant::fit(scene, size, progress)?,
        false => 0.0,
    };
    Ok(EmissionEstimator::new(&scene.strategy, fitted))
}
