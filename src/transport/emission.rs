//! Walks of their own that gather a ray's emission: ∫ T ε dt over the whole ray, through every
//! medium, whatever the scattering walk does there (Huang et al. 2021, section 2).
//!
//! All have the same mean. They differ in where they read the emission and in how they estimate the
//! transmittance in front of it.

mod optimal;
pub mod ratio;
pub mod ray;
mod stratified;

use self::ray::{RayEmission, RayKind};
pub(super) use self::stratified::transmittance;
use super::march;
use super::strategy::{Advanced, BoostMode, Strategy};
use super::tracking::majorant::EmissionMajorant;
use crate::math::PathRng;
use crate::volume::world::MediumRay;

/// Reads of the emission by [`EmissionEstimator::coarse`], along the brightest chord.
const COARSE: f32 = 8.0;

/// The walk that a strategy asks for, ready to be taken any number of times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionEstimator(EstimatorKind);

#[derive(Clone, Copy, Debug, PartialEq)]
enum EstimatorKind {
    RatioTracking(EmissionMajorant),
    /// Stratified sampling with this many reads of the emission along the brightest chord.
    Stratified(f32),
    /// Ratio tracking under the optimal majorant with this many collisions along the brightest
    /// chord.
    Optimal(f32),
    /// Biased ray marching by steps of this many voxels.
    March(f32),
}

impl EmissionEstimator {
    /// The walk that `strategy` asks for. `fitted` is k of the optimal majorant, as measured for
    /// the picture; it matters only where [`EmissionEstimator::is_fitted`].
    pub fn new(strategy: &Strategy, fitted: f32) -> Self {
        let advanced = &strategy.advanced;
        let amount = advanced.boost_amount;
        if strategy.marches() {
            return Self(EstimatorKind::March(advanced.march_step));
        }
        if !strategy.majorant_boost {
            return Self(EstimatorKind::RatioTracking(EmissionMajorant::of(strategy)));
        }
        Self(match advanced.boost_mode {
            BoostMode::Stratified => EstimatorKind::Stratified(amount),
            BoostMode::Optimal if Self::is_fitted(strategy) => {
                EstimatorKind::Optimal(amount / Advanced::default().boost_amount * fitted)
            }
            BoostMode::Optimal => EstimatorKind::Optimal(amount),
            BoostMode::Clamped | BoostMode::Literal => {
                EstimatorKind::RatioTracking(EmissionMajorant::of(strategy))
            }
        })
    }

    /// Whether k is fitted to the picture before it starts: for the optimal majorant, where camera
    /// rays gather emission by a walk of its own.
    pub fn is_fitted(strategy: &Strategy) -> bool {
        !strategy.marches()
            && strategy.majorant_boost
            && strategy.advanced.boost_mode == BoostMode::Optimal
            && strategy.emission_ratio_tracking
            && strategy.advanced.boost_amount > 0.0
    }

    /// Ratio tracking under the optimal majorant, with `k` collisions along the brightest chord.
    pub(super) fn optimal(k: f32) -> Self {
        Self(EstimatorKind::Optimal(k))
    }

    /// Stratified sampling with so few reads that one more ray costs next to nothing.
    pub(super) fn coarse() -> Self {
        Self(EstimatorKind::Stratified(COARSE))
    }

    /// Gathers the emission along the medium.
    pub fn gather(&self, medium: MediumRay, ray_kind: RayKind, rng: &mut PathRng) -> RayEmission {
        match self.0 {
            EstimatorKind::RatioTracking(majorant) => {
                ratio::gather(medium, |segment, _| majorant.rate(segment), rng)
            }
            EstimatorKind::Stratified(reads) => stratified::gather(medium, reads, ray_kind, rng),
            EstimatorKind::Optimal(k) => optimal::gather(medium, k, ray_kind, rng),
            EstimatorKind::March(voxels) => march::gather(medium, voxels, rng),
        }
    }
}
