//! Everything that was prepared for the paths of a picture.

use super::emission::EmissionEstimator;
use super::probes::{Brightness, Probes};
use super::strategy::Strategy;

/// Everything that was prepared for the paths of a picture, and fixed before the first of them.
#[derive(Clone, Copy, Debug)]
pub struct PathContext<'s> {
    /// The emission's own walk.
    pub emission_estimator: &'s EmissionEstimator,
    /// Probes that say where scattering pays and which light to sample, as far as that is asked for.
    pub probes: Option<&'s Probes>,
    /// Mean in-scattered radiance over the film, estimated from the probes.
    pub brightness: Brightness,
    /// Guided flights of the camera rays, relative to those that the probes propose; 0 asks the
    /// probes nowhere where scattering pays.
    pub flights: f32,
}

impl<'s> PathContext<'s> {
    /// The probes, where they say where scattering pays.
    pub(super) fn guides(&self, strategy: &Strategy) -> Option<&'s Probes> {
        self.probes.filter(|_| self.flights > 0.0 && strategy.guides())
    }
}
