//! Numbers as colors: a perceptual ramp from dark violet to pale yellow, one for numbers of either
//! sign, and logarithmic scales.

use std::sync::LazyLock;

use super::tone::srgb_from_linear;

/// Stops of the ramp; colors between them are mixed in linear light.
pub const STOPS: usize = 17;

/// The ramp in linear light, from the lowest to the highest.
///
/// It goes evenly up in Oklab's lightness (Ottosson, "A perceptual color space for image
/// processing", 2020) while the hue turns away from that of fire, which it is drawn over.
pub fn stops() -> &'static [[f32; 3]; STOPS] {
    static RAMP: LazyLock<[[f32; 3]; STOPS]> =
        LazyLock::new(|| std::array::from_fn(|index| stop(index as f32 / (STOPS - 1) as f32)));
    &RAMP
}

fn stop(t: f32) -> [f32; 3] {
    let lightness = 0.3 + 0.63 * t;
    // Screens show only pale cyans.
    let chroma = 0.12 - 0.03 * (std::f32::consts::PI * t).sin().powi(2);
    linear_from_hue(lightness, chroma, 300.0 - 195.0 * t)
}

fn linear_from_hue(lightness: f32, chroma: f32, hue_degrees: f32) -> [f32; 3] {
    let hue = hue_degrees.to_radians();
    linear_from_oklab([lightness, chroma * hue.cos(), chroma * hue.sin()])
        .map(|value| value.clamp(0.0, 1.0))
}

fn linear_from_oklab([lightness, a, b]: [f32; 3]) -> [f32; 3] {
    let l = (lightness + 0.396_337_78 * a + 0.215_803_76 * b).powi(3);
    let m = (lightness - 0.105_561_346 * a - 0.063_854_17 * b).powi(3);
    let s = (lightness - 0.089_484_18 * a - 1.291_485_5 * b).powi(3);
    [
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    ]
}

/// The sRGB code of the color at a place in 0..=1 of the ramp.
pub fn color(place: f32) -> [u8; 3] {
    let place = place.clamp(0.0, 1.0) * (STOPS - 1) as f32;
    let (index, part) = ((place as usize).min(STOPS - 2), place.fract());
    let part = if place as usize > index { 1.0 } else { part };
    let (low, high) = (stops()[index], stops()[index + 1]);
    srgb([0, 1, 2].map(|channel| low[channel] + part * (high[channel] - low[channel])))
}

/// The sRGB code of a number in -1..=1: blue below zero, orange above, nearly black at zero, and as
/// bright on either side.
pub fn signed_color(place: f32) -> [u8; 3] {
    srgb(signed(place))
}

/// Diverging color of a signed `place`, in linear light.
pub fn signed(place: f32) -> [f32; 3] {
    let strength = place.abs().min(1.0);
    let hue = if place < 0.0 { 250.0 } else { 60.0 };
    linear_from_hue(0.2 + 0.6 * strength, 0.11 * strength.sqrt(), hue)
}

fn srgb(linear: [f32; 3]) -> [u8; 3] {
    linear.map(|value| (srgb_from_linear(value) * 255.0).round() as u8)
}

/// A logarithmic scale between two positive numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Number at the low end of the ramp; smaller ones get the same color.
    pub low: f32,
    /// Number at the high end of the ramp; larger ones get the same color.
    pub high: f32,
}

/// The most that the ends of a scale differ by; fainter values would only dull the rest.
const MOST_SPAN: f32 = 1e4;

impl Scale {
    /// A scale between the smallest and the largest of some positive numbers.
    pub fn exact([low, high]: [f32; 2]) -> Self {
        Self { low: low.max(high / MOST_SPAN), high }
    }

    /// A scale as of [`Self::exact`], its ends moved outwards to 1, 2 or 5 times a power of ten, so
    /// that it rests while the numbers still change a little.
    pub fn rounded(range: [f32; 2]) -> Self {
        let Self { low, high } = Self::exact(range);
        let round = |value: f32, up: bool| {
            let value = f64::from(value);
            let decade = 10_f64.powf(value.log10().floor());
            let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
            let found = match up {
                true => steps.into_iter().find(|&step| step >= value * 0.9999),
                false => steps.into_iter().rev().find(|&step| step <= value * 1.0001),
            };
            found.unwrap_or(value) as f32
        };
        Self { low: round(low, false), high: round(high, true) }
    }

    /// A positive number, moved up to 1, 2 or 5 times a power of ten.
    pub fn rounded_up(value: f32) -> f32 {
        Self::rounded([value, value]).high
    }

    /// Position of a number between the ends, in 0..=1; 1 where they coincide.
    pub fn place(&self, value: f32) -> f32 {
        let span = (self.high / self.low).ln();
        if span > 0.0 { ((value / self.low).ln() / span).clamp(0.0, 1.0) } else { 1.0 }
    }

    /// The number in the middle of the scale.
    pub fn middle(&self) -> f32 {
        self.low.sqrt() * self.high.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_brightens_evenly_and_needs_no_clipping() {
        let mut last = 0.0;
        for index in 0..STOPS {
            let t = index as f32 / (STOPS - 1) as f32;
            let [r, g, b] = stops()[index];
            assert!([r, g, b].iter().all(|&value| value > 0.0 && value < 1.0), "stop {index}");
            // Oklab's lightness of a color, back from linear light.
            let l = (0.412_221_47 * r + 0.536_332_55 * g + 0.051_445_995 * b).cbrt();
            let m = (0.211_903_5 * r + 0.680_699_5 * g + 0.107_396_96 * b).cbrt();
            let s = (0.088_302_46 * r + 0.281_718_85 * g + 0.629_978_7 * b).cbrt();
            let lightness = 0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s;
            assert!((lightness - (0.3 + 0.63 * t)).abs() < 1e-3, "stop {index}: {lightness}");
            assert!(lightness > last);
            last = lightness;
        }
        assert_eq!(color(-1.0), color(0.0));
        assert_eq!(color(2.0), color(1.0));
        assert_ne!(color(0.97), color(1.0));
    }

    #[test]
    fn signed_numbers_are_as_bright_on_either_side() {
        let sum = |[r, g, b]: [u8; 3]| u32::from(r) + u32::from(g) + u32::from(b);
        let [mut last_blue, mut last_orange] = [0, 0];
        for step in 1..=10 {
            let place = step as f32 / 10.0;
            let (blue, orange) = (signed_color(-place), signed_color(place));
            assert!(blue[2] > blue[0] && orange[0] > orange[2], "{place}");
            assert!(sum(blue) > last_blue && sum(orange) > last_orange, "{place}");
            (last_blue, last_orange) = (sum(blue), sum(orange));
        }
        let [r, g, b] = signed_color(0.0);
        assert!(r == g && g == b && r < 30, "zero is no color");
        assert_eq!(signed_color(7.0), signed_color(1.0));
    }

    #[test]
    fn scales_are_logarithmic_and_rest_on_round_numbers() {
        let scale = Scale::rounded([3.2, 741.0]);
        assert_eq!((scale.low, scale.high), (2.0, 1000.0));
        assert_eq!(Scale::rounded([3.1, 812.0]), scale);
        assert_eq!([1.0, 2.0, 1000.0, 1e9].map(|value| scale.place(value)), [0.0, 0.0, 1.0, 1.0]);
        assert!((scale.place(scale.middle()) - 0.5).abs() < 1e-5);
        assert_eq!(Scale::rounded([1e-9, 50.0]), Scale { low: 0.005, high: 50.0 });
        let flat = Scale::exact([4.0, 4.0]);
        assert_eq!((flat.place(4.0), flat.middle()), (1.0, 4.0));
        let vast = Scale::exact([f32::MIN_POSITIVE, f32::MAX]);
        assert!(vast.place(vast.middle()).is_finite() && vast.middle() > 0.0);
    }
}
