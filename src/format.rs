//! Numbers as people write them: with the digits that count.

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
    fn numbers_are_rounded_as_typed() {
        assert_eq!(two_digits(12.345), 12.0);
        assert_eq!(two_digits(0.034_56), 0.035);
        assert_eq!(two_digits(1234.0), 1200.0);
    }
}
