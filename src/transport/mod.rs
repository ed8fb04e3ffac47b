//! How light moves through volumes: the strategies and the paths they sample.

pub mod strategy;

use crate::math::Rgb;

/// What one path brought to its pixel: four parts that sum to the beauty, and the rest of the AOVs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathSample {
    /// Volume emission seen on the camera segment.
    pub emission: Rgb,
    /// Environment and emitters seen directly.
    pub background: Rgb,
    /// Light after one scatter or reflection.
    pub direct: Rgb,
    /// Light after more than one.
    pub indirect: Rgb,
    /// One minus the transmittance to the background.
    pub alpha: f32,
    /// Distance of the first event or surface.
    pub depth: Option<f32>,
    /// Tentative collisions of the whole path.
    pub tracking_steps: u32,
    /// Whether the path was cut by the guard.
    pub guard_hit: bool,
}

/// Anything that can sample a pixel; the film and the session know nothing more.
pub trait PixelSampler: Send + Sync {
    /// The path of `sample` through `pixel`; the same for any thread.
    fn sample(&self, pixel: glam::UVec2, sample: u32) -> PathSample;
}
