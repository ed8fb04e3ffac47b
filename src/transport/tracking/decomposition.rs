//! Decomposition tracking: scattering walks that leave most of the medium unread.

use std::ops::ControlFlow;

use super::event::{Event, Flight};
use super::scattering::Scattering;
use super::{Collision, Walk, null_coefficient, track};
use crate::{
    math::{PathRng, Rgb, mean},
    transport::strategy::Strategy,
    volume::{medium::Segment, world::MediumRay},
};

/// Decomposition tracking (Kutz et al. 2017, section 4): μ_t = μ_c + μ_r, with the control μ_c the
/// lower bound of μ_t in each segment, so that a collision with it is real without a read of the
/// medium. Both components' collisions come from one process of rate μ̄, of which a share P_c ∝ the
/// channels' mean of w·μ_c is the control's; among the rest, P ∝ the mean of w·μ_r and of w·μ_n, as
/// [`super::scattering::scatter`] chooses. Uniform segments are all control: their closed form.
///
/// Unbiased in every channel. It gathers no emission, and where the control scatters μ_t is
/// unknown, so that the density of the flight, `pdf_null`, stays unknown and 0.
///
/// The first step is `optical_distance` long, which has density exp(-x).
pub fn scatter(
    medium: MediumRay,
    strategy: &Strategy,
    throughput: Rgb,
    optical_distance: f32,
    rng: &mut PathRng,
) -> Flight {
    let scattering = Scattering::new(strategy, throughput);
    let mut walk = Decomposition { scattering, control: Rgb::ZERO };
    let collisions = track(medium, optical_distance, rng, &mut walk);
    walk.scattering.flight(collisions)
}

struct Decomposition {
    scattering: Scattering,
    control: Rgb,
}

impl Walk for Decomposition {
    fn rate(&mut self, medium: &MediumRay, segment: &Segment) -> f32 {
        self.control = medium.bounds_of_mu_t().0;
        segment.majorant
    }

    fn cross(&mut self, medium: &MediumRay, segment: &Segment, rng: &mut PathRng) -> bool {
        self.scattering.cross(medium, segment, rng)
    }

    fn collide(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        let color = self.scattering.state.throughput * self.scattering.state.weight;
        let total = mean(color) * at.rate;
        if !(total > 0.0 && total.is_finite()) {
            // Nothing is left to follow; what is no number stays one and is counted.
            return self.scattering.end(total, at.t);
        }
        let control = mean(color * self.control);
        let u = rng.uniform() * total;
        if u < control {
            let mu_c = self.control;
            return self.real(medium, at, mu_c / at.rate * (total / control));
        }
        let mu_t = medium.mu_t(at.t);
        let (mu_r, mu_n) = ((mu_t - self.control).max(Rgb::ZERO), null_coefficient(at.rate, mu_t));
        let [real, null] = [mu_r, mu_n].map(|mu| mean(color * mu));
        if !(real + null).is_finite() {
            return self.scattering.end(real + null, at.t);
        }
        // 1 / (μ̄ P) is `odds` over the event's share; there may be no rest but by rounding.
        let odds = total / (total - control) * (real + null) / at.rate;
        if (u - control) * (real + null) < (total - control) * real {
            return self.real(medium, at, mu_r * (odds / real));
        }
        if null > 0.0 {
            self.scattering.state.weight *= mu_n * (odds / null);
        }
        ControlFlow::Continue(())
    }
}

impl Decomposition {
    /// A real collision, before which the weight was short of `factor`.
    fn real(&mut self, medium: &MediumRay, at: &Collision, factor: Rgb) -> ControlFlow<()> {
        let (albedo, phase) = medium.scattering(at.t);
        self.scattering.event = if albedo == Rgb::ZERO {
            Event::Absorbed { t: at.t, real: true }
        } else {
            self.scattering.state.weight *= factor * albedo;
            Event::Scattered { t: at.t, phase }
        };
        ControlFlow::Break(())
    }
}
