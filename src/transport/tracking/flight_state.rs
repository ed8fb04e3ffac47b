//! Weight and density of a flight, collision by collision: the same for the walk that chooses its
//! events and for the walk to an event that was drawn otherwise, so that MIS compares like with
//! like.
//!
//! At drawn coefficients the scattering walk takes a null collision with P_n and scatters with P_s.
//! The density of the flight is Π P_n · μ̄ P_s, and its weight Π μ_n/(μ̄ P_n) · μ_s/(μ̄ P_s); the
//! factors T̄ and the density of the tentative collisions are common to both walks and cancel
//! (Huang et al. 2021, section 3).

use super::event::{EmissionGathering, Event};
use super::majorant::{EMISSION_FLOOR, EmissionMajorant};
use super::{Collision, null_coefficient};
use crate::math::{Rgb, mean};
use crate::transport::strategy::{Strategy, Tracker};
use crate::volume::medium::{Coefficients, Segment};
use crate::volume::world::MediumRay;

/// Weight and density of a flight so far, and the rules that choose its events.
pub(super) struct FlightState {
    majorant: EmissionMajorant,
    pub(super) gathering: EmissionGathering,
    /// The path's throughput before the flight; only its color matters here.
    pub(super) throughput: Rgb,
    /// Whether events are chosen whatever the color of the path.
    spectral: bool,
    pub(super) weight: Rgb,
    /// Π P_n so far, and T of the uniform segments that have no null collisions.
    null_probability: f32,
    /// Transmittance of such a segment, if the walk is in one.
    null_probability_ahead: f32,
    /// Density of the flight once it scatters; 0 before.
    pub(super) pdf_null: f32,
}

/// The events' shares of a collision, in proportion to their probabilities: P_n = `null` / `total`,
/// and so on.
pub(super) struct EventProbabilities {
    pub(super) absorb: f32,
    pub(super) scatter: f32,
    pub(super) null: f32,
    pub(super) total: f32,
}

impl EventProbabilities {
    /// Whether an event can be chosen by them.
    #[inline]
    pub(super) fn are_usable(&self) -> bool {
        self.total > 0.0 && self.total.is_finite()
    }
}

impl FlightState {
    pub(super) fn new(strategy: &Strategy, throughput: Rgb) -> Self {
        Self {
            majorant: EmissionMajorant::of(strategy),
            gathering: EmissionGathering::of(strategy),
            throughput,
            spectral: strategy.advanced.tracker == Tracker::Spectral,
            weight: Rgb::ONE,
            null_probability: 1.0,
            null_probability_ahead: 1.0,
            pdf_null: 0.0,
        }
    }

    /// Enters a segment: the rate μ̄ of its tentative collisions.
    pub(super) fn rate(&mut self, segment: &Segment) -> f32 {
        let rate = match self.gathering {
            EmissionGathering::Nothing => segment.majorant,
            EmissionGathering::EveryCollision => self.majorant.rate(segment),
            EmissionGathering::Absorption => {
                segment.majorant.max(EMISSION_FLOOR * segment.emission_rate)
            }
        };
        self.null_probability *= self.null_probability_ahead;
        self.null_probability_ahead = if self.has_no_nulls(segment) {
            (-rate * (segment.t1 - segment.t0)).exp()
        } else {
            1.0
        };
        rate
    }

    /// Probability that an endless uniform segment is crossed without a collision: the share, in
    /// the path's color, of the channels it is clear to. `None` where it is left to the collisions;
    /// not usable, not a number, where nothing is left to follow.
    pub(super) fn escape_probability(
        &self,
        medium: &MediumRay,
        segment: &Segment,
    ) -> Option<Escape> {
        if segment.t1.is_finite() {
            return None;
        }
        let clear = medium.coefficients(segment.t0).mu_t.cmpeq(Rgb::ZERO);
        if !clear.any() {
            return None;
        }
        let color = self.throughput * self.weight;
        let total = mean(color);
        let probability = mean(Rgb::select(clear, color, Rgb::ZERO)) / total;
        Some(Escape { clear, total, probability })
    }

    /// Crosses the segment with the channels that it is clear to.
    pub(super) fn escape(&mut self, escape: &Escape) {
        self.weight = Rgb::select(escape.clear, self.weight / escape.probability, Rgb::ZERO);
    }

    /// Stays in the segment with the channels that collide.
    pub(super) fn stay(&mut self, escape: &Escape) {
        self.null_probability *= 1.0 - escape.probability;
        self.weight =
            Rgb::select(escape.clear, Rgb::ZERO, self.weight / (1.0 - escape.probability));
    }

    /// Whether one channel stands for all and no emission is gathered by absorption.
    #[inline]
    pub(super) fn is_gray(&self, segment: &Segment) -> bool {
        segment.gray && self.gathering == EmissionGathering::Nothing
    }

    /// Whether every collision is real: where the majorant is the extinction itself.
    #[inline]
    pub(super) fn has_no_nulls(&self, segment: &Segment) -> bool {
        segment.uniform && self.is_gray(segment)
    }

    /// A null collision, chosen with P_n, in a colored segment.
    #[inline]
    pub(super) fn pass_null(&mut self, mu_n: Rgb, rate: f32, probabilities: &EventProbabilities) {
        let EventProbabilities { null, total, .. } = *probabilities;
        self.weight *= mu_n / rate * (total / null);
        self.null_probability *= null / total;
    }

    /// A null collision in a gray segment, where μ_n/(μ̄ P_n) = 1.
    #[inline]
    pub(super) fn pass_gray_null(&mut self, mu_n: f32, total: f32) {
        self.null_probability *= mu_n / total;
    }

    /// μ_n of a gray segment.
    #[inline]
    pub(super) fn gray_null(&self, at: &Collision, mu_t: Rgb) -> f32 {
        if self.has_no_nulls(at.segment) { 0.0 } else { (at.rate - mu_t.x).max(0.0) }
    }

    /// Scatters in a gray segment; `None` where nothing does.
    pub(super) fn scatter_gray(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        [mu_t, mu_s, mu_n]: [f32; 3],
    ) -> Option<Event> {
        if mu_s <= 0.0 {
            return None;
        }
        let clear = if self.has_no_nulls(at.segment) {
            (-at.rate * (at.t - at.segment.t0)).exp()
        } else {
            1.0
        };
        self.pdf_null = self.null_probability * clear * at.rate * (mu_t / (mu_n + mu_t));
        self.weight *= mu_s / mu_t;
        Some(Event::Scattered { t: at.t, phase: medium.phase(at.t) })
    }

    /// Scatters, chosen with P_s; `None` where nothing does.
    pub(super) fn scatter(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        c: &Coefficients,
        probabilities: &EventProbabilities,
    ) -> Option<Event> {
        let EventProbabilities { scatter, total, .. } = *probabilities;
        if c.mu_s == Rgb::ZERO || scatter <= 0.0 {
            return None;
        }
        self.pdf_null = self.null_probability * at.rate * (scatter / total);
        self.weight *= c.mu_s / at.rate * (total / scatter);
        Some(Event::Scattered { t: at.t, phase: medium.phase(at.t) })
    }

    /// The share of a coefficient μ among the events: the channels' mean of w·μ.
    #[inline]
    pub(super) fn share(&self, mu: Rgb) -> f32 {
        if self.spectral { mu.max_element() } else { mean(self.throughput * self.weight * mu) }
    }

    /// The shares of absorption, scattering and null at a collision, and μ_n there.
    ///
    /// Where emission is not gathered by absorption, a real collision always scatters, and the
    /// weight carries the albedo: a path that lives on dimly beats one that mostly dies.
    ///
    /// Where absorption alone gathers the emission, it is chosen in proportion to μ_a, and often
    /// enough to gather it: ε may be positive with little or no μ_a. The other events make up for
    /// that share by their weights, so that the floor absorbs nothing by itself.
    #[inline]
    pub(super) fn probabilities(
        &self,
        c: &Coefficients,
        at: &Collision,
    ) -> (EventProbabilities, Rgb) {
        let [absorb, scatter] = if self.gathering != EmissionGathering::Absorption {
            [Rgb::ZERO, c.mu_t]
        } else if c.emission.max_element() > 0.0 {
            [c.mu_a().max(Rgb::splat(EMISSION_FLOOR * at.segment.emission_rate)), c.mu_s]
        } else {
            [c.mu_a(), c.mu_s]
        };
        let mu_n = null_coefficient(at.rate, c.mu_t);
        let [absorb, scatter, null] = [absorb, scatter, mu_n].map(|mu| self.share(mu));
        (EventProbabilities { absorb, scatter, null, total: absorb + scatter + null }, mu_n)
    }
}

/// The choice at an endless uniform segment that is clear to some channels and not to others.
pub(super) struct Escape {
    /// Channels that never collide there.
    clear: glam::BVec3A,
    /// Mean of the path's color; nothing is left to follow where it is not positive and finite.
    pub(super) total: f32,
    /// Probability of crossing.
    pub(super) probability: f32,
}
