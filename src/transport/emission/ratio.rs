//! Emission ratio tracking, the talk's second idea: a walk that never stops at an absorption.

use std::ops::ControlFlow;

use super::ray::{RayEmission, attenuated};
use crate::math::{PathRng, Rgb};
use crate::transport::tracking::{Collision, Walk, exp_neg, null_coefficient, roulette, track};
use crate::volume::medium::Segment;
use crate::volume::world::MediumRay;

/// Emission ratio tracking (Huang et al. 2021, algorithm 1): a walk of its own with P_n = 1 that
/// neither scatters nor is absorbed. At each tentative collision L += w ε/μ̄, then w ·= μ_n/μ̄;
/// closed form in uniform segments. `rate` gives the majorant μ̄ of a segment and may heed the
/// walk's weight w.
pub(in crate::transport) fn gather(
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
