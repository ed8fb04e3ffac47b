//! What one path brings to its pixel, and whatever can sample a pixel.

use glam::UVec2;

use crate::math::Rgb;

/// What one path brought to its pixel: four parts that sum to the beauty, and what else is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathSample {
    /// Volume emission seen on the camera ray.
    pub emission: Rgb,
    /// Environment and emitting surfaces seen directly.
    pub background: Rgb,
    /// Light after one scattering event or reflection.
    pub direct: Rgb,
    /// Light after more of them.
    pub indirect: Rgb,
    /// 1 − transmittance to the background; 1 on surfaces.
    pub alpha: f32,
    /// Distance of the first event or surface, if there was one.
    pub depth: Option<f32>,
    /// Tentative collisions of all walks of the path, and steps of ray marching.
    pub tracking_steps: u32,
    /// Whether the path was cut, at [`path::GUARD`] events or [`tracking::MOST_COLLISIONS`].
    pub guard_hit: bool,
}

impl PathSample {
    /// All light of the path.
    pub fn beauty(&self) -> Rgb {
        self.emission + self.background + self.direct + self.indirect
    }
}

/// Anything that can sample a pixel: film and session know nothing more.
pub trait PixelSampler: Send + Sync {
    /// The path of this sample of this pixel; the same arguments give the same path.
    fn sample(&self, pixel: UVec2, sample: u32) -> PathSample;

    /// How often probes are asked, relative to what they propose; `None` until that is found out,
    /// and where it never is.
    fn found_flights(&self) -> Option<f32> {
        None
    }
}
