//! A trial of the pilot pass: some pixels of the picture, traced under one scale of guided flights
//! and all choices of how the light at the end of rays is gathered, with the variance and the cost
//! of each.
//!
//! A path takes the same turns however the light at the end of its rays is gathered. So the trial
//! gathers half of it in each way, and one set of paths serves all choices: their comparison has
//! the noise of the light at the ends alone.

use super::cost::Cost;
use super::pilot_film::PilotFilm;
use super::pilot_pixel::{PilotPixel, half_square};
use crate::error::{Progress, Result, report};
use crate::math::{Rgb, mean};
use crate::transport::context::PathContext;
use crate::transport::learned_counts::{BounceClass, LearnedCounts};
use crate::transport::observer::{Observer, PathStep};
use crate::transport::sample::PathSample;
use crate::transport::scene::Scene;

/// Most pixels of a trial.
const MOST_PIXELS: u32 = 1 << 14;
/// Cost of reading the probes along a ray, in tracking steps. Measured as the rest is.
const GUIDE_COST: f64 = 26.0;
/// Standard errors by which another way to gather the light at the end of rays must be better: the
/// best of so many looks better than it is.
const DOUBT: f64 = 2.0;
/// Fewest pixels of a trial, relative to those of the trial with the most.
const FEWEST_PIXELS: f64 = 1.0 / 16.0;
/// Share of the light at the end of rays that a trial gathers in each way.
const HALF: f32 = 0.5;

/// One way to gather the light at the end of rays for each class of vertices that rays leave: one
/// bit for each class, set for gathering by transmittance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct RayEnds(u32);

impl RayEnds {
    /// Number of choices.
    pub(super) const COUNT: usize = 1 << BounceClass::COUNT;

    /// All choices.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        (0..Self::COUNT as u32).map(Self)
    }

    /// The choice that `counts` make.
    pub(super) fn of(counts: &LearnedCounts) -> Self {
        let bit = |class: BounceClass| u32::from(counts.at(class).by_transmittance > HALF);
        Self(BounceClass::ALL.iter().map(|&class| bit(class) << class as u32).sum())
    }

    /// `counts` with this choice.
    pub(super) fn applied(self, mut counts: LearnedCounts) -> LearnedCounts {
        for class in BounceClass::ALL {
            let share = if self.by_transmittance(class as usize) { 1.0 } else { 0.0 };
            counts.at_mut(class).by_transmittance = share;
        }
        counts
    }

    fn by_transmittance(self, class: usize) -> bool {
        self.0 >> class & 1 == 1
    }
}

/// Variance and cost of a trial for each choice of [`RayEnds`].
#[derive(Clone, Debug)]
pub(super) struct Trial {
    /// Mean over the pixels of the variance of all light but the emission that is seen directly.
    pub(super) variance: [f64; RayEnds::COUNT],
    /// Standard error of the difference to the variance of the first choice.
    pub(super) doubt: [f64; RayEnds::COUNT],
    /// Mean over the pixels of the variance of the emission that is seen directly.
    pub(super) emission: f64,
    /// Mean cost of a sample, in steps.
    pub(super) cost: [f64; RayEnds::COUNT],
    /// Mean over the pixels of all light but the emission that is seen directly, and its variance
    /// as it was gathered.
    pub(super) light: [f64; 2],
    /// Pixels, each of which had two paths.
    pub(super) pixels: f64,
}

impl Trial {
    /// Measures the counts of `context` with every choice of ray ends, by paths of the cost
    /// `budget`.
    pub(super) fn new(
        film: PilotFilm<'_>,
        context: PathContext<'_>,
        budget: f64,
        progress: Progress,
    ) -> Result<Self> {
        let PilotFilm { scene, size, .. } = film;
        let guides = context.counts.guided_flights > 0.0;
        let usual = RayEnds::of(context.counts);
        let counts = context.counts.with_all_by_transmittance(HALF);
        let context = context.with_counts(&counts);
        let none = [0.0; RayEnds::COUNT];
        let mut trial = Self {
            variance: none,
            doubt: none,
            emission: 0.0,
            cost: none,
            light: [0.0; 2],
            pixels: 0.0,
        };
        let (mut pixels, mut spent) = (0, 0.0);
        while spent < budget && pixels < MOST_PIXELS {
            report(progress, (spent / budget) as f32)?;
            let pixel = PilotPixel::new(scene, size, pixels);
            let guide_cost = if guides && pixel.meets_medium() { GUIDE_COST } else { 0.0 };
            let paths = [0, 1].map(|number| {
                let mut ends = EndObserver::new(scene);
                let sample = pixel.path(context, 0, number, &mut ends);
                spent += 0.5 * (ends.cost.of(&sample) + guide_cost);
                (sample, ends)
            });
            trial.add(&paths, usual, guide_cost);
            pixels += 1;
        }
        trial.pixels = f64::from(pixels);
        Ok(trial.over(f64::from(pixels)))
    }

    /// Variance, without that of the emission that is seen directly, and cost of a choice; of any
    /// but the first choice the most that the variance may well be.
    pub(super) fn of(&self, ends: RayEnds) -> (f64, f64) {
        let index = ends.0 as usize;
        (self.variance[index] + DOUBT * self.doubt[index], self.cost[index])
    }

    /// Raises the variance of each trial that missed light which another one found, or whose paths
    /// cost so much that it has far fewer pixels than another one and tells nothing.
    ///
    /// Light that none of n paths found comes by paths rarer than 1/n: where it adds Δ to the mean,
    /// it adds Δ² n to the variance at least, which the trial could not see.
    pub(super) fn heed_missed_light(trials: &mut [Self]) {
        let proven = trials.iter().map(Self::least_mean).fold(0.0, f64::max);
        let most = trials.iter().map(|trial| trial.pixels).fold(0.0, f64::max);
        for trial in trials {
            if trial.pixels < FEWEST_PIXELS * most {
                trial.variance.fill(f64::INFINITY);
            }
            let missed = (proven - trial.light[0]).max(0.0);
            let least = 2.0 * trial.pixels * missed * missed;
            trial.variance.iter_mut().for_each(|variance| *variance = variance.max(least));
        }
    }

    /// The mean less twice its standard error.
    fn least_mean(&self) -> f64 {
        let [mean, variance] = self.light;
        let least = mean - 2.0 * (variance / (2.0 * self.pixels)).sqrt();
        if least.is_finite() { least } else { 0.0 }
    }

    /// Least variance times cost of all choices if there is one, else of that of `counts`.
    pub(super) fn least(&self, has_choice: bool, counts: &LearnedCounts) -> f64 {
        let usual = RayEnds::of(counts);
        let choices = RayEnds::all().filter(|&ends| has_choice || ends == usual);
        let product = |ends| {
            let (variance, cost) = self.of(ends);
            (variance + self.emission) * cost
        };
        choices.map(product).fold(f64::INFINITY, f64::min)
    }

    fn add(&mut self, paths: &[(PathSample, EndObserver<'_>); 2], usual: RayEnds, guide_cost: f64) {
        let light = |sample: &PathSample| gray(sample.beauty() - sample.emission);
        let [a, b] = paths.each_ref().map(|(sample, _)| light(sample));
        self.light[0] += 0.5 * (a + b);
        self.light[1] += half_square(a - b);
        self.emission += half_square(gray(paths[0].0.emission) - gray(paths[1].0.emission));
        let both = paths.each_ref().map(|(sample, ends)| ends.otherwise(sample));
        let costs = paths.each_ref().map(|(sample, ends)| ends.cost.of(sample) + guide_cost);
        let variance = |choice| {
            let [a, b] = [0, 1].map(|i| both[i] + paths[i].1.light(choice));
            half_square(a - b)
        };
        let usual = variance(usual);
        for choice in RayEnds::all() {
            let index = choice.0 as usize;
            let variance = variance(choice);
            self.variance[index] += variance;
            self.doubt[index] += (variance - usual) * (variance - usual);
            self.cost[index] +=
                [0, 1].iter().map(|&i| 0.5 * (costs[i] - paths[i].1.saved(choice))).sum::<f64>();
        }
    }

    fn over(mut self, pixels: f64) -> Self {
        let sums = self
            .variance
            .iter_mut()
            .chain(&mut self.cost)
            .chain([&mut self.emission])
            .chain(&mut self.light);
        sums.for_each(|sum| *sum /= pixels);
        self.doubt.iter_mut().for_each(|squares| *squares = squares.sqrt() / pixels);
        self
    }
}

/// Sums of the light at the ends of a path's rays, by the class of the vertex that a ray left, each
/// as it would be were all of it gathered in one way.
#[derive(Debug)]
struct EndObserver<'s> {
    cost: Cost<'s>,
    /// Whether camera rays need their transmittance for coverage.
    covers: bool,
    by_arrival: [f64; BounceClass::COUNT],
    by_transmittance: [f64; BounceClass::COUNT],
    /// Cost of walks for the transmittance alone.
    walks: [f64; BounceClass::COUNT],
}

impl<'s> EndObserver<'s> {
    fn new(scene: &'s Scene) -> Self {
        let none = [0.0; BounceClass::COUNT];
        let (cost, covers) = (Cost::new(scene), scene.strategy.gathers_whole_rays());
        Self { cost, covers, by_arrival: none, by_transmittance: none, walks: none }
    }

    /// All light of the path but the emission that is seen directly and the light at the ends.
    fn otherwise(&self, sample: &PathSample) -> f64 {
        let ends = self.by_arrival.iter().chain(&self.by_transmittance).sum::<f64>();
        gray(sample.beauty() - sample.emission) - f64::from(HALF) * ends
    }

    /// The light at the ends, gathered by a choice.
    fn light(&self, choice: RayEnds) -> f64 {
        let one = |class: usize| match choice.by_transmittance(class) {
            true => self.by_transmittance[class],
            false => self.by_arrival[class],
        };
        (0..BounceClass::COUNT).map(one).sum()
    }

    /// Cost of the walks that a choice needs not. A camera ray's is needed for coverage, where the
    /// strategy gathers whole rays.
    fn saved(&self, choice: RayEnds) -> f64 {
        let classes = usize::from(self.covers)..BounceClass::COUNT;
        classes
            .filter(|&class| !choice.by_transmittance(class))
            .map(|class| self.walks[class])
            .sum()
    }
}

impl Observer for EndObserver<'_> {
    fn step(&mut self, step: PathStep) {
        self.cost.step(step);
        if let PathStep::End { contribution, class, by_transmittance, .. } = step {
            let sums = match by_transmittance {
                true => &mut self.by_transmittance,
                false => &mut self.by_arrival,
            };
            sums[class as usize] += gray(contribution) / f64::from(HALF);
            self.walks[class as usize] += self.cost.of_last_step();
        }
    }
}

/// The value whose variance is the noise of a picture, see
/// [`estimate::gray`](crate::render::estimate::gray).
pub(super) fn gray(light: Rgb) -> f64 {
    f64::from(mean(light))
}
