//! Position and direction of a camera.

use glam::{Vec2, Vec3A};

/// A camera's position, target, direction of up and field of view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position of the camera in the world.
    pub position: Vec3A,
    /// The point that the camera looks at.
    pub target: Vec3A,
    /// The direction that points up in the picture.
    pub up: Vec3A,
    /// The full horizontal angle in degrees.
    pub fov_x: f32,
}

/// A camera's position and unit axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub position: Vec3A,
    pub forward: Vec3A,
    pub right: Vec3A,
    pub up: Vec3A,
    pub tan_half_fov_x: f32,
}

impl View {
    /// The view between this one, at 0, and `other`, at 1.
    #[must_use]
    pub fn lerp(&self, other: &Self, at: f32) -> Self {
        Self {
            position: self.position.lerp(other.position, at),
            target: self.target.lerp(other.target, at),
            up: self.up.lerp(other.up, at),
            fov_x: self.fov_x + at * (other.fov_x - self.fov_x),
        }
    }

    /// Position and axes; `None` where position and target coincide or `up` is along the view.
    pub(super) fn frame(&self) -> Option<Frame> {
        let forward = (self.target - self.position).try_normalize()?;
        let right = forward.cross(self.up.try_normalize()?);
        let right = (right.length() > 1e-6).then(|| right.normalize())?;
        let tan_half_fov_x = (0.5 * self.fov_x.to_radians()).tan();
        let (position, up) = (self.position, right.cross(forward));
        Some(Frame { position, forward, right, up, tan_half_fov_x })
    }
}

impl Frame {
    /// Offset from the unit axis of a view ray that passes the film at `place`, in half widths.
    pub fn across(&self, place: Vec2) -> Vec3A {
        self.tan_half_fov_x * (place.x * self.right + place.y * self.up)
    }
}
