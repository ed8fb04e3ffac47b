//! Expected counts of light samples and emission walks, learned from one set of paths for all
//! counts at once.
//!
//! At a vertex, two techniques find the same light: light samples and the path's own ray. With
//! expected counts n and densities p, balance weights make each contribution β f / (n · p), where
//! n · p = n₁p₁ + n₂p₂, and the sum of their second moments ∫ (β f)²/(n · p) dω (Veach 1997,
//! section 9.2). Paths that were traced with counts m draw directions with density m · p in all, so
//! that each contribution g found there estimates it for any n, as g² (m · p)/(n · p).
//!
//! Below one sample a second moment is what a count adds to the variance, since roulette that
//! expects n of one sample has the variance of that sample and (1/n − 1) of its second moment. The
//! counts with the least variance times cost are those that are good in most parts of the film: the
//! pixels fall into groups, and the logarithm is averaged over them, so that one bright path
//! decides nothing (after Rath et al. 2022, *EARS: Efficiency-Aware Russian Roulette and
//! Splitting*, and Meyer et al. 2024, *MARS: Multi-sample Allocation through Russian roulette and
//! Splitting*).

use glam::UVec2;

use super::cost::Cost;
use super::pilot_pixel::{PilotPixel, budget, half_square};
use super::trial::gray;
use crate::error::{Progress, Result, report};
use crate::light::LightGroup;
use crate::transport::context::PathContext;
use crate::transport::learned_counts::{BounceClass, ClassCounts, CountRule, LearnedCounts};
use crate::transport::observer::{Observer, PathStep, Technique};
use crate::transport::scene::Scene;

/// Most pixels.
const MOST_PIXELS: u32 = 1 << 13;
/// Groups that the pixels fall into.
const GROUPS: usize = 8;
/// Counts for each unit of throughput that are compared. Between none and the least, samples would
/// save little more, and bring rare bright ones, which so few paths know nothing of.
const TRIED: [f32; 8] = [0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, f32::INFINITY];
/// Fewest light samples of lamps, and emission walks, for each unit of throughput: near to small
/// lamps and inside of fires the other technique has rare bright finds.
const FEWEST: f32 = 0.25;
/// Least part of the measured variance that any counts are taken to leave.
const LEAST_LEFT: f64 = 0.1;
/// Factor by which a change of a count must lower variance times cost.
const GAIN: f64 = 0.95;
/// Factor by which a change of a count at first vertices must lower it: samples that are spread
/// evenly there have much less variance than the independent ones of the pilot, so that rounding
/// adds more.
const GAIN_OF_FIRST: f64 = 0.8;
/// Largest factor of a contribution by other counts: none of them would find it.
const LARGEST: f64 = 1e6;
/// Cost of an emission walk whose emission is not weighted against light samples, relative to one
/// whose is.
const UNWEIGHTED: f64 = 0.6;
/// Rounds of improving one count after the other.
const ROUNDS: u32 = 2;

/// The counts of `context` with the light samples and emission walks that have the least variance
/// times cost, whatever `context` has of them.
pub(super) fn learn(
    scene: &Scene,
    size: UVec2,
    context: PathContext<'_>,
    progress: Progress,
) -> Result<LearnedCounts> {
    let mut best = context.counts.with_one_of_each();
    let knobs = knobs(scene);
    if knobs.is_empty() {
        return Ok(best);
    }
    let counts = best;
    let mut groups = measure(scene, size, context.with_counts(&counts), progress)?;
    for _ in 0..ROUNDS {
        for &(class, technique) in &knobs {
            improve(&mut groups, &mut best, class, technique);
        }
    }
    Ok(best)
}

/// Takes the rule of one technique at one class that has the least variance times cost.
fn improve(groups: &mut [Group], best: &mut LearnedCounts, class: BounceClass, kind: Kind) {
    let rules = best.at_mut(class);
    let gain = if is_first(class) { GAIN_OF_FIRST } else { GAIN };
    let mut least = objective(groups, class, rules) + gain.ln();
    for per_throughput in TRIED {
        if per_throughput < FEWEST && kind != Kind::FireSample {
            continue;
        }
        let mut other = *rules;
        let most = if per_throughput > 0.0 { 1.0 } else { 0.0 };
        *kind.rule(&mut other) = CountRule { per_throughput, most };
        let product = objective(groups, class, &other);
        if product < least {
            (least, *rules) = (product, other);
        }
    }
    for group in groups {
        group.set(class, group.added(class, rules));
    }
}

/// Whether vertices of a class have samples that are spread evenly over the samples of a pixel.
fn is_first(class: BounceClass) -> bool {
    matches!(class, BounceClass::FirstInMedium | BounceClass::FirstOnSurface)
}

/// The counts that matter in a scene.
fn knobs(scene: &Scene) -> Vec<(BounceClass, Kind)> {
    let strategy = &scene.strategy;
    let exists = |group| scene.lights.len(group) > 0;
    let fires = strategy.nee && exists(LightGroup::Fires);
    let walks = strategy.gathers_whole_rays() && scene.world.emits();
    let kinds = [
        (Kind::FireSample, fires),
        (Kind::EmissionWalk, walks),
        (Kind::LampSample, exists(LightGroup::Lamps)),
    ];
    let matters = |class| kinds.into_iter().filter(|kind| kind.1).map(move |kind| (class, kind.0));
    match strategy.marches() {
        true => Vec::new(),
        false => BounceClass::ALL.into_iter().skip(1).flat_map(matters).collect(),
    }
}

/// Kind of a technique that found a contribution.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    FireSample,
    LampSample,
    EmissionWalk,
}

impl Kind {
    /// Number of kinds.
    const COUNT: usize = 3;

    /// The rule of the kind.
    fn rule(self, counts: &mut ClassCounts) -> &mut CountRule {
        match self {
            Self::FireSample => &mut counts.fire_samples,
            Self::LampSample => &mut counts.lamp_samples,
            Self::EmissionWalk => &mut counts.emission_walks,
        }
    }
}

/// A contribution to a pixel, found at a vertex or along the ray that leaves it.
#[derive(Clone, Copy, Debug)]
struct Record {
    kind: Kind,
    technique: Technique,
    /// Which of the two paths of its pixel found it.
    path: u32,
    /// Gray contribution to the pixel.
    contribution: f64,
    /// Cost of the sample.
    cost: f64,
}

impl Record {
    /// Expected counts of the technique and the other one by other rules.
    fn counts_by(&self, rules: &ClassCounts) -> [f32; 2] {
        let Technique { throughput, share, counts: [_, other], .. } = self.technique;
        let fire_samples = rules.fire_samples.at(throughput * share);
        let emission_walks = rules.emission_walks.at(throughput);
        match self.kind {
            Kind::LampSample => [rules.lamp_samples.at(throughput * share), other],
            // Where the scattering walk gathers the emission, the rule is one walk.
            Kind::FireSample => [fire_samples, emission_walks],
            Kind::EmissionWalk if other > 0.0 => [emission_walks, fire_samples],
            Kind::EmissionWalk => [emission_walks, 0.0],
        }
    }

    /// Root of the second moment, and cost, that the record stands for by other rules.
    fn value_and_cost(&self, rules: &ClassCounts) -> (f64, f64) {
        let Technique { counts: m, pdfs, .. } = self.technique;
        let n = self.counts_by(rules);
        let dot = |c: [f32; 2]| {
            f64::from(c[0]) * f64::from(pdfs[0]) + f64::from(c[1]) * f64::from(pdfs[1])
        };
        // Finds of both techniques tell of both: light that rays alone would rarely meet shows in
        // the finds of light samples.
        let value = match self.contribution == 0.0 {
            true => 0.0,
            false => self.contribution * (dot(m) / dot(n)).sqrt().min(LARGEST),
        };
        // Without light samples, emission needs no MIS weight.
        let alone = self.kind == Kind::EmissionWalk && n[1] == 0.0;
        let cost = self.cost * if alone { UNWEIGHTED } else { 1.0 };
        (value, f64::from(n[0] / m[0]) * cost)
    }
}

/// Variance, cost and records of a group of pixels.
#[derive(Debug, Default)]
struct Group {
    /// Sum of the variances of the pixels.
    variance: f64,
    /// Sum of the mean costs of a path of each pixel.
    cost: f64,
    /// The records of each pixel, by the class of their vertex.
    records: [Vec<Vec<Record>>; BounceClass::COUNT],
    /// Variance and cost that the techniques of each class add, by the best counts so far.
    added: [(f64, f64); BounceClass::COUNT],
}

impl Group {
    /// Variance and cost that the techniques of a class add to the group, by `rules`.
    fn added(&self, class: BounceClass, rules: &ClassCounts) -> (f64, f64) {
        let sum = |sum: (f64, f64), records: &Vec<Record>| {
            let (variance, cost) = added(class, records, rules);
            (sum.0 + variance, sum.1 + cost)
        };
        self.records[class as usize].iter().fold((0.0, 0.0), sum)
    }

    /// Variance times cost of the group if the techniques of a class added `added`.
    fn product(&self, class: BounceClass, added: (f64, f64)) -> f64 {
        let before = self.added[class as usize];
        let variance = self.variance + added.0 - before.0;
        let cost = self.cost + added.1 - before.1;
        variance.max(LEAST_LEFT * self.variance) * cost
    }

    /// Sets the variance and cost that the techniques of a class add.
    fn set(&mut self, class: BounceClass, added: (f64, f64)) {
        let before = std::mem::replace(&mut self.added[class as usize], added);
        self.variance += added.0 - before.0;
        self.cost += added.1 - before.1;
    }
}

/// Variance and cost that the techniques of a class add to a pixel, by `rules`.
///
/// At the first vertex the counts are rounded by numbers that are spread evenly over the samples of
/// a pixel, so that only the variance of a technique's samples matters; later, their second moment.
fn added(class: BounceClass, records: &[Record], rules: &ClassCounts) -> (f64, f64) {
    let is_first = is_first(class);
    let mut differences = [0.0; Kind::COUNT];
    let (mut variance, mut cost) = (0.0, 0.0);
    for record in records {
        let (value, of_record) = record.value_and_cost(rules);
        cost += of_record;
        if is_first {
            differences[record.kind as usize] += if record.path == 0 { value } else { -value };
        } else {
            variance += 0.5 * value * value;
        }
    }
    variance += differences.iter().map(|&difference| half_square(difference)).sum::<f64>();
    // Of two paths.
    (variance, 0.5 * cost)
}

/// Mean over the groups of the logarithm of variance times cost, by other `rules` of a class.
fn objective(groups: &[Group], class: BounceClass, rules: &ClassCounts) -> f64 {
    let of =
        |group: &Group| group.product(class, group.added(class, rules)).max(f64::MIN_POSITIVE).ln();
    groups.iter().map(of).sum::<f64>() / groups.len() as f64
}

/// Traces paths at some pixels, which fall into groups.
fn measure(
    scene: &Scene,
    size: UVec2,
    context: PathContext<'_>,
    progress: Progress,
) -> Result<Vec<Group>> {
    let mut groups: Vec<Group> = (0..GROUPS).map(|_| Group::default()).collect();
    let (budget, mut pixels, mut spent) = (budget(size), 0, 0.0);
    while spent < budget && pixels < MOST_PIXELS {
        report(progress, (spent / budget) as f32)?;
        let pixel = PilotPixel::new(scene, size, pixels);
        let group = &mut groups[pixels as usize % GROUPS];
        let mut records: [Vec<Record>; BounceClass::COUNT] = Default::default();
        let values = [0, 1].map(|path| {
            let mut recorder = Recorder { path, cost: Cost::new(scene), records: &mut records };
            let sample = pixel.path(context, 0, FIRST_NUMBER + path, &mut recorder);
            let cost = 0.5 * recorder.cost.of(&sample);
            group.cost += cost;
            spent += cost;
            gray(sample.beauty())
        });
        group.variance += half_square(values[0] - values[1]);
        for (all, records) in group.records.iter_mut().zip(records) {
            if !records.is_empty() {
                all.push(records);
            }
        }
        pixels += 1;
    }
    groups.retain(|group| group.variance > 0.0);
    for group in &mut groups {
        group.added = BounceClass::ALL.map(|class| group.added(class, context.counts.at(class)));
    }
    Ok(groups)
}

/// First of the random numbers of these paths: those of the trials come before.
const FIRST_NUMBER: u32 = 16;

/// Keeps the contributions of a path.
#[derive(Debug)]
struct Recorder<'s> {
    path: u32,
    cost: Cost<'s>,
    records: &'s mut [Vec<Record>; BounceClass::COUNT],
}

impl Observer for Recorder<'_> {
    fn step(&mut self, step: PathStep) {
        self.cost.step(step);
        let (kind, contribution, technique) = match step {
            PathStep::Light { contribution, technique, fires, .. } => {
                let kind = if fires { Kind::FireSample } else { Kind::LampSample };
                (kind, contribution, technique)
            }
            PathStep::Emission { contribution, technique } => {
                (Kind::EmissionWalk, contribution, technique)
            }
            _ => return,
        };
        let (path, contribution) = (self.path, gray(contribution));
        if technique.class != BounceClass::Camera && contribution.is_finite() {
            let cost = self.cost.of_last_step();
            self.records[technique.class as usize].push(Record {
                kind,
                technique,
                path,
                contribution,
                cost,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::math::PathRng;

    /// Directions of a vertex: density of light samples, of rays, and the light that comes from
    /// there.
    const DIRECTIONS: [([f32; 2], f32); 3] =
        [([0.7, 0.1], 2.0), ([0.3, 0.3], 0.5), ([0.0, 0.6], 1.0)];
    const LATER: BounceClass = BounceClass::LaterInMedium;

    fn rules(fire_samples: f32, emission_walks: f32) -> ClassCounts {
        let rule = |per_throughput| CountRule { per_throughput, most: 1.0 };
        ClassCounts {
            fire_samples: rule(fire_samples),
            emission_walks: rule(emission_walks),
            ..*LearnedCounts::first(0.0).at(LATER)
        }
    }

    /// The finds of both techniques, one sample of each, drawn by their densities.
    fn finds(count: u32) -> Vec<Record> {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let mut find = |index: u32| {
            let own = (index % 2) as usize;
            let mut u = rng.uniform();
            let drawn = DIRECTIONS.iter().find(|(pdfs, _)| {
                u -= pdfs[own];
                u < 0.0
            });
            let (pdfs, light) = *drawn.unwrap_or(&DIRECTIONS[2 - own]);
            let technique = Technique {
                class: LATER,
                throughput: 0.5,
                share: 1.0,
                counts: [1.0, 1.0],
                pdfs: [pdfs[own], pdfs[1 - own]],
                collisions: 0,
            };
            let contribution = f64::from(light / (pdfs[0] + pdfs[1]));
            let kind = if own == 0 { Kind::FireSample } else { Kind::EmissionWalk };
            Record { kind, technique, path: 0, contribution, cost: 1.0 }
        };
        (0..count).map(&mut find).collect()
    }

    /// Finds with counts of one estimate ∫ (β f)²/(n · p) and the cost of any other counts.
    #[test]
    fn one_set_of_paths_tells_the_second_moment_of_any_counts() {
        const COUNT: u32 = 100_000;
        let records = finds(2 * COUNT);
        for (c, n) in
            [([8.0, 8.0], [1.0, 1.0]), ([0.5, 8.0], [0.25, 1.0]), ([1.0, 0.25], [0.5, 0.125])]
        {
            let (moment, cost) = added(LATER, &records, &rules(c[0], c[1]));
            let exact: f32 = DIRECTIONS
                .iter()
                .map(|(p, light)| light * light / (n[0] * p[0] + n[1] * p[1]))
                .sum();
            // Records stand for two paths of a pixel.
            let found = 2.0 * moment / f64::from(COUNT);
            assert!((found / f64::from(exact) - 1.0).abs() < 0.02, "{n:?}: {found} for {exact}");
            let found = 2.0 * cost / f64::from(COUNT);
            assert!((found - f64::from(n[0] + n[1])).abs() < 1e-3, "{n:?}: cost {found}");
        }
    }

    /// Samples that cost nothing keep their count; samples that cost much for their variance become
    /// rare.
    #[test]
    fn counts_fall_where_samples_cost_more_than_they_bring() {
        let learned = |cost: f64| {
            let mut records = finds(1000);
            records.iter_mut().filter(|r| r.kind == Kind::FireSample).for_each(|r| r.cost = cost);
            let mut group =
                Group { variance: 1e5, cost: 2000.0 + 250.0 * cost, ..Group::default() };
            group.records[LATER as usize] = vec![records];
            let mut best = LearnedCounts::first(0.0);
            group.added[LATER as usize] = group.added(LATER, best.at(LATER));
            improve(&mut [group], &mut best, LATER, Kind::FireSample);
            best.at(LATER).fire_samples.at(0.5)
        };
        assert_eq!(learned(0.0), 1.0);
        assert!(learned(100.0) < 0.1, "{}", learned(100.0));
    }
}
