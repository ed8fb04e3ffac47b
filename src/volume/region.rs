//! Regions of space that volumes fill.

use glam::Vec3A;

use crate::math::{Aabb, Ray};

/// Region that a volume fills in its own space, with sharp borders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// A box.
    Box(Aabb),
    /// A sphere about the origin.
    Sphere {
        /// Radius of the sphere.
        radius: f32,
    },
    /// All of space.
    Everywhere,
}

impl Region {
    /// Smallest box around the region; infinite for [`Region::Everywhere`].
    pub fn bounds(&self) -> Aabb {
        match self {
            Self::Box(bounds) => *bounds,
            Self::Sphere { radius } => Aabb::centered(Vec3A::splat(*radius)),
            Self::Everywhere => Aabb::centered(Vec3A::INFINITY),
        }
    }

    /// The part of (0, t_max) that `ray` spends inside; its direction need not be a unit vector.
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<(f32, f32)> {
        match self {
            Self::Box(bounds) => bounds.intersect(ray, 0.0, t_max),
            Self::Sphere { radius } => {
                let a = ray.direction.length_squared();
                let middle = -ray.origin.dot(ray.direction) / a;
                let nearest = ray.at(middle);
                let half_squared = (radius * radius - nearest.length_squared()) / a;
                if half_squared <= 0.0 || half_squared.is_nan() {
                    return None;
                }
                let half = half_squared.sqrt();
                let (t0, t1) = ((middle - half).max(0.0), (middle + half).min(t_max));
                (t0 < t1).then_some((t0, t1))
            }
            Self::Everywhere => (t_max > 0.0).then_some((0.0, t_max)),
        }
    }
}
