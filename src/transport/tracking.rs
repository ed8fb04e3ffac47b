//! Null-collision tracking: the one loop that walks tentative collisions.
//!
//! A heterogeneous medium is filled up with fictitious matter μ_n = μ̄ − μ_t to a piecewise
//! constant majorant μ̄, in which distances to collisions are exponential. With T̄ the
//! transmittance of μ̄, L = ∫ T̄ [ε + μ_s L_s + μ_n L] dt + T̄(d) L_end (Miller et al. 2019, eq.
//! 10, with emission), and each walk is a Monte Carlo reading of it. All are unbiased: the
//! majorants hold everywhere, and roulette compensates for what it ends.
//!
//! | walk | at a tentative collision |
//! |---|---|
//! | [`scattering`] | one of absorption, scattering, null |
//! | [`fill`] | always null (P_n = 1), up to a distance that was drawn otherwise |
//! | [`decomposition`] | the same as `scattering`, with most of the medium unread |
//! | [`super::emission::ratio`] | gathers ε, always null |
//! | [`super::shadow`] | transmittance, always null |

pub mod decomposition;
pub mod event;
pub mod fill;
pub(super) mod flight_state;
pub(super) mod majorant;
pub mod scattering;

use std::ops::ControlFlow;

use crate::math::{PathRng, Rgb};
use crate::volume::medium::Segment;
use crate::volume::world::MediumRay;

/// Most tentative collisions of one walk. A walk that reaches this limit is cut, and its path
/// counted as cut: it takes coefficients far beyond what single precision can step through.
pub const MOST_COLLISIONS: u32 = 1 << 17;
/// Weight below which a walk of transmittance meets Russian roulette.
pub(super) const ROULETTE_BELOW: f32 = 0.05;

/// A walk along a ray, by its actions at segments and collisions.
pub(super) trait Walk {
    /// The rate of tentative collisions μ̄ in a segment, at least its majorant. Called once for
    /// each segment, from near to far; it may depend on the walk's history.
    fn rate(&mut self, medium: &MediumRay, segment: &Segment) -> f32;

    /// Crosses a uniform segment in closed form; false to be given its collisions instead.
    fn cross(&mut self, medium: &MediumRay, segment: &Segment, rng: &mut PathRng) -> bool;

    /// Ray parameter at which the walk ends, if not at the end of the medium.
    #[inline]
    fn until(&self) -> f32 {
        f32::INFINITY
    }

    /// Called at the end of the walk, [`Walk::until`], if that lies in the medium.
    fn arrive(&mut self, _medium: &MediumRay, _at: &Collision) {}

    /// Called at a tentative collision under the majorant [`Collision::rate`].
    fn collide(&mut self, medium: &MediumRay, at: &Collision, rng: &mut PathRng)
    -> ControlFlow<()>;
}

/// A tentative collision.
pub(super) struct Collision<'s> {
    /// Ray parameter of the collision.
    pub(super) t: f32,
    /// The majorant μ̄ it was drawn under.
    pub(super) rate: f32,
    /// The segment it lies in.
    pub(super) segment: &'s Segment,
}

/// Calls `walk` for each tentative collision along the medium, from near to far, and returns how
/// many there were. A step that lands beyond the end of its segment is no collision.
///
/// The first step is `optical_distance` long, which has density exp(-x).
pub(super) fn track(
    mut medium: MediumRay,
    mut optical_distance: f32,
    rng: &mut PathRng,
    walk: &mut impl Walk,
) -> u32 {
    let mut collisions = 0;
    let until = walk.until();
    while let Some(segment) = medium.next_segment() {
        if segment.t0 > until {
            break;
        }
        if segment.uniform && walk.cross(&medium, &segment, rng) {
            continue;
        }
        let rate = walk.rate(&medium, &segment);
        if rate <= 0.0 {
            continue;
        }
        let mut t = segment.t0;
        let end = segment.t1.min(until);
        loop {
            let depth_left = rate * (end - t);
            if optical_distance >= depth_left {
                optical_distance -= depth_left;
                if segment.t1 >= until {
                    walk.arrive(&medium, &Collision { t: until, rate, segment: &segment });
                    return collisions;
                }
                break;
            }
            // However short the step, the walk moves on.
            t = (t + optical_distance / rate).max(t.next_up());
            collisions += 1;
            let at = Collision { t, rate, segment: &segment };
            if walk.collide(&medium, &at, rng).is_break() || collisions == MOST_COLLISIONS {
                return collisions;
            }
            optical_distance = rng.exponential();
        }
    }
    collisions
}

/// μ_n = μ̄ − μ_t per channel. Never below zero: at a border of cells rounding may read the
/// neighbor's coefficient.
#[inline]
pub(super) fn null_coefficient(rate: f32, mu_t: Rgb) -> Rgb {
    (Rgb::splat(rate) - mu_t).max(Rgb::ZERO)
}

/// Russian roulette for walks of small weight; the weight of a walk that survives compensates for
/// it.
#[inline]
pub(super) fn roulette(weight: &mut Rgb, rng: &mut PathRng) -> ControlFlow<()> {
    roulette_below(weight, ROULETTE_BELOW, rng)
}

/// [`roulette`] of weights below a given one.
#[inline]
pub(super) fn roulette_below(weight: &mut Rgb, below: f32, rng: &mut PathRng) -> ControlFlow<()> {
    let largest = weight.abs().max_element();
    if !largest.is_finite() {
        // Leads nowhere, and is counted with the sample it spoils.
        return ControlFlow::Break(());
    }
    if largest >= below {
        return ControlFlow::Continue(());
    }
    let survival = largest / below;
    if rng.uniform() >= survival {
        *weight = Rgb::ZERO;
        return ControlFlow::Break(());
    }
    *weight /= survival;
    ControlFlow::Continue(())
}

/// exp(−τ) per channel; an infinite path through nothing is clear.
pub(super) fn exp_neg(mu_t: Rgb, length: f32) -> Rgb {
    let clear = mu_t.cmpeq(Rgb::ZERO);
    Rgb::select(clear, Rgb::ONE, (-mu_t * length).exp())
}

#[cfg(test)]
mod tests;
