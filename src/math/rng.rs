//! The random numbers of one path.

use std::convert::Infallible;

use glam::UVec2;
use rand::{SeedableRng, TryRng};
use rand_xoshiro::Xoshiro128PlusPlus;

/// The random numbers of one path: (seed, pixel, sample) fixes them all, so that any path can be
/// walked again and the number of threads changes nothing.
#[derive(Clone, Debug)]
pub struct PathRng(Xoshiro128PlusPlus);

impl PathRng {
    /// The generator of one sample of one pixel.
    pub fn new(seed: u64, pixel: UVec2, sample: u32) -> Self {
        let place = (u64::from(pixel.y) << 32) | u64::from(pixel.x);
        let key = mix(mix(mix(seed) ^ place) ^ u64::from(sample));
        Self(Xoshiro128PlusPlus::seed_from_u64(key))
    }

    /// A number uniform in [0, 1).
    #[inline]
    pub fn uniform(&mut self) -> f32 {
        const SCALE: f32 = 1.0 / (1 << 24) as f32;
        (self.bits() >> 8) as f32 * SCALE
    }

    /// A number with density exp(-x), x >= 0: the optical distance to a collision.
    #[inline]
    pub fn exponential(&mut self) -> f32 {
        -(1.0 - self.uniform()).ln()
    }

    #[inline]
    fn bits(&mut self) -> u32 {
        match self.0.try_next_u32() {
            Ok(bits) => bits,
        }
    }
}

impl TryRng for PathRng {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        self.0.try_next_u32()
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        self.0.try_next_u64()
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        self.0.try_fill_bytes(bytes)
    }
}

/// The finalizer of SplitMix64: every input bit reaches every output bit.
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seed_pixel_and_sample_each_change_the_numbers() {
        let first = |seed, x, y, sample| PathRng::new(seed, UVec2::new(x, y), sample).uniform();
        let base = first(0, 1, 2, 3);
        assert_eq!(base, first(0, 1, 2, 3));
        for other in [first(1, 1, 2, 3), first(0, 2, 1, 3), first(0, 1, 2, 4)] {
            assert_ne!(base, other);
        }
    }

    #[test]
    fn the_exponential_is_finite_and_has_mean_one() {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let n = 1 << 20;
        let sum: f64 = (0..n).map(|_| f64::from(rng.exponential())).sum();
        // Standard error 1e-3; five of them.
        assert!((sum / f64::from(n) - 1.0).abs() < 5e-3);
    }
}
