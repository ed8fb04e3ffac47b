//! Light that arrives from one sampled direction.

use glam::Vec3A;

use crate::math::Rgb;

/// Light arriving at a point from one sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub direction: Vec3A,
    /// Distance to the light; infinite for the sun.
    pub distance: f32,
    /// Radiance, or for a light of a single direction its irradiance across it.
    pub radiance: Rgb,
    /// Density over solid angle; 1 for a light of a single direction.
    pub pdf: f32,
    /// Whether a scattered ray can meet the light too, so that MIS must weight it.
    pub can_be_met: bool,
}
