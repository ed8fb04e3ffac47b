//! Maps of two pictures: how they differ, and how noisy each is.

use std::sync::Arc;

use rayon::prelude::*;

use super::measure::Measure;
use crate::app::document::Side;
use crate::app::picture::look::Look;
use crate::image::metrics::{ErrorMap, magma};
use crate::image::ramp::{self, Scale};
use crate::image::tone::{Tone, ToneCurve, false_color, linear_from_srgb};
use crate::render::{LayerMap, Picture};

/// Kind of the difference of gray values between A and B.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Difference {
    /// B − A.
    Signed,
    /// |B − A|.
    Absolute,
    /// |B − A| relative to the mean of A and B.
    Relative,
}

/// A map of noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Noise {
    /// Standard error of a side's pixels.
    Of(Side),
    /// Standard error of B over that of A.
    Ratio,
}

/// The kind of a map of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapKind {
    /// Differences of A and B.
    Difference(Difference),
    /// Noise of A or B, or the ratio of both.
    Noise(Noise),
    /// Errors of one picture against the reference: of that side, where there are two.
    Error(Measure, Option<Side>),
}

/// Numbers a pixel, as a picture to show.
#[derive(Clone, Debug)]
pub struct Map {
    /// Kind of the numbers.
    pub kind: MapKind,
    /// The picture.
    pub picture: Arc<Picture>,
    /// Tone or scale that the map is shown with.
    pub look: Look,
    /// Meaning of the colors.
    pub key: ColorKey,
}

/// The meaning of the colors of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorKey {
    /// The ramp of positive numbers.
    Ramp(Scale),
    /// Blue for less than the middle, orange for more; so far to either side.
    Diverging {
        /// The number at the ends.
        reach: f32,
        /// Whether the numbers are factors, 1 in the middle.
        factors: bool,
    },
    /// Magma, evenly from 0 to 1.
    Magma,
    /// False colors, one per stop of exposure from middle gray.
    Stops,
}

impl ColorKey {
    /// The 8-bit sRGB color at a place in 0..=1.
    pub fn color(self, place: f32) -> [u8; 3] {
        match self {
            Self::Ramp(_) => ramp::color(place),
            Self::Diverging { .. } => ramp::signed_color(2.0 * place - 1.0),
            Self::Magma => magma(place),
            Self::Stops => {
                let index = (place.max(0.0) * false_color::COLORS.len() as f32) as usize;
                false_color::COLORS[index.min(false_color::COLORS.len() - 1)]
            }
        }
    }

    /// The numbers at the start, in the middle and at the end.
    pub fn ends(self) -> [f32; 3] {
        match self {
            Self::Ramp(scale) => [scale.low, scale.middle(), scale.high],
            Self::Diverging { reach, factors: true } => [1.0 / reach, 1.0, reach],
            Self::Diverging { reach, factors: false } => [-reach, 0.0, reach],
            Self::Magma => [0.0, 0.5, 1.0],
            Self::Stops => [-1.0, 0.0, 1.0].map(|end| end * false_color::STOPS as f32),
        }
    }
}

/// The share of pixels that lie beyond the ends of a scale.
const BEYOND: f32 = 0.01;
/// The number added to the denominator of a relative difference, relative to the picture's mean.
const FLOOR: f32 = 0.01;

impl Map {
    /// The map of the pictures of A and B; `None` where they have different sizes or nothing to
    /// show yet.
    pub fn new(kind: MapKind, pictures: &[Arc<Picture>; 2]) -> Option<Self> {
        let [a, b] = pictures;
        if a.size != b.size {
            return None;
        }
        let values = match kind {
            MapKind::Difference(difference) => differences(difference, a, b),
            MapKind::Noise(Noise::Of(Side::A)) => errors(a),
            MapKind::Noise(Noise::Of(Side::B)) => errors(b),
            MapKind::Noise(Noise::Ratio) => {
                std::iter::zip(errors(a), errors(b)).map(|(a, b)| (b / a).ln()).collect()
            }
            // Two pictures do not tell.
            MapKind::Error(..) => return None,
        };
        let signed = match kind {
            MapKind::Difference(Difference::Signed) => Some(false),
            MapKind::Noise(Noise::Ratio) => Some(true),
            _ => None,
        };
        match signed {
            Some(factors) => Self::diverging(kind, a, &values, factors),
            None => Self::ramp(kind, a, values),
        }
    }

    /// The map of the errors of one picture; `None` where there are none.
    pub fn of_errors(kind: MapKind, errors: &ErrorMap) -> Option<Self> {
        let like = Picture { size: errors.size, ..Picture::default() };
        match kind {
            MapKind::Error(Measure::Flip, _) => {
                Some(Self::colored(kind, &like, ColorKey::Magma, {
                    errors.map.par_iter().map(|&error| linear(magma(error))).collect()
                }))
            }
            // The legend would have no numbers.
            _ if errors.mean == 0.0 => None,
            _ => Self::ramp(kind, &like, errors.map.clone()),
        }
    }

    /// Colors in linear light.
    fn colored(kind: MapKind, like: &Picture, key: ColorKey, pixels: Vec<[f32; 4]>) -> Self {
        let picture = Picture { size: like.size, pixels, complete: true, ..Picture::default() };
        let look = Look::Picture(Tone { curve: ToneCurve::Linear, ..Tone::default() });
        Self { kind, picture: Arc::new(picture), look, key }
    }

    /// Positive numbers on the ramp.
    fn ramp(kind: MapKind, like: &Picture, values: Vec<f32>) -> Option<Self> {
        let high = quantile(&values, 1.0 - BEYOND)?;
        let low = quantile(&values, BEYOND)?.min(high);
        let scale = Scale::rounded([low, high]);
        let values = values.into_iter().map(|v| if v.is_finite() { v } else { 0.0 }).collect();
        let picture = Picture {
            size: like.size,
            pixels: like.pixels.clone(),
            layer: LayerMap { numbers: values, range: Some([low, high]), ..LayerMap::default() },
            complete: true,
            ..Picture::default()
        };
        let (look, key) = (Look::Numbers(scale), ColorKey::Ramp(scale));
        Some(Self { kind, picture: Arc::new(picture), look, key })
    }

    /// Numbers of either sign; logarithms where they stand for `factors`.
    fn diverging(kind: MapKind, like: &Picture, values: &[f32], factors: bool) -> Option<Self> {
        let sizes: Vec<f32> = values.iter().map(|value| value.abs()).collect();
        let reach = quantile(&sizes, 1.0 - BEYOND)?;
        let reach = if factors { Scale::rounded_up(reach.exp()) } else { Scale::rounded_up(reach) };
        let span = if factors { reach.ln() } else { reach };
        let pixels = values.iter().map(|value| signed(value / span)).collect();
        Some(Self::colored(kind, like, ColorKey::Diverging { reach, factors }, pixels))
    }
}

/// The linear color of an 8-bit sRGB code.
fn linear(code: [u8; 3]) -> [f32; 4] {
    let [r, g, b] = code.map(|code| linear_from_srgb(f32::from(code) / 255.0));
    [r, g, b, 1.0]
}

/// The color of a number in −1..=1; black where it is not known.
fn signed(value: f32) -> [f32; 4] {
    let [r, g, b] = if value.is_finite() { ramp::signed(value) } else { [0.0; 3] };
    [r, g, b, 1.0]
}

fn gray(pixel: &[f32; 4]) -> f32 {
    (pixel[0] + pixel[1] + pixel[2]) / 3.0
}

fn differences(difference: Difference, a: &Picture, b: &Picture) -> Vec<f32> {
    let mean = a.pixels.iter().map(gray).sum::<f32>() / a.pixels.len().max(1) as f32;
    let pairs = a.pixels.par_iter().zip(&b.pixels);
    let of = |(a, b): (&[f32; 4], &[f32; 4])| {
        let (a, b) = (gray(a), gray(b));
        match difference {
            Difference::Signed => b - a,
            Difference::Absolute => (b - a).abs(),
            Difference::Relative => (b - a).abs() / (0.5 * (a + b) + FLOOR * mean),
        }
    };
    pairs.map(of).collect()
}

/// Standard errors of the gray values of the pixels.
fn errors(picture: &Picture) -> Vec<f32> {
    picture.variance.iter().map(|[variance, _]| variance.sqrt()).collect()
}

/// The number that a share of the finite ones other than zero does not exceed.
fn quantile(values: &[f32], share: f32) -> Option<f32> {
    let mut known: Vec<f32> =
        values.iter().copied().filter(|value| value.is_finite() && *value > 0.0).collect();
    let index = ((known.len() as f32 * share) as usize).min(known.len().checked_sub(1)?);
    Some(*known.select_nth_unstable_by(index, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::UVec2;

    fn picture(values: &[f32], variances: &[f32]) -> Arc<Picture> {
        Arc::new(Picture {
            size: UVec2::new(values.len() as u32, 1),
            pixels: values.iter().map(|&v| [v, v, v, 1.0]).collect(),
            variance: variances.iter().map(|&variance| [variance, 0.0]).collect(),
            ..Picture::default()
        })
    }

    fn map(kind: MapKind) -> Map {
        let a = picture(&[1.0, 2.0, 0.0, 4.0], &[1.0, 4.0, f32::NAN, 0.25]);
        let b = picture(&[1.0, 1.0, 0.5, 8.0], &[1.0, 1.0, 1.0, 4.0]);
        Map::new(kind, &[a, b]).unwrap()
    }

    #[test]
    fn signed_differences_tell_more_from_less() {
        let map = map(MapKind::Difference(Difference::Signed));
        assert_eq!(map.key, ColorKey::Diverging { reach: 5.0, factors: false });
        let pixels = &map.picture.pixels;
        assert_eq!(pixels[0][..3], ramp::signed(0.0));
        assert!(pixels[1][2] > pixels[1][0], "less is blue");
        assert!(pixels[3][0] > pixels[3][2] && pixels[3][0] > pixels[2][0], "more is orange");
    }

    #[test]
    fn noise_is_the_root_of_the_variance_and_unknown_is_black() {
        let map = map(MapKind::Noise(Noise::Of(Side::A)));
        assert_eq!(map.picture.layer.numbers, [1.0, 2.0, 0.0, 0.5]);
        assert_eq!(map.key, ColorKey::Ramp(Scale { low: 0.5, high: 2.0 }));
    }

    #[test]
    fn ratios_of_noise_lie_about_one() {
        let map = map(MapKind::Noise(Noise::Ratio));
        assert_eq!(map.key, ColorKey::Diverging { reach: 5.0, factors: true });
        let pixels = &map.picture.pixels;
        assert_eq!(pixels[0][..3], ramp::signed(0.0), "as noisy");
        assert!(pixels[1][2] > pixels[1][0] && pixels[3][0] > pixels[3][2]);
        assert_eq!(pixels[2][..3], [0.0; 3], "not known");
    }

    #[test]
    fn pictures_of_two_sizes_have_no_map() {
        let (a, b) = (picture(&[1.0], &[1.0]), picture(&[1.0, 2.0], &[1.0, 1.0]));
        assert!(Map::new(MapKind::Difference(Difference::Absolute), &[a, b]).is_none());
    }
}
