//! Index space whose slices widen with depth, as voxels of a camera's frustum do.
//!
//! Between index space and the world lies *spread space*, which is affine to the world: a ray is
//! straight there, and only a look-up goes on to index space. There it would be a hyperbola, since
//! depth stays linear while the slices widen.

use glam::{DVec2, DVec3, IVec3, Vec3A};

use super::grid::IndexBox;
use crate::math::Aabb;

/// The part of a frustum transform that is not affine, from index space to spread space:
/// (i − center.x) s, (j − center.y) s, k − near, with s = 1 + growth (k − near).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taper {
    /// Index coordinates i and j of the axis.
    pub center: DVec2,
    /// Index coordinate k of the slice that is not widened.
    pub near: f64,
    /// Growth of the slices a voxel of depth.
    pub growth: f64,
}

/// Least size of a slice, relative to that at `near`: at the tip it would be zero.
const SMALLEST: f64 = 1e-6;
/// Room for rounding in single precision, in voxels.
const ROUNDING: f64 = 0.01;

impl Taper {
    /// Whether all of a box of voxels lies before the tip of the frustum.
    pub fn holds(&self, voxels: &IndexBox) -> bool {
        let [low, high] = [voxels.min.z, voxels.max.z].map(f64::from);
        let ends = [low - 0.5 - ROUNDING, high + 0.5 + ROUNDING];
        ends.into_iter().all(|k| self.size(k - self.near) >= SMALLEST)
    }

    /// The taper of a grid whose voxel `origin` becomes voxel 0.
    pub fn rebased(&self, origin: IVec3) -> Self {
        let origin = origin.as_dvec3();
        Self { center: self.center - origin.truncate(), near: self.near - origin.z, ..*self }
    }

    /// Index space to spread space.
    pub fn spread(&self, index: DVec3) -> DVec3 {
        let depth = index.z - self.near;
        ((index.truncate() - self.center) * self.size(depth)).extend(depth)
    }

    /// Spread space to index space; `None` at the tip of the frustum and behind it.
    pub fn gather(&self, spread: DVec3) -> Option<DVec3> {
        let size = self.size(spread.z);
        let index = (spread.truncate() / size + self.center).extend(spread.z + self.near);
        (size >= SMALLEST).then_some(index)
    }

    fn size(&self, depth: f64) -> f64 {
        1.0 + self.growth * depth
    }
}

/// A [`Taper`] in single precision, for look-ups.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gather {
    /// Center and near.
    origin: Vec3A,
    growth: f32,
}

impl Gather {
    pub(super) fn new(taper: &Taper) -> Self {
        let origin = taper.center.extend(taper.near).as_vec3a();
        Self { origin, growth: taper.growth as f32 }
    }

    /// Spread space to index space; infinite at the tip of the frustum and behind it.
    #[inline]
    pub(super) fn point(&self, spread: Vec3A) -> Vec3A {
        let size = 1.0 + self.growth * spread.z;
        if size < SMALLEST as f32 {
            return Vec3A::INFINITY;
        }
        Vec3A::new(spread.x / size, spread.y / size, spread.z) + self.origin
    }

    /// The box in index space around a box of spread space, as far as that lies between the first
    /// and the last slice of `support`; `None` where no part does.
    pub(super) fn boxed(&self, spread: &Aabb, support: &Aabb) -> Option<Aabb> {
        let rounding = ROUNDING as f32;
        let low = spread.min.z.max(support.min.z - self.origin.z - rounding);
        let high = spread.max.z.min(support.max.z - self.origin.z + rounding);
        if low > high {
            return None;
        }
        let sizes = [low, high].map(|depth| 1.0 + self.growth * depth);
        let mut around = Aabb { min: Vec3A::splat(low), max: Vec3A::splat(high) };
        for axis in 0..2 {
            // A coordinate over the size of its slice is largest at one of the ends.
            let ends = sizes.map(|size| [spread.min[axis] / size, spread.max[axis] / size]);
            around.min[axis] = ends[0][0].min(ends[1][0]);
            around.max[axis] = ends[0][1].max(ends[1][1]);
        }
        Some(Aabb { min: around.min + self.origin, max: around.max + self.origin })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAPER: Taper = Taper { center: DVec2::new(0.5, 3.0), near: -8.0, growth: 1.0 / 16.0 };

    #[test]
    fn gathering_undoes_spreading_up_to_the_tip() {
        let single = Gather::new(&TAPER);
        for index in [DVec3::new(3.0, -2.0, 5.0), DVec3::new(-7.5, 9.0, -8.0), DVec3::ZERO] {
            let spread = TAPER.spread(index);
            assert!((TAPER.gather(spread).unwrap() - index).length() < 1e-12);
            let found = single.point(spread.as_vec3a());
            assert!(found.abs_diff_eq(index.as_vec3a(), 1e-5), "{found} for {index}");
        }
        assert_eq!(TAPER.gather(DVec3::new(1.0, 1.0, -16.0)), None);
        assert_eq!(single.point(Vec3A::new(1.0, 1.0, -17.0)), Vec3A::INFINITY);
        let tip = |z: i32| TAPER.holds(&IndexBox::of_voxel(IVec3::new(0, 0, z)));
        assert!(tip(-23) && !tip(-24));
    }

    #[test]
    fn boxes_hold_all_that_lies_in_them() {
        let single = Gather::new(&TAPER);
        let support = Aabb::new(Vec3A::splat(-8.0), Vec3A::splat(12.0));
        for n in 0..200 {
            let random = |k: i32| (f64::from(n * 7 + k) * 0.618_034).fract() as f32;
            let min = Vec3A::new(random(0), random(1), random(2)) * 30.0 - 15.0;
            let spread = Aabb::new(min, min + Vec3A::new(random(3), random(4), random(5)) * 9.0);
            let around = single.boxed(&spread, &support);
            for m in 0..50 {
                let t = Vec3A::new(random(m), random(m + 90), random(m + 180));
                let index = single.point(spread.min + t * spread.size());
                if index.z < support.min.z || index.z > support.max.z {
                    continue;
                }
                let around = around.unwrap();
                let slack = 1e-3;
                let inside = index.cmpge(around.min - slack) & index.cmple(around.max + slack);
                assert!(inside.all(), "{index} of {spread:?} is not in {around:?}");
            }
        }
    }
}
