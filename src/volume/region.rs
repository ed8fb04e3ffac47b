//! The region of space that a volume takes.

use glam::Vec3A;

use crate::math::{Aabb, Ray};

/// Where a volume is, in its own space. Its borders are sharp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// A box.
    Box(Aabb),
    /// A sphere about the origin.
    Sphere {
        /// Its radius.
        radius: f32,
    },
    /// All of space.
    Everywhere,
}

impl Region {
    /// The smallest box around it; infinite for [`Region::Everywhere`].
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
