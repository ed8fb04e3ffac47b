//! A half line.

use glam::Vec3A;

/// A half line `origin + t * direction`, `t >= 0`, with a unit direction unless said otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin of the ray.
    pub origin: Vec3A,
    /// Direction of the ray, a unit vector unless said otherwise.
    pub direction: Vec3A,
}

impl Ray {
    /// A ray from `origin` along `direction`.
    pub fn new(origin: Vec3A, direction: Vec3A) -> Self {
        Self { origin, direction }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3A {
        self.origin + t * self.direction
    }
}
