//! The arguments of the choice among lights: emitters as the hierarchy sees them, and receivers.

use glam::Vec3A;

use crate::math::Aabb;

/// Upper bound of a light's importance, so that sums of importances stay finite.
pub(super) const MOST_IMPORTANT: f32 = 1e30;

/// A light as the hierarchy sees it.
#[derive(Clone, Copy, Debug)]
pub struct Emitter {
    /// A box around it.
    pub bounds: Aabb,
    /// Radiant intensity, W/sr; a rough value will do. Without any it is never chosen.
    pub intensity: f32,
    /// The cone outside of which a light like a spot sends nothing: its unit axis and the cosine of
    /// its half angle.
    pub cone: Option<(Vec3A, f32)>,
}

/// Where light is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// The point.
    pub position: Vec3A,
    /// On surfaces the unit normal of the lit side.
    pub normal: Option<Vec3A>,
}
