//! Orthonormal frames around a direction.

use glam::Vec3A;

/// A right-handed orthonormal frame whose third axis is `normal`.
#[derive(Clone, Copy, Debug)]
pub struct OrthonormalBasis {
    /// First axis.
    pub tangent: Vec3A,
    /// Second axis.
    pub bitangent: Vec3A,
    /// Third axis.
    pub normal: Vec3A,
}

impl OrthonormalBasis {
    /// The frame around a unit `normal`, without branches (Duff et al. 2017, *Building an
    /// Orthonormal Basis, Revisited*). For +z it is the world's own frame.
    pub fn around(normal: Vec3A) -> Self {
        let sign = 1.0_f32.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Self {
            tangent: Vec3A::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            bitangent: Vec3A::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    /// Transforms local coordinates to the world.
    #[inline]
    pub fn world_from_local(&self, local: Vec3A) -> Vec3A {
        local.x * self.tangent + local.y * self.bitangent + local.z * self.normal
    }

    /// Transforms a world vector to local coordinates.
    #[inline]
    pub fn local_from_world(&self, world: Vec3A) -> Vec3A {
        Vec3A::new(world.dot(self.tangent), world.dot(self.bitangent), world.dot(self.normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_orthonormal_and_right_handed() {
        for n in [Vec3A::Z, -Vec3A::Z, Vec3A::X, Vec3A::new(0.3, -0.5, -0.81).normalize()] {
            let f = OrthonormalBasis::around(n);
            assert!((f.tangent.cross(f.bitangent) - n).length() < 1e-6, "{n}");
            let v = Vec3A::new(0.2, 0.7, -0.4);
            assert!((f.local_from_world(f.world_from_local(v)) - v).length() < 1e-6);
        }
    }
}
