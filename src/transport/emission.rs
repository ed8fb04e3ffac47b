//! Walks of their own that gather a ray's emission: ∫ T ε dt over the whole ray, through every
//! medium, whatever the scattering walk does there (Huang et al. 2021, section 2).
//!
//! All have the same mean. They differ in where they look at the emission and in how they learn
//! the transmittance in front of it.

use std::ops::ControlFlow;

use super::{
    strategy::{BoostMode, Strategy},
    stratified,
    tracking::{Collision, EMISSION_FLOOR, Walk, exp_neg, null_coefficient, roulette, track},
};
use crate::{
    math::{PathRng, Rgb},
    volume::{medium::Segment, world::MediumRay},
};

/// What an emission walk brings back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glow {
    /// ∫ T ε dt along the ray.
    pub emission: Rgb,
    /// T to the ray's end.
    pub transmittance: Rgb,
    /// Tentative collisions, or places looked at, on the way.
    pub collisions: u32,
}

/// Which ray of a path the emission is gathered along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Errand {
    /// The camera's.
    Camera,
    /// One that scattering or reflection sent.
    Scattered,
    /// A look at a light.
    Light,
}

/// Gathers the emission along the medium by the walk that `strategy` asks for.
pub fn gather(medium: MediumRay, strategy: &Strategy, errand: Errand, rng: &mut PathRng) -> Glow {
    let advanced = &strategy.advanced;
    if strategy.majorant_boost && advanced.boost_mode == BoostMode::Stratified {
        return stratified::gather(medium, advanced.boost_amount, errand, rng);
    }
    by_ratio_tracking(medium, strategy, rng)
}

/// Emission ratio tracking (Huang et al. 2021, algorithm 1): a walk of its own with P_n = 1 that
/// neither scatters nor is absorbed. At each tentative collision L += w ε/μ̄, then w ·= μ_n/μ̄;
/// closed form in uniform segments.
fn by_ratio_tracking(medium: MediumRay, strategy: &Strategy, rng: &mut PathRng) -> Glow {
    struct EmissionRatio {
        majorant: EmissionMajorant,
        weight: Rgb,
        emission: Rgb,
    }
    impl Walk for EmissionRatio {
        fn rate(&self, segment: &Segment) -> f32 {
            self.majorant.rate(segment)
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
    let majorant = EmissionMajorant::of(strategy);
    let mut walk = EmissionRatio { majorant, weight: Rgb::ONE, emission: Rgb::ZERO };
    let collisions = track(medium, rng.exponential(), rng, &mut walk);
    Glow { emission: walk.emission, transmittance: walk.weight, collisions }
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
#[derive(Clone, Copy)]
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
        let floor = segment.majorant.max(EMISSION_FLOOR * segment.emission_rate);
        // Without voxels there is nothing to clamp by.
        let most = if segment.voxel_rate > 0.0 {
            segment.voxel_rate * self.per_voxel
        } else {
            f32::INFINITY
        };
        floor.max((self.boost * segment.emission_rate).min(most))
    }
}
