//! Tone mapping from linear light to the screen: white balance, exposure, curve, sRGB. The window's
//! shader does the same.

mod curve;
mod exposure;
pub mod false_color;
pub mod white;

use glam::Mat3A;

use crate::math::{Rgb, luminance};

pub use curve::ToneCurve;
pub use exposure::auto_exposure;

/// Channel of a color that is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Channel {
    /// The whole color.
    #[default]
    Color,
    /// Red, as gray.
    Red,
    /// Green, as gray.
    Green,
    /// Blue, as gray.
    Blue,
    /// Luminance, as gray.
    Luminance,
    /// Exposure in stops from middle gray, as a color of [`false_color::COLORS`].
    FalseColor,
}

impl Channel {
    /// All channels, in the order of menus.
    pub const ALL: [Self; 6] =
        [Self::Color, Self::Red, Self::Green, Self::Blue, Self::Luminance, Self::FalseColor];

    /// Name of the channel in menus.
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "Color",
            Self::Red => "Red",
            Self::Green => "Green",
            Self::Blue => "Blue",
            Self::Luminance => "Luminance",
            Self::FalseColor => "False color",
        }
    }

    /// The exposed linear color that is shown for `color`; of false color it is `color` itself.
    fn of(self, color: Rgb) -> Rgb {
        match self {
            Self::Color | Self::FalseColor => color,
            Self::Red => Rgb::splat(color.x),
            Self::Green => Rgb::splat(color.y),
            Self::Blue => Rgb::splat(color.z),
            Self::Luminance => Rgb::splat(luminance(color)),
        }
    }
}

/// Tone mapping of a picture for the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Stops of exposure: the picture is multiplied by 2 to this power.
    pub exposure: f32,
    /// Color temperature of the light that is shown white, in kelvin; without a tint
    /// [`white::NEUTRAL`] changes nothing.
    pub white: f32,
    /// Tint of the white point from -150 to 150: above 0 greener than a black body, below 0 more
    /// magenta.
    pub tint: f32,
    /// The curve after exposure.
    pub curve: ToneCurve,
    /// Channel of the color that is shown.
    pub channel: Channel,
}

impl Default for Tone {
    fn default() -> Self {
        Self {
            exposure: 0.0,
            white: white::NEUTRAL,
            tint: 0.0,
            curve: ToneCurve::default(),
            channel: Channel::default(),
        }
    }
}

impl Tone {
    /// Matrix from linear colors to white-balanced, exposed ones.
    pub fn exposed_from_linear(self) -> Mat3A {
        white::balance(self.white, self.tint) * self.exposure.exp2()
    }

    /// Encoder from linear colors to sRGB codes.
    pub fn encoder(self) -> Encoder {
        Encoder { tone: self, exposed_from_linear: self.exposed_from_linear() }
    }
}

/// Turns linear colors into 8-bit codes.
#[derive(Clone, Copy, Debug)]
pub struct Encoder {
    tone: Tone,
    exposed_from_linear: Mat3A,
}

impl Encoder {
    /// The 8-bit sRGB code of a linear color.
    pub fn encode(&self, color: Rgb) -> [u8; 3] {
        let Tone { curve, channel, .. } = self.tone;
        let exposed = self.exposed_from_linear * color.clamp(-BRIGHTEST, BRIGHTEST);
        if channel == Channel::FalseColor {
            return false_color::code(luminance(exposed));
        }
        let shown = curve.apply(channel.of(exposed));
        shown.to_array().map(|value| (srgb_from_linear(value) * 255.0).round() as u8)
    }
}

/// Keeps infinite light from becoming no number at all.
const BRIGHTEST: Rgb = Rgb::splat(1.0e20);

/// The sRGB code in 0..=1 of a display-linear value in 0..=1 (IEC 61966-2-1).
pub fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The display-linear value in 0..=1 of an sRGB code in 0..=1: the inverse of
/// [`srgb_from_linear`].
pub fn linear_from_srgb(code: f32) -> f32 {
    if code <= 0.040_45 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINEAR: Tone = Tone {
        exposure: 0.0,
        white: white::NEUTRAL,
        tint: 0.0,
        curve: ToneCurve::Linear,
        channel: Channel::Color,
    };

    #[test]
    fn codes_are_srgb() {
        let linear = LINEAR.encoder();
        assert_eq!(linear.encode(Rgb::new(0.0, 0.5, 1.0)), [0, 188, 255]);
        assert_eq!(linear.encode(Rgb::splat(0.002)), [7; 3]);
        assert_eq!(linear.encode(Rgb::splat(f32::INFINITY)), [255; 3]);
        let brighter = Tone { exposure: 1.0, ..LINEAR }.encoder();
        assert_eq!(brighter.encode(Rgb::splat(0.25)), [188; 3]);
        for code in 0..=255_u8 {
            let value = linear_from_srgb(f32::from(code) / 255.0);
            assert_eq!(linear.encode(Rgb::splat(value)), [code; 3]);
        }
    }

    #[test]
    fn channels_show_what_they_say() {
        let color = Rgb::new(0.0, 0.5, 1.0);
        let shown = |channel| Tone { channel, ..LINEAR }.encoder().encode(color);
        assert_eq!(shown(Channel::Red), [0; 3]);
        assert_eq!(shown(Channel::Green), [188; 3]);
        assert_eq!(shown(Channel::Blue), [255; 3]);
        // 0.7152 × 0.5 + 0.0722 = 0.4298 linear.
        assert_eq!(shown(Channel::Luminance), [175; 3]);
        let stop = false_color::COLORS[9];
        let one_up = Tone { channel: Channel::FalseColor, ..LINEAR }.encoder();
        assert_eq!(one_up.encode(Rgb::splat(0.36)), stop);
    }

    #[test]
    fn a_light_of_the_white_is_shown_gray() {
        let warm = white::of_temperature(2500.0);
        let [r, g, b] = Tone { white: 2500.0, ..LINEAR }.encoder().encode(0.4 * warm);
        assert!(r.abs_diff(g) <= 1 && g.abs_diff(b) <= 1, "{r} {g} {b}");
        let [r, _, b] = LINEAR.encoder().encode(0.4 * warm);
        assert!(r > b + 50, "{r} {b}");
    }
}
