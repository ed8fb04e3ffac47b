//! Points of surfaces: intersections with rays, and samples of lights.

use glam::Vec3A;

/// Rounding of a hit point relative to the numbers it was computed from, with room to spare.
const RELATIVE_ERROR: f32 = 64.0 * f32::EPSILON;

/// Intersection of a ray with a shape.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Ray parameter.
    pub t: f32,
    /// Position of the intersection.
    pub point: Vec3A,
    /// Unit normal of the shape, on no particular side of the ray.
    pub normal: Vec3A,
}

impl Hit {
    /// Distance from the point at which a ray must start so that it doesn't meet the same place
    /// again.
    pub fn offset(&self) -> f32 {
        RELATIVE_ERROR * (self.t + self.point.abs().max_element() + 1e-3)
    }
}

/// A point drawn on a light.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Unit direction towards the point.
    pub direction: Vec3A,
    /// Distance to the point.
    pub distance: f32,
    /// Density over solid angle of the direction, 1/sr.
    pub pdf_solid_angle: f32,
}

/// Density over solid angle of a point drawn with `pdf_area`, seen along `to_point`.
pub(super) fn pdf_from_area(pdf_area: f32, to_point: Vec3A, normal: Vec3A) -> f32 {
    let squared = to_point.length_squared();
    let cos_times_distance = to_point.dot(normal).abs();
    if cos_times_distance <= 0.0 {
        return 0.0;
    }
    pdf_area * squared * squared.sqrt() / cos_times_distance
}
