//! Errors of a whole picture: a map, its mean, its quartiles.

use glam::UVec2;
use rayon::prelude::*;

/// Error of every pixel of a picture against the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorMap {
    /// Width and height in pixels.
    pub size: UVec2,
    /// The mean of the map.
    pub mean: f64,
    /// The error of every pixel, at least 0; row 0 on top.
    pub map: Vec<f32>,
}

impl ErrorMap {
    /// The errors `map` of a picture of `size`.
    pub(super) fn new(size: UVec2, map: Vec<f32>) -> Self {
        // In order, so that the mean is the same for any number of threads.
        let sum: f64 = map.iter().copied().map(f64::from).sum();
        Self { size, mean: sum / map.len().max(1) as f64, map }
    }

    /// Mean over a region of `size` pixels from `first` on, clipped to the map; 0 where they do not
    /// overlap.
    pub fn mean_of(&self, first: UVec2, size: UVec2) -> f64 {
        let first = first.min(self.size);
        let end = first.saturating_add(size).min(self.size);
        let width = self.size.x as usize;
        let lines = (first.y..end.y).map(|y| {
            let start = y as usize * width;
            &self.map[start + first.x as usize..start + end.x as usize]
        });
        let sum: f64 = lines.flatten().copied().map(f64::from).sum();
        let pixels = f64::from(end.x - first.x) * f64::from(end.y - first.y);
        if pixels > 0.0 { sum / pixels } else { 0.0 }
    }

    /// The errors up to which the pixels add up to a quarter, half and three quarters of all error.
    ///
    /// Plain quartiles of a good picture lie in its flawless parts; these tell how bad the bad
    /// parts are (Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020,
    /// section on pooling).
    pub fn weighted_quartiles(&self) -> [f32; 3] {
        let mut sorted = self.map.clone();
        sorted.par_sort_unstable_by(f32::total_cmp);
        let sums: Vec<f64> = sorted
            .iter()
            .scan(0.0, |sum, &error| {
                *sum += f64::from(error);
                Some(*sum)
            })
            .collect();
        let all = sums.last().copied().unwrap_or(0.0);
        [0.25, 0.5, 0.75].map(|share| {
            let index = sums.partition_point(|&sum| sum < share * all);
            sorted.get(index).copied().unwrap_or(0.0)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_of_regions_end_at_the_map() {
        let map = ErrorMap::new(UVec2::new(3, 2), vec![1.0, 2.0, 3.0, 4.0, 5.0, 9.0]);
        let mean = |x, y, w, h| map.mean_of(UVec2::new(x, y), UVec2::new(w, h));
        assert_eq!(mean(0, 0, 3, 2), map.mean);
        assert_eq!(mean(1, 0, 1, 2), 3.5);
        assert_eq!(mean(2, 1, 7, u32::MAX), 9.0);
        assert_eq!(mean(3, 0, 5, 5), 0.0);
    }

    #[test]
    fn quartiles_weigh_pixels_by_their_error() {
        let map = |values: Vec<f32>| ErrorMap::new(UVec2::new(values.len() as u32, 1), values);
        // Of a sum of 8, the ones add up to 2, with one of the twos to 4, with two of them to 6.
        let errors = map(vec![2.0, 0.0, 1.0, 2.0, 0.0, 2.0, 1.0, 0.0]);
        assert_eq!(errors.mean, 1.0);
        assert_eq!(errors.weighted_quartiles(), [1.0, 2.0, 2.0]);
        assert_eq!(map(vec![0.0; 5]).weighted_quartiles(), [0.0; 3]);
        assert_eq!(map(Vec::new()).weighted_quartiles(), [0.0; 3]);
    }
}
