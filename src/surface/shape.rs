//! The shapes of surfaces: intersection, and sampling of those that can be lights.

use glam::{Vec2, Vec3A};

use super::hit::{Hit, SurfacePoint, pdf_from_area};
use super::quad::Quad;
use super::sphere::Sphere;
use crate::{
    math::{Aabb, OrthonormalBasis, Ray},
    sampling::warp::uniform_sphere,
};

/// A shape in the world.
#[derive(Clone, Debug)]
pub enum Shape {
    /// An infinite plane.
    Plane {
        /// A point of the plane.
        point: Vec3A,
        /// Unit normal of the plane.
        normal: Vec3A,
    },
    /// A parallelogram.
    Quad(Quad),
    /// A sphere.
    Sphere(Sphere),
    /// An axis-aligned box, as its six faces.
    Box(Box<[Quad; 6]>),
}

impl Shape {
    /// A square of a plane, or all of it without `half_size`. Its edges follow the plane's frame;
    /// for a normal along z these are x and y.
    pub fn plane(point: Vec3A, normal: Vec3A, half_size: Option<f32>) -> Self {
        match half_size {
            None => Self::Plane { point, normal },
            Some(half) => {
                let frame = OrthonormalBasis::around(normal);
                Self::Quad(Quad::new(point, half * frame.tangent, half * frame.bitangent))
            }
        }
    }

    /// An axis-aligned box.
    pub fn cuboid(center: Vec3A, half_size: Vec3A) -> Self {
        let face = |i: usize| {
            let axis = i / 2;
            let sign = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            let edge = |a: usize| Vec3A::AXES[a % 3] * half_size[a % 3];
            Quad::new(center + sign * edge(axis), edge(axis + 1), edge(axis + 2))
        };
        Self::Box(Box::new(std::array::from_fn(face)))
    }

    /// The first intersection with `ray` in (0, t_max). A ray that starts on the shape must be
    /// offset first.
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<Hit> {
        match self {
            Self::Plane { point, normal } => {
                let t = (*point - ray.origin).dot(*normal) / ray.direction.dot(*normal);
                (t > 0.0 && t < t_max).then(|| Hit { t, point: ray.at(t), normal: *normal })
            }
            Self::Quad(quad) => quad.intersect(ray, t_max),
            Self::Sphere(sphere) => sphere.intersect(ray, t_max),
            Self::Box(faces) => faces.iter().fold(None, |nearest: Option<Hit>, face| {
                let t_max = nearest.map_or(t_max, |hit| hit.t);
                face.intersect(ray, t_max).or(nearest)
            }),
        }
    }

    /// Surface area; `None` where it is infinite, so that the shape cannot be sampled.
    pub fn area(&self) -> Option<f32> {
        match self {
            Self::Plane { .. } => None,
            Self::Quad(quad) => Some(quad.area()),
            Self::Sphere(sphere) => Some(sphere.area()),
            Self::Box(faces) => Some(faces.iter().map(Quad::area).sum()),
        }
    }

    /// Bounding box of the shape; `None` where it is infinite.
    pub fn bounds(&self) -> Option<Aabb> {
        match self {
            Self::Plane { .. } => None,
            Self::Quad(quad) => Some(quad.bounds()),
            Self::Sphere(sphere) => {
                let half = Vec3A::splat(sphere.radius);
                Some(Aabb::new(sphere.center - half, sphere.center + half))
            }
            Self::Box(faces) => {
                Some(faces.iter().fold(Aabb::EMPTY, |all, face| all.union(&face.bounds())))
            }
        }
    }

    /// A point uniform over the shape's area, and the unit normal there. `None` for infinite
    /// shapes.
    pub fn point(&self, pick: f32, u: Vec2) -> Option<(Vec3A, Vec3A)> {
        match self {
            Self::Plane { .. } => None,
            Self::Quad(quad) => Some(quad.point(u)),
            Self::Sphere(sphere) => {
                let normal = uniform_sphere(u);
                Some((sphere.center + sphere.radius * normal, normal))
            }
            Self::Box(faces) => Some(face_by_area(faces, pick).0.point(u)),
        }
    }

    /// Draws a direction from `from` towards the shape. `None` where it cannot be sampled.
    pub fn sample(&self, from: Vec3A, pick: f32, u: Vec2) -> Option<SurfacePoint> {
        match self {
            Self::Plane { .. } => None,
            Self::Quad(quad) => quad.sample(from, u),
            Self::Sphere(sphere) => sphere.sample(from, u),
            Self::Box(faces) => {
                let (face, total) = face_by_area(faces, pick);
                let mut point = face.sample(from, u)?;
                if faces_away(faces, face, from, &point) {
                    return None;
                }
                point.pdf_solid_angle *= face.area() / total;
                Some(point)
            }
        }
    }

    /// Density over solid angle with which [`Shape::sample`] draws the unit `direction` from
    /// `from` such that it ends at `hit`.
    pub fn pdf_solid_angle(&self, from: Vec3A, hit: &Hit) -> f32 {
        match self {
            Self::Plane { .. } => 0.0,
            Self::Sphere(sphere) => sphere.pdf_solid_angle(from, hit),
            Self::Quad(_) | Self::Box(_) => {
                let area = self.area().unwrap_or(f32::INFINITY);
                pdf_from_area(1.0 / area, hit.point - from, hit.normal)
            }
        }
    }
}

/// The face of a box that `pick`, in [0, 1), chooses by area, and the area of all.
fn face_by_area(faces: &[Quad; 6], pick: f32) -> (&Quad, f32) {
    let total: f32 = faces.iter().map(Quad::area).sum();
    let mut left = pick * total;
    let face = faces.iter().find(|face| {
        left -= face.area();
        left < 0.0
    });
    (face.unwrap_or(&faces[5]), total)
}

/// Whether `point` lies on the far side of a box seen from outside, hidden behind the near side.
fn faces_away(faces: &[Quad; 6], face: &Quad, from: Vec3A, point: &SurfacePoint) -> bool {
    let center = 0.5 * (faces[0].center + faces[1].center);
    let outside = faces.iter().any(|f| (from - f.center).dot(f.center - center) > 0.0);
    outside && point.direction.dot(face.center - center) > 0.0
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::{
        math::PathRng,
        sampling::warp::{UNIFORM_SPHERE_PDF, uniform_sphere},
    };

    fn shapes() -> [Shape; 4] {
        [
            Shape::plane(
                Vec3A::new(0.2, -0.1, 0.9),
                Vec3A::new(0.3, 0.1, 1.0).normalize(),
                Some(0.8),
            ),
            Shape::Sphere(Sphere { center: Vec3A::new(1.0, 0.5, 0.4), radius: 0.7 }),
            Shape::Sphere(Sphere { center: Vec3A::new(0.1, 0.2, 0.0), radius: 2.0 }),
            Shape::cuboid(Vec3A::new(-1.5, 0.2, 0.1), Vec3A::new(0.5, 0.7, 0.3)),
        ]
    }

    /// The solid angle seen from a point is the integral of visibility; both estimates of it, by
    /// uniform directions and by the shape's own, must agree.
    #[test]
    fn sampling_and_density_measure_the_same_solid_angle() {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let from = Vec3A::new(-0.1, 0.05, 0.02);
        for (number, shape) in shapes().iter().enumerate() {
            let n = 400_000;
            let (mut uniform, mut own) = (0.0, 0.0);
            for _ in 0..n {
                let direction = uniform_sphere(Vec2::new(rng.uniform(), rng.uniform()));
                let ray = Ray::new(from, direction);
                if shape.intersect(&ray, f32::INFINITY).is_some() {
                    uniform += 1.0 / UNIFORM_SPHERE_PDF;
                }
                let u = Vec2::new(rng.uniform(), rng.uniform());
                let Some(point) = shape.sample(from, rng.uniform(), u) else { continue };
                let ray = Ray::new(from, point.direction);
                let hit = shape.intersect(&ray, f32::INFINITY);
                let hit = hit.filter(|hit| hit.t > 0.999_99 * point.distance);
                if let Some(hit) = hit {
                    let pdf = shape.pdf_solid_angle(from, &hit);
                    let ratio = pdf / point.pdf_solid_angle;
                    assert!(
                        (ratio - 1.0).abs() < 1e-2,
                        "shape {number}: {ratio} {point:?} {hit:?}"
                    );
                    own += 1.0 / point.pdf_solid_angle;
                }
            }
            let (uniform, own) = (uniform / n as f32, own / n as f32);
            // Standard error of the uniform estimate: below 0.01 sr for these shapes.
            assert!((uniform - own).abs() < 0.05, "shape {number}: {uniform} {own}");
        }
    }
}
