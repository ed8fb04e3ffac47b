//! White balance: which light is shown white.

use glam::{Mat3A, Vec2, Vec3A};

use crate::math::{Rgb, luminance};

/// The color temperature that changes nothing without a tint, in kelvin.
pub const NEUTRAL: f32 = 6500.0;
/// Temperatures that can be balanced, in kelvin: those of the formula for the Planckian locus.
pub const RANGE: [f32; 2] = [1667.0, 25_000.0];

/// Tints that can be balanced.
pub const TINTS: [f32; 2] = [-150.0, 150.0];
/// One unit of tint, as a distance in the CIE 1960 (u, v) diagram; the unit of raw converters.
const TINT_UNIT: f32 = 1.0 / 3000.0;

/// The most that a cone response is raised.
const MOST_GAIN: f32 = 32.0;

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

/// Takes the light of a black body at `kelvin`, greener by `tint` (more magenta where that is
/// negative), to that of one at [`NEUTRAL`], and all other colors along: von Kries adaptation of
/// Bradford's cone responses. What is out of [`RANGE`] and [`TINTS`] is taken as their ends.
pub fn balance(kelvin: f32, tint: f32) -> Mat3A {
    if kelvin == NEUTRAL && tint == 0.0 {
        return Mat3A::IDENTITY;
    }
    let adapt = Mat3A::from_diagonal(gains(kelvin, tint).into());
    let cones_from_rgb = CONES_FROM_XYZ * RGB_FROM_XYZ.inverse();
    cones_from_rgb.inverse() * adapt * cones_from_rgb
}

/// Linear color of luminance 1 of a black body at `kelvin`, relative to one at [`NEUTRAL`], which
/// is white.
pub fn of_temperature(kelvin: f32) -> Rgb {
    let color = balance(kelvin, 0.0).inverse() * Rgb::ONE;
    color / luminance(color)
}

/// Gain of each cone response. The greenest of warm lights are no colors any more: their missing
/// response is not made up for beyond [`MOST_GAIN`].
fn gains(kelvin: f32, tint: f32) -> Vec3A {
    let tinted = xyz_of_uv(tinted(kelvin, tint));
    let [from, to] = [tinted, xyz_of(NEUTRAL)].map(|xyz| CONES_FROM_XYZ * xyz);
    to / from.max(to / MOST_GAIN)
}

/// CIE 1960 (u, v) of a light `tint` units above the locus of black bodies, at `kelvin`.
fn tinted(kelvin: f32, tint: f32) -> Vec2 {
    let kelvin = kelvin.clamp(RANGE[0], RANGE[1]);
    let [colder, on_locus, hotter] =
        [kelvin / 1.01, kelvin, kelvin * 1.01].map(|kelvin| uv_of_xyz(xyz_of(kelvin)));
    let along = hotter - colder;
    // Along the locus u falls, so that this side of it is the green one.
    let green = Vec2::new(along.y, -along.x).normalize();
    on_locus + tint.clamp(TINTS[0], TINTS[1]) * TINT_UNIT * green
}

fn uv_of_xyz(xyz: Vec3A) -> Vec2 {
    Vec2::new(4.0 * xyz.x, 6.0 * xyz.y) / xyz.dot(Vec3A::new(1.0, 15.0, 3.0))
}

/// CIE XYZ of luminance 1.
fn xyz_of_uv(uv: Vec2) -> Vec3A {
    Vec3A::new(3.0 * uv.x, 2.0 * uv.y, 4.0 - uv.x - 10.0 * uv.y) / (2.0 * uv.y)
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
        assert_eq!(balance(NEUTRAL, 0.0), Mat3A::IDENTITY);
        assert!(balance(NEUTRAL + 0.01, 0.0).abs_diff_eq(Mat3A::IDENTITY, 1e-4));
        assert!(balance(NEUTRAL, 0.01).abs_diff_eq(Mat3A::IDENTITY, 1e-4));
        for kelvin in [0.0, 1667.0, 4000.0, 25_000.0, f32::INFINITY] {
            for tint in [f32::NEG_INFINITY, 0.0, 150.0] {
                assert!(balance(kelvin, tint).is_finite(), "{kelvin} {tint}");
            }
        }
    }

    /// A warm light that is much greener would have less than nothing of blue; it must not turn the
    /// picture's blue over.
    #[test]
    fn no_response_is_turned_over_or_raised_endlessly() {
        for step in 0..=40 {
            let kelvin = RANGE[0] * (RANGE[1] / RANGE[0]).powf(step as f32 / 40.0);
            assert!(gains(kelvin, 0.0).max_element() < 0.6 * MOST_GAIN, "{kelvin}: cut untinted");
            for tint in -30..=30 {
                let gains = gains(kelvin, 5.0 * tint as f32);
                let bounds = (gains.min_element(), gains.max_element());
                assert!(
                    bounds.0 > 0.1 && bounds.1 <= 1.0001 * MOST_GAIN,
                    "{kelvin} {tint} {bounds:?}"
                );
            }
        }
    }

    /// D65 lies 0.0032 above the locus at 6504 K (CIE 15, appendix E: (x, y) = (0.3127, 0.3290)).
    #[test]
    fn daylight_is_a_greener_black_body() {
        let d65 = Vec3A::new(0.3127, 0.3290, 0.3583) / 0.3290;
        let away = uv_of_xyz(d65).distance(tinted(6504.0, 0.0032 * 3000.0));
        assert!(away < 2e-4, "off by {away}");
        let shown = balance(6504.0, 9.6) * (RGB_FROM_XYZ * d65);
        let plain = balance(6504.0, 0.0) * (RGB_FROM_XYZ * d65);
        assert!((shown / shown.y - plain / plain.y).x > 0.01, "a green light is not made gray");
    }
}
