//! Stratified emission sampling: reads of the emission and the transmittance to them are sampled
//! separately.
//!
//! The emission is read at jittered positions, one in each unit of Λ(t) = ∫ λ dt, and each adds
//! ε(t) T̂(t) / λ(t). Their jitter is independent of that of the transmittance's, so that the mean
//! of the product is the product of the means.

use std::ops::ControlFlow;

use super::ray::{RayEmission, RayKind, attenuated};
use crate::transport::tracking::MOST_COLLISIONS;
use crate::transport::tracking::majorant::EMISSION_FLOOR;
use crate::transport::transmittance::{self, Comb, Transmittance};
use crate::{
    math::{PathRng, Rgb, Slot},
    volume::{medium::Segment, world::MediumRay},
};

/// Places where a comb along a camera ray reads μ_t, for each unit of the majorants' optical
/// distance: T̂ is the larger part of the noise that is left there.
const CAMERA_READS: f32 = 6.0;
/// Reads of μ_t in the same unit along any other ray, whose direction was a noisier choice.
const OTHER_READS: f32 = 1.0;

/// Numbers of reads of a walk, and the slots of random numbers that jitter them.
struct StratifiedSampling {
    /// Reads of the emission along the brightest chord.
    emission_reads: f32,
    /// Places where a comb reads μ_t, for each unit of the majorants' optical distance.
    reads: f32,
    jitter: Slot,
    comb_jitters: [Slot; 2],
}

impl StratifiedSampling {
    fn new(boost: f32, ray_kind: RayKind) -> Self {
        let emission_reads = ray_kind.share(boost);
        let reads = match ray_kind {
            RayKind::Camera => CAMERA_READS,
            RayKind::Scattered | RayKind::Light => OTHER_READS,
        };
        let (jitter, comb_jitters) = match ray_kind {
            RayKind::Camera | RayKind::Scattered => {
                (Slot::Emission, [Slot::TransmittanceA, Slot::TransmittanceB])
            }
            RayKind::Light => {
                (Slot::LightEmission, [Slot::LightTransmittanceA, Slot::LightTransmittanceB])
            }
        };
        Self { emission_reads: emission_reads.max(EMISSION_FLOOR), reads, jitter, comb_jitters }
    }
}

/// Estimates the transmittance along the medium as [`gather`] does, where no emission is gathered;
/// also returns the number of reads.
pub(in crate::transport) fn transmittance(
    medium: MediumRay,
    ray_kind: RayKind,
    rng: &mut PathRng,
) -> (Rgb, u32) {
    let StratifiedSampling { reads, comb_jitters, .. } = StratifiedSampling::new(0.0, ray_kind);
    transmittance::whole(medium, reads, comb_jitters, rng)
}

/// Gathers the emission along the medium, with `boost` reads along the brightest chord of a camera
/// ray.
pub(in crate::transport) fn gather(
    mut medium: MediumRay,
    boost: f32,
    ray_kind: RayKind,
    rng: &mut PathRng,
) -> RayEmission {
    let Some(mut segment) = medium.next_segment() else {
        return RayEmission { emission: Rgb::ZERO, transmittance: Rgb::ONE, collisions: 0 };
    };
    let mut walk = Stratified::new(&StratifiedSampling::new(boost, ray_kind), rng);
    loop {
        let crossed = if segment.uniform {
            walk.cross_uniform(&medium, &segment, rng)
        } else {
            walk.cross(&medium, &segment, rng)
        };
        if crossed.is_break() {
            break;
        }
        let Some(next) = medium.next_segment() else { break };
        segment = next;
    }
    // A walk that is cut may have read a few places more.
    let collisions = walk.read().min(MOST_COLLISIONS);
    RayEmission { emission: walk.emission, transmittance: walk.t_hat.estimate(), collisions }
}

struct Stratified {
    reads_per_chord: f32,
    comb: Comb,
    t_hat: Transmittance,
    emission: Rgb,
    emission_reads: u32,
}

impl Stratified {
    fn new(sampling: &StratifiedSampling, rng: &mut PathRng) -> Self {
        let comb = Comb::new(rng.at(sampling.jitter));
        let jitters = sampling.comb_jitters.map(|slot| rng.at(slot));
        Self {
            reads_per_chord: sampling.emission_reads,
            comb,
            t_hat: Transmittance::new(sampling.reads, jitters, rng),
            emission: Rgb::ZERO,
            emission_reads: 0,
        }
    }

    /// Reads of the medium so far.
    fn read(&self) -> u32 {
        self.emission_reads.saturating_add(self.t_hat.reads)
    }

    /// λ = max(reads · maj ε, maj μ_t), where anything emits. Thinned out by T̂ there would be
    /// fewer reads, but fire behind smoke would have several times the noise.
    fn rate(&self, segment: &Segment) -> f32 {
        if segment.emission_rate <= 0.0 {
            return 0.0;
        }
        (self.reads_per_chord * segment.emission_rate).max(segment.majorant)
    }

    fn cross(
        &mut self,
        medium: &MediumRay,
        segment: &Segment,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        let mut t = segment.t0;
        let rate = self.rate(segment);
        if rate > 0.0 {
            while let Some(place) = self.comb.next(rate, t, segment.t1) {
                self.t_hat.advance(medium, segment.majorant, t, place, rng)?;
                t = place;
                self.emission_reads += 1;
                let emission = medium.emission(place);
                if emission != Rgb::ZERO {
                    self.emission += emission * self.t_hat.estimate() / rate;
                }
                if self.read() >= MOST_COLLISIONS {
                    return ControlFlow::Break(());
                }
            }
        }
        self.t_hat.advance(medium, segment.majorant, t, segment.t1, rng)?;
        if self.read() >= MOST_COLLISIONS {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn cross_uniform(
        &mut self,
        medium: &MediumRay,
        segment: &Segment,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        let c = medium.coefficients(segment.t0);
        if c.emission != Rgb::ZERO {
            let gathered = attenuated(c.emission, c.mu_t, segment.t1 - segment.t0);
            self.emission += self.t_hat.estimate() * gathered;
        }
        self.t_hat.cross_uniform(c.mu_t, segment, rng)
    }
}

#[cfg(test)]
mod tests;
