//! Distance along a ray to its next scattering event: by null-collision tracking, by guiding
//! towards light, or by both, combined by MIS.
//!
//! Both strategies make the same kind of path: tentative collisions at the majorant's rate, all
//! null up to the last. The majorant's transmittance and rate cancel between them, so that with P
//! the null-collision walk's own probabilities
//! p_null : p_guided = Π P_n(x_i) · μ̄ P_s(x_k) : p_select(t_k) (Huang et al. 2021, section 3).
//!
//! Guides are built from probes and points of lights, which are fixed before either strategy draws.

use glam::Vec3A;

use super::{
    counts::Allocation,
    learned_counts,
    probes::{Brightness, DistancePdf},
    strategy::{Strategy, Tracker},
    tracking::{
        decomposition,
        event::{Event, Flight},
        fill::fill,
        scattering::scatter,
    },
};
use crate::{
    math::{PathRng, Ray, Rgb, Slot},
    sampling::{equiangular::Equiangular, mis},
    volume::world::MediumRay,
};

/// Probability of null-collision tracking where a flight is either that or guided. It bounds the
/// weights by its inverse.
const NULL_SHARE: f32 = 0.6;
/// Least number of guided flights that the light of a ray is divided by for the weight window.
const LEAST_SPREAD: f32 = 0.1;

/// p_select: the densities that guide along one ray, each with the same share.
#[derive(Debug)]
pub(super) struct DistanceGuide {
    /// Density that the probes along the ray give.
    pub(super) distance_pdf: Option<DistancePdf>,
    /// Equiangular density towards a point of a light.
    pub(super) equiangular: Option<Equiangular>,
}

impl DistanceGuide {
    /// Combines the two densities with equal shares; `None` without either.
    pub(super) fn new(
        distance_pdf: Option<DistancePdf>,
        equiangular: Option<Equiangular>,
    ) -> Option<Self> {
        let guides = distance_pdf.is_some() || equiangular.is_some();
        guides.then_some(Self { distance_pdf, equiangular })
    }

    fn sample(&self, u: f32) -> f32 {
        match (&self.distance_pdf, &self.equiangular) {
            (Some(distance_pdf), Some(_)) if u < 0.5 => distance_pdf.sample(2.0 * u),
            (Some(_), Some(equiangular)) => equiangular.sample(2.0 * u - 1.0),
            (Some(distance_pdf), None) => distance_pdf.sample(u),
            (None, Some(equiangular)) => equiangular.sample(u),
            (None, None) => 0.0,
        }
    }

    fn pdf(&self, t: f32) -> f32 {
        let distance_pdf = self.distance_pdf.as_ref().map(|distance_pdf| distance_pdf.pdf(t));
        let equiangular = self.equiangular.as_ref().map(|equiangular| equiangular.pdf(t));
        pdf_of_both(distance_pdf, equiangular)
    }
}

/// Density of a guide from the densities of its parts, 1/length.
pub(super) fn pdf_of_both(distance_pdf: Option<f32>, equiangular: Option<f32>) -> f32 {
    match (distance_pdf, equiangular) {
        (Some(distance_pdf), Some(equiangular)) => 0.5 * (distance_pdf + equiangular),
        (one, None) | (None, one) => one.unwrap_or(0.0),
    }
}

/// The point of a ray between two parameters at which points of lights are chosen.
pub(super) fn middle(ray: &Ray, t0: f32, t1: f32) -> Vec3A {
    ray.at(if t1.is_finite() { 0.5 * (t0 + t1) } else { t0 })
}

/// The unguided flight along a ray through `medium`, by the tracker of the strategy.
pub(super) fn unguided(
    medium: MediumRay,
    strategy: &Strategy,
    throughput: Rgb,
    rng: &mut PathRng,
) -> Flight {
    // Without a walk of its own, the emission is gathered by the collisions that are read.
    if strategy.advanced.tracker == Tracker::Decomposition && strategy.emission_ratio_tracking {
        let optical_distance = rng.exponential_at(Slot::Distance);
        return decomposition::scatter(medium, strategy, throughput, optical_distance, rng);
    }
    null(medium, strategy, throughput, rng)
}

/// The flight along a ray through `medium` by null-collision tracking, with its density.
fn null(medium: MediumRay, strategy: &Strategy, throughput: Rgb, rng: &mut PathRng) -> Flight {
    let optical_distance = rng.exponential_at(Slot::Distance);
    scatter(medium, strategy, throughput, optical_distance, rng)
}

/// One flight, guided or not: its weight divides by the mixture of both densities.
pub(super) fn null_or_guided(
    medium: MediumRay,
    strategy: &Strategy,
    guide: &DistanceGuide,
    throughput: Rgb,
    rng: &mut PathRng,
) -> Flight {
    let u = rng.at(Slot::Distance);
    let is_null = u < NULL_SHARE;
    let mut flight = if is_null {
        let optical_distance = -(1.0 - u / NULL_SHARE).max(f32::EPSILON).ln();
        scatter(medium, strategy, throughput, optical_distance, rng)
    } else {
        let t = guide.sample(((u - NULL_SHARE) / (1.0 - NULL_SHARE)).min(1.0 - f32::EPSILON));
        fill(medium, strategy, throughput, t, rng)
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

/// Flights along a camera ray: one unguided, and guided ones, more of them where more light is
/// scattered into the ray. They share scattering; the unguided one carries all else.
///
/// With n guided flights on average the guided density counts n times in the balance heuristic;
/// they are drawn from one number, evenly apart.
pub(super) struct GuidedDistances<'g> {
    guide: &'g DistanceGuide,
    allocation: Allocation,
    /// Guided flights.
    count: u32,
    /// Jitter of the guided flights, in [0, 1).
    offset: f32,
}

impl<'g> GuidedDistances<'g> {
    pub(super) fn new(
        strategy: &Strategy,
        guide: &'g DistanceGuide,
        (film, flights_scale): (&Brightness, f32),
        rng: &mut PathRng,
    ) -> Self {
        let distance_pdf = guide.distance_pdf.as_ref();
        let allocation = Allocation::new(strategy, distance_pdf, film, flights_scale);
        let mean = allocation.mean_flights;
        let count = learned_counts::draw(mean, Slot::GuidedCount, rng);
        let offset = if count > 0 { rng.at(Slot::GuidedDistance) } else { 0.0 };
        Self { guide, allocation, count, offset }
    }

    /// Expected contribution of each guided flight, as radiance.
    pub(super) fn expected(&self) -> f32 {
        let distance_pdf = self.guide.distance_pdf.as_ref();
        let in_scattered = distance_pdf.map_or(0.0, |distance_pdf| distance_pdf.in_scattered());
        in_scattered / self.allocation.mean_flights.max(LEAST_SPREAD)
    }

    /// Ray parameters at which the guided flights end.
    pub(super) fn iter(&self) -> impl Iterator<Item = f32> + use<'g> {
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
        self.weighed(fill(medium, strategy, throughput, t, rng), false)
    }

    /// The unguided flight.
    pub(super) fn unguided(
        &self,
        medium: MediumRay,
        strategy: &Strategy,
        throughput: Rgb,
        rng: &mut PathRng,
    ) -> Flight {
        self.weighed(null(medium, strategy, throughput, rng), true)
    }

    fn weighed(&self, mut flight: Flight, is_null: bool) -> Flight {
        if let Event::Scattered { t, .. } = flight.event {
            flight.weight *= self.allocation.weight(flight.pdf_null, self.guide.pdf(t), is_null);
        }
        flight
    }
}

#[cfg(test)]
mod tests {
    use crate::error::NO_PROGRESS;
    use crate::transport::prepare::SceneProbes;
    use glam::UVec2;

    use super::*;
    use crate::transport::Scene;
    use crate::transport::probes::Probes;
    use crate::transport::strategy::{Advanced, ScatterProbability};

    const SMOKE: &str = r#"
        [[volume]]
        shape = "noise"
        half_size = 1.0
        frequency = 2.0
        contrast = 2.0
        density = { scale = 3.0 }
        albedo = [0.9, 0.7, 0.5]
        phase = { g = 0.4 }
        [[light]]
        type = "point"
        position = [0.3, 0.1, 0.2]
        intensity = 1.0
    "#;
    const LAMP: Vec3A = Vec3A::new(0.3, 0.1, 0.2);

    /// A ray through the smoke and the guide of its flights: the probes' density, the lamp or both.
    fn guided_ray<'s>(
        scene: &'s Scene,
        probes: &Probes,
        index: u64,
    ) -> Option<(DistanceGuide, MediumRay<'s>)> {
        let mut rng = PathRng::new(index, UVec2::ONE, 0);
        let target = 0.5 * Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
        let origin = Vec3A::new(-3.0, 0.2, 0.1);
        let ray = Ray::new(origin, (target - origin).normalize());
        let medium = scene.world.along(ray, f32::INFINITY);
        let (t0, t1) = medium.extent()?;
        let distance_pdf = probes.along(medium.clone(), &ray).filter(|_| index % 3 != 2);
        let equiangular = Equiangular::new(&ray, LAMP, probes.mean_cosine(), t0, t1);
        Some((DistanceGuide::new(distance_pdf, equiangular.filter(|_| index % 3 != 1))?, medium))
    }

    /// A flight as the path sees it, the same with its weight over the density of null-collision
    /// sampling alone, and the expected number of each of the two kinds.
    struct Drawn {
        flight: Flight,
        plain: Flight,
        counts: [f32; 2],
    }

    /// A draw on a ray that has one flight.
    fn one_of_one(
        strategy: &Strategy,
        guide: &DistanceGuide,
        medium: &MediumRay,
        index: u64,
    ) -> Drawn {
        let mut rng = PathRng::new(index, UVec2::ZERO, 0);
        let mut again = rng.clone();
        let flight = null_or_guided(medium.clone(), strategy, guide, Rgb::ONE, &mut rng);
        let u = again.at(Slot::Distance);
        let plain = if u < NULL_SHARE {
            let depth = -(1.0 - u / NULL_SHARE).max(f32::EPSILON).ln();
            scatter(medium.clone(), strategy, Rgb::ONE, depth, &mut again)
        } else {
            let t = guide.sample((u - NULL_SHARE) / (1.0 - NULL_SHARE));
            fill(medium.clone(), strategy, Rgb::ONE, t, &mut again)
        };
        Drawn { flight, plain, counts: [NULL_SHARE, 1.0 - NULL_SHARE] }
    }

    /// A draw on a ray that has several flights: the first guided one if there is any.
    fn one_of_several(
        strategy: &Strategy,
        guide: &DistanceGuide,
        medium: &MediumRay,
        index: u64,
    ) -> Drawn {
        let film = Brightness { scattered: 1.0, volume_fraction: 0.7 };
        let mut rng = PathRng::new(index, UVec2::ZERO, 0);
        let distances = GuidedDistances::new(strategy, guide, (&film, 1.0), &mut rng);
        let mut again = rng.clone();
        let medium = || medium.clone();
        let (flight, plain) = match distances.iter().next() {
            Some(t) => (
                distances.guided(medium(), strategy, t, Rgb::ONE, &mut rng),
                fill(medium(), strategy, Rgb::ONE, t, &mut again),
            ),
            None => (
                distances.unguided(medium(), strategy, Rgb::ONE, &mut rng),
                null(medium(), strategy, Rgb::ONE, &mut again),
            ),
        };
        Drawn { flight, plain, counts: [1.0, distances.allocation.mean_flights] }
    }

    /// Density of a guide's draws at `t` estimated from the samples alone: the slope of their
    /// distribution, found by bisection. `None` where it has a step nearby.
    fn drawn_density(guide: &DistanceGuide, t: f32) -> Option<f32> {
        const STEP: f32 = 4e-3;
        let both = guide.distance_pdf.is_some() && guide.equiangular.is_some();
        let halves = if both { vec![[0.0, 0.5], [0.5, 1.0]] } else { vec![[0.0, 1.0]] };
        let share_before = |t: f32| -> f64 {
            let of_part = |&[from, to]: &[f64; 2]| {
                let (mut low, mut high) = (from, to);
                for _ in 0..30 {
                    let middle = 0.5 * (low + high);
                    if guide.sample(middle as f32) <= t { low = middle } else { high = middle }
                }
                low - from
            };
            halves.iter().map(of_part).sum()
        };
        let slope =
            |from: f32, to: f32| (share_before(to) - share_before(from)) as f32 / (to - from);
        let wide = slope(t - STEP, t + STEP);
        let parts = [slope(t - STEP, t), slope(t, t + STEP), slope(t - 0.2 * STEP, t + 0.2 * STEP)];
        let smooth = parts.iter().all(|part| (part - wide).abs() < 0.02 * wide);
        (smooth && wide > 1e-3).then_some(wide)
    }

    /// For thousands of flights, by null-collision sampling and guided: the weight is f over the
    /// mixture of both densities, that of null-collision sampling as the walk gives it (which its
    /// own tests hold against the product) and that of the guide as the slope of its samples'
    /// distribution.
    #[test]
    fn weights_divide_by_the_mixture_of_what_draws() {
        let scene = Scene::of_text(SMOKE);
        let probes = SceneProbes::placed(&scene, NO_PROGRESS).unwrap().unwrap();
        let probes = probes.fine(&scene, NO_PROGRESS).unwrap();
        let scatter_probability = ScatterProbability::Even;
        let advanced = Advanced { scatter_probability, ..Advanced::default() };
        let strategy = Strategy { advanced, ..scene.strategy };
        let mut checked = [0; 2];
        for index in 0..8000 {
            let Some((guide, medium)) = guided_ray(&scene, probes, index) else { continue };
            let kind = (index / 3 % 2) as usize;
            let draw = [one_of_one, one_of_several][kind];
            let Drawn { flight, plain, counts } = draw(&strategy, &guide, &medium, index);
            let (Event::Scattered { t, .. }, Event::Scattered { t: same, .. }) =
                (flight.event, plain.event)
            else {
                continue;
            };
            assert_eq!(t, same);
            let Some(pdf_select) = drawn_density(&guide, t) else { continue };
            let expected = plain.weight * plain.pdf_null
                / (counts[0] * plain.pdf_null + counts[1] * pdf_select);
            let error = (flight.weight - expected).abs().max_element();
            assert!(
                error <= 0.03 * expected.max_element(),
                "path {index} at {t}: {} for {expected}",
                flight.weight
            );
            checked[kind] += 1;
        }
        assert!(checked[0] > 1000 && checked[1] > 1000, "{checked:?}");
    }
}
