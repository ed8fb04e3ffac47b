//! Numbers as people write them: with the digits that count. One function for each way of writing.

/// `value` rounded to so many digits that count, as short as it can be written.
pub fn rounded(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let decimals = digits - 1 - value.abs().log10().floor() as i32;
    let step = 10_f64.powi(decimals);
    let value = (value * step).round() / step;
    // The quotient is the double nearest to the decimal number, but for huge and tiny ones.
    if (1e-5..1e7).contains(&value.abs()) { value.to_string() } else { format!("{value:.1e}") }
}

/// `value` with so many decimals that it shows a hundredth of `step`, and no zeros at its end.
pub fn in_steps(value: f64, step: f64) -> String {
    let decimals = (2.0 - step.abs().max(1e-15).log10().floor()).clamp(0.0, 17.0);
    let text = format!("{value:.0$}", decimals as usize);
    let is_zero = value.abs() < 0.5 * 10_f64.powf(-decimals);
    match text.contains('.') {
        _ if is_zero => "0".to_owned(),
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// One part of `factor` parts, with two significant digits: 1/38.
pub fn one_part_of(factor: f64) -> String {
    format!("1/{}", rounded(factor, 2))
}

/// A size in memory: 12.3 MiB.
pub fn mebibytes(bytes: usize) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

/// A growing number of samples per pixel: 12.3 spp.
pub fn samples_per_pixel(samples: f64) -> String {
    format!("{samples:.1} spp")
}

/// The nearest of the numbers that one uses for rough figures: 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6 or 8
/// times a power of ten. The value must be above zero.
pub fn rough(value: f64) -> f64 {
    const STEPS: [f64; 10] = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];
    let decade = 10_f64.powf(value.log10().floor());
    let distance = |candidate: &f64| (candidate / value).ln().abs();
    let candidates = STEPS.into_iter().chain([10.0]).map(|step| step * decade);
    candidates.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(value)
}

/// A share in percent, with two digits that count.
pub fn percent(share: f64) -> String {
    format!("{} %", rounded(100.0 * share, 2))
}

/// `value` to two digits, as one would type it.
pub fn two_digits(value: f32) -> f32 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_count() {
        assert_eq!([0.0, 1.0, 38.2, 0.031_49].map(|x| rounded(x, 2)), ["0", "1", "38", "0.031"]);
        assert_eq!([1234.0, -0.000_12, 99.6].map(|x| rounded(x, 2)), ["1200", "-0.00012", "100"]);
        assert_eq!(rounded(1.234e-9, 3), "1.2e-9");
        assert_eq!((percent(0.018_34), percent(12.0)), ("1.8 %".to_owned(), "1200 %".to_owned()));
    }

    #[test]
    fn coordinates_have_the_decimals_of_a_voxel() {
        let far = [499_999.989_5, 500_000.010_5, 500_000.0].map(|x| in_steps(x, 0.001));
        assert_eq!(far, ["499999.9895", "500000.0105", "500000"]);
        assert_eq!([-0.650_000_04, 0.0, -1e-9].map(|x| in_steps(x, 0.1)), ["-0.65", "0", "0"]);
        assert_eq!([in_steps(1500.0, 1000.0), in_steps(0.5, 0.0)], ["1500", "0.5"]);
    }

    #[test]
    fn numbers_are_rounded_as_typed() {
        assert_eq!(two_digits(12.345), 12.0);
        assert_eq!(two_digits(0.034_56), 0.035);
        assert_eq!(two_digits(1234.0), 1200.0);
    }

    #[test]
    fn rough_numbers_are_round_in_any_decade() {
        let nearest = [38.2, 14.0, 0.9, 7.1, 0.001_3].map(rough);
        let expected = [40.0, 15.0, 1.0, 8.0, 0.0012];
        for (rough, expected) in std::iter::zip(nearest, expected) {
            assert!((rough / expected - 1.0).abs() < 1e-12, "{rough} for {expected}");
        }
        assert_eq!(one_part_of(38.2), "1/38");
        assert_eq!(
            (mebibytes(3 << 19), samples_per_pixel(2.5)),
            ("1.5 MiB".to_owned(), "2.5 spp".to_owned())
        );
    }
}
