//! A logarithmic axis of a drawing.

/// The least that an axis spans, as a factor.
const LEAST_SPAN: f64 = 3.0;
/// Margin on both sides of the values, as a factor.
const MARGIN: f64 = 1.15;

/// A logarithmic axis.
pub(super) struct LogAxis {
    low: f64,
    high: f64,
    /// Pixels of the two ends.
    pixels: [i32; 2],
}

impl LogAxis {
    /// An axis over `values`, all of them positive, between two pixels.
    pub fn over(values: impl Iterator<Item = f64>, pixels: [i32; 2]) -> Self {
        let (low, high) =
            values.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
        let widened = (LEAST_SPAN * low / high).max(1.0).sqrt() * MARGIN;
        Self { low: low / widened, high: high * widened, pixels }
    }

    /// The place of a value.
    pub fn pixel(&self, value: f64) -> i32 {
        let place = (value / self.low).ln() / (self.high / self.low).ln();
        let [start, end] = self.pixels.map(f64::from);
        (start + place * (end - start)).round() as i32
    }

    /// Numbers to write along the axis: 1, 2 and 5 times powers of ten, or the powers alone where
    /// those would be too many.
    pub fn ticks(&self) -> Vec<f64> {
        let decades = (self.high / self.low).log10();
        let steps: &[f64] = if decades <= 3.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let powers = self.low.log10().floor() as i32..=self.high.log10().ceil() as i32;
        let all = powers.flat_map(|power| steps.iter().map(move |step| step * 10_f64.powi(power)));
        all.filter(|tick| (self.low..=self.high).contains(tick)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_on_the_axis() {
        let ticks = |low, high| LogAxis { low, high, pixels: [0, 100] }.ticks();
        let close = |a: Vec<f64>, b: &[f64]| {
            assert_eq!(a.len(), b.len(), "{a:?}");
            assert!(a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-9), "{a:?}");
        };
        close(ticks(0.15, 12.0), &[0.2, 0.5, 1.0, 2.0, 5.0, 10.0]);
        close(ticks(0.003, 90.0), &[0.01, 0.1, 1.0, 10.0]);
    }
}
