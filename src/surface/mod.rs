//! Surfaces: shapes, their materials, and the nearest one along a ray.

mod bsdf;
mod hit;
mod quad;
mod shape;
mod sphere;

pub use bsdf::{Bsdf, Material};
pub use hit::{Hit, SurfacePoint};
pub use quad::Quad;
pub use shape::Shape;
pub use sphere::Sphere;

use crate::math::{Ray, Rgb};

/// A shape with its material and what it radiates.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its shape.
    pub shape: Shape,
    /// How it reflects.
    pub material: Material,
    /// Radiance it emits from both sides.
    pub emission: Rgb,
}

impl Surface {
    /// Whether it emits at all.
    pub fn emits(&self) -> bool {
        self.emission.max_element() > 0.0
    }

    /// Whether paths go on from it.
    pub fn reflects(&self) -> bool {
        self.material != Material::Black
    }
}

/// Where a ray meets the surfaces first.
#[derive(Clone, Copy, Debug)]
pub struct Intersection<'s> {
    /// Index of the surface.
    pub index: usize,
    /// The surface itself.
    pub surface: &'s Surface,
    /// Ray parameter and geometry of the meeting.
    pub hit: Hit,
}

/// The nearest surface along `ray`.
pub fn intersect<'s>(surfaces: &'s [Surface], ray: &Ray) -> Option<Intersection<'s>> {
    let mut nearest: Option<Intersection<'s>> = None;
    for (index, surface) in surfaces.iter().enumerate() {
        let t_max = nearest.map_or(f32::INFINITY, |found| found.hit.t);
        if let Some(hit) = surface.shape.intersect(ray, t_max) {
            nearest = Some(Intersection { index, surface, hit });
        }
    }
    nearest
}

/// Whether anything lies on `ray` before parameter `t_max`.
pub fn occluded(surfaces: &[Surface], ray: &Ray, t_max: f32) -> bool {
    surfaces.iter().any(|surface| surface.shape.intersect(ray, t_max).is_some())
}
