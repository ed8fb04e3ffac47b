//! Comparisons gathered: each on its own, and all that share a choice together.
//!
//! A single setting is held to an error of a few per cent (see [`super::sequential`]). What is
//! wrong with a technique is wrong in every setting that has it, so that the settings with one
//! choice, and those with a pair of choices, are pooled as well: with deviations dᵢ and information
//! Iᵢ = 1/sᵢ², z = Σ Iᵢ dᵢ / √(Σ Iᵢ). Each Iᵢ dᵢ is a score, a martingale in the samples, so that
//! its variance is the mean of Iᵢ however the samples' number was decided (Wald's second identity).
//! Sixteen settings with half of them sharing a choice find errors of it that are a third as large.
//! Settings have seeds of their own, which is what makes their errors independent.

use flambeau::error::NO_PROGRESS;
use std::collections::{BTreeMap, BTreeSet};

use flambeau::{
    math::{ACCUMULATORS, Rgb},
    transport::{PathSample, Scene, learned_counts::LearnedCounts, strategy::Strategy},
};

use statrs::distribution::{ContinuousCDF, Normal};

use super::{
    Estimate, POWER, Rows, SIDE, choices_of, framed_by_seed,
    sequential::{Comparison, Verdict, Z_LIMIT},
};

/// Relative rounding of single precision in answers that come without noise.
const ROUNDING: f64 = 2e-5;
/// Fewest settings that are pooled.
const FEW: usize = 2;
/// Probability of a false alarm of all pools of a test together, shared evenly (Bonferroni).
const POOLED_ALPHA: f64 = 1e-4;

/// Values to hold estimates against: of the channels, from the first on, or of other quantities.
#[derive(Clone, Debug)]
pub struct Expected {
    values: Vec<f64>,
    /// Standard errors relative to the values, where they were measured themselves.
    errors: Vec<f64>,
    /// How many of them, from the first on, are looked at until a verdict; the others come along.
    decisive: usize,
}

impl Expected {
    /// A value that is known, channel by channel.
    pub fn known(values: &[f64]) -> Self {
        let errors = vec![0.0; values.len()];
        Self { values: values.to_vec(), errors, decisive: values.len() }
    }

    /// A value that was measured.
    pub fn measured(estimate: &Estimate) -> Self {
        Self::measured_all(&channels_of(estimate))
    }

    /// Values that were measured, each with its variance.
    pub fn measured_all(found: &[[f64; 2]]) -> Self {
        let values: Vec<f64> = found.iter().map(|[mean, _]| *mean).collect();
        let errors = found.iter().map(|[mean, variance]| variance.sqrt() / mean.abs()).collect();
        Self { decisive: values.len(), values, errors }
    }

    /// The same, of which the first few alone are looked at until a verdict.
    pub fn deciding(self, decisive: usize) -> Self {
        Self { decisive, ..self }
    }
}

/// How one quantity of one setting came out.
struct Record {
    choices: BTreeSet<String>,
    number: usize,
    /// From the expected value, relative to it.
    deviation: f64,
    information: f64,
    /// The expected value, by its place among those of the test, and its own relative error.
    expected: (usize, f64),
}

/// Comparisons gathered, so that one run shows all that fail.
pub struct Verdicts {
    failures: Vec<String>,
    count: usize,
    power: f64,
    measured: u64,
    expected: Vec<Vec<f64>>,
    records: Vec<Record>,
}

impl Default for Verdicts {
    fn default() -> Self {
        Self::of_power(POWER)
    }
}

impl Verdicts {
    /// Comparisons whose standard error may be as large as `power`, relative to what is expected.
    pub fn of_power(power: f64) -> Self {
        Self {
            failures: Vec::new(),
            count: 0,
            power,
            measured: 0,
            expected: Vec::new(),
            records: Vec::new(),
        }
    }

    /// Holds the mean radiance of a scene against a value, by as many paths as it takes to tell and
    /// about `most` at most.
    pub fn hold(&mut self, label: &str, scene: &Scene, most: u32, expected: &Expected) {
        self.hold_part(label, scene, most, expected, PathSample::beauty);
    }

    /// The same of what `of` takes from each path.
    pub fn hold_part(
        &mut self,
        label: &str,
        scene: &Scene,
        most: u32,
        expected: &Expected,
        of: impl Fn(&PathSample) -> Rgb + Sync,
    ) {
        let frame = framed_by_seed(scene, SIDE, self.next_seed());
        let mut rows = Rows::default();
        self.follow(label, scene.strategy(), most / (SIDE * SIDE), expected, |samples| {
            rows.add(samples, |_| &frame, &of);
            channels_of(&rows.estimate())
        });
    }

    /// Holds the mean radiance of a scene whose paths have given expected counts.
    pub fn hold_counts(
        &mut self,
        label: &str,
        scene: &Scene,
        counts: LearnedCounts,
        most: u32,
        expected: &Expected,
    ) {
        let frame = framed_by_seed(scene, SIDE, self.next_seed());
        let frame = frame.frame().clone().with_counts(counts, NO_PROGRESS).unwrap();
        let mut rows = Rows::default();
        self.follow(label, scene.strategy(), most / (SIDE * SIDE), expected, |samples| {
            rows.add(samples, |_| &frame, PathSample::beauty);
            channels_of(&rows.estimate())
        });
    }

    /// Holds the mean radiance where scenes take turns, each with as many of the samples.
    pub fn hold_in_turn(&mut self, label: &str, scenes: &[Scene], most: u32, expected: &Expected) {
        let seed = self.next_seed();
        let frames: Vec<_> = scenes.iter().map(|scene| framed_by_seed(scene, SIDE, seed)).collect();
        let mut rows = Rows::default();
        self.follow(label, scenes[0].strategy(), most / (SIDE * SIDE), expected, |samples| {
            let turn = |s: u32| (s / ACCUMULATORS as u32) as usize % frames.len();
            rows.add(samples, |s| &frames[turn(s)], PathSample::beauty);
            channels_of(&rows.estimate())
        });
    }

    /// The seed of the next setting; 0 is that of what they are held against.
    pub fn next_seed(&mut self) -> u64 {
        self.measured += 1;
        self.measured
    }

    /// Holds quantities of a setting, each with its mean and variance as `measure` finds them by so
    /// many samples a pixel, against what is expected of them, by as many samples as it takes to
    /// tell and about `most` at most.
    pub fn follow(
        &mut self,
        label: &str,
        strategy: &Strategy,
        most: u32,
        expected: &Expected,
        mut measure: impl FnMut(u32) -> Vec<[f64; 2]>,
    ) {
        const ROUND: u32 = ACCUMULATORS as u32;
        let most = most.div_ceil(ROUND).max(1) * ROUND;
        let mut comparisons = vec![Comparison::of_power(self.power); expected.decisive];
        let mut samples = ROUND;
        let mut found = deviations(&measure(samples), expected);
        while let Some(factor) = look_at(&mut comparisons, &found, samples >= most) {
            let wanted = (f64::from(samples) * factor) as u32;
            samples = (wanted.max(samples + 1).div_ceil(ROUND) * ROUND).min(most);
            found = deviations(&measure(samples), expected);
        }
        if comparisons.iter().any(|one| one.verdict == Verdict::Wrong) && samples < most {
            // Few samples may all have missed what is rare and bright, and say little of their
            // variance: what is wrong has to be so by four times as many.
            samples = (4 * samples).min(most);
            found = deviations(&measure(samples), expected);
            for (comparison, quantity) in comparisons.iter_mut().zip(&found) {
                comparison.confirm(quantity.deviation, quantity.error());
            }
        }
        let told = format!("{label} by {samples} samples");
        self.record(&told, strategy, &comparisons, &found, expected);
    }

    fn record(
        &mut self,
        label: &str,
        strategy: &Strategy,
        comparisons: &[Comparison],
        found: &[Quantity],
        expected: &Expected,
    ) {
        let place = self.expected.iter().position(|values| *values == expected.values);
        let place = place.unwrap_or_else(|| {
            self.expected.push(expected.values.clone());
            self.expected.len() - 1
        });
        let choices = choices_of(strategy);
        for (number, quantity) in found.iter().enumerate() {
            self.count += 1;
            let z = quantity.deviation / quantity.error();
            let told = format!(
                "{label}, {number}: {:+.3} % ± {:.3} % of {:.6}, z {z:.2}",
                100.0 * quantity.deviation,
                100.0 * quantity.error(),
                expected.values[number],
            );
            println!("{told}");
            match comparisons.get(number).map(|comparison| comparison.verdict) {
                Some(Verdict::Right) => {}
                Some(Verdict::Open) => self.failures.push(format!("{told}: too weak")),
                // What only comes along has no power of its own.
                None if z.abs() <= Z_LIMIT => {}
                Some(Verdict::Wrong) | None => self.failures.push(told),
            }
            self.records.push(Record {
                choices: choices.clone(),
                number,
                deviation: quantity.deviation,
                information: 1.0 / (quantity.own * quantity.own),
                expected: (place, quantity.given),
            });
        }
    }

    /// Panics with every failure, of single settings and of all that share a choice or two.
    pub fn finish(mut self) {
        assert!(self.count > 0, "nothing was compared");
        let pools = self.pools();
        let found: Vec<(String, f64, f64)> =
            pools.iter().flat_map(|(name, members)| self.deviations_of(name, members)).collect();
        // So that all of them together raise a false alarm with a probability of POOLED_ALPHA.
        let tail = 0.5 * POOLED_ALPHA / found.len().max(1) as f64;
        let limit = -Normal::standard().inverse_cdf(tail);
        for (name, deviation, error) in found {
            let z = deviation / error;
            let [deviation, error] = [deviation, error].map(|share| 100.0 * share);
            let told = format!("{name}: {deviation:+.3} % ± {error:.3} %, z {z:.2}");
            if z.abs() > limit {
                self.failures.push(told);
            } else if !name.contains(" and ") {
                println!("{told}");
            }
        }
        assert!(self.failures.is_empty(), "{}", self.failures.join("\n"));
    }

    /// By how much a pool is off its expected values, and where those were measured by how much it
    /// is off all others; each with its standard error.
    fn deviations_of(&self, name: &str, members: &[&Record]) -> Vec<(String, f64, f64)> {
        let (deviation, error) = pooled(members, &[]);
        let mut found = vec![(format!("all with {name}"), deviation, error)];
        if members.iter().any(|one| one.expected.1 > 0.0) {
            let same = |one: &&Record| one.number == members[0].number;
            let is_member =
                |one: &&Record| members.iter().any(|member| std::ptr::eq(*member, *one));
            let rest = self.records.iter().filter(same).filter(|one| !is_member(one));
            let rest: Vec<&Record> = rest.collect();
            if rest.len() >= FEW {
                let (deviation, error) = pooled(members, &rest);
                found.push((format!("all with {name} against the rest"), deviation, error));
            }
        }
        found
    }

    /// The records of each quantity that share nothing in particular, one choice or two.
    fn pools(&self) -> Vec<(String, Vec<&Record>)> {
        let mut pools: BTreeMap<(usize, String), Vec<&Record>> = BTreeMap::new();
        for record in &self.records {
            let mut add = |name: String| {
                pools.entry((record.number, name)).or_default().push(record);
            };
            add("any setting".to_owned());
            for (i, one) in record.choices.iter().enumerate() {
                add(one.clone());
                record.choices.iter().skip(i + 1).for_each(|two| add(format!("{one} and {two}")));
            }
        }
        // Choices that come together are one pool.
        let mut distinct: Vec<(String, Vec<&Record>)> = Vec::new();
        for ((number, name), members) in pools {
            let same = |other: &(String, Vec<&Record>)| {
                other.1.len() == members.len()
                    && std::iter::zip(&other.1, &members).all(|(a, b)| std::ptr::eq(*a, *b))
            };
            if members.len() >= FEW && !distinct.iter().any(same) {
                distinct.push((format!("{name}, {number}"), members));
            }
        }
        distinct
    }
}

/// The mean deviation of some settings, or its difference from that of others, with its standard
/// error. Expected values that were measured err alike in all that share them.
fn pooled(members: &[&Record], rest: &[&Record]) -> (f64, f64) {
    let mut weights: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    let (mut deviation, mut variance) = (0.0, 0.0);
    for (records, sign) in [(members, 1.0), (rest, -1.0)] {
        let total: f64 = records.iter().map(|one| one.information).sum();
        for one in records {
            let weight = sign * one.information / total;
            deviation += weight * one.deviation;
            let entry = weights.entry(one.expected.0).or_insert((0.0, one.expected.1));
            entry.0 += weight;
        }
        if total > 0.0 {
            variance += 1.0 / total;
        }
    }
    variance += weights.values().map(|(weight, error)| (weight * error).powi(2)).sum::<f64>();
    // Rounding may be the same in all of them.
    (deviation, variance.sqrt().hypot(ROUNDING))
}

/// Looks at all quantities that are to be decided; by how much to multiply the samples for the next
/// look, if one of them is still open and this was not the `last` one.
fn look_at(comparisons: &mut [Comparison], found: &[Quantity], last: bool) -> Option<f64> {
    let mut most: Option<f64> = None;
    for (comparison, quantity) in comparisons.iter_mut().zip(found) {
        comparison.look(quantity.deviation, quantity.error());
        if last {
            comparison.end(quantity.deviation, quantity.error());
        } else if comparison.verdict == Verdict::Open {
            let factor = quantity.samples_factor(comparison.next_error(quantity.error()));
            most = Some(most.unwrap_or(0.0).max(factor.min(4.0)));
        }
    }
    most
}

/// A quantity relative to what is expected.
struct Quantity {
    deviation: f64,
    /// Standard error of the estimate.
    own: f64,
    /// Standard error of the expected value.
    given: f64,
}

impl Quantity {
    fn error(&self) -> f64 {
        self.own.hypot(self.given)
    }

    /// By how much to multiply the samples so that the error of both is `wanted`.
    fn samples_factor(&self, wanted: f64) -> f64 {
        // Of an expected value that is as bad as that, half is as good as it gets.
        let least = 0.5 * self.given;
        let own = (wanted * wanted - self.given * self.given).max(least * least).sqrt();
        1.02 * (self.own / own).powi(2)
    }
}

fn deviations(found: &[[f64; 2]], expected: &Expected) -> Vec<Quantity> {
    let quantity = |(([mean, variance], value), given): ((&[f64; 2], &f64), &f64)| Quantity {
        deviation: (mean - value) / value,
        own: (variance.sqrt() / value.abs()).hypot(ROUNDING),
        given: *given,
    };
    found.iter().zip(&expected.values).zip(&expected.errors).map(quantity).collect()
}

fn channels_of(estimate: &Estimate) -> Vec<[f64; 2]> {
    std::iter::zip(estimate.mean, estimate.variance)
        .map(|(mean, variance)| [mean, variance])
        .collect()
}
