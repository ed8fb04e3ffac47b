//! Multiple importance sampling (Veach 1997, chapter 9): the only place that makes weights.

/// Balance heuristic for several strategies with `counts` samples each on average, as a factor of a
/// weight that is over the first of `pdfs`: that density over the mixture of all. All densities in
/// the same measure.
///
/// The factor is 0 where the first density is 0.
#[inline]
pub fn mixture(counts: [f32; 2], pdfs: [f32; 2]) -> f32 {
    if pdfs[0] <= 0.0 { 0.0 } else { 1.0 / (counts[0] + counts[1] * (pdfs[1] / pdfs[0])) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_the_two_strategies_sum_to_one() {
        for (a, b) in [(1.0, 3.0), (0.0, 2.0), (2.0, 0.0), (1e38, 3e38), (1e-30, 1e-32)] {
            let [one, other] = [[a, b], [b, a]].map(|pdfs| mixture([1.0, 1.0], pdfs));
            assert!((one + other - 1.0).abs() < 1e-6, "{a} {b}");
        }
    }
}
