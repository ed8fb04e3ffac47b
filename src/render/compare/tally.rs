//! Sums over the pixels of one film.

use glam::UVec2;

use super::side_figures::SideFigures;
use crate::render::area::Area;
use crate::render::estimate::{PixelEstimate, gray};
use crate::render::film::Film;
use crate::render::picture::Picture;

/// Sums over some pixels of one side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tally {
    pixels: u64,
    samples: u64,
    pub fewest_samples: u32,
    sampled: u64,
    rgb: [f64; 3],
    /// Pixels whose variance is known; the sums below run over them.
    pub measured: u64,
    pub gray: f64,
    pub variance: f64,
    /// Variance of `variance`.
    pub uncertainty: f64,
    /// The largest variance of a pixel.
    pub largest_variance: f64,
}

impl Default for Tally {
    fn default() -> Self {
        Self {
            pixels: 0,
            samples: 0,
            fewest_samples: u32::MAX,
            sampled: 0,
            rgb: [0.0; 3],
            measured: 0,
            gray: 0.0,
            variance: 0.0,
            uncertainty: 0.0,
            largest_variance: 0.0,
        }
    }
}

/// A film or a picture that pixels are read from.
pub(super) trait PixelSource: Sync {
    /// Width and height.
    fn size(&self) -> UVec2;

    /// Samples of a pixel, or fewer.
    fn samples(&self, pixel: UVec2) -> u32;

    /// The estimate of a pixel, once it has any samples.
    fn estimate(&self, pixel: UVec2) -> Option<Estimate>;
}

/// The estimate of a pixel from its samples.
pub(super) struct Estimate {
    mean: [f64; 3],
    /// Variance of the gray mean, and the variance of that.
    variance: Option<(f64, f64)>,
}

impl PixelSource for Film {
    fn size(&self) -> UVec2 {
        self.size()
    }

    fn samples(&self, pixel: UVec2) -> u32 {
        self.samples(pixel)
    }

    fn estimate(&self, pixel: UVec2) -> Option<Estimate> {
        let pixel = PixelEstimate::of(self, pixel)?;
        let variance = pixel.gray_variance().zip(pixel.gray_variance_uncertainty());
        Some(Estimate { mean: pixel.mean(), variance })
    }
}

/// Pixels without samples show their block and count as if they had none of their own.
impl PixelSource for Picture {
    fn size(&self) -> UVec2 {
        self.size
    }

    fn samples(&self, pixel: UVec2) -> u32 {
        match self.region {
            Some((area, fewest)) if area.contains(pixel) => fewest,
            _ => self.fewest_samples,
        }
    }

    fn estimate(&self, pixel: UVec2) -> Option<Estimate> {
        let index = pixel.y as usize * self.size.x as usize + pixel.x as usize;
        let [r, g, b, _] = *self.pixels.get(index)?;
        let variance = self.variance.get(index).filter(|variance| variance[0].is_finite());
        let variance = variance.map(|[of, again]| (f64::from(*of), f64::from(*again)));
        let mean = [r, g, b].map(f64::from);
        (self.fewest_samples > 0 || variance.is_some()).then_some(Estimate { mean, variance })
    }
}

impl Tally {
    /// Sums over the pixels of `area`, all of which the source has.
    pub fn of(source: &impl PixelSource, area: &Area) -> Self {
        let mut tally = Self::default();
        for pixel in area.iter() {
            let samples = source.samples(pixel);
            tally.pixels += 1;
            tally.samples += u64::from(samples);
            tally.fewest_samples = tally.fewest_samples.min(samples);
            if let Some(estimate) = source.estimate(pixel) {
                tally.add(&estimate);
            }
        }
        tally
    }

    fn add(&mut self, pixel: &Estimate) {
        self.sampled += 1;
        (0..3).for_each(|c| self.rgb[c] += pixel.mean[c]);
        if let Some((variance, uncertainty)) = pixel.variance {
            self.measured += 1;
            self.gray += gray(pixel.mean);
            self.variance += variance;
            self.uncertainty += uncertainty;
            self.largest_variance = self.largest_variance.max(variance);
        }
    }

    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            pixels: self.pixels + other.pixels,
            samples: self.samples + other.samples,
            fewest_samples: self.fewest_samples.min(other.fewest_samples),
            sampled: self.sampled + other.sampled,
            rgb: [0, 1, 2].map(|c| self.rgb[c] + other.rgb[c]),
            measured: self.measured + other.measured,
            gray: self.gray + other.gray,
            variance: self.variance + other.variance,
            uncertainty: self.uncertainty + other.uncertainty,
            largest_variance: self.largest_variance.max(other.largest_variance),
        }
    }

    /// The figures of the side from its sums.
    pub fn side(&self, cpu_seconds: f64) -> SideFigures {
        let mean_of = |sum: f64, count: u64| (count > 0).then(|| sum / count as f64);
        let variance = mean_of(self.variance, self.measured);
        let mean = mean_of(self.gray, self.measured).filter(|&mean| mean > 0.0);
        SideFigures {
            samples_per_pixel: mean_of(self.samples as f64, self.pixels).unwrap_or(0.0),
            fewest_samples: if self.pixels > 0 { self.fewest_samples } else { 0 },
            cpu_seconds,
            mean_rgb: self.rgb.map(|sum| mean_of(sum, self.sampled).unwrap_or(0.0)),
            variance_of_mean: variance,
            variance_error: mean_of(self.uncertainty.max(0.0).sqrt(), self.measured),
            noise: variance.zip(mean).map(|(variance, mean)| variance.sqrt() / mean),
            spending: None,
        }
    }
}
