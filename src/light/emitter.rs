//! Arguments of the choice among lights: emitters, which summarize lights for the hierarchy, and
//! receivers.

use glam::Vec3A;

use crate::math::Aabb;

/// Upper bound of a light's importance, so that sums of importances stay finite.
pub(super) const MOST_IMPORTANT: f32 = 1e30;

/// Summary of a light for the hierarchy.
#[derive(Clone, Copy, Debug)]
pub struct Emitter {
    /// A box around the light.
    pub bounds: Aabb,
    /// Radiant intensity, W/sr; a rough value will do. A light of intensity 0 is never chosen.
    pub intensity: f32,
    /// The cone outside of which a light like a spot sends nothing: its unit axis and the cosine of
    /// its half angle.
    pub cone: Option<(Vec3A, f32)>,
}

/// A point that light samples are drawn for.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// Position in world space.
    pub position: Vec3A,
    /// Unit normal of the lit side on a surface; `None` in a volume.
    pub normal: Option<Vec3A>,
}
