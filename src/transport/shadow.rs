//! Transmittance of shadow rays, by any of three estimators with the same mean.
//!
//! In uniform segments all take the closed form. Each is unbiased in every channel, roulette
//! included; they differ in noise and cost alone.

use std::ops::ControlFlow;

use super::{
    strategy::TransmittanceEstimator,
    tracking::{Collision, Walk, exp_neg, null_coefficient, roulette, track},
    transmittance,
};
use crate::{
    math::{PathRng, Rgb, Slot},
    volume::{medium::Segment, world::MediumRay},
};

/// Places where a comb reads μ_t, for each unit of the majorants' optical distance.
const READS: f32 = 1.0;
/// Slots of the jitters of the first two combs.
const JITTERS: [Slot; 2] = [Slot::LightTransmittanceA, Slot::LightTransmittanceB];
/// The control coefficient of residual ratio tracking: its place between the bounds of μ_t in a
/// segment. The lower bound errs nowhere by more than ratio tracking does, (μ − a)²/(M − a) ≤ μ²/M;
/// halfway would err by as much in the empty part of a cell as in the dense one.
const CONTROL: f32 = 0.0;

/// Estimates the transmittance along the medium; also returns the number of reads.
pub fn transmittance(
    medium: MediumRay,
    estimator: TransmittanceEstimator,
    rng: &mut PathRng,
) -> (Rgb, u32) {
    match estimator {
        TransmittanceEstimator::Marching => transmittance::whole(medium, READS, JITTERS, rng),
        TransmittanceEstimator::Residual => residual(medium, rng),
        TransmittanceEstimator::Ratio => ratio(medium, rng),
    }
}

/// Ratio tracking (Novák et al. 2014, eq. 12): the product of μ_n/μ̄ over all tentative collisions.
pub(super) fn ratio(medium: MediumRay, rng: &mut PathRng) -> (Rgb, u32) {
    struct Ratio {
        weight: Rgb,
    }
    impl Walk for Ratio {
        fn rate(&mut self, _: &MediumRay, segment: &Segment) -> f32 {
            segment.majorant
        }
        fn cross(&mut self, medium: &MediumRay, segment: &Segment, _: &mut PathRng) -> bool {
            self.weight *= across_uniform(medium, segment);
            true
        }
        fn collide(
            &mut self,
            medium: &MediumRay,
            at: &Collision,
            rng: &mut PathRng,
        ) -> ControlFlow<()> {
            self.weight *= null_coefficient(at.rate, medium.mu_t(at.t)) / at.rate;
            roulette(&mut self.weight, rng)
        }
    }
    let mut walk = Ratio { weight: Rgb::ONE };
    let collisions = track(medium, rng.exponential(), rng, &mut walk);
    (walk.weight, collisions)
}

/// Residual ratio tracking (Novák et al. 2014, section 4): of μ_t = μ_c + μ_r, a control that is
/// constant in each segment has the closed form exp(−∫ μ_c dt), and what is left of it is ratio
/// tracked, Π (1 − μ_r/μ̄_r). Unbiased for any control, of any sign of μ_r, and any rate μ̄_r > 0
/// where μ_r may differ from zero.
fn residual(medium: MediumRay, rng: &mut PathRng) -> (Rgb, u32) {
    struct Residual {
        weight: Rgb,
        control: Rgb,
    }
    impl Walk for Residual {
        fn rate(&mut self, medium: &MediumRay, segment: &Segment) -> f32 {
            let (low, high) = medium.bounds_of_mu_t();
            self.control = low + CONTROL * (high - low);
            self.weight *= exp_neg(self.control, segment.t1 - segment.t0);
            CONTROL.max(1.0 - CONTROL) * (high - low).max_element()
        }
        fn cross(&mut self, medium: &MediumRay, segment: &Segment, _: &mut PathRng) -> bool {
            self.weight *= across_uniform(medium, segment);
            true
        }
        fn collide(
            &mut self,
            medium: &MediumRay,
            at: &Collision,
            rng: &mut PathRng,
        ) -> ControlFlow<()> {
            let mu_r = medium.mu_t(at.t) - self.control;
            self.weight *= Rgb::ONE - mu_r / at.rate;
            roulette(&mut self.weight, rng)
        }
    }
    let mut walk = Residual { weight: Rgb::ONE, control: Rgb::ZERO };
    let collisions = track(medium, rng.exponential(), rng, &mut walk);
    (walk.weight, collisions)
}

/// Transmittance of a uniform segment, per channel.
fn across_uniform(medium: &MediumRay, segment: &Segment) -> Rgb {
    exp_neg(medium.coefficients(segment.t0).mu_t, segment.t1 - segment.t0)
}
