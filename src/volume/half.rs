//! Half floats: which numbers are exactly one, and conversion both ways.
//!
//! Neither direction branches, so that the compiler converts several numbers at a time on any
//! processor. The largest exponent, which IEEE gives to infinity and NaN, stands for plain numbers
//! here: neither is ever stored.

/// Difference of the exponents' biases, in place for single precision.
const REBIAS: u32 = (127 - 15) << 23;
/// 2⁻¹⁴, the smallest normal half float.
const SMALLEST_NORMAL: u32 = REBIAS + (1 << 23);
/// 2¹¹², as a factor what [`REBIAS`] is as a summand; it makes subnormal numbers right, too.
const SCALE: f32 = f32::from_bits((127 + 127 - 15) << 23);
/// Sign, exponent and fraction of a half float in their places, without copies of the sign.
const IN_PLACE: u32 = 0x8fff_e000;

/// The number with these bits as a half float.
#[inline(always)]
pub(super) fn widen(half: u16) -> f32 {
    in_place(u32::from(half) << 16)
}

/// As [`widen`], with infinity and NaN as IEEE has them.
#[inline(always)]
pub(super) fn widen_ieee(half: u16) -> f32 {
    const EXPONENT: u32 = 0x7f80_0000;
    let special = u32::from(half & 0x7c00 == 0x7c00).wrapping_neg();
    f32::from_bits(widen(half).to_bits() | (special & EXPONENT))
}

/// The numbers in the lower and in the upper bits of each word.
#[inline(always)]
pub(super) fn widen_pairs(words: [u32; 4]) -> [[f32; 4]; 2] {
    let [a, b, c, d] = words;
    let low = [in_place(a << 16), in_place(b << 16), in_place(c << 16), in_place(d << 16)];
    [low, [in_place(a), in_place(b), in_place(c), in_place(d)]]
}

/// The number whose bits are the upper ones of a word.
#[inline(always)]
fn in_place(word: u32) -> f32 {
    f32::from_bits((word as i32 >> 3) as u32 & IN_PLACE) * SCALE
}

/// The bits of `value` as a half float; of another number if it is not exactly one.
#[inline(always)]
pub(super) fn narrow(value: f32) -> u16 {
    let bits = value.to_bits();
    let magnitude = bits & 0x7fff_ffff;
    // The last bit of numbers around one half is 2⁻²⁴, as that of subnormal half floats.
    let subnormal = (f32::from_bits(magnitude) + 0.5).to_bits().wrapping_sub(0.5_f32.to_bits());
    let normal = magnitude.wrapping_sub(REBIAS) >> 13;
    let half = if magnitude < SMALLEST_NORMAL { subnormal } else { normal };
    (half | (bits >> 16 & 0x8000)) as u16
}

/// Whether `value` survives [`narrow`] and [`widen`], bit by bit.
#[inline(always)]
pub(super) fn is_half(value: f32) -> bool {
    widen(narrow(value)).to_bits() == value.to_bits()
}

#[cfg(test)]
mod tests {
    use half::f16;

    use super::*;

    #[test]
    fn every_finite_half_float_both_ways() {
        for bits in 0..=u16::MAX {
            let want = f16::from_bits(bits);
            let ieee = widen_ieee(bits);
            assert!(ieee.to_bits() == want.to_f32().to_bits() || (ieee.is_nan() && want.is_nan()));
            if want.is_finite() {
                assert_eq!(widen(bits).to_bits(), want.to_f32().to_bits(), "{bits:#x}");
                assert_eq!(narrow(want.to_f32()), bits, "{bits:#x}");
                assert!(is_half(want.to_f32()));
                let other = bits ^ 0x8001;
                let [low, high] = widen_pairs([u32::from(bits) | u32::from(other) << 16; 4]);
                assert_eq!(low.map(f32::to_bits), [widen(bits).to_bits(); 4]);
                assert_eq!(high.map(f32::to_bits), [widen(other).to_bits(); 4]);
            }
        }
    }

    #[test]
    fn other_numbers_are_told_apart() {
        for bits in (0..u32::MAX).step_by(4093) {
            let value = f32::from_bits(bits);
            let exact = f16::from_f32(value).to_f32().to_bits() == bits && value.is_finite();
            // The largest exponent holds numbers beyond the largest half float as well.
            assert!(is_half(value) == exact || (value.abs() >= 65536.0 && is_half(value)));
        }
        for value in [f32::INFINITY, f32::NAN, -f32::NAN, 131_072.0, 1e-8, 1.0 + f32::EPSILON] {
            assert!(!is_half(value), "{value}");
        }
    }
}
