//! A direction that was drawn towards an environment.

use glam::Vec3A;

use crate::math::Rgb;

/// A direction in the environment's own space, as it was drawn.
#[derive(Clone, Copy, Debug)]
pub(in crate::light) struct DrawnDirection {
    /// The unit direction.
    pub(super) direction: Vec3A,
    /// Radiance from there.
    pub(super) radiance: Rgb,
    /// Density over solid angle.
    pub(super) pdf_solid_angle: f32,
}
