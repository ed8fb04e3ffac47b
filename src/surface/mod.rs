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

/// A shape with its material and emission.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Shape in world space.
    pub shape: Shape,
    /// Reflection of the surface.
    pub material: Material,
    /// Emitted radiance, the same on both sides.
    pub emission: Rgb,
}

impl Surface {
    /// Whether the surface emits.
    pub fn emits(&self) -> bool {
        self.emission.max_element() > 0.0
    }

    /// Whether the surface reflects, so that paths go on from it.
    pub fn reflects(&self) -> bool {
        self.material != Material::Black
    }
}

/// The nearest intersection of a ray with the surfaces.
#[derive(Clone, Copy, Debug)]
pub struct Intersection<'s> {
    /// Index of the surface.
    pub index: usize,
    /// The surface itself.
    pub surface: &'s Surface,
    /// Ray parameter and geometry of the intersection.
    pub hit: Hit,
}

/// The nearest intersection of `ray` with the surfaces.
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

/// Whether any surface occludes `ray` before parameter `t_max`.
pub fn occluded(surfaces: &[Surface], ray: &Ray, t_max: f32) -> bool {
    surfaces.iter().any(|surface| surface.shape.intersect(ray, t_max).is_some())
}
