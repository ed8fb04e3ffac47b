//! Walks of their own that gather a ray's emission: ∫ T ε dt over the whole ray, through every
//! medium, whatever the scattering walk does there (Huang et al. 2021, section 2).
//!
//! All have the same mean. They differ in where they look at the emission and in how they learn
//! the transmittance in front of it.

pub(super) mod optimal;
pub(super) mod stratified;

use std::ops::ControlFlow;

use glam::UVec2;

use super::march;
use super::prepare::optimal_majorant;
use super::scene::Scene;
use super::strategy::{Advanced, BoostMode, Integrator, Strategy};
use super::tracking::{
    Collision, EMISSION_FLOOR, Walk, exp_neg, null_coefficient, roulette, track,
};
use crate::{
    math::{PathRng, Rgb},
    volume::{medium::Segment, world::MediumRay},
};

/// What an emission walk brings back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayEmission {
    /// ∫ T ε dt along the ray.
    pub emission: Rgb,
    /// T to the ray's end.
    pub transmittance: Rgb,
    /// Tentative collisions, or places looked at, on the way.
    pub collisions: u32,
}

/// Which ray of a path the emission is gathered along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// The camera's.
    Camera,
    /// One that scattering or reflection sent.
    Scattered,
    /// A look at a light.
    Light,
}

/// Looks of [`EmissionEstimator::at_a_glance`].
const GLANCE: f32 = 8.0;
/// The share of the looks along a camera ray that any other ray gets.
const OTHER_LOOKS: f32 = 0.25;

impl RayKind {
    /// How many of `looks` along the brightest chord the errand is worth. Camera rays are looked at
    /// closely. Any other ray is one of many directions whose choice is noisier than a glance
    /// along it.
    pub(super) fn share(self, looks: f32) -> f32 {
        match self {
            Self::Camera => looks,
            Self::Scattered | Self::Light => OTHER_LOOKS * looks,
        }
    }
}

/// The walk that a strategy asks for, ready to be taken any number of times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionEstimator(EstimatorKind);

#[derive(Clone, Copy, Debug, PartialEq)]
enum EstimatorKind {
    RatioTracking(EmissionMajorant),
    /// With that many looks along the brightest chord.
    Stratified(f32),
    /// The same.
    Optimal(f32),
    /// Biased, by steps of so many voxels.
    March(f32),
}

impl EmissionEstimator {
    /// For a picture of `size` pixels. The optimal majorant takes a few milliseconds to find out
    /// how often to look; nothing else is measured.
    pub fn new(scene: &Scene, size: UVec2) -> Self {
        let strategy = &scene.strategy;
        let amount = strategy.advanced.boost_amount;
        Self(match strategy.advanced.boost_mode {
            _ if strategy.integrator == Integrator::March => {
                EstimatorKind::March(strategy.advanced.march_step)
            }
            _ if !strategy.majorant_boost => {
                EstimatorKind::RatioTracking(EmissionMajorant::of(strategy))
            }
            BoostMode::Stratified => EstimatorKind::Stratified(amount),
            // The looks along camera rays are what is measured; without them, none.
            BoostMode::Optimal if strategy.emission_ratio_tracking && amount > 0.0 => {
                let scale = amount / Advanced::default().boost_amount;
                EstimatorKind::Optimal(scale * optimal_majorant::looks(scene, size))
            }
            BoostMode::Optimal => EstimatorKind::Optimal(amount),
            BoostMode::Clamped | BoostMode::Literal => {
                EstimatorKind::RatioTracking(EmissionMajorant::of(strategy))
            }
        })
    }

    /// By the optimal majorant, with so many looks along the brightest chord.
    pub(super) fn optimal(looks: f32) -> Self {
        Self(EstimatorKind::Optimal(looks))
    }

    /// With so few looks that one more ray costs next to nothing.
    pub(super) fn at_a_glance() -> Self {
        Self(EstimatorKind::Stratified(GLANCE))
    }

    /// Gathers the emission along the medium.
    pub fn gather(&self, medium: MediumRay, ray_kind: RayKind, rng: &mut PathRng) -> RayEmission {
        match self.0 {
            EstimatorKind::RatioTracking(majorant) => {
                by_rate(medium, |segment, _| majorant.rate(segment), rng)
            }
            EstimatorKind::Stratified(looks) => stratified::gather(medium, looks, ray_kind, rng),
            EstimatorKind::Optimal(looks) => optimal::gather(medium, looks, ray_kind, rng),
            EstimatorKind::March(voxels) => march::gather(medium, voxels, rng),
        }
    }
}

/// Emission ratio tracking (Huang et al. 2021, algorithm 1): a walk of its own with P_n = 1 that
/// neither scatters nor is absorbed. At each tentative collision L += w ε/μ̄, then w ·= μ_n/μ̄;
/// closed form in uniform segments. `rate` gives the majorant μ̄ of a segment and may heed the
/// walk's weight w.
pub(super) fn by_rate(
    medium: MediumRay,
    rate: impl FnMut(&Segment, Rgb) -> f32,
    rng: &mut PathRng,
) -> RayEmission {
    struct EmissionRatio<F> {
        rate: F,
        weight: Rgb,
        emission: Rgb,
    }
    impl<F: FnMut(&Segment, Rgb) -> f32> Walk for EmissionRatio<F> {
        fn rate(&mut self, _: &MediumRay, segment: &Segment) -> f32 {
            (self.rate)(segment, self.weight)
        }
        fn cross(&mut self, medium: &MediumRay, segment: &Segment, _: &mut PathRng) -> bool {
            let c = medium.coefficients(segment.t0);
            let length = segment.t1 - segment.t0;
            self.emission += self.weight * attenuated(c.emission, c.mu_t, length);
            self.weight *= exp_neg(c.mu_t, length);
            true
        }
        fn collide(
            &mut self,
            medium: &MediumRay,
            at: &Collision,
            rng: &mut PathRng,
        ) -> ControlFlow<()> {
            let c = medium.coefficients(at.t);
            self.emission += self.weight * c.emission / at.rate;
            self.weight *= null_coefficient(at.rate, c.mu_t) / at.rate;
            roulette(&mut self.weight, rng)
        }
    }
    let mut walk = EmissionRatio { rate, weight: Rgb::ONE, emission: Rgb::ZERO };
    let collisions = track(medium, rng.exponential(), rng, &mut walk);
    RayEmission { emission: walk.emission, transmittance: walk.weight, collisions }
}

/// ε ∫₀^length exp(−μ_t t) dt per channel.
pub(super) fn attenuated(emission: Rgb, mu_t: Rgb, length: f32) -> Rgb {
    let of = |epsilon: f32, mu: f32| {
        let tau = mu * length;
        match () {
            // Not even an infinite length of nothing glows.
            () if epsilon == 0.0 => 0.0,
            () if mu == 0.0 => epsilon * length,
            () if tau < 1e-4 => epsilon * length * (1.0 - 0.5 * tau),
            () => -epsilon * (-tau).exp_m1() / mu,
        }
    };
    Rgb::new(of(emission.x, mu_t.x), of(emission.y, mu_t.y), of(emission.z, mu_t.z))
}

/// The majorant of a walk that gathers emission by collisions: μ̄ = max(maj μ_t, boost · maj ε),
/// the boosted part at most one collision per voxel unless it is taken literally (Huang et al.
/// 2021, section 2). It never goes below maj μ_t, nor below a floor wherever something emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EmissionMajorant {
    /// Collisions along the brightest chord.
    boost: f32,
    /// Most boosted collisions per voxel.
    per_voxel: f32,
}

impl EmissionMajorant {
    pub(super) fn of(strategy: &Strategy) -> Self {
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
    pub(super) fn rate(&self, segment: &Segment) -> f32 {
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
pub(super) fn least_rate(segment: &Segment) -> f32 {
    segment.majorant.max(EMISSION_FLOOR * segment.emission_rate)
}
