//! From linear light to the screen: exposure, curve, sRGB. The window's shader does the same.

use crate::math::Rgb;

/// The curve from exposed linear values to display-linear ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// None: values above 1 clip.
    Linear,
    /// A shoulder that lets fire go through yellow to white, and a toe that keeps blacks deep.
    #[default]
    Filmic,
}

/// Beyond this the filmic curve is flat; also keeps its squares finite.
const BRIGHTEST: f32 = 1.0e4;

impl ToneCurve {
    /// The display-linear color, each channel in 0..=1.
    ///
    /// Filmic is Narkowicz's fit of the ACES reference curve ("ACES filmic tone mapping curve",
    /// 2015): x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) for each channel.
    #[inline]
    pub fn apply(self, color: Rgb) -> Rgb {
        let curved = match self {
            Self::Linear => color,
            Self::Filmic => {
                let x = color.clamp(Rgb::ZERO, Rgb::splat(BRIGHTEST));
                x * (2.51 * x + Rgb::splat(0.03))
                    / (x * (2.43 * x + Rgb::splat(0.59)) + Rgb::splat(0.14))
            }
        };
        curved.clamp(Rgb::ZERO, Rgb::ONE)
    }
}

/// How a picture is brought to the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    /// Stops of exposure: the picture is multiplied by 2 to this power.
    pub exposure: f32,
    /// The curve after exposure.
    pub curve: ToneCurve,
}

impl Tone {
    /// The 8-bit sRGB code of a linear color.
    pub fn encode(self, color: Rgb) -> [u8; 3] {
        let shown = self.curve.apply(color * self.exposure.exp2());
        shown.to_array().map(|value| (srgb_from_linear(value) * 255.0).round() as u8)
    }
}

/// The sRGB code in 0..=1 of a display-linear value in 0..=1 (IEC 61966-2-1).
pub fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_rise_from_black_to_white() {
        for curve in [ToneCurve::Linear, ToneCurve::Filmic] {
            let at = |value: f32| curve.apply(Rgb::splat(value)).x;
            assert_eq!(at(0.0), 0.0);
            assert_eq!(at(-1.0), 0.0);
            assert_eq!(at(f32::MAX), 1.0);
            let values: Vec<f32> = (0..2000).map(|i| at(i as f32 * 0.01)).collect();
            assert!(values.is_sorted(), "{curve:?}");
        }
        let gray = ToneCurve::Filmic.apply(Rgb::splat(0.18)).x;
        assert!((gray - 0.267).abs() < 0.001, "{gray}");
        assert!(ToneCurve::Filmic.apply(Rgb::splat(1.0)).x < 0.85, "no room left for fire");
    }

    #[test]
    fn codes_are_srgb() {
        let linear = Tone { exposure: 0.0, curve: ToneCurve::Linear };
        assert_eq!(linear.encode(Rgb::new(0.0, 0.5, 1.0)), [0, 188, 255]);
        assert_eq!(linear.encode(Rgb::splat(0.002)), [7; 3]);
        let brighter = Tone { exposure: 1.0, ..linear };
        assert_eq!(brighter.encode(Rgb::splat(0.25)), [188; 3]);
        assert_eq!(linear.encode(Rgb::splat(f32::INFINITY)), [255; 3]);
    }
}
