//! Everything that was prepared for the paths of a picture.

use super::emission::EmissionEstimator;
use super::learned_counts::LearnedCounts;
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
    /// Expected counts that the pilot pass learned.
    pub counts: &'s LearnedCounts,
}

impl<'s> PathContext<'s> {
    /// This context with the expected `counts`.
    pub(super) fn with_counts<'c>(self, counts: &'c LearnedCounts) -> PathContext<'c>
    where
        's: 'c,
    {
        PathContext { counts, ..self }
    }

    /// Probes that guide scattering distances, and the weight window with them; `None` where the
    /// strategy does not guide, or where the pilot pass found that guided flights gain nothing.
    pub(super) fn probes_for_distances(&self, strategy: &Strategy) -> Option<&'s Probes> {
        self.probes.filter(|_| self.counts.guided_flights > 0.0 && strategy.guides())
    }

    /// Probes that guide directions at vertices; `None` where the strategy does not guide, or where
    /// the pilot pass found that they gain nothing. Caustics may be worth guiding to without guided
    /// flights as well.
    pub(super) fn probes_for_directions(&self, strategy: &Strategy) -> Option<&'s Probes> {
        self.probes.filter(|_| self.counts.guided_directions && strategy.guides())
    }

    /// Probes that choose lights. Their light scores serve whether or not the strategy guides:
    /// probes that need not choose lights have none.
    pub(super) fn probes_for_lights(&self) -> Option<&'s Probes> {
        self.probes
    }
}
