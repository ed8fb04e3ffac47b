//! Emission ratio tracking under the majorant that reduces noise most for its cost.
//!
//! With m(t) the radiance still to come from beyond t, the variance of the walk is ∫ (T²/μ̄) [(ε −
//! μ_t m)² + μ_t² V] dt. Least for its steps is μ̄ = max(μ_t, k T √(…)), about max(maj μ_t, k T̂
//! max(ε, μ_t m̂)): k collisions along the brightest chord, in emission and in extinction in front
//! of emission, fewer where little is transmitted. The walk's own weight stands for T̂, and m̂ is
//! the emission ahead, summed from the majorants. Since such a majorant depends on the walk's
//! history, it is for the emission's own walk only.

use super::ratio;
use super::ray::{RayEmission, RayKind};
use crate::transport::tracking::majorant::{EMISSION_FLOOR, least_rate};
use crate::{
    math::{PathRng, Rgb},
    volume::{medium::Segment, world::MediumRay},
};

/// Approximate mean emission of a cell relative to its upper bound.
const FILL: f32 = 0.5;

/// Gathers the emission along the medium, with `k` collisions along the brightest chord of a camera
/// ray.
pub(in crate::transport) fn gather(
    medium: MediumRay,
    k: f32,
    ray_kind: RayKind,
    rng: &mut PathRng,
) -> RayEmission {
    // To sum the emission ahead costs more than it gains where the direction is noisier anyway.
    let ahead = match ray_kind {
        RayKind::Camera if k > EMISSION_FLOOR => emission_ahead(medium.clone()),
        _ => 0.0,
    };
    let mut majorant = OptimalMajorant { k: ray_kind.share(k), ahead };
    ratio::gather(medium, |segment, weight| majorant.rate(segment, weight), rng)
}

struct OptimalMajorant {
    k: f32,
    /// Emission of the rest of the ray, as a share of the brightest chord's.
    ahead: f32,
}

impl OptimalMajorant {
    #[inline]
    fn rate(&mut self, segment: &Segment, weight: Rgb) -> f32 {
        // No more than the brightest chord: an endless one is endlessly bright.
        let to_come = self.ahead.min(1.0);
        self.ahead = (self.ahead - emission_of(segment)).max(0.0);
        let wanted = segment.emission_rate.max(segment.majorant * to_come);
        let boosted = self.k * weight.abs().max_element() * wanted;
        least_rate(segment).max(boosted.min(f32::MAX))
    }
}

/// The emission along the medium, extinction apart, as a share of the brightest chord's.
fn emission_ahead(mut medium: MediumRay) -> f32 {
    let mut sum = 0.0;
    while let Some(segment) = medium.next_segment() {
        sum += emission_of(&segment);
    }
    sum
}

#[inline]
fn emission_of(segment: &Segment) -> f32 {
    if segment.emission_rate > 0.0 {
        FILL * segment.emission_rate * (segment.t1 - segment.t0)
    } else {
        0.0
    }
}
