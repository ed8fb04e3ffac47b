//! How far a ray goes before it scatters: by null-collision tracking, by what guides it to where
//! light is, or by both, shared by MIS.
//!
//! Both strategies make the same kind of path: tentative collisions at the majorant's rate, all
//! null up to the last. The majorant's transmittance and rate cancel between them, so that with P
//! the null-collision walk's own probabilities
//! p_null : p_guided = Π P_n(x_i) · μ̄ P_s(x_k) : p_select(t_k) (Huang et al. 2021, section 3).
//!
//! What a guide is made from (the probes, a point of a light) is fixed before either strategy
//! draws.

use super::{
    probes::Line,
    strategy::{Distance, Strategy, Tracker},
    tracking::{self, Event, Flight},
};
use crate::{
    math::{PathRng, Rgb, Slot},
    sampling::{equiangular::Equiangular, mis},
    volume::world::MediumRay,
};

/// Probability of null-collision tracking where a flight is either that or guided. It bounds the
/// weights by its inverse.
const NULL_SHARE: f32 = 0.3;
/// Least probability of a guided flight beside the other one.
const LEAST_BRANCHING: f32 = 0.1;

/// p_select: the densities that guide along one ray, each with the same share.
#[derive(Debug)]
pub(super) struct Guide {
    /// Of the probes.
    pub(super) line: Option<Line>,
    /// Towards a point of a light.
    pub(super) light: Option<Equiangular>,
}

impl Guide {
    /// `None` where there is nothing to guide by.
    pub(super) fn new(line: Option<Line>, light: Option<Equiangular>) -> Option<Self> {
        (line.is_some() || light.is_some()).then_some(Self { line, light })
    }

    fn sample(&self, u: f32) -> f32 {
        match (&self.line, &self.light) {
            (Some(line), Some(_)) if u < 0.5 => line.sample(2.0 * u),
            (Some(_), Some(light)) => light.sample(2.0 * u - 1.0),
            (Some(line), None) => line.sample(u),
            (None, Some(light)) => light.sample(u),
            (None, None) => 0.0,
        }
    }

    fn pdf(&self, t: f32) -> f32 {
        let line = self.line.as_ref().map(|line| line.pdf(t));
        let light = self.light.as_ref().map(|light| light.pdf(t));
        match (line, light) {
            (Some(line), Some(light)) => 0.5 * (line + light),
            (one, None) | (None, one) => one.unwrap_or(0.0),
        }
    }

    /// How often a guided flight pays beside an unguided one: the more of the ray's light the
    /// latter leaves behind without scattering, the more.
    fn branching(&self) -> f32 {
        self.line.as_ref().map_or(1.0, Line::transmittance).max(LEAST_BRANCHING)
    }
}

/// The flight along a ray through `medium` without a guide, by the tracker that is chosen.
pub(super) fn unguided(
    medium: MediumRay,
    strategy: &Strategy,
    throughput: Rgb,
    rng: &mut PathRng,
) -> Flight {
    // Without a walk of its own, the emission is gathered by the collisions that are read.
    if strategy.advanced.tracker == Tracker::Decomposition && strategy.emission_ratio_tracking {
        let optical_distance = rng.exponential_at(Slot::Distance);
        return tracking::scatter_by_decomposition(
            medium,
            strategy,
            throughput,
            optical_distance,
            rng,
        );
    }
    null(medium, strategy, throughput, rng)
}

/// The flight along a ray through `medium` by null-collision tracking that knows its density.
fn null(medium: MediumRay, strategy: &Strategy, throughput: Rgb, rng: &mut PathRng) -> Flight {
    let optical_distance = rng.exponential_at(Slot::Distance);
    tracking::scatter(medium, strategy, throughput, optical_distance, rng)
}

/// One flight, guided or not: its weight divides by the mixture of both densities.
pub(super) fn null_or_guided(
    medium: MediumRay,
    strategy: &Strategy,
    guide: &Guide,
    throughput: Rgb,
    rng: &mut PathRng,
) -> Flight {
    let u = rng.at(Slot::Distance);
    let is_null = u < NULL_SHARE;
    let mut flight = if is_null {
        let optical_distance = -(1.0 - u / NULL_SHARE).max(f32::EPSILON).ln();
        tracking::scatter(medium, strategy, throughput, optical_distance, rng)
    } else {
        let t = guide.sample(((u - NULL_SHARE) / (1.0 - NULL_SHARE)).min(1.0 - f32::EPSILON));
        tracking::fill(medium, strategy, throughput, t, rng)
    };
    flight.emission /= NULL_SHARE;
    flight.weight *= match flight.event {
        Event::Scattered { t, .. } if strategy.advanced.distance == Distance::Probes => {
            alone(flight.pdf_null, guide.pdf(t), is_null) / (1.0 - NULL_SHARE)
        }
        Event::Scattered { t, .. } => {
            mis::mixture([NULL_SHARE, 1.0 - NULL_SHARE], [flight.pdf_null, guide.pdf(t)])
        }
        _ => 1.0 / NULL_SHARE,
    };
    flight
}

/// Two flights, one unguided, the other guided and by chance left out where it brings little. They
/// share what both can bring, scattering, and the first brings all else.
pub(super) fn null_and_guided(
    medium: MediumRay,
    strategy: &Strategy,
    guide: &Guide,
    throughput: Rgb,
    rng: &mut PathRng,
) -> (Flight, Option<Flight>) {
    let share = match strategy.advanced.distance {
        Distance::Probes => 1.0,
        _ => guide.branching(),
    };
    let weigh = |flight: &mut Flight, is_null: bool| {
        if let Event::Scattered { t, .. } = flight.event {
            flight.weight *= match strategy.advanced.distance {
                Distance::Probes => alone(flight.pdf_null, guide.pdf(t), is_null),
                _ => mis::mixture([1.0, share], [flight.pdf_null, guide.pdf(t)]),
            };
        }
    };
    let u = rng.at(Slot::GuidedDistance);
    let guided = (u < share).then(|| {
        let t = guide.sample((u / share).min(1.0 - f32::EPSILON));
        let mut flight = tracking::fill(medium.clone(), strategy, throughput, t, rng);
        weigh(&mut flight, false);
        flight
    });
    let mut unguided = null(medium, strategy, throughput, rng);
    weigh(&mut unguided, true);
    (unguided, guided)
}

/// The factor of a scattering event where guides alone may draw it.
fn alone(pdf_null: f32, pdf_guided: f32, is_null: bool) -> f32 {
    if is_null || pdf_guided <= 0.0 { 0.0 } else { pdf_null / pdf_guided }
}
