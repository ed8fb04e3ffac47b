//! A half line.

use glam::Vec3A;

/// A half line `origin + t * direction`, `t >= 0`, with a unit direction unless said otherwise, at
/// one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin of the ray.
    pub origin: Vec3A,
    /// Direction of the ray, a unit vector unless said otherwise.
    pub direction: Vec3A,
    /// Time at which the ray sees the scene, in seconds after that of the frame, the middle of the
    /// time that the shutter is open.
    pub time: f32,
}

impl Ray {
    /// A ray from `origin` along `direction`, at the time of the frame.
    pub fn new(origin: Vec3A, direction: Vec3A) -> Self {
        Self { origin, direction, time: 0.0 }
    }

    /// A copy of the ray at another time.
    pub fn at_time(self, time: f32) -> Self {
        Self { time, ..self }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3A {
        self.origin + t * self.direction
    }
}
