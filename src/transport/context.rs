//! Everything that was prepared for the paths of a picture.

use super::emission::EmissionEstimator;
use super::probes::{Brightness, Probes};
use super::strategy::Strategy;

/// Everything that was prepared for the paths of a picture, and fixed before the first of them.
#[derive(Clone, Copy, Debug)]
pub struct PathContext<'s> {
    /// Walk that gathers the emission along a ray.
    pub emission_estimator: &'s EmissionEstimator,
    /// Probes that guide scattering and the choice of lights; `None` where the strategy places
    /// none.
    pub probes: Option<&'s Probes>,
    /// Mean in-scattered radiance over the film, estimated from the probes.
    pub brightness: Brightness,
    /// Guided flights of a camera ray, relative to the number that the probes propose; 0 switches
    /// guiding by probes off.
    pub flights: f32,
}

impl<'s> PathContext<'s> {
    /// Probes that guide scattering distances and directions; `None` where guiding is off.
    pub(super) fn guides(&self, strategy: &Strategy) -> Option<&'s Probes> {
        self.probes.filter(|_| self.flights > 0.0 && strategy.guides())
    }
}
