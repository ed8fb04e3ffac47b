//! The color spaces of FLIP: opponent colors for blurring, Lab for distances.

use std::sync::LazyLock;

use glam::Mat3A;

use crate::image::tone::linear_from_srgb;
use crate::math::Rgb;

/// XYZ of linear Rec.709, by columns; from the primaries of IEC 61966-2-1 and the white that the
/// authors' program takes for D65, x = 0.31271 and y = 0.32902.
const XYZ_FROM_LINEAR: Mat3A = Mat3A::from_cols_array(&[
    0.412_386_57,
    0.212_636_82,
    0.019_330_62,
    0.357_591_5,
    0.715_183,
    0.119_197_16,
    0.180_450_49,
    0.072_180_2,
    0.950_372_6,
]);

/// Linear sRGB from CIE XYZ, the inverse of the matrix above.
static LINEAR_FROM_XYZ: LazyLock<Mat3A> = LazyLock::new(|| XYZ_FROM_LINEAR.inverse());

/// XYZ of the white of the screen.
const WHITE: Rgb = Rgb::new(0.950_428_55, 1.0, 1.088_900_4);

/// The display-linear value of every 8-bit sRGB code.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| linear_from_srgb(code as f32 / 255.0)));

/// The color YCxCz of an 8-bit sRGB code: lightness, red against green, yellow against blue, all
/// linear in light, so that they can be blurred (Kolpatzik and Bouman, 1992; the paper's section on
/// the color pipeline).
pub fn opponent_from_code(code: [u8; 3]) -> Rgb {
    let [r, g, b] = code.map(|code| LINEAR[usize::from(code)]);
    let [x, y, z] = (XYZ_FROM_LINEAR * Rgb::new(r, g, b) / WHITE).to_array();
    Rgb::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}

/// Display-linear Rec.709 of a color YCxCz; blurred colors may lie outside of 0..=1.
pub fn linear_from_opponent(opponent: Rgb) -> Rgb {
    let [lightness, cx, cz] = opponent.to_array();
    let y = (lightness + 16.0) / 116.0;
    *LINEAR_FROM_XYZ * (Rgb::new(y + cx / 500.0, y, y - cz / 200.0) * WHITE)
}

/// CIELAB of a display-linear color in 0..=1, its a and b made smaller where it is dark: there,
/// colors appear less vivid (Hunt, 1952).
pub fn hunt_lab(linear: Rgb) -> Rgb {
    let [x, y, z] = (XYZ_FROM_LINEAR * linear / WHITE).to_array().map(curve);
    let lightness = 116.0 * y - 16.0;
    let vividness = 0.01 * lightness;
    Rgb::new(lightness, vividness * 500.0 * (x - y), vividness * 200.0 * (y - z))
}

/// CIELAB's cube root, which is a line near black.
fn curve(value: f32) -> f32 {
    const DELTA: f32 = 6.0 / 29.0;
    if value > DELTA * DELTA * DELTA {
        value.cbrt()
    } else {
        value / (3.0 * DELTA * DELTA) + 4.0 / 29.0
    }
}

/// The distance HyAB of two colors, for large ones: lightness and color apart, then added (Abasi,
/// Tehran and Fairchild, "Distance metrics for very large color differences", 2020).
pub fn hyab(a: Rgb, b: Rgb) -> f32 {
    let difference = a - b;
    difference.x.abs() + difference.y.hypot(difference.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_has_no_color_and_codes_come_back() {
        let white = opponent_from_code([255; 3]);
        assert!(white.abs_diff_eq(Rgb::new(100.0, 0.0, 0.0), 1e-4), "{white}");
        let white = hunt_lab(Rgb::ONE);
        assert!(white.abs_diff_eq(Rgb::new(100.0, 0.0, 0.0), 1e-4), "{white}");
        let linear = linear_from_opponent(opponent_from_code([13, 128, 240]));
        // IEC 61966-2-1 by hand.
        let expected = Rgb::new(0.004_024_7, 0.215_860_5, 0.871_367_1);
        assert!(linear.abs_diff_eq(expected, 1e-5), "{linear}");
    }

    #[test]
    fn gray_is_at_its_lightness() {
        // CIE: L* = 116 (Y/Yn)^(1/3) - 16, and 903.3 Y/Yn near black.
        let gray = hunt_lab(Rgb::splat(0.184_186_5));
        assert!((gray.x - 50.0).abs() < 1e-3, "{gray}");
        let dark = hunt_lab(Rgb::splat(0.005));
        assert!((dark.x - 4.5165).abs() < 1e-3, "{dark}");
        assert_eq!(hyab(Rgb::new(1.0, 5.0, 0.0), Rgb::new(3.0, 2.0, 4.0)), 7.0);
    }
}
