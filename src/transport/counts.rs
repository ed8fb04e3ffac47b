//! Decides the expected number of samples of each technique at a vertex, before any direction is
//! drawn. Nothing else decides it.
//!
//! | technique | rule |
//! |---|---|
//! | guided flights of a camera ray | as the radiance scattered into it, times the pilot's scale |
//! | light samples, emission walks | learned by the pilot, see [`super::learned_counts`] |
//! | light at the end of a ray | by arrival or by transmittance, learned by the pilot |
//! | path continuation, near the camera inside of a medium | the weight window |
//! | path continuation, elsewhere | Russian roulette on the throughput |
//!
//! The estimate is unbiased whatever the numbers: splitting and roulette compensate by their
//! factors, all else by its expected number in the balance heuristic.

use super::context::PathContext;
use super::probes::{Brightness, DistancePdf};
use super::strategy::{Distance, ScatterProbability, Strategy};
use super::vertex::Vertex;
use super::weight_window::{MOST_BRANCHES, MOST_NESTED, Splitting};
use crate::math::{PathRng, Rgb, mean};
use crate::sampling::mis;

/// Scattering events and reflections before roulette may end a path.
const ROULETTE_AFTER: u32 = 3;
/// Throughput below which roulette may end a path. Paths that may yet reach a light are not worth
/// less for being dim: at 1 the noise of dense smoke costs a third more time, that of lights inside
/// of it several times as much.
const ROULETTE_BELOW: f32 = 0.1;
/// Vertices up to which the weight window decides: beyond them it has made up for the spread of
/// weights that guiding brings, and a probe lookup at each of a thousand vertices costs more than
/// the walk.
const WEIGHED_VERTICES: u32 = 8;
/// Most guided flights of a ray from the camera, on average.
const MOST_FLIGHTS: f32 = 16.0;
/// Relative variance of an unguided flight's contribution from which on guided flights pay.
const MUCH_MISSED: f32 = 1.0;

/// The value of a path where the number of its continuations is decided, with the limits of that
/// number.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathValue {
    /// The throughput that arrives at the vertex.
    pub(super) throughput: Rgb,
    /// Scattering events and reflections before the vertex.
    pub(super) scatters: u32,
    /// Expected contribution of one flight of the camera ray; 0 where it is unknown.
    pub(super) expected: f32,
    /// Splits whose branches are being followed.
    pub(super) nested: u32,
    /// Branches of the sample so far.
    pub(super) branches: u32,
}

/// The number of paths that go on from one vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counts {
    /// The path's value relative to `expected` and its brightness relative to one worth keeping,
    /// where the weight window decides.
    window: Option<[f32; 2]>,
    may_split: bool,
    /// Whether the weight window decides for the path beyond the vertex as well.
    survives_roulette: bool,
    scatters: u32,
}

impl Counts {
    /// The counts at `vertex`, which a path reaches along the unit `forward`.
    pub(super) fn at(
        context: &PathContext,
        strategy: &Strategy,
        vertex: &Vertex,
        forward: glam::Vec3A,
        path: PathValue,
    ) -> Self {
        let is_known = path.expected > 0.0 && !vertex.is_surface();
        let weighs = is_known && path.scatters < WEIGHED_VERTICES;
        let probes = context.probes_for_distances(strategy).filter(|_| weighs);
        let window = probes.map(|probes| {
            let radiance = probes.radiance_at(vertex.receiver().position, forward);
            let value = mean(path.throughput) * radiance / path.expected;
            [value, path.throughput.max_element() / ROULETTE_BELOW]
        });
        Self {
            window,
            may_split: path.nested < MOST_NESTED && path.branches < MOST_BRANCHES,
            survives_roulette: is_known && path.scatters + 1 < WEIGHED_VERTICES,
            scatters: path.scatters + 1,
        }
    }

    /// Draws how many paths go on from the vertex.
    pub(super) fn splitting(&self, rng: &mut PathRng) -> Splitting {
        match self.window {
            Some([value, brightness]) => Splitting::draw(value, brightness, self.may_split, rng),
            None => Splitting { count: 1, factor: 1.0 },
        }
    }

    /// Probability, up to 1, that a path goes on along the direction it has drawn: Russian roulette
    /// on its throughput, with `guiding_ratio` times as many paths where guides sent them, except
    /// where the weight window has spoken.
    pub(super) fn survival(&self, throughput: Rgb, guiding_ratio: f32) -> f32 {
        if self.survives_roulette {
            return f32::from(u8::from(throughput != Rgb::ZERO));
        }
        let survival = (throughput.max_element() * guiding_ratio / ROULETTE_BELOW).min(1.0);
        if self.scatters < ROULETTE_AFTER {
            return f32::from(u8::from(survival > 0.0));
        }
        survival
    }
}

/// Allocation of scattering along a camera ray to guided and unguided flights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allocation {
    /// Expected number of guided flights.
    pub(super) mean_flights: f32,
    /// Whether guided flights alone gather the scattered light; otherwise guided and unguided ones
    /// do, by MIS.
    pub(super) alone: bool,
}

impl Allocation {
    /// Number of guided flights under the guides of `distance_pdf`, `flights_scale` times what the
    /// probes propose. The noise of a pixel is about in proportion to its light, so that the
    /// picture's falls fastest for the same cost where each gets flights in that proportion; fewer
    /// where an unguided flight gathers all the light as well, as in a cloud, or where the noise is
    /// that of surfaces. But each ray gets one at least, or the part of one that the scale allows,
    /// as it does from probes alone: rays that are rarely guided have rare bright paths.
    pub(super) fn new(
        strategy: &Strategy,
        distance_pdf: Option<&DistancePdf>,
        film: &Brightness,
        flights_scale: f32,
    ) -> Self {
        let alone = strategy.advanced.distance == Distance::Probes;
        let Some(distance_pdf) = distance_pdf else { return Self { mean_flights: 1.0, alone } };
        let fraction = film.volume_fraction * flights_scale;
        let least = if alone { 1.0 } else { fraction };
        let relative = fraction * (distance_pdf.in_scattered() / film.scattered);
        let wanted = relative * (distance_pdf.missed() / MUCH_MISSED).min(1.0);
        let mean_flights = match strategy.advanced.scatter_probability {
            ScatterProbability::Light if wanted.is_finite() => wanted.clamp(least, MOST_FLIGHTS),
            _ => least,
        };
        Self { mean_flights, alone }
    }

    /// The factor of a scattering event of either kind, whose weight is over `pdf_null`.
    pub(super) fn weight(&self, pdf_null: f32, pdf_guided: f32, is_null: bool) -> f32 {
        match self.alone {
            false => mis::mixture([1.0, self.mean_flights], [pdf_null, pdf_guided]),
            true if is_null || pdf_guided <= 0.0 => 0.0,
            true => pdf_null / (pdf_guided * self.mean_flights),
        }
    }
}
