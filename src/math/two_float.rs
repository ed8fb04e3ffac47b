//! A running sum kept as two floats, so that a million samples lose no visible precision.

use bytemuck::{Pod, Zeroable};

/// An unevaluated sum of two `f32`: the rounded value and what the rounding lost.
///
/// Carries about 48 bits. Both halves are plain `f32`, so a sum written to a picture of floats and
/// read back goes on exactly as if it had never left memory.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TwoFloat {
    /// The sum rounded to `f32`.
    pub sum: f32,
    /// The remainder, at most half a unit in the last place of `sum`.
    pub rest: f32,
}

impl TwoFloat {
    /// Adds `x`: Knuth's two-sum for the exact rounding error, then Dekker's fast two-sum to
    /// normalize the pair.
    #[inline]
    pub fn add(&mut self, x: f32) {
        let sum = self.sum + x;
        let part = sum - self.sum;
        let error = (self.sum - (sum - part)) + (x - part);
        let rest = self.rest + error;
        self.sum = sum + rest;
        self.rest = rest - (self.sum - sum);
    }

    /// The sum in double precision.
    #[inline]
    pub fn value(self) -> f64 {
        f64::from(self.sum) + f64::from(self.rest)
    }
}

/// Adds a color to three sums.
#[inline]
pub fn add_rgb(sums: &mut [TwoFloat; 3], rgb: crate::math::Rgb) {
    sums[0].add(rgb.x);
    sums[1].add(rgb.y);
    sums[2].add(rgb.z);
}

/// Three sums in double precision.
#[inline]
pub fn values(sums: &[TwoFloat; 3]) -> [f64; 3] {
    sums.map(TwoFloat::value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_tenths_keep_their_digits() {
        let mut pair = TwoFloat::default();
        let mut plain = 0.0f32;
        for _ in 0..1_000_000 {
            pair.add(0.1);
            plain += 0.1;
        }
        let exact = 1_000_000.0 * f64::from(0.1f32);
        assert!((pair.value() / exact - 1.0).abs() < 1e-10, "{}", pair.value());
        assert!((f64::from(plain) / exact - 1.0).abs() > 1e-4, "the plain sum is no yardstick");
    }

    #[test]
    fn values_of_very_different_size_survive() {
        let mut pair = TwoFloat::default();
        pair.add(1.0e8);
        for _ in 0..1000 {
            pair.add(0.01);
        }
        pair.add(-1.0e8);
        assert!((pair.value() - 1000.0 * f64::from(0.01f32)).abs() < 1e-3, "{pair:?}");
    }
}
