//! Choice among the texels of a line, with probabilities that are exactly those that are told.
//!
//! Cumulative weights are rounded to 32-bit integers. The difference of two of them is both the
//! share of the random numbers that choose a texel and the probability that is told for it.

/// The end of the last texel.
const WHOLE: f64 = u32::MAX as f64;

/// Appends to `starts` the start of each texel of a line with these `weights`; all weights zero
/// stand for even ones. Returns the sum of the weights.
pub fn append(starts: &mut Vec<u32>, weights: impl ExactSizeIterator<Item = f64> + Clone) -> f64 {
    let total: f64 = weights.clone().sum();
    let even = 1.0 / weights.len().max(1) as f64;
    let mut before = 0.0;
    for weight in weights {
        starts.push((before * WHOLE).round().min(WHOLE) as u32);
        before += if total > 0.0 { weight / total } else { even };
    }
    total
}

/// The texel that `u`, in [0, 1), chooses, and the place in it from 0 to 1.
pub fn choose(starts: &[u32], u: f64) -> (usize, f64) {
    let x = (u * WHOLE).min(WHOLE - 0.5);
    let index = starts.partition_point(|&start| f64::from(start) <= x).saturating_sub(1);
    let [start, end] = ends(starts, index);
    (index, ((x - start) / (end - start)).clamp(0.0, 1.0))
}

/// Probability with which [`choose`] takes a texel.
pub fn probability(starts: &[u32], index: usize) -> f64 {
    let [start, end] = ends(starts, index);
    (end - start) / WHOLE
}

fn ends(starts: &[u32], index: usize) -> [f64; 2] {
    let at = |index: usize| starts.get(index).map_or(WHOLE, |&start| f64::from(start));
    [at(index), at(index + 1)]
}
