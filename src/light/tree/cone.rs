//! Cones of directions that lights send light into.

use std::f32::consts::PI;

use glam::Vec3A;

use crate::math::Aabb;

/// Allowance for rounding, radians.
const SLACK: f32 = 1e-3;

/// All directions within an angle of an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    axis: Vec3A,
    /// Half angle, radians; π or more for every direction.
    half_angle: f32,
}

impl Cone {
    pub(super) const EVERYWHERE: Self = Self { axis: Vec3A::Z, half_angle: PI };

    /// The cone about a unit `axis`; invalid cones become the whole sphere.
    pub(super) fn new(axis: Vec3A, cos_half_angle: f32) -> Self {
        if !(axis.is_finite() && cos_half_angle.is_finite()) {
            return Self::EVERYWHERE;
        }
        Self { axis, half_angle: cos_half_angle.clamp(-1.0, 1.0).acos() }
    }

    pub(super) fn is_everywhere(&self) -> bool {
        self.half_angle >= PI
    }

    /// A cone that holds both.
    pub(super) fn union(&self, other: &Self) -> Self {
        let (wide, narrow) =
            if self.half_angle >= other.half_angle { (self, other) } else { (other, self) };
        let between = wide.axis.dot(narrow.axis).clamp(-1.0, 1.0).acos();
        if between + narrow.half_angle <= wide.half_angle {
            return *wide;
        }
        let half_angle = 0.5 * (wide.half_angle + between + narrow.half_angle);
        // The axis rotates from the wide one's towards the narrow one's.
        let across = (narrow.axis - wide.axis.dot(narrow.axis) * wide.axis).normalize_or_zero();
        if half_angle >= PI || across == Vec3A::ZERO {
            return Self::EVERYWHERE;
        }
        let (sin, cos) = (half_angle - wide.half_angle).sin_cos();
        Self { axis: (cos * wide.axis + sin * across).normalize(), half_angle }
    }

    /// Share of the sphere of directions that the cone covers, above zero.
    pub(super) fn share(&self) -> f32 {
        0.5 * (1.0 - self.half_angle.min(PI).cos()) + 0.01
    }

    /// False only if no direction from any point of `bounds` to `point` is inside.
    #[inline]
    pub(super) fn may_reach(&self, bounds: &Aabb, point: Vec3A) -> bool {
        if self.is_everywhere() {
            return true;
        }
        let towards = point - bounds.center();
        let (distance, radius) = (towards.length(), 0.5 * bounds.size().length());
        if distance <= radius || distance.is_nan() {
            return true;
        }
        // Directions from inside the box's sphere differ from the center's by less than this.
        let spread = (radius / distance).asin();
        let angle = (towards.dot(self.axis) / distance).clamp(-1.0, 1.0).acos();
        angle - spread <= self.half_angle + SLACK
    }
}
