//! White balance: which light is shown white.

use glam::{Mat3A, Vec3A};

use crate::math::{Rgb, luminance};

/// The color temperature that changes nothing, in kelvin.
pub const NEUTRAL: f32 = 6500.0;
/// Temperatures that can be balanced, in kelvin: those of the formula for the Planckian locus.
pub const RANGE: [f32; 2] = [1667.0, 25_000.0];

/// Linear Rec.709 from CIE XYZ, column by column (IEC 61966-2-1).
const RGB_FROM_XYZ: Mat3A = Mat3A::from_cols(
    Vec3A::new(3.240_454, -0.969_266, 0.055_643_4),
    Vec3A::new(-1.537_138_5, 1.876_010_8, -0.204_025_9),
    Vec3A::new(-0.498_531_4, 0.041_556, 1.057_225_2),
);
/// Bradford's cone responses from CIE XYZ (Lam 1985), column by column.
const CONES_FROM_XYZ: Mat3A = Mat3A::from_cols(
    Vec3A::new(0.8951, -0.7502, 0.0389),
    Vec3A::new(0.2664, 1.7135, -0.0685),
    Vec3A::new(-0.1614, 0.0367, 1.0296),
);

/// Takes the light of a black body at `kelvin` to that of one at [`NEUTRAL`], and all other colors
/// along: von Kries adaptation of Bradford's cone responses. Temperatures out of [`RANGE`] are taken
/// as its ends.
pub fn balance(kelvin: f32) -> Mat3A {
    if kelvin == NEUTRAL {
        return Mat3A::IDENTITY;
    }
    let [from, to] = [kelvin, NEUTRAL].map(|kelvin| CONES_FROM_XYZ * xyz_of(kelvin));
    let adapt = Mat3A::from_diagonal((to / from).into());
    let cones_from_rgb = CONES_FROM_XYZ * RGB_FROM_XYZ.inverse();
    cones_from_rgb.inverse() * adapt * cones_from_rgb
}

/// Linear color of luminance 1 of a black body at `kelvin`, relative to one at [`NEUTRAL`], which
/// is white.
pub fn of_temperature(kelvin: f32) -> Rgb {
    let color = balance(kelvin).inverse() * Rgb::ONE;
    color / luminance(color)
}

/// CIE XYZ of luminance 1 of a black body: the cubic fit of Kim et al. (US patent 7024034, 2006).
fn xyz_of(kelvin: f32) -> Vec3A {
    let t = kelvin.clamp(RANGE[0], RANGE[1]);
    let cubic = |[a, b, c, d]: [f32; 4], x: f32| ((a * x + b) * x + c) * x + d;
    let x = if t <= 4000.0 {
        cubic([-0.266_123_9, -0.234_358_9, 0.877_695_6, 0.179_91], 1.0e3 / t)
    } else {
        cubic([-3.025_847, 2.107_038, 0.222_634_7, 0.240_39], 1.0e3 / t)
    };
    let y = if t <= 2222.0 {
        cubic([-1.106_381_4, -1.348_110_2, 2.185_558_3, -0.202_196_83], x)
    } else if t <= 4000.0 {
        cubic([-0.954_947_6, -1.374_185_9, 2.091_370_3, -0.167_488_67], x)
    } else {
        cubic([3.081_758, -5.873_387, 3.751_13, -0.370_014_83], x)
    };
    Vec3A::new(x / y, 1.0, (1.0 - x - y) / y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chromaticities of black bodies (Wyszecki and Stiles, *Color Science*, table 1(3.11)).
    #[test]
    fn black_bodies_have_their_colors() {
        for (kelvin, x, y) in [
            (2000.0, 0.5267, 0.4133),
            (2856.0, 0.4475, 0.4074),
            (5000.0, 0.3451, 0.3516),
            (6500.0, 0.3135, 0.3237),
            (10_000.0, 0.2807, 0.2884),
        ] {
            let xyz = xyz_of(kelvin);
            let sum = xyz.element_sum();
            let error = (xyz.x / sum - x).abs().max((xyz.y / sum - y).abs());
            assert!(error < 1e-3, "{kelvin} K: off by {error}");
        }
    }

    #[test]
    fn neutral_changes_nothing_and_others_keep_finite() {
        assert_eq!(balance(NEUTRAL), Mat3A::IDENTITY);
        assert!(balance(NEUTRAL + 0.01).abs_diff_eq(Mat3A::IDENTITY, 1e-4));
        for kelvin in [0.0, 1667.0, 4000.0, 25_000.0, f32::INFINITY] {
            assert!(balance(kelvin).is_finite(), "{kelvin}");
        }
    }
}
