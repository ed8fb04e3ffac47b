//! Spheres.

use std::f32::consts::PI;

use glam::{Vec2, Vec3A};

use super::hit::{Hit, SurfacePoint, pdf_from_area};
use crate::{
    math::{OrthonormalBasis, Ray},
    sampling::warp::{uniform_cone, uniform_cone_pdf, uniform_sphere},
};

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// The middle.
    pub center: Vec3A,
    /// The radius.
    pub radius: f32,
}

impl Sphere {
    /// Surface area.
    pub fn area(&self) -> f32 {
        4.0 * PI * self.radius * self.radius
    }

    /// The first intersection with `ray` in (0, t_max).
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<Hit> {
        // From the nearest point of the line, which keeps its digits for spheres far away.
        let middle = (self.center - ray.origin).dot(ray.direction);
        let offset = ray.at(middle) - self.center;
        let squared = self.radius * self.radius - offset.length_squared();
        if squared <= 0.0 {
            return None;
        }
        let half = squared.sqrt();
        let (near, far) = (middle - half, middle + half);
        let t = if near > 0.0 { near } else { far };
        if !(t > 0.0 && t < t_max) {
            return None;
        }
        let normal = (ray.at(t) - self.center).normalize();
        Some(Hit { t, point: self.center + self.radius * normal, normal })
    }

    /// Draws a direction from `from`: uniform over the cone the sphere fills when seen from
    /// outside, to a point uniform over its area from inside.
    pub fn sample(&self, from: Vec3A, u: Vec2) -> Option<SurfacePoint> {
        let Some(one_minus_cos) = self.cone(from) else {
            let normal = uniform_sphere(u);
            let to_point = self.center + self.radius * normal - from;
            let outside = (from - self.center).length_squared() > self.radius * self.radius;
            if outside && normal.dot(to_point) > 0.0 {
                // The far side, hidden behind the near one.
                return None;
            }
            let pdf_solid_angle = pdf_from_area(1.0 / self.area(), to_point, normal);
            let distance = to_point.length();
            let direction = to_point / distance;
            return (pdf_solid_angle > 0.0).then_some(SurfacePoint {
                direction,
                distance,
                pdf_solid_angle,
            });
        };
        let axis = (self.center - from).normalize();
        let direction =
            OrthonormalBasis::around(axis).world_from_local(uniform_cone(u, one_minus_cos));
        // At the rim rounding may miss the sphere; the tangent point stands in.
        let distance = self
            .intersect(&Ray::new(from, direction), f32::INFINITY)
            .map_or((self.center - from).dot(direction), |hit| hit.t);
        Some(SurfacePoint { direction, distance, pdf_solid_angle: uniform_cone_pdf(one_minus_cos) })
    }

    /// Density over solid angle of [`Sphere::sample`] for a direction that ends at `hit`.
    pub fn pdf_solid_angle(&self, from: Vec3A, hit: &Hit) -> f32 {
        match self.cone(from) {
            Some(one_minus_cos) => uniform_cone_pdf(one_minus_cos),
            None => pdf_from_area(1.0 / self.area(), hit.point - from, hit.normal),
        }
    }

    /// 1 − cos of the half angle under which the sphere is seen; `None` from inside or close by.
    fn cone(&self, from: Vec3A) -> Option<f32> {
        let sin_squared = self.radius * self.radius / (self.center - from).length_squared();
        (sin_squared < 0.999).then(|| sin_squared / (1.0 + (1.0 - sin_squared).sqrt()))
    }
}
