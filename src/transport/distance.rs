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
    strategy::{Distance, ScatterProbability, Strategy},
    tracking::{self, Event, Flight},
};
use crate::{
    math::{PathRng, Rgb, Slot},
    sampling::{equiangular::Equiangular, mis},
    volume::world::MediumRay,
};

/// Probability of null-collision tracking where a flight is either that or guided. It bounds the
/// weights by its inverse.
const NULL_SHARE: f32 = 0.6;
/// Fewest and most guided flights of a ray from the camera, on average.
const LEAST_FLIGHTS: f32 = 0.1;
const MOST_FLIGHTS: f32 = 16.0;
/// Relative variance of what an unguided flight finds from which on guided ones pay.
const MUCH_MISSED: f32 = 1.0;

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

    /// How many guided flights a ray from the camera gets on average. The noise of a pixel is about
    /// in proportion to its light, so that the picture's falls fastest for the same effort where
    /// each gets flights in that proportion; fewer where an unguided one finds all the light as
    /// well, as in a cloud; and some at least.
    fn flights(&self, strategy: &Strategy, mean_light: f32) -> f32 {
        let Some(line) = &self.line else { return 1.0 };
        let least = match strategy.advanced.distance {
            Distance::Probes => 1.0,
            _ => line.transmittance().max(LEAST_FLIGHTS),
        };
        let wanted = line.light() / mean_light * (line.missed() / MUCH_MISSED).min(1.0);
        match strategy.advanced.scatter_probability {
            ScatterProbability::Light if wanted.is_finite() => wanted.clamp(least, MOST_FLIGHTS),
            _ => least,
        }
    }
}

/// The flight along a ray through `medium`, without a guide.
pub(super) fn null(
    medium: MediumRay,
    strategy: &Strategy,
    throughput: Rgb,
    rng: &mut PathRng,
) -> Flight {
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
        Event::Scattered { t, .. } => {
            mis::mixture([NULL_SHARE, 1.0 - NULL_SHARE], [flight.pdf_null, guide.pdf(t)])
        }
        _ => 1.0 / NULL_SHARE,
    };
    flight
}

/// The flights along a ray from the camera: one that is unguided, and guided ones, more of them
/// where more light is scattered into the ray. They share what both kinds can bring, scattering;
/// the unguided one brings all else.
///
/// With n guided flights on average the guided density counts n times in the balance heuristic;
/// they are drawn from one number, evenly apart.
pub(super) struct Fan<'g> {
    guide: &'g Guide,
    /// Guided flights on average.
    mean: f32,
    /// Guided flights.
    count: u32,
    /// The number that places them.
    offset: f32,
}

impl<'g> Fan<'g> {
    /// `mean_light` is the radiance scattered into rays from the camera on average.
    pub(super) fn new(
        strategy: &Strategy,
        guide: &'g Guide,
        mean_light: f32,
        rng: &mut PathRng,
    ) -> Self {
        let mean = guide.flights(strategy, mean_light);
        let whole = mean.floor();
        let more = mean > whole && rng.uniform() < mean - whole;
        let count = whole as u32 + u32::from(more);
        let offset = if count > 0 { rng.at(Slot::GuidedDistance) } else { 0.0 };
        Self { guide, mean, count, offset }
    }

    /// Where the guided flights end.
    pub(super) fn distances(&self) -> impl Iterator<Item = f32> + use<'g> {
        let (guide, count, offset) = (self.guide, self.count, self.offset);
        (0..count).map(move |index| {
            let u = (index as f32 + offset) / count as f32;
            guide.sample(u.min(1.0 - f32::EPSILON))
        })
    }

    /// The guided flight to parameter `t`.
    pub(super) fn guided(
        &self,
        medium: MediumRay,
        strategy: &Strategy,
        t: f32,
        throughput: Rgb,
        rng: &mut PathRng,
    ) -> Flight {
        let flight = tracking::fill(medium, strategy, throughput, t, rng);
        self.weighed(flight, strategy, false)
    }

    /// The unguided one.
    pub(super) fn unguided(
        &self,
        medium: MediumRay,
        strategy: &Strategy,
        throughput: Rgb,
        rng: &mut PathRng,
    ) -> Flight {
        self.weighed(null(medium, strategy, throughput, rng), strategy, true)
    }

    fn weighed(&self, mut flight: Flight, strategy: &Strategy, is_null: bool) -> Flight {
        if let Event::Scattered { t, .. } = flight.event {
            let pdf = self.guide.pdf(t);
            flight.weight *= match strategy.advanced.distance {
                Distance::Probes => alone(flight.pdf_null, pdf, is_null) / self.mean,
                _ => mis::mixture([1.0, self.mean], [flight.pdf_null, pdf]),
            };
        }
        flight
    }
}

/// The factor of a scattering event where guides alone may draw it.
fn alone(pdf_null: f32, pdf_guided: f32, is_null: bool) -> f32 {
    if is_null || pdf_guided <= 0.0 { 0.0 } else { pdf_null / pdf_guided }
}
