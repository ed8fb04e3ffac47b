//! Means, variances and the noise of a picture, all read from the accumulators.

use glam::UVec2;
use rayon::prelude::*;

use super::film::{Film, Sums};
use crate::math::ACCUMULATORS;
use crate::math::two_float::{TwoFloat, values};

/// Estimates from the samples of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct PixelEstimate<'a> {
    sums: &'a Sums,
    samples: u32,
}

impl<'a> PixelEstimate<'a> {
    /// The estimate of a pixel of `film`, once it has a sample.
    pub fn of(film: &'a Film, pixel: UVec2) -> Option<Self> {
        film.sums(pixel).map(|sums| Self { sums, samples: film.samples(pixel) })
    }

    /// Mean of the beauty.
    pub fn mean(&self) -> [f64; 3] {
        let mut total = [0.0; 3];
        for accumulator in &self.sums.beauty[..self.filled()] {
            let sum = values(accumulator);
            (0..3).for_each(|c| total[c] += sum[c]);
        }
        total.map(|sum| sum / f64::from(self.samples))
    }

    /// Mean of one of the four parts, or of any RGB sum.
    pub fn part(&self, part: impl Fn(&Sums) -> &[TwoFloat; 3]) -> [f64; 3] {
        values(part(self.sums)).map(|sum| sum / f64::from(self.samples))
    }

    /// Mean alpha.
    pub fn alpha(&self) -> f64 {
        self.sums.alpha.value() / f64::from(self.samples)
    }

    /// Mean distance of the first event or surface, over the samples that met one.
    pub fn depth(&self) -> Option<f64> {
        let count = self.sums.depth_count;
        (count > 0).then(|| self.sums.depth.value() / f64::from(count))
    }

    /// Mean number of tentative collisions of a sample.
    pub fn steps(&self) -> f64 {
        self.sums.steps.value() / f64::from(self.samples)
    }

    /// Variance of the mean of each channel; none below two filled accumulators.
    pub fn variance(&self) -> Option<[f64; 3]> {
        let channel = |c: usize| self.variance_of(|rgb| rgb[c]);
        Some([channel(0)?, channel(1)?, channel(2)?])
    }

    /// Variance of the mean of (R + G + B) / 3.
    pub fn gray_variance(&self) -> Option<f64> {
        self.variance_of(gray)
    }

    /// Variance of [`Self::gray_variance`] itself: how far it can be trusted. Unbiased where the
    /// accumulators have equally many samples, so that sums of it over pixels are good to have; of
    /// one pixel it may be negative. None below two filled accumulators.
    ///
    /// Of K independent values with the k-statistics k₂ and k₄,
    /// (2 K k₂² + (K − 1) k₄) / (K (K + 1)) is unbiased for the variance of k₂ whatever their distribution (Kendall and Stuart, *The
    /// Advanced Theory of Statistics*, vol. 1, ch. 12). For normal ones k₄ vanishes on average,
    /// which is assumed below four of them. Where one value alone saw any light it is k₂², the
    /// variance of a count of rare events.
    pub fn gray_variance_uncertainty(&self) -> Option<f64> {
        let filled = self.filled();
        if filled < 2 {
            return None;
        }
        let mut means = [0.0; ACCUMULATORS];
        for (k, mean) in means[..filled].iter_mut().enumerate() {
            *mean = gray(values(&self.sums.beauty[k])) / f64::from(self.samples_of(k));
        }
        let count = filled as f64;
        let center = means[..filled].iter().sum::<f64>() / count;
        let moment = |power: i32| {
            means[..filled].iter().map(|mean| (mean - center).powi(power)).sum::<f64>() / count
        };
        let (second, fourth) = (moment(2), moment(4));
        let k2 = second * count / (count - 1.0);
        let k4 = match filled {
            ..4 => 0.0,
            _ => {
                let products = (count - 1.0) * (count - 2.0) * (count - 3.0);
                let difference = (count + 1.0) * fourth - 3.0 * (count - 1.0) * second * second;
                count * count * difference / products
            }
        };
        let of_k2 = (2.0 * count * k2 * k2 + (count - 1.0) * k4) / (count * (count + 1.0));
        // The variance of the mean is k₂ / K.
        Some(of_k2 / (count * count))
    }

    /// Variance of the mean of a channel.
    ///
    /// With K accumulators of n_k samples, means m_k, shares w_k = n_k / Σ n_j and m = Σ w_k m_k,
    /// the variance of m is Σ w_k² Var(m_k). It is estimated by Σ a_k (m_k − m)² / (1 + Σ a_k) with
    /// a_k = w_k² / (1 − 2 w_k): as E (m_k − m)² = (1 − 2 w_k) Var(m_k) + Var(m), this is unbiased
    /// whatever the variances of the m_k, which need not fall as 1 / n_k. For equal shares it is
    /// the textbook's Σ (m_k − m)² / (K (K − 1)).
    fn variance_of(&self, channel: impl Fn([f64; 3]) -> f64) -> Option<f64> {
        let filled = self.filled();
        if filled < 2 {
            return None;
        }
        let mut sums = [0.0; ACCUMULATORS];
        for (sum, accumulator) in std::iter::zip(&mut sums, &self.sums.beauty[..filled]) {
            *sum = channel(values(accumulator));
        }
        let total = f64::from(self.samples);
        let mean = sums.iter().sum::<f64>() / total;
        let count = |k: usize| f64::from(self.samples_of(k));
        let square = |k: usize| (sums[k] / count(k) - mean).powi(2);
        if filled == 2 {
            return Some((square(0) + square(1)) / 2.0);
        }
        let (mut spread, mut factors) = (0.0, 0.0);
        for k in 0..filled {
            let share = count(k) / total;
            let factor = share * share / (1.0 - 2.0 * share);
            spread += factor * square(k);
            factors += factor;
        }
        Some(spread / (1.0 + factors))
    }

    fn filled(&self) -> usize {
        (self.samples as usize).min(ACCUMULATORS)
    }

    fn samples_of(&self, accumulator: usize) -> u32 {
        let (rounds, extra) =
            (self.samples / ACCUMULATORS as u32, self.samples % ACCUMULATORS as u32);
        rounds + u32::from((accumulator as u32) < extra)
    }
}

/// Samples without which a pixel has no variance.
pub const FEWEST_FOR_VARIANCE: u32 = 2;

/// (R + G + B) / 3.
pub fn gray(rgb: [f64; 3]) -> f64 {
    (rgb[0] + rgb[1] + rgb[2]) / 3.0
}

/// Figures of a whole film. Means run over the pixels that have what they need; a figure is absent
/// where no pixel has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilmStats {
    /// Mean over the pixels of their samples.
    pub samples_per_pixel: f64,
    /// Mean color.
    pub mean_rgb: [f64; 3],
    /// Mean over pixels of the variance of the gray mean.
    pub gray_variance_of_mean: Option<f64>,
    /// Mean over pixels of var / (mean² + ε²) of gray, with ε one hundredth of the picture's mean.
    pub mean_relative_variance: Option<f64>,
    /// The noise of the picture, its relative standard error: √(mean gray variance) / mean gray.
    /// As the variances are unbiased it falls as 1/√samples, also where most pixels have not yet
    /// met the light that makes them noisy. Absent for a black picture.
    pub noise: Option<f64>,
}

impl FilmStats {
    /// Measures `film`.
    pub fn of(film: &Film) -> Self {
        let lines: Vec<LineStats> = (0..film.size().y)
            .into_par_iter()
            .map(|y| {
                let mut line = LineStats::default();
                for x in 0..film.size().x {
                    if let Some(pixel) = PixelEstimate::of(film, UVec2::new(x, y)) {
                        line.add(&pixel, pixel.mean());
                    }
                }
                line
            })
            .collect();
        Self::from_lines(film, &lines)
    }

    /// The figures of `film` from those of its lines, from top to bottom.
    pub(crate) fn from_lines(film: &Film, lines: &[LineStats]) -> Self {
        let pixels: u64 = lines.iter().map(|line| line.pixels).sum();
        let mean_rgb = [0, 1, 2].map(|c| {
            let sum: f64 = lines.iter().map(|line| line.mean[c]).sum();
            sum / pixels.max(1) as f64
        });
        let floor = (0.01 * gray(mean_rgb)).powi(2);
        let measured: usize = lines.iter().map(|line| line.noise.len()).sum();
        let over_measured = |value: &dyn Fn(f64, f64) -> f64| {
            let pixels = lines.iter().flat_map(|line| &line.noise);
            let sum: f64 = pixels.map(|&(gray, variance)| value(gray, variance)).sum();
            (measured > 0).then(|| sum / measured as f64)
        };
        let relative = |gray: f64, variance: f64| match variance > 0.0 {
            true => variance / (gray * gray + floor),
            false => 0.0,
        };
        let variance = over_measured(&|_, variance| variance);
        let mean = over_measured(&|gray, _| gray).filter(|&mean| mean > 0.0);
        Self {
            samples_per_pixel: samples_per_pixel(film),
            mean_rgb,
            gray_variance_of_mean: variance,
            mean_relative_variance: over_measured(&relative),
            noise: variance.zip(mean).map(|(variance, mean)| variance.sqrt() / mean),
        }
    }
}

/// Mean number of samples of a pixel.
pub fn samples_per_pixel(film: &Film) -> f64 {
    film.totals.paths as f64 / (f64::from(film.size().x) * f64::from(film.size().y))
}

/// Sums over one line of a film from which its figures are formed. Lines are summed in order, so
/// that the figures do not depend on the number of threads.
#[derive(Clone, Debug, Default)]
pub(crate) struct LineStats {
    pixels: u64,
    mean: [f64; 3],
    /// Gray mean and its variance of every pixel that has one.
    noise: Vec<(f64, f64)>,
}

impl LineStats {
    /// Adds a pixel, whose mean is known already.
    pub(crate) fn add(&mut self, pixel: &PixelEstimate<'_>, mean: [f64; 3]) {
        self.pixels += 1;
        (0..3).for_each(|c| self.mean[c] += mean[c]);
        self.noise.extend(pixel.gray_variance().map(|variance| (gray(mean), variance)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{PathRng, Rgb, Slot};
    use crate::render::synthetic::Uniform;
    use crate::transport::{PathSample, PixelSampler, SampleNumber};

    fn sampled(size: UVec2, samples: u32) -> Film {
        sampled_by(&Uniform::default(), size, samples)
    }

    fn sampled_by(sampler: &impl PixelSampler, size: UVec2, samples: u32) -> Film {
        crate::render::synthetic::sampled(sampler, size, samples)
    }

    /// A uniform variable on [0, 1) has variance 1/12, so a mean of n has 1/(12 n). The estimate
    /// of each of many pixels scatters by about √(2/(K−1)); the mean over pixels must lie within
    /// four standard errors, for equal and for unequal accumulators.
    #[test]
    fn variance_agrees_with_theory() {
        for samples in [2, 3, 8, 13, 64] {
            let size = UVec2::new(64, 64);
            let film = sampled(size, samples);
            let mut estimates = Vec::new();
            for y in 0..size.y {
                for x in 0..size.x {
                    let pixel = PixelEstimate::of(&film, UVec2::new(x, y)).unwrap();
                    estimates.push(pixel.variance().unwrap()[0]);
                }
            }
            let n = estimates.len() as f64;
            let mean = estimates.iter().sum::<f64>() / n;
            let spread = estimates.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (n - 1.0);
            let expected = 1.0 / (12.0 * f64::from(samples));
            let z = (mean - expected) / (spread / n).sqrt();
            assert!(z.abs() < 4.0, "{samples} samples: {mean} for {expected}, z = {z}");
        }
    }

    /// A smooth function of evenly spread numbers, with mean 1; independent numbers would give it
    /// variance (13/12)² 4/3 − 1 = 0.565.
    struct Smooth;

    impl PixelSampler for Smooth {
        fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
            let mut rng = PathRng::stratified(0, pixel, number.index());
            let value = (0.5 + rng.at(Slot::PixelX)) * (0.5 + rng.at(Slot::PixelY));
            let value = value * 2.0 * rng.at(Slot::Distance);
            PathSample { direct: Rgb::splat(value), ..Default::default() }
        }
    }

    /// Samples that are spread evenly have far less variance than independent ones would, and the
    /// spread between the accumulators knows: it agrees with the squared distances from the true
    /// mean, for equal and for unequal accumulators. Standard errors are below 3 %.
    #[test]
    fn variance_of_evenly_spread_samples_is_that_between_randomizations() {
        for (samples, gain) in [(8, 0.9), (13, 1.5), (24, 1.8), (64, 4.0), (100, 4.0), (256, 5.0)] {
            let size = UVec2::splat(64);
            let film = sampled_by(&Smooth, size, samples);
            let (mut measured, mut real, mut spread) = (0.0, 0.0, 0.0);
            for i in 0..size.element_product() {
                let pixel = PixelEstimate::of(&film, UVec2::new(i % 64, i / 64)).unwrap();
                let (variance, error) = (pixel.variance().unwrap()[0], pixel.mean()[0] - 1.0);
                measured += variance;
                real += error * error;
                spread += (variance - error * error).powi(2);
            }
            let z = (measured - real) / spread.sqrt();
            assert!(z.abs() < 4.0, "{samples} samples: {measured} for {real}, z = {z}");
            assert!(spread.sqrt() < 0.04 * real, "{samples} samples: too weak");
            let independent = 0.5648 / f64::from(samples) * 4096.0;
            assert!(real * gain < independent, "{samples}: {real} for {independent}");
        }
    }

    #[test]
    fn one_sample_has_no_variance() {
        let film = sampled(UVec2::ONE, 1);
        let pixel = PixelEstimate::of(&film, UVec2::ZERO).unwrap();
        assert_eq!((pixel.variance(), pixel.gray_variance()), (None, None));
        let stats = FilmStats::of(&film);
        assert_eq!((stats.noise, stats.mean_relative_variance), (None, None));
        assert_eq!(stats.samples_per_pixel, 1.0);
    }

    /// The three channels of the synthetic sampler are equal, so gray has their variance, and the
    /// relative variance is that of a uniform variable, 1/(12 n) / (1/2)².
    #[test]
    fn figures_of_the_picture() {
        let film = sampled(UVec2::new(70, 50), 16);
        let stats = FilmStats::of(&film);
        let variance = stats.gray_variance_of_mean.unwrap();
        assert!((variance * 12.0 * 16.0 - 1.0).abs() < 0.05, "{variance}");
        let relative = stats.mean_relative_variance.unwrap();
        // E[var / mean²] is a little above 1/(12 n) / (1/4) as the mean is noisy too.
        assert!((relative * 12.0 * 16.0 / 4.0 - 1.0).abs() < 0.1, "{relative}");
        let noise = stats.noise.unwrap();
        assert!((noise / ((1.0 / (12.0 * 16.0f64)).sqrt() / 0.5) - 1.0).abs() < 0.02, "{noise}");
        assert!((gray(stats.mean_rgb) - 0.5).abs() < 0.01);
    }

    #[test]
    fn a_black_picture_has_no_relative_noise() {
        let mut film = Film::new(UVec2::new(3, 3)).unwrap();
        for y in 0..3 {
            for x in 0..3 {
                (0..8).for_each(|_| film.add(UVec2::new(x, y), &Default::default()));
            }
        }
        let stats = FilmStats::of(&film);
        assert_eq!((stats.noise, stats.mean_relative_variance), (None, Some(0.0)));
        assert_eq!(stats.gray_variance_of_mean, Some(0.0));
    }
}
