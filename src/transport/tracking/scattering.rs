//! The scattering walk: analog or weighted, by null-collision tracking.

use std::ops::ControlFlow;

use super::event::{EmissionGathering, Event, Flight};
use super::flight_state::FlightState;
use super::{Collision, Walk, track};
use crate::math::{PathRng, Rgb};
use crate::transport::strategy::Strategy;
use crate::volume::medium::Segment;
use crate::volume::world::MediumRay;

/// The scattering walk: at each tentative collision one of absorption, scattering and null (or,
/// with the albedo in the weight, one of the latter two) is chosen with P ∝ the channels' mean of
/// w·μ, so that the throughput stays near one color and the factors μ/(μ̄ P) near 1 (Kutz et al.
/// 2017, section 5.1, history-aware probabilities). The first step is `optical_distance` long,
/// which has density exp(-x).
///
/// That is spectral MIS in closed form: with f_c the path's contribution to channel c so far, which
/// is also how likely that channel's own analog walk is to take it, the probabilities make the
/// path's density the mean of f over the channels, and its weight f_c / mean f (Miller et al.
/// 2019).
///
/// With the tracker `spectral` it is P ∝ the largest channel of μ instead, whatever the path's
/// color (the same paper's section 5.1, maximum probabilities): spectral tracking, whose weights
/// grow with every collision that the channels disagree at. Gray media take it for `delta`.
pub fn scatter(
    medium: MediumRay,
    strategy: &Strategy,
    throughput: Rgb,
    optical_distance: f32,
    rng: &mut PathRng,
) -> Flight {
    let mut walk = Scattering::new(strategy, throughput);
    let collisions = track(medium, optical_distance, rng, &mut walk);
    walk.flight(collisions)
}

/// The walk behind [`scatter`].
pub(super) struct Scattering {
    pub(super) state: FlightState,
    pub(super) emission: Rgb,
    pub(super) event: Event,
}

impl Walk for Scattering {
    fn rate(&mut self, _: &MediumRay, segment: &Segment) -> f32 {
        self.state.rate(segment)
    }

    /// Where a uniform medium goes on for ever, a channel it is clear to never collides, and one
    /// it is not clear to always does. One of the two kinds is chosen, so that neither waits for
    /// the other; the rest of uniform media is left to the collisions.
    fn cross(&mut self, medium: &MediumRay, segment: &Segment, rng: &mut PathRng) -> bool {
        let Some(escape) = self.state.escape_probability(medium, segment) else { return false };
        if !(escape.total > 0.0 && escape.total.is_finite()) {
            self.state.weight *= escape.total;
            return true;
        }
        let escapes = escape.probability >= 1.0 || rng.uniform() < escape.probability;
        if escapes {
            self.state.escape(&escape);
        } else {
            self.state.stay(&escape);
        }
        escapes
    }

    fn collide(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        if self.state.is_gray(at.segment) {
            return self.collide_gray(medium, at, rng);
        }
        let &Collision { t, rate, .. } = at;
        let c = medium.coefficients(t);
        if self.state.gathering == EmissionGathering::EveryCollision {
            self.emission += self.state.weight * c.emission / rate;
        }
        let (p, mu_n) = self.state.probabilities(&c, at);
        if !p.are_usable() {
            return self.end(p.total, t);
        }
        let u = rng.uniform() * p.total;
        if u < p.null {
            self.state.pass_null(mu_n, rate, &p);
            return ControlFlow::Continue(());
        }
        if u < p.null + p.scatter
            && let Some(event) = self.state.scatter(medium, at, &c, &p)
        {
            self.event = event;
            return ControlFlow::Break(());
        }
        if self.state.gathering == EmissionGathering::Absorption {
            self.emission += self.state.weight * c.emission / rate * (p.total / p.absorb);
        }
        let real = u - p.null - p.scatter < self.state.share(c.mu_a());
        self.event = Event::Absorbed { t, real };
        ControlFlow::Break(())
    }
}

impl Scattering {
    pub(super) fn new(strategy: &Strategy, throughput: Rgb) -> Self {
        let state = FlightState::new(strategy, throughput);
        Self { state, emission: Rgb::ZERO, event: Event::Reached }
    }

    /// The finished flight.
    pub(super) fn flight(self, collisions: u32) -> Flight {
        let FlightState { weight, pdf_null, .. } = self.state;
        Flight { event: self.event, weight, emission: self.emission, pdf_null, collisions }
    }

    /// Ends the walk where nothing is left to follow; a weight that is no number stays one and is
    /// counted with its sample.
    pub(super) fn end(&mut self, factor: f32, t: f32) -> ControlFlow<()> {
        self.state.weight *= factor;
        self.event = Event::Absorbed { t, real: false };
        ControlFlow::Break(())
    }

    /// [`Scattering::collide`] where all channels are the same: whatever the color, each event's
    /// probability is its share of the collisions, and the weight is the albedo.
    fn collide_gray(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        let (mu_t, mu_s) = medium.extinction(at.t);
        let mu_n = self.state.gray_null(at, mu_t);
        let total = mu_n + mu_t.x;
        if !total.is_finite() {
            return self.end(total, at.t);
        }
        if rng.uniform() * total < mu_n {
            self.state.pass_gray_null(mu_n, total);
            return ControlFlow::Continue(());
        }
        let event = self.state.scatter_gray(medium, at, [mu_t.x, mu_s.x, mu_n]);
        self.event = event.unwrap_or(Event::Absorbed { t: at.t, real: true });
        ControlFlow::Break(())
    }
}
