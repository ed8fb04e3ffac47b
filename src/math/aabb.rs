//! Axis-aligned boxes.

use glam::{Affine3A, Vec3A};

use super::Ray;

/// An axis-aligned box; empty where a minimum exceeds its maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lower corner.
    pub min: Vec3A,
    /// Upper corner.
    pub max: Vec3A,
}

impl Aabb {
    /// The box without points, neutral for [`Aabb::union`].
    pub const EMPTY: Self =
        Self { min: Vec3A::splat(f32::INFINITY), max: Vec3A::splat(f32::NEG_INFINITY) };

    /// A box from its corners.
    pub fn new(min: Vec3A, max: Vec3A) -> Self {
        Self { min, max }
    }

    /// The box centered at the origin.
    pub fn centered(half_size: Vec3A) -> Self {
        Self { min: -half_size, max: half_size }
    }

    /// Whether the box holds no point.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Edge lengths.
    pub fn size(&self) -> Vec3A {
        self.max - self.min
    }

    /// The middle.
    pub fn center(&self) -> Vec3A {
        0.5 * (self.min + self.max)
    }

    /// Length of the space diagonal; 0 for an empty box.
    pub fn diagonal(&self) -> f32 {
        if self.is_empty() { 0.0 } else { self.size().length() }
    }

    /// The smallest box that holds both.
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The box of the points that lie in both.
    pub fn intersection(&self, other: &Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// Whether a point lies in the box, its faces included; never for what is not a number.
    #[inline]
    pub fn contains(&self, point: Vec3A) -> bool {
        (point.cmpge(self.min) & point.cmple(self.max)).all()
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3A; 8] {
        std::array::from_fn(|i| {
            Vec3A::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }

    /// The smallest axis-aligned box around this one after `transform`.
    pub fn transformed(&self, transform: &Affine3A) -> Self {
        if self.is_empty() {
            return *self;
        }
        self.corners().iter().fold(Self::EMPTY, |grown, &corner| {
            let p = transform.transform_point3a(corner);
            Self { min: grown.min.min(p), max: grown.max.max(p) }
        })
    }

    /// The part of `(t_min, t_max)` that `ray` spends inside, if any. The direction need not be
    /// a unit vector, so a ray in a volume's own space keeps its world parameter.
    pub fn intersect(&self, ray: &Ray, t_min: f32, t_max: f32) -> Option<(f32, f32)> {
        let (mut near, mut far) = (t_min, t_max);
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            if d == 0.0 {
                if o < self.min[axis] || o > self.max[axis] {
                    return None;
                }
                continue;
            }
            let inverse = 1.0 / d;
            let (a, b) = ((self.min[axis] - o) * inverse, (self.max[axis] - o) * inverse);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        (near < far).then_some((near, far))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intersection_from_outside_inside_and_along_a_face() {
        let cube = Aabb::centered(Vec3A::ONE);
        let along = |o: Vec3A, d: Vec3A| cube.intersect(&Ray::new(o, d), 0.0, f32::INFINITY);
        assert_eq!(along(Vec3A::new(-3.0, 0.0, 0.0), Vec3A::X), Some((2.0, 4.0)));
        assert_eq!(along(Vec3A::ZERO, Vec3A::X), Some((0.0, 1.0)));
        assert_eq!(along(Vec3A::new(-3.0, 1.0, 0.0), Vec3A::X), Some((2.0, 4.0)));
        assert_eq!(along(Vec3A::new(-3.0, 1.5, 0.0), Vec3A::X), None);
        assert_eq!(along(Vec3A::new(3.0, 0.0, 0.0), Vec3A::X), None);
    }

    #[test]
    fn a_direction_that_is_not_unit_keeps_the_parameter() {
        let cube = Aabb::centered(Vec3A::ONE);
        let ray = Ray::new(Vec3A::new(-3.0, 0.0, 0.0), 0.5 * Vec3A::X);
        assert_eq!(cube.intersect(&ray, 0.0, f32::INFINITY), Some((4.0, 8.0)));
    }
}
