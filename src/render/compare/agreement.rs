//! Whether two films show the same picture, as far as their noise lets one tell.
//!
//! Every setting but ray marching converges to the same picture, so a difference beyond the noise
//! is news: a biased setting, or a fault.

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::tally::Tally;
use crate::math::ACCUMULATORS;
use crate::render::area::Area;

/// Probability of a false alarm in one check of all blocks: that settings which agree are said to
/// differ.
pub const ALARM: f64 = 1.0e-3;

/// Fewest samples of any pixel for a verdict: one for each accumulator.
pub const FEWEST_SAMPLES: u32 = ACCUMULATORS as u32;

/// Differences below this share of the brightness may come of rounding to `f32` along the path.
pub(super) const ROUNDING: f64 = 1.0e-5;

/// The outcome of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Some pixels have too few samples for a verdict.
    TooFewSamples,
    /// The films agree: no difference stands out from the noise.
    Agree,
    /// Some difference stands out from the noise.
    Differ,
}

/// The difference of two films over an area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Region of the compared pixels.
    pub area: Area,
    /// Mean gray of A and of B.
    pub means: [f64; 2],
    /// Standard error of the difference of the means.
    pub standard_error: f64,
    /// The probability of a difference as large as this between settings that agree.
    pub probability: f64,
}

impl Difference {
    /// The difference over one area with these sums; `all` are those of the whole films. `None`
    /// without pixels.
    ///
    /// Means of many pixels are normal enough, but their variances are only estimated, and where
    /// few pixels make most of the noise not even well: Student's t with as many degrees of freedom
    /// as 2 V² / Var(V) says (Satterthwaite, "An Approximate Distribution of Estimates of Variance
    /// Components", 1946). Light that is rare may not have been met in an area at all, which then
    /// seems free of noise; so each area is taken to hide one pixel as noisy as the noisiest of its
    /// film, in the spirit of Laplace's rule of succession.
    fn new(area: &Area, sums: &[Tally; 2], all: &[Tally; 2]) -> Option<Self> {
        if sums.iter().any(|sum| sum.measured == 0) {
            return None;
        }
        let means = [0, 1].map(|side| sums[side].gray / sums[side].measured as f64);
        let (mut variance, mut uncertainty) = (0.0, 0.0);
        for side in 0..2 {
            let pixels = sums[side].measured as f64;
            let hidden = all[side].largest_variance;
            variance += (sums[side].variance + hidden) / (pixels * pixels);
            uncertainty += (sums[side].uncertainty + hidden * hidden) / pixels.powi(4);
        }
        let rounding = ROUNDING * means[0].abs().max(means[1].abs());
        let standard_error = (variance + rounding * rounding).sqrt();
        let freedom = 2.0 * variance * variance / uncertainty;
        let distance = (means[0] - means[1]).abs() / standard_error;
        let probability = two_sided(distance, freedom);
        Some(Self { area: *area, means, standard_error, probability })
    }

    /// Difference of A from B in standard errors, above 0 where A is brighter.
    pub fn standard_errors(&self) -> f64 {
        let difference = self.means[0] - self.means[1];
        if difference == 0.0 { 0.0 } else { difference / self.standard_error }
    }
}

/// The probability of more than `distance` standard errors to either side, with so many degrees of
/// freedom. Where there is neither a distance nor an error there is no difference.
fn two_sided(distance: f64, freedom: f64) -> f64 {
    // More than this many are as good as any number, and what cannot be told is not held against
    // the films.
    let freedom = if freedom > 0.0 { freedom.clamp(1.0, 1.0e6) } else { 1.0e6 };
    let student = StudentsT::new(0.0, 1.0, freedom);
    match student {
        Ok(student) if !distance.is_nan() => (2.0 * student.sf(distance)).min(1.0),
        _ => 1.0,
    }
}

/// Whether two films show the same picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// Verdict of the check.
    pub verdict: Verdict,
    /// The difference over the whole area; none where it has no pixel with a variance.
    pub overall: Option<Difference>,
    /// The difference over the block where one is least likely to be chance.
    pub worst: Option<Difference>,
    /// Number of tests made: one for each block, and one for all of them together.
    pub tests: usize,
    /// A difference less probable than this is taken to be real: the chance of a false alarm
    /// shared out over the tests (Bonferroni), for which they need not be independent.
    pub limit: f64,
}

impl Agreement {
    /// Checks an area with its sums and its blocks with theirs, with the chance `alarm` of a false
    /// alarm.
    pub(super) fn new(
        (area, all): (&Area, &[Tally; 2]),
        blocks: &[Area],
        tallies: &[[Tally; 2]],
        alarm: f64,
    ) -> Self {
        let overall = Difference::new(area, all, all);
        let parts: Vec<Difference> = match blocks.len() {
            // The one block is the whole.
            ..=1 => Vec::new(),
            _ => std::iter::zip(blocks, tallies)
                .filter_map(|(block, sums)| Difference::new(block, sums, all))
                .collect(),
        };
        let tests = parts.len() + usize::from(overall.is_some());
        let limit = alarm / tests.max(1) as f64;
        let by_probability =
            |a: &Difference, b: &Difference| a.probability.total_cmp(&b.probability);
        let worst = parts.into_iter().min_by(by_probability).or(overall);
        let enough = all.iter().all(|sum| sum.fewest_samples >= FEWEST_SAMPLES);
        let is_real = |difference: &Difference| difference.probability < limit;
        let verdict = match (enough, overall) {
            (true, Some(overall)) => {
                match is_real(&overall) || worst.as_ref().is_some_and(is_real) {
                    true => Verdict::Differ,
                    false => Verdict::Agree,
                }
            }
            _ => Verdict::TooFewSamples,
        };
        Self { verdict, overall, worst, tests, limit }
    }
}
