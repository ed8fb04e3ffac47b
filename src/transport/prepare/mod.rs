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
mod pilot_pixel;
mod trial;

use glam::UVec2;

use super::emission::EmissionEstimator;
use super::probes::Probes;
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

/// The probes for `scene`, if its strategy asks for any and anything scatters. The same scene
/// always gets the same ones. `progress` is called after every few paths, from many threads at
/// once.
///
/// # Errors
/// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
pub fn probes(scene: &Scene, progress: Progress) -> Result<Option<Probes>> {
    let Some(mut probes) = Probes::placed(scene, progress)? else { return Ok(None) };
    let (guides, advanced) = (scene.strategy.guides(), &scene.strategy.advanced);
    if advanced.guide_caustics && guides {
        probes.find_caustics(scene, progress)?;
    }
    if advanced.probe_learning && guides {
        let learned = learning::indirect_light(&probes, scene, progress)?;
        probes.learn(&learned);
    }
    Ok(Some(probes))
}
