//! The walk to a scattering event whose distance was drawn otherwise.

use std::ops::ControlFlow;

use super::event::{Event, Flight};
use super::flight_state::FlightState;
use super::{Collision, Walk, track};
use crate::math::{PathRng, Rgb};
use crate::transport::strategy::Strategy;
use crate::volume::medium::Segment;
use crate::volume::world::MediumRay;

/// Fills the distance to a scattering event at parameter `t`, however that was drawn, by ratio
/// tracking: tentative collisions at the rate μ̄, all of them null (P_n = 1). The flight's density
/// is the one that the scattering walk would have had, with *its* P_n and P_s at the same drawn
/// coefficients, and its weight is over that density. The walk gathers no emission, which is left
/// to the scattering walk. Ends lost, with weight 0, where nothing scatters.
pub fn fill(
    medium: MediumRay,
    strategy: &Strategy,
    throughput: Rgb,
    t: f32,
    rng: &mut PathRng,
) -> Flight {
    let mut walk = Fill { state: FlightState::new(strategy, throughput), until: t, event: None };
    let collisions = track(medium, rng.exponential(), rng, &mut walk);
    let Fill { state, event, .. } = walk;
    let weight = if event.is_some() { state.weight } else { Rgb::ZERO };
    let event = event.unwrap_or(Event::Absorbed { t, real: false });
    Flight { event, weight, emission: Rgb::ZERO, pdf_null: state.pdf_null, collisions }
}

struct Fill {
    state: FlightState,
    /// Ray parameter of the event.
    until: f32,
    /// The event, once the walk has got there.
    event: Option<Event>,
}

impl Walk for Fill {
    fn rate(&mut self, _: &MediumRay, segment: &Segment) -> f32 {
        self.state.rate(segment)
    }

    /// An endless uniform segment keeps the channels that may collide in it.
    fn cross(&mut self, medium: &MediumRay, segment: &Segment, _: &mut PathRng) -> bool {
        let Some(escape) = self.state.escape_probability(medium, segment) else { return false };
        if !(escape.total > 0.0 && escape.total.is_finite()) || escape.probability >= 1.0 {
            return true;
        }
        self.state.stay(&escape);
        false
    }

    #[inline]
    fn until(&self) -> f32 {
        self.until
    }

    fn arrive(&mut self, medium: &MediumRay, at: &Collision) {
        if self.state.is_gray(at.segment) {
            let (mu_t, mu_s) = medium.extinction(at.t);
            let mu_n = self.state.gray_null(at, mu_t);
            self.event = self.state.scatter_gray(medium, at, [mu_t.x, mu_s.x, mu_n]);
            return;
        }
        let c = medium.coefficients(at.t);
        let (p, _) = self.state.probabilities(&c, at);
        if p.are_usable() {
            self.event = self.state.scatter(medium, at, &c, &p);
        }
    }

    /// A null collision; where there is none, no path comes through, and the walk ends lost.
    fn collide(&mut self, medium: &MediumRay, at: &Collision, _: &mut PathRng) -> ControlFlow<()> {
        if self.state.is_gray(at.segment) {
            return self.collide_gray(medium, at);
        }
        let (p, mu_n) = self.state.probabilities(&medium.coefficients(at.t), at);
        if !p.are_usable() || p.null <= 0.0 {
            return ControlFlow::Break(());
        }
        self.state.pass_null(mu_n, at.rate, &p);
        ControlFlow::Continue(())
    }
}

impl Fill {
    /// [`Fill::collide`] where all channels are the same.
    fn collide_gray(&mut self, medium: &MediumRay, at: &Collision) -> ControlFlow<()> {
        if self.state.has_no_nulls(at.segment) {
            // Crossed in closed form.
            return ControlFlow::Continue(());
        }
        let (mu_t, _) = medium.extinction(at.t);
        let mu_n = self.state.gray_null(at, mu_t);
        let total = mu_n + mu_t.x;
        if !total.is_finite() || mu_n <= 0.0 {
            return ControlFlow::Break(());
        }
        self.state.pass_gray_null(mu_n, total);
        ControlFlow::Continue(())
    }
}
