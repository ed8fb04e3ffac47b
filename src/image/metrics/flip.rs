//! FLIP: the differences that somebody notices who flips between two pictures on a screen.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference
//! Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive
//! Techniques 3(2), 2020. Two pipelines look at the displayed pictures:
//!
//! - colors, blurred as the eye blurs them at this distance ([`contrast`]), compared in a space in
//!   which distances are evenly large ([`color`]);
//! - edges and points ([`features`]), since sharp differences are seen before others.
//!
//! The difference of features is the power that raises the difference of colors. Errors are between
//! 0, the same, and 1, pure green in place of pure blue.

mod color;
mod contrast;
mod features;
mod filter;
#[cfg(test)]
mod tests;

use glam::UVec2;
use rayon::prelude::*;

use super::ErrorMap;
use crate::error::{Error, Result};
use crate::image::reference::Reference;
use crate::image::tone::Tone;
use crate::math::Rgb;
use color::{hunt_lab, hyab, linear_from_opponent, opponent_from_code};
use contrast::Contrast;
use features::{Detectors, Features};

/// Pixels in a degree of the viewer's visual field as the paper assumes: a screen of 3840 pixels on
/// 0.7 m, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 67.020_64;

/// Compresses differences of color (q_c of the paper).
const COLOR_POWER: f32 = 0.7;
/// Share of the largest color difference (p_c) up to which errors rise to [`KNEE_ERROR`].
const KNEE: f32 = 0.4;
/// Error at the knee (p_t); larger differences share the rest of the range.
const KNEE_ERROR: f32 = 0.95;
/// Widens differences of features (q_f).
const FEATURE_POWER: f32 = 0.5;

/// Viewing conditions of both pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewing {
    /// Tone mapping that brings both pictures to the screen.
    pub tone: Tone,
    /// Pixels in a degree of the visual field, from 1 to 1000: d · w · π / 180 for a screen with w
    /// pixels per meter seen from d meters. The more, the smaller are details, and the less is
    /// seen.
    pub pixels_per_degree: f32,
}

impl Default for Viewing {
    fn default() -> Self {
        Self { tone: Tone::default(), pixels_per_degree: PIXELS_PER_DEGREE }
    }
}

/// The FLIP errors of linear `picture`, both shown as `viewing` says. Runs on the threads of the
/// calling pool.
///
/// # Errors
/// As [`Flip::new`] and [`Flip::compare`].
pub fn flip(picture: &[[f32; 4]], reference: &Reference, viewing: Viewing) -> Result<ErrorMap> {
    Flip::new(reference, viewing)?.compare(picture)
}

/// A reference as the eye sees it, for comparing many pictures with it.
#[derive(Clone, Debug)]
pub struct Flip<'a> {
    reference: &'a Reference,
    tone: Tone,
    eye: Eye,
    seen: PerceivedImage,
}

impl<'a> Flip<'a> {
    /// Perceives `reference` once, for comparison with many pictures. Runs on the threads of the
    /// calling pool.
    ///
    /// # Errors
    /// When the pixels per degree are out of their range.
    pub fn new(reference: &'a Reference, viewing: Viewing) -> Result<Self> {
        let eye = Eye::new(viewing.pixels_per_degree)?;
        let seen = eye.filter(&codes(reference.pixels(), viewing.tone), reference.size());
        Ok(Self { reference, tone: viewing.tone, eye, seen })
    }

    /// The FLIP errors of linear `picture`. Runs on the threads of the calling pool.
    ///
    /// # Errors
    /// When `picture` has another number of pixels than the reference.
    pub fn compare(&self, picture: &[[f32; 4]]) -> Result<ErrorMap> {
        self.reference.check_pixels(picture)?;
        let size = self.reference.size();
        let seen = self.eye.filter(&codes(picture, self.tone), size);
        Ok(ErrorMap::new(size, difference(&self.seen, &seen)))
    }
}

fn codes(pixels: &[[f32; 4]], tone: Tone) -> Vec<[u8; 3]> {
    let encoder = tone.encoder();
    pixels.par_iter().map(|&[r, g, b, _]| encoder.encode(Rgb::new(r, g, b))).collect()
}

/// Filters of the eye at one viewing distance.
#[derive(Clone, Debug)]
struct Eye {
    contrast: Contrast,
    detectors: Detectors,
}

/// A picture as the eye sees it.
#[derive(Clone, Debug)]
struct PerceivedImage {
    /// Blurred colors, see [`hunt_lab`].
    colors: Vec<Rgb>,
    features: Features,
}

impl Eye {
    fn new(pixels_per_degree: f32) -> Result<Self> {
        if !(1.0..=1000.0).contains(&pixels_per_degree) {
            let reason = format!("{pixels_per_degree} must be from 1 to 1000");
            return Err(Error::invalid("", "pixels_per_degree", reason));
        }
        let pixels_per_degree = f64::from(pixels_per_degree);
        Ok(Self {
            contrast: Contrast::new(pixels_per_degree),
            detectors: Detectors::new(pixels_per_degree),
        })
    }

    /// Filters 8-bit sRGB `codes` of a picture of `size` as the eye does.
    fn filter(&self, codes: &[[u8; 3]], size: UVec2) -> PerceivedImage {
        let width = size.x as usize;
        let plane = |channel: usize| -> Vec<f32> {
            codes.par_iter().map(|&code| opponent_from_code(code)[channel]).collect()
        };
        let mut lightness = plane(0);
        let blurred = [
            self.contrast.blur(0, &lightness, width),
            self.contrast.blur(1, &plane(1), width),
            self.contrast.blur(2, &plane(2), width),
        ];
        let [y, cx, cz] = &blurred;
        let colors = (y, cx, cz)
            .into_par_iter()
            .map(|(&y, &cx, &cz)| {
                let linear = linear_from_opponent(Rgb::new(y, cx, cz));
                hunt_lab(linear.clamp(Rgb::ZERO, Rgb::ONE))
            })
            .collect();
        lightness.par_iter_mut().for_each(|y| *y = (*y + 16.0) / 116.0);
        PerceivedImage { colors, features: self.detectors.detect(&lightness, width) }
    }
}

/// The errors between two pictures of one size.
fn difference(reference: &PerceivedImage, picture: &PerceivedImage) -> Vec<f32> {
    let largest = hyab(hunt_lab(Rgb::Y), hunt_lab(Rgb::Z)).powf(COLOR_POWER);
    let features = reference.features.difference(&picture.features);
    (&reference.colors, &picture.colors, features)
        .into_par_iter()
        .map(|(&a, &b, feature)| {
            let color = spread(hyab(a, b).powf(COLOR_POWER), largest);
            color.powf(1.0 - feature.powf(FEATURE_POWER))
        })
        .collect()
}

/// Errors from 0 to 1 of compressed differences of color up to `largest`: those above the knee are
/// rare and don't need much room.
fn spread(difference: f32, largest: f32) -> f32 {
    let knee = KNEE * largest;
    if difference < knee {
        KNEE_ERROR * difference / knee
    } else {
        KNEE_ERROR + (1.0 - KNEE_ERROR) * (difference - knee) / (largest - knee)
    }
}
