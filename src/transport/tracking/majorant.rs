//! Majorants of the walks that gather emission: of μ_t, and boosted where much is emitted.

use crate::transport::strategy::{BoostMode, Strategy};
use crate::volume::medium::Segment;

/// Least collisions along a volume's brightest chord where emission is gathered by collisions, and
/// least absorptions where it is gathered by those, so that fire without soot is found at all.
pub(in crate::transport) const EMISSION_FLOOR: f32 = 0.1;

/// The majorant of a walk that gathers emission by collisions: μ̄ = max(maj μ_t, boost · maj ε),
/// the boosted part at most one collision per voxel unless it is taken literally (Huang et al.
/// 2021, section 2). It never goes below maj μ_t, nor below a floor wherever something emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::transport) struct EmissionMajorant {
    /// Collisions along the brightest chord.
    boost: f32,
    /// Most boosted collisions per voxel.
    per_voxel: f32,
}

impl EmissionMajorant {
    pub(in crate::transport) fn of(strategy: &Strategy) -> Self {
        let advanced = &strategy.advanced;
        let boost = if strategy.majorant_boost { advanced.boost_amount } else { 0.0 };
        let per_voxel = match advanced.boost_mode {
            BoostMode::Literal => f32::INFINITY,
            // The other modes are for the emission's own walk only.
            _ => 1.0 / advanced.boost_clamp_voxels,
        };
        Self { boost, per_voxel }
    }

    #[inline]
    pub(in crate::transport) fn rate(&self, segment: &Segment) -> f32 {
        let floor = least_rate(segment);
        // Without voxels there is nothing to clamp by.
        let most = if segment.voxel_rate > 0.0 {
            segment.voxel_rate * self.per_voxel
        } else {
            f32::INFINITY
        };
        floor.max((self.boost * segment.emission_rate).min(most))
    }
}

/// The least majorant that emission may be gathered under: maj μ_t, and a floor wherever something
/// emits.
#[inline]
pub(in crate::transport) fn least_rate(segment: &Segment) -> f32 {
    segment.majorant.max(EMISSION_FLOOR * segment.emission_rate)
}
