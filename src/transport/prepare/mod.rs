//! Paths that are traced before the picture, to find out what pays in it: k of the optimal
//! majorant, what probes learn, how many guided flights the camera rays get.
//!
//! All of it is fixed by the scene, the strategy and the size of the film, never by the seed, the
//! time or the number of threads, and costs are counted in steps, so that the same picture is
//! always prepared in the same way.

mod cost;
pub(super) mod guided_flights;
mod learning;
mod optimal_majorant;
mod pilot_pixel;

use glam::UVec2;

use super::emission::EmissionEstimator;
use super::scene::Scene;

/// The emission walk for a picture of `size` pixels. The optimal majorant takes a few milliseconds
/// to be fitted; nothing else is measured.
pub(super) fn emission_estimator(scene: &Scene, size: UVec2) -> EmissionEstimator {
    let fitted = match EmissionEstimator::is_fitted(&scene.strategy) {
        true => optimal_majorant::looks(scene, size),
        false => 0.0,
    };
    EmissionEstimator::new(&scene.strategy, fitted)
}
