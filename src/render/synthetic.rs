//! Samplers for tests: no light, only numbers that a test can foresee.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::UVec2;

use super::film::Film;
use crate::error::NO_PROGRESS;
use crate::math::Rgb;
use crate::transport::{PathSample, PixelSampler, SampleNumber};

/// Uniform variables on [0, 1), one for each pixel and sample, alike in all channels and spread
/// over the four parts.
#[derive(Default)]
pub(crate) struct Uniform {
    /// Samples taken so far.
    pub calls: AtomicU64,
    /// Rounds of extra work, to cost time.
    pub cost: u32,
}

/// The finalizer of SplitMix64: well mixed bits of a counter.
pub(crate) fn mix(seed: u64) -> u64 {
    let z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl PixelSampler for Uniform {
    fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
        self.calls.fetch_add(1, Ordering::Relaxed);
        let key = u64::from(pixel.x) | u64::from(pixel.y) << 20 | u64::from(number.index()) << 40;
        let bits = (0..self.cost).fold(mix(key), |bits, _| std::hint::black_box(mix(bits)));
        let _ = bits;
        let value = (mix(key) >> 40) as f32 / (1u64 << 24) as f32;
        let part = Rgb::splat(value);
        let zero = Rgb::ZERO;
        let parts = match mix(!key) % 4 {
            0 => [part, zero, zero, zero],
            1 => [zero, part, zero, zero],
            2 => [zero, zero, part, zero],
            _ => [zero, zero, zero, part],
        };
        PathSample {
            emission: parts[0],
            background: parts[1],
            direct: parts[2],
            indirect: parts[3],
            alpha: value,
            depth: (value < 0.5).then_some(1.0 + value),
            tracking_steps: 3,
            was_cut: false,
        }
    }
}

/// Gray values of a known mean and variance: uniform on `mean` ± `spread` / 2, so of variance
/// `spread`² / 12.
pub(crate) struct GrayLevel {
    pub seed: u64,
    pub mean: f32,
    pub spread: f32,
}

impl PixelSampler for GrayLevel {
    fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
        gray(self.mean + self.spread * (uniform(self.seed, pixel, number.index()) - 0.5))
    }
}

/// Black but for rare bright samples: `mean` / `chance` with probability `chance`, so of variance
/// `mean`² (1 / `chance` − 1).
pub(crate) struct Fireflies {
    pub seed: u64,
    pub mean: f32,
    pub chance: f32,
}

impl PixelSampler for Fireflies {
    fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
        let is_lit = uniform(self.seed, pixel, number.index()) < self.chance;
        gray(if is_lit { self.mean / self.chance } else { 0.0 })
    }
}

fn gray(value: f32) -> PathSample {
    PathSample { direct: Rgb::splat(value), ..PathSample::default() }
}

fn uniform(seed: u64, pixel: UVec2, sample: u32) -> f32 {
    let key = u64::from(pixel.x) | u64::from(pixel.y) << 20 | u64::from(sample) << 40;
    (mix(key ^ mix(seed)) >> 40) as f32 / (1u64 << 24) as f32
}

/// Sample `index` of a pixel.
pub(crate) fn sample_of(sampler: &impl PixelSampler, pixel: UVec2, index: u32) -> PathSample {
    let prepared = sampler.prepare(NO_PROGRESS).unwrap();
    sampler.sample(pixel, SampleNumber::new(index, &prepared))
}

/// A film with so many samples of every pixel.
pub(crate) fn sampled(sampler: &impl PixelSampler, size: UVec2, samples: u32) -> Film {
    let mut film = Film::new(size).unwrap();
    for y in 0..size.y {
        for x in 0..size.x {
            let pixel = UVec2::new(x, y);
            for index in 0..samples {
                film.add(pixel, &sample_of(sampler, pixel, index));
            }
        }
    }
    film
}
