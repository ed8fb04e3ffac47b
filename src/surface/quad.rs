//! Parallelograms.

use glam::{Vec2, Vec3A};

use super::hit::{Hit, SurfacePoint, pdf_from_area};
use crate::math::{Aabb, Ray};

/// A parallelogram: the points `center + a · edge_u + b · edge_v` with a and b in [−1, 1].
#[derive(Clone, Debug)]
pub struct Quad {
    /// The middle.
    pub center: Vec3A,
    /// First half edge.
    pub edge_u: Vec3A,
    /// Second half edge.
    pub edge_v: Vec3A,
    normal: Vec3A,
    /// Dual vectors: their dot products with an offset from the center are a and b.
    dual_u: Vec3A,
    dual_v: Vec3A,
}

impl Quad {
    /// A parallelogram from its middle and two half edges, which must not be parallel.
    pub fn new(center: Vec3A, edge_u: Vec3A, edge_v: Vec3A) -> Self {
        let cross = edge_u.cross(edge_v);
        let squared = cross.length_squared();
        let (dual_u, dual_v) = (edge_v.cross(cross) / squared, cross.cross(edge_u) / squared);
        Self { center, edge_u, edge_v, normal: cross / squared.sqrt(), dual_u, dual_v }
    }

    /// Area of one side.
    pub fn area(&self) -> f32 {
        4.0 * self.edge_u.cross(self.edge_v).length()
    }

    /// Bounding box of the parallelogram.
    pub fn bounds(&self) -> Aabb {
        let half = self.edge_u.abs() + self.edge_v.abs();
        Aabb::new(self.center - half, self.center + half)
    }

    /// The intersection with `ray` in (0, t_max).
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<Hit> {
        let t = (self.center - ray.origin).dot(self.normal) / ray.direction.dot(self.normal);
        if !(t > 0.0 && t < t_max) {
            return None;
        }
        let point = ray.at(t);
        let offset = point - self.center;
        let inside = offset.dot(self.dual_u).abs() <= 1.0 && offset.dot(self.dual_v).abs() <= 1.0;
        inside.then_some(Hit { t, point, normal: self.normal })
    }

    /// A point uniform over the area and the unit normal, from `u` in [0, 1)².
    pub fn point(&self, u: Vec2) -> (Vec3A, Vec3A) {
        let [a, b] = [2.0 * u.x - 1.0, 2.0 * u.y - 1.0];
        (self.center + a * self.edge_u + b * self.edge_v, self.normal)
    }

    /// Draws a point uniform over the area, as a direction from `from`.
    pub fn sample(&self, from: Vec3A, u: Vec2) -> Option<SurfacePoint> {
        let to_point = self.point(u).0 - from;
        let distance = to_point.length();
        let pdf_solid_angle = pdf_from_area(1.0 / self.area(), to_point, self.normal);
        let direction = to_point / distance;
        (pdf_solid_angle > 0.0).then_some(SurfacePoint { direction, distance, pdf_solid_angle })
    }
}
