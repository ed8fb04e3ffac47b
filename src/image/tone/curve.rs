//! Curves from exposed light to what a display can show.

use glam::{Mat3A, Vec3A};

use crate::math::Rgb;

/// The curve from exposed linear values to display-linear ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// No curve: values above 1 clip.
    Linear,
    /// A shoulder that lets fire go through yellow to white, and a toe that keeps blacks deep.
    #[default]
    Filmic,
    /// AgX, softer: bright colors fade to white early, as in Blender's view of that name.
    Agx,
}

/// Input beyond which curves are flat; also keeps squares finite.
const BRIGHTEST: f32 = 1.0e4;

/// AgX: stops of middle gray's light that the curve starts and ends at, over 1.
const AGX_STOPS: [f32; 2] = [-12.473_93, 4.026_069];
/// AgX: what each channel takes from the others before the curve, column by column.
const AGX_INSET: Mat3A = Mat3A::from_cols(
    Vec3A::new(0.842_479_1, 0.042_328_24, 0.042_375_66),
    Vec3A::new(0.078_433_6, 0.878_468_6, 0.078_433_6),
    Vec3A::new(0.079_223_745, 0.079_166_13, 0.879_143),
);
/// AgX: the inverse of the inset.
const AGX_OUTSET: Mat3A = Mat3A::from_cols(
    Vec3A::new(1.196_879, -0.052_896_85, -0.052_971_635),
    Vec3A::new(-0.098_020_88, 1.151_903_1, -0.098_043_45),
    Vec3A::new(-0.099_029_74, -0.098_961_18, 1.151_073_7),
);

impl ToneCurve {
    /// All curves, in the order in which a key goes through them.
    pub const ALL: [Self; 3] = [Self::Filmic, Self::Agx, Self::Linear];

    /// The next curve in the order of [`Self::ALL`], cyclic.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Filmic => Self::Agx,
            Self::Agx => Self::Linear,
            Self::Linear => Self::Filmic,
        }
    }

    /// Name of the curve in menus.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "Linear",
            Self::Filmic => "Filmic",
            Self::Agx => "AgX",
        }
    }

    /// The display-linear color, each channel in 0..=1.
    ///
    /// Filmic is Narkowicz's fit of the ACES reference curve ("ACES filmic tone mapping curve",
    /// 2015): x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) for each channel. AgX is Sobotka's,
    /// with the curve of Wrensch's fit ("Minimal AgX Implementation", 2023).
    #[inline]
    pub fn apply(self, color: Rgb) -> Rgb {
        let curved = match self {
            Self::Linear => color,
            Self::Filmic => {
                let x = color.clamp(Rgb::ZERO, Rgb::splat(BRIGHTEST));
                x * (2.51 * x + Rgb::splat(0.03))
                    / (x * (2.43 * x + Rgb::splat(0.59)) + Rgb::splat(0.14))
            }
            Self::Agx => agx(color.clamp(Rgb::ZERO, Rgb::splat(BRIGHTEST))),
        };
        curved.clamp(Rgb::ZERO, Rgb::ONE)
    }
}

fn agx(color: Rgb) -> Rgb {
    let [low, high] = AGX_STOPS;
    let mixed = AGX_INSET * color;
    let curved = mixed.to_array().map(|value| {
        let stops = value.max(1.0e-10).log2().clamp(low, high);
        agx_contrast((stops - low) / (high - low))
    });
    let coded = AGX_OUTSET * Rgb::from_array(curved);
    // The curve gives codes of a display with gamma 2.2.
    Rgb::from_array(coded.to_array().map(|value| value.clamp(0.0, 1.0).powf(2.2)))
}

/// The S of AgX, fitted by a polynomial, from and to 0..=1.
fn agx_contrast(x: f32) -> f32 {
    let coefficients = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.002_32];
    coefficients.into_iter().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_rise_from_black_to_white() {
        for curve in ToneCurve::ALL {
            let at = |value: f32| curve.apply(Rgb::splat(value)).x;
            assert_eq!(at(0.0), 0.0);
            assert_eq!(at(-1.0), 0.0);
            assert!(at(f32::MAX) > 0.99, "{curve:?}");
            let values: Vec<f32> = (0..2000).map(|i| at(i as f32 * 0.01)).collect();
            // The terms of the polynomial are large and round off by so much.
            assert!(values.windows(2).all(|pair| pair[1] > pair[0] - 2e-5), "{curve:?}");
        }
        let gray = ToneCurve::Filmic.apply(Rgb::splat(0.18)).x;
        assert!((gray - 0.267).abs() < 0.001, "{gray}");
        assert!(ToneCurve::Filmic.apply(Rgb::splat(1.0)).x < 0.85, "no room left for fire");
    }

    /// Sobotka's curve goes through middle gray: 0.18 is shown as the code 0.5 of gamma 2.2 or
    /// close to it.
    #[test]
    fn agx_keeps_gray_gray_and_middle_gray_in_the_middle() {
        let gray = ToneCurve::Agx.apply(Rgb::splat(0.18));
        assert!((gray.x.powf(1.0 / 2.2) - 0.5).abs() < 0.05, "{gray}");
        assert!((gray - Rgb::splat(gray.x)).abs().max_element() < 1e-3, "{gray}");
        let unity = AGX_INSET * AGX_OUTSET;
        assert!(unity.abs_diff_eq(Mat3A::IDENTITY, 1e-4), "{unity}");
    }

    #[test]
    fn agx_fades_bright_colors_to_white() {
        let fire = Rgb::new(1.0, 0.25, 0.02);
        let [dim, bright] = [0.3, 100.0].map(|factor| ToneCurve::Agx.apply(factor * fire));
        assert!(dim.z / dim.x < 0.1, "{dim}");
        assert!(bright.z / bright.x > 0.5, "{bright}");
    }

    #[test]
    fn the_key_goes_through_all_of_them() {
        let mut curve = ToneCurve::default();
        for expected in ToneCurve::ALL {
            assert_eq!(curve, expected);
            curve = curve.next();
        }
        assert_eq!(curve, ToneCurve::default());
    }
}
