//! A group-sequential z-test of a mean against a value: it looks after each batch of samples and
//! stops as soon as the mean is clearly right or clearly wrong.
//!
//! The fixed test that it stands for asks for |z| ≤ 5 at a standard error of `power`, relative to
//! the expected value: α = 5.7e-7, and a deviation of δ = (5 + 2.326) · `power` is found with
//! probability 99 % (δ = 3.7 % for the usual power of 0.5 %).
//!
//! With s the standard error at a look, u = δ/s says how far the samples have come; 8.1 is the end.
//! The information, 1/s², grows with the square of u: t = (u/8.1)².
//!
//! - *Clearly wrong*: |z| > 7 at any look, |z| > 5 at the end. All of α but 2.6e-12 a look is spent
//!   at the end (Haybittle and Peto), so that looking costs no false alarms. What is found wrong has
//!   to be so by four times as many samples as well, where there may be more: a few thousand paths
//!   can all miss what is rare and bright, and then know little of their variance.
//! - *Clearly right*: |z| ≤ u − a(b), a(b) the normal quantile of 1 − b: the confidence interval of
//!   the mean excludes deviations of δ and more at level b. A deviation of δ is let through with
//!   probability b at most. The looks share β = 0.9 %, by the function β (1 − (1 − t)³) of Hwang,
//!   Shih and DeCani: b is what it grew by since the look before. At the end another 0.1 % is due,
//!   Φ(5 − 8.1).
//!
//! Simulated with looks at u = 3.3, 4, 5, 6.3 and 8.1, deviations of δ/2, 0.68 δ, 0.8 δ and δ are
//! found with probability 0.15, 0.65, 0.90 and 0.993, where the fixed test finds them with 0.09, 0.50,
//! 0.81 and 0.99. Where nothing is wrong it takes 0.30 of the fixed test's samples on average.

use statrs::distribution::{ContinuousCDF, Normal};

/// |z| up to which a measurement counts as agreeing.
pub const Z_LIMIT: f64 = 5.0;
/// |z| beyond which a look needs no more samples to tell an error.
const Z_AT_ONCE: f64 = 7.0;
/// Quantile of the normal distribution at 99 %, the fixed test's power.
const QUANTILE: f64 = 2.326;
/// δ over the standard error at the last look.
const LAST: f64 = 8.1;
/// δ over the standard error where looks are planned.
const LOOKS: [f64; 5] = [3.3, 4.0, 5.0, 6.3, LAST];
/// Probability with which a deviation of δ is let through before the last look.
const BETA: f64 = 0.009;

/// How one comparison stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// More samples are needed.
    Open,
    /// The mean is the expected value, or so near that it doesn't matter.
    Right,
    /// It is another.
    Wrong,
}

/// One comparison on its way.
#[derive(Clone, Copy, Debug)]
pub struct Comparison {
    /// δ, relative to the expected value.
    difference: f64,
    /// Share of β that the looks so far have spent.
    spent: f64,
    /// How it stands.
    pub verdict: Verdict,
}

impl Comparison {
    /// In place of a fixed test at a standard error of `power`, relative to the expected value.
    pub fn of_power(power: f64) -> Self {
        Self { difference: (Z_LIMIT + QUANTILE) * power, spent: 0.0, verdict: Verdict::Open }
    }

    /// Looks at a relative `deviation` from the expected value with its standard error.
    pub fn look(&mut self, deviation: f64, error: f64) {
        if self.verdict != Verdict::Open {
            return;
        }
        let (z, u) = (deviation.abs() / error, self.difference / error);
        let left = 1.0 - (u / LAST).powi(2);
        if left <= 0.0 {
            let right = z <= Z_LIMIT;
            self.verdict = if right { Verdict::Right } else { Verdict::Wrong };
            return;
        }
        let spent = BETA * (1.0 - left.powi(3));
        let normal = Normal::standard();
        if z > Z_AT_ONCE {
            self.verdict = Verdict::Wrong;
        } else if spent > self.spent && z <= u + normal.inverse_cdf(spent - self.spent) {
            self.verdict = Verdict::Right;
        }
        self.spent = self.spent.max(spent);
    }

    /// Looks for the last time, when there are no more samples to be had: decides as the fixed test
    /// does, and stays open where its power is missed.
    pub fn end(&mut self, deviation: f64, error: f64) {
        if self.verdict == Verdict::Open && self.difference / error >= Z_LIMIT + QUANTILE {
            let right = deviation.abs() <= Z_LIMIT * error;
            self.verdict = if right { Verdict::Right } else { Verdict::Wrong };
        }
    }

    /// Takes back that the mean is wrong where more samples don't say so.
    pub fn confirm(&mut self, deviation: f64, error: f64) {
        if self.verdict == Verdict::Wrong && deviation.abs() <= Z_LIMIT * error {
            self.verdict = Verdict::Open;
            self.end(deviation, error);
        }
    }

    /// The relative standard error to go on to from a look at `error`.
    pub fn next_error(&self, error: f64) -> f64 {
        // A look that falls short of its plan by a little has been at it.
        const NEARLY: f64 = 1.02;
        let u = NEARLY * self.difference / error;
        let next = LOOKS.into_iter().find(|look| *look > u).unwrap_or(LAST);
        self.difference / next
    }
}

/// Of ten thousand simulated comparisons each: the false alarms are none, errors of δ are let
/// through in less than one of a hundred, and where nothing is wrong a third of the fixed test's
/// samples are taken.
#[test]
fn the_test_holds_its_levels() {
    use flambeau::math::PathRng;
    const RUNS: u32 = 10_000;
    let simulate = |deviation: f64| {
        let (mut wrong, mut information) = (0, 0.0);
        for run in 0..RUNS {
            let mut rng = PathRng::new(0, glam::UVec2::new(run, 0), 0);
            let mut comparison = Comparison::of_power(1.0 / (Z_LIMIT + QUANTILE));
            let (mut score, mut before, mut error) = (0.0, 0.0, 1.0);
            while comparison.verdict == Verdict::Open {
                error = comparison.next_error(error);
                let now = 1.0 / (error * error);
                let step: f64 = now - before;
                let u = f64::from(rng.uniform()).clamp(1e-7, 1.0 - 1e-7);
                score += step.sqrt() * Normal::standard().inverse_cdf(u) + deviation * step;
                before = now;
                comparison.look(score / now, error);
            }
            wrong += u32::from(comparison.verdict == Verdict::Wrong);
            information += before / f64::from(RUNS);
        }
        (f64::from(wrong) / f64::from(RUNS), information / (Z_LIMIT + QUANTILE).powi(2))
    };
    let (alarms, share) = simulate(0.0);
    assert!(alarms == 0.0 && share < 0.34, "{alarms} false alarms, {share} of the samples");
    for (deviation, least) in [(0.5, 0.09), (0.68, 0.50), (0.8, 0.81), (1.0, 0.99)] {
        let (found, _) = simulate(deviation);
        assert!(found >= least, "{deviation} δ is found with {found}");
    }
}
