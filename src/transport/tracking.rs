//! Null-collision tracking: the one loop that walks tentative collisions, and the three walks that
//! use it.
//!
//! A heterogeneous medium is filled up with fictitious matter μ_n = μ̄ − μ_t to a piecewise constant
//! majorant μ̄, in which distances to collisions are exponential. With T̄ the transmittance of μ̄,
//! L = ∫ T̄ [ε + μ_s L_s + μ_n L] dt + T̄(d) L_end (Miller et al. 2019, eq. 10, with emission), and
//! each walk below is a Monte Carlo reading of it. All are unbiased: the majorants hold
//! everywhere, and roulette compensates for what it ends.

use std::ops::ControlFlow;

use super::{emission::EmissionMajorant, strategy::Strategy};
use crate::{
    math::{PathRng, Rgb, Slot, mean},
    volume::{
        medium::{Coefficients, Segment},
        phase::PhaseMix,
        world::MediumRay,
    },
};

/// Least collisions along a volume's brightest chord where emission is gathered by collisions, and
/// least absorptions where it is gathered by those, so that fire without soot is found at all.
pub(super) const EMISSION_FLOOR: f32 = 0.1;
/// Most tentative collisions of one walk. One that gets here is cut, and its path counted as cut:
/// it takes coefficients far beyond what single precision can step through.
pub const MOST_COLLISIONS: u32 = 1 << 17;
/// Below this weight a walk of transmittance goes on by chance only.
pub(super) const ROULETTE_BELOW: f32 = 0.05;

/// What a walk does on its way.
pub(super) trait Walk {
    /// The rate of tentative collisions μ̄ in a segment, at least its majorant. Asked for once in
    /// each, from near to far; the walk's history may have a say in it.
    fn rate(&mut self, segment: &Segment) -> f32;

    /// Crosses a uniform segment in closed form; false to be given its collisions instead.
    fn cross(&mut self, medium: &MediumRay, segment: &Segment, rng: &mut PathRng) -> bool;

    /// A tentative collision under the majorant [`Collision::rate`].
    fn collide(&mut self, medium: &MediumRay, at: &Collision, rng: &mut PathRng)
    -> ControlFlow<()>;
}

/// A tentative collision.
pub(super) struct Collision<'s> {
    /// Where it is, as a ray parameter.
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
    while let Some(segment) = medium.next_segment() {
        if segment.uniform && walk.cross(&medium, &segment, rng) {
            continue;
        }
        let rate = walk.rate(&segment);
        if rate <= 0.0 {
            continue;
        }
        let mut t = segment.t0;
        loop {
            let depth_left = rate * (segment.t1 - t);
            if optical_distance >= depth_left {
                optical_distance -= depth_left;
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

/// Ends a walk of small weight by chance, and makes up for it where it goes on.
#[inline]
pub(super) fn roulette(weight: &mut Rgb, rng: &mut PathRng) -> ControlFlow<()> {
    let largest = weight.abs().max_element();
    if !largest.is_finite() {
        // Leads nowhere, and is counted with the sample it spoils.
        return ControlFlow::Break(());
    }
    if largest >= ROULETTE_BELOW {
        return ControlFlow::Continue(());
    }
    let survival = largest / ROULETTE_BELOW;
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

/// Ratio tracking (Novák et al. 2014, eq. 12): an estimate of the transmittance along the medium,
/// the product of μ_n/μ̄ over all tentative collisions; closed form in uniform segments.
/// Also returns the number of collisions.
pub fn transmittance(medium: MediumRay, rng: &mut PathRng) -> (Rgb, u32) {
    struct Ratio {
        weight: Rgb,
    }
    impl Walk for Ratio {
        fn rate(&mut self, segment: &Segment) -> f32 {
            segment.majorant
        }
        fn cross(&mut self, medium: &MediumRay, segment: &Segment, _: &mut PathRng) -> bool {
            let mu_t = medium.coefficients(segment.t0).mu_t;
            self.weight *= exp_neg(mu_t, segment.t1 - segment.t0);
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

/// Where the scattering walk gathers emission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gather {
    /// On absorption, which ends the path (the baseline).
    Absorption,
    /// At every tentative collision (decoupled).
    EveryCollision,
    /// Nowhere: the emission has its own walk.
    Nothing,
}

impl Gather {
    /// What the toggles ask of the scattering walk; ratio tracking overrides decoupling.
    pub fn of(strategy: &Strategy) -> Self {
        if strategy.emission_ratio_tracking {
            Self::Nothing
        } else if strategy.emission_decoupling {
            Self::EveryCollision
        } else {
            Self::Absorption
        }
    }
}

/// How a flight through the medium ended.
#[derive(Clone, Debug)]
pub enum Event {
    /// It reached the end of the ray.
    Reached,
    /// It was absorbed.
    Absorbed {
        /// Where.
        t: f32,
        /// Whether by the medium; or only to show emission that comes without absorption.
        real: bool,
    },
    /// It scatters.
    Scattered {
        /// Where.
        t: f32,
        /// Into which directions.
        phase: PhaseMix,
    },
}

/// One flight of the scattering walk.
#[derive(Clone, Debug)]
pub struct Flight {
    /// How it ended.
    pub event: Event,
    /// Factor of the path's throughput up to and including the event.
    pub weight: Rgb,
    /// Emission gathered on the way, by the mode it was asked for.
    pub emission: Rgb,
    /// Tentative collisions on the way.
    pub collisions: u32,
}

/// The scattering walk: at each tentative collision one of absorption, scattering and null (or,
/// with the albedo in the weight, one of the latter two) is chosen with P ∝ the channels' mean of
/// w·μ, so that the throughput stays near one color and the factors μ/(μ̄ P) near 1 (Kutz et al.
/// 2017, section 5.1, history-aware probabilities).
///
/// That is spectral MIS in closed form: with f_c what the path so far brings to channel c, which
/// is also how likely that channel's own analog walk is to take it, the probabilities make the
/// path's density the mean of f over the channels, and its weight f_c / mean f (Miller et al.
/// 2019).
pub fn scatter(
    medium: MediumRay,
    strategy: &Strategy,
    throughput: Rgb,
    rng: &mut PathRng,
) -> Flight {
    let gather = Gather::of(strategy);
    let mut walk = Scattering {
        majorant: EmissionMajorant::of(strategy),
        gather,
        throughput,
        weight: Rgb::ONE,
        emission: Rgb::ZERO,
        event: Event::Reached,
    };
    let collisions = track(medium, rng.exponential_at(Slot::Distance), rng, &mut walk);
    Flight { event: walk.event, weight: walk.weight, emission: walk.emission, collisions }
}

struct Scattering {
    majorant: EmissionMajorant,
    gather: Gather,
    /// The path's throughput before the flight; only its color matters here.
    throughput: Rgb,
    weight: Rgb,
    emission: Rgb,
    event: Event,
}

impl Walk for Scattering {
    fn rate(&mut self, segment: &Segment) -> f32 {
        match self.gather {
            Gather::Nothing => segment.majorant,
            Gather::EveryCollision => self.majorant.rate(segment),
            Gather::Absorption => segment.majorant.max(EMISSION_FLOOR * segment.emission_rate),
        }
    }

    /// Where a uniform medium goes on for ever, a channel it is clear to never collides, and one
    /// it is not clear to always does. One of the two kinds is chosen, so that neither waits for
    /// the other; the rest of uniform media is left to the collisions.
    fn cross(&mut self, medium: &MediumRay, segment: &Segment, rng: &mut PathRng) -> bool {
        if segment.t1.is_finite() {
            return false;
        }
        let clear = medium.coefficients(segment.t0).mu_t.cmpeq(Rgb::ZERO);
        if !clear.any() {
            return false;
        }
        let color = self.throughput * self.weight;
        let total = mean(color);
        if !(total > 0.0 && total.is_finite()) {
            self.weight *= total;
            return true;
        }
        let escape = mean(Rgb::select(clear, color, Rgb::ZERO)) / total;
        let escapes = rng.uniform() < escape;
        self.weight = if escapes {
            Rgb::select(clear, self.weight / escape, Rgb::ZERO)
        } else {
            Rgb::select(clear, Rgb::ZERO, self.weight / (1.0 - escape))
        };
        escapes
    }

    fn collide(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        if at.segment.gray && self.gather == Gather::Nothing {
            return self.collide_gray(medium, at, rng);
        }
        let &Collision { t, rate, .. } = at;
        let c = medium.coefficients(t);
        if self.gather == Gather::EveryCollision {
            self.emission += self.weight * c.emission / rate;
        }
        let mu_n = null_coefficient(rate, c.mu_t);
        let [absorb, scatter] = self.shares(&c, at.segment);
        let color = self.throughput * self.weight;
        let [a, s, n] = [absorb, scatter, mu_n].map(|mu| mean(color * mu));
        let total = a + s + n;
        if !(total > 0.0 && total.is_finite()) {
            // Nothing is left to follow; what is no number stays one and is counted.
            self.weight *= total;
            self.event = Event::Absorbed { t, real: false };
            return ControlFlow::Break(());
        }
        let u = rng.uniform() * total;
        if u < n {
            self.weight *= mu_n / rate * (total / n);
            return ControlFlow::Continue(());
        }
        if u < n + s && c.mu_s != Rgb::ZERO {
            self.weight *= c.mu_s / rate * (total / s);
            self.event = Event::Scattered { t, phase: medium.phase(t) };
            return ControlFlow::Break(());
        }
        if self.gather == Gather::Absorption {
            self.emission += self.weight * c.emission / rate * (total / a);
        }
        let real = u - n - s < mean(color * c.mu_a());
        self.event = Event::Absorbed { t, real };
        ControlFlow::Break(())
    }
}

impl Scattering {
    /// The same where all channels are: whatever the color, each event's probability is its share
    /// of the collisions, and the weight is the albedo.
    fn collide_gray(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        let (mu_t, mu_s) = medium.extinction(at.t);
        let mu_n = (at.rate - mu_t.x).max(0.0);
        let total = mu_n + mu_t.x;
        if !total.is_finite() {
            self.weight *= total;
            self.event = Event::Absorbed { t: at.t, real: false };
            return ControlFlow::Break(());
        }
        if rng.uniform() * total < mu_n {
            return ControlFlow::Continue(());
        }
        if mu_s.x > 0.0 {
            self.weight *= mu_s.x / mu_t.x;
            self.event = Event::Scattered { t: at.t, phase: medium.phase(at.t) };
        } else {
            self.event = Event::Absorbed { t: at.t, real: true };
        }
        ControlFlow::Break(())
    }

    /// Coefficients in whose proportion a collision is an absorption or a scattering event.
    ///
    /// Where emission is not gathered by absorption, a real collision always scatters, and the
    /// weight carries the albedo: a path that lives on dimly beats one that mostly dies.
    ///
    /// Where absorption alone shows the emission, it happens as often as μ_a says, and often
    /// enough to show it: ε may be positive with little or no μ_a. The other events make up for
    /// that share by their weights, so that the floor absorbs nothing by itself.
    fn shares(&self, c: &Coefficients, segment: &Segment) -> [Rgb; 2] {
        if self.gather != Gather::Absorption {
            return [Rgb::ZERO, c.mu_t];
        }
        let mu_a = c.mu_a();
        if c.emission.max_element() > 0.0 {
            [mu_a.max(Rgb::splat(EMISSION_FLOOR * segment.emission_rate)), c.mu_s]
        } else {
            [mu_a, c.mu_s]
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Affine3A, UVec2, Vec3A};

    use super::*;
    use crate::{
        math::{Aabb, Ray},
        transport::strategy::Preset,
        volume::{
            body::{Region, Substance, Volume},
            emission::Emission,
            field::{RgbField, ScalarField},
            world::{Instance, World},
        },
    };

    /// A draw of zero distance collides in however thin a medium.
    #[test]
    fn a_collision_of_vanishing_rate_leaves_the_weight_alone() {
        let glow =
            Emission::Field { field: RgbField::Constant(Rgb::ONE), scale: Rgb::splat(1e-30) };
        let substance = Substance {
            density: ScalarField::Constant(0.0),
            density_scale: Rgb::ONE,
            albedo: RgbField::Constant(Rgb::ZERO),
            g: 0.0,
            emission: glow,
        };
        let region = Region::Box(Aabb::centered(Vec3A::ONE));
        let volume = Arc::new(Volume::uniform(region, substance));
        let world = World::new(vec![Instance::new(volume, Affine3A::IDENTITY)]);
        let mut medium = world.along(Ray::new(-3.0 * Vec3A::X, Vec3A::X), f32::INFINITY);
        let segment = medium.next_segment().unwrap();
        let mut walk = Scattering {
            majorant: EmissionMajorant::of(&Preset::Baseline.strategy()),
            gather: Gather::EveryCollision,
            throughput: Rgb::ONE,
            weight: Rgb::ONE,
            emission: Rgb::ZERO,
            event: Event::Reached,
        };
        let at = Collision { t: 3.0, rate: 1e-30, segment: &segment };
        let goes_on = walk.collide(&medium, &at, &mut PathRng::new(0, UVec2::ZERO, 0));
        assert!(goes_on.is_continue());
        assert_eq!((walk.weight, walk.emission), (Rgb::ONE, Rgb::ONE));
    }
}
