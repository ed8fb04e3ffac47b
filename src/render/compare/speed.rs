//! Speed-up of one setting over another, and the sentence that states it.

use super::side_figures::SideFigures;
use crate::format::{one_part_of, rough};
use crate::render::estimate::FEWEST_FOR_VARIANCE;

/// Standard errors on either side of an estimate that hold the truth with 95 %.
const CONFIDENCE: f64 = 1.96;

/// Relative error of the ratio of two CPU times: the same work repeats to about this, also when
/// both sides alternate.
const TIMING_ERROR: f64 = 0.03;

/// Factor of the 95 % interval beyond which a ratio is not said to be a tie: it is unknown.
const TOO_WIDE: f64 = 1.5;

/// Speed-up of B over A, the factor by which it reaches a given noise faster: the ratio of their
/// variances times their CPU times, as variance falls with the inverse of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedUp {
    /// The time that A needs over that of B; below 1 where A is the faster.
    pub ratio: f64,
    /// Standard error of the logarithm of the ratio, nearly the relative error of the ratio.
    pub log_error: f64,
}

impl SpeedUp {
    /// The speed-up from `a` to `b`; none where one has no noise or no measured time, or where only
    /// some of its pixels have the samples that it takes to know their variance: the noise of one
    /// part of the picture says nothing of another.
    ///
    /// The error is that of the estimated variances, and of the clock.
    pub fn new(a: &SideFigures, b: &SideFigures) -> Option<Self> {
        if a.fewest_samples.min(b.fewest_samples) < FEWEST_FOR_VARIANCE {
            return None;
        }
        let ((a, error_a), (b, error_b)) = (a.variance_times_time()?, b.variance_times_time()?);
        let log_error = error_a.hypot(error_b).hypot(TIMING_ERROR);
        let ratio = a / b;
        (ratio > 0.0 && ratio.is_finite()).then_some(Self { ratio, log_error })
    }

    /// Standard error of the ratio.
    pub fn standard_error(&self) -> f64 {
        self.ratio * self.log_error
    }

    /// The interval that holds the true ratio with 95 %.
    pub fn interval(&self) -> [f64; 2] {
        let factor = self.factor();
        [self.ratio / factor, self.ratio * factor]
    }

    /// Whether one side is faster with 95 % confidence.
    pub fn is_clear(&self) -> bool {
        let [low, high] = self.interval();
        low > 1.0 || high < 1.0
    }

    /// Whether the ratio is too uncertain to call a tie.
    pub fn is_vague(&self) -> bool {
        !self.is_clear() && self.factor() > TOO_WIDE
    }

    /// The time of the faster side as a share of the other's, with the digits that are known: 1/38,
    /// about 75 %.
    pub fn share(&self) -> String {
        let factor = self.ratio.max(1.0 / self.ratio);
        let spread = self.factor();
        if factor < 2.0 {
            return percents(factor, spread);
        }
        if spread <= 1.1 {
            one_part_of(factor)
        } else if spread <= 1.6 {
            format!("about {}", one_part_of(rough(factor)))
        } else {
            let [low, high] = [factor / spread, factor * spread].map(rough);
            format!("between {} and {}", one_part_of(high), one_part_of(low))
        }
    }

    /// Factor between the ratio and the ends of its confidence interval.
    fn factor(&self) -> f64 {
        (CONFIDENCE * self.log_error).exp()
    }
}

/// See [`Comparison::sentence`](super::Comparison::sentence).
pub(super) fn sentence(sides: &[SideFigures; 2], speed_up: Option<&SpeedUp>) -> String {
    match speed_up {
        Some(speed_up) if speed_up.is_clear() => {
            let (winner, loser) = if speed_up.ratio > 1.0 { ("B", "A") } else { ("A", "B") };
            let share = speed_up.share();
            format!("{winner} needs {share} of {loser}'s time for the same noise")
        }
        Some(speed_up) if speed_up.is_vague() => {
            "It is too early to tell which of A and B is faster".to_owned()
        }
        Some(_) => "No measurable difference in speed between A and B".to_owned(),
        None => unknown(sides),
    }
}

/// Reason why no speed-up is known.
fn unknown(sides: &[SideFigures; 2]) -> String {
    match [0, 1].map(|side| sides[side].is_noiseless()) {
        [true, true] => "Neither A nor B has any noise",
        [true, false] => "A has no noise, so times cannot be compared",
        [false, true] => "B has no noise, so times cannot be compared",
        [false, false] => "There are too few samples to compare A and B",
    }
    .to_owned()
}

/// A share of more than a half: 77 %, about 75 %, between 60 and 90 %.
fn percents(factor: f64, spread: f64) -> String {
    let share = 100.0 / factor;
    let fives = |value: f64| 5.0 * (value / 5.0).round();
    if spread <= 1.03 {
        format!("{share:.0} %")
    } else if spread <= 1.15 {
        format!("about {:.0} %", fives(share).min(95.0))
    } else {
        // The other end is below 100 %, as the case is clear.
        let (low, high) = (fives(share / spread), fives(share * spread).min(95.0));
        format!("between {low:.0} and {high:.0} %")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sentence_of(ratio: f64, log_error: f64) -> String {
        sentence(&[SideFigures::default(); 2], Some(&SpeedUp { ratio, log_error }))
    }

    #[test]
    fn sentences_round_to_what_is_known() {
        let b = |share: &str| format!("B needs {share} of A's time for the same noise");
        for (ratio, log_error, share) in [
            (38.2, 0.02, "1/38"),
            (3.84, 0.03, "1/3.8"),
            (4.01, 0.03, "1/4"),
            (1234.0, 0.04, "1/1200"),
            (38.2, 0.15, "about 1/40"),
            (14.0, 0.2, "about 1/15"),
            (38.2, 0.4, "between 1/80 and 1/20"),
            (1.3, 0.01, "77 %"),
            (1.3, 0.05, "about 75 %"),
            (1.5, 0.1, "between 55 and 80 %"),
            (1.02, 0.008, "98 %"),
        ] {
            assert_eq!(sentence_of(ratio, log_error), b(share), "{ratio} with {log_error}");
        }
        let expected = "A needs 1/38 of B's time for the same noise";
        assert_eq!(sentence_of(1.0 / 38.2, 0.02), expected);
        assert_eq!(sentence_of(1.05, 0.05), "No measurable difference in speed between A and B");
        assert!(sentence_of(1.3, 0.3).starts_with("It is too early"));
    }

    #[test]
    fn without_noise_or_samples_there_is_nothing_to_compare() {
        let silent = SideFigures {
            fewest_samples: 2,
            variance_of_mean: Some(0.0),
            cpu_seconds: 1.0,
            ..SideFigures::default()
        };
        let noisy =
            SideFigures { variance_of_mean: Some(1.0), variance_error: Some(0.1), ..silent };
        assert_eq!(SpeedUp::new(&silent, &noisy), None);
        assert!(sentence(&[silent, noisy], None).starts_with("A has no noise"));
        assert!(sentence(&[noisy, silent], None).starts_with("B has no noise"));
        assert!(sentence(&[silent; 2], None).starts_with("Neither"));
        assert!(sentence(&[SideFigures::default(); 2], None).contains("too few samples"));
        let timeless = SideFigures { cpu_seconds: 0.0, ..noisy };
        let partly = SideFigures { fewest_samples: 1, ..noisy };
        assert_eq!(SpeedUp::new(&partly, &noisy), None, "the noise of one part of the picture");
        assert_eq!(SpeedUp::new(&timeless, &noisy), None);
    }
}
