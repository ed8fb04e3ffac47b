//! Boxes of voxels.

use glam::IVec3;

/// A box of voxels in index space; both corners belong to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IndexBox {
    /// The voxel with the smallest coordinates.
    pub min: IVec3,
    /// The voxel with the largest coordinates.
    pub max: IVec3,
}

impl IndexBox {
    /// The box of a single voxel.
    pub fn of_voxel(voxel: IVec3) -> Self {
        Self { min: voxel, max: voxel }
    }

    /// The smallest box around both boxes.
    pub fn union(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(Self { min: a.min.min(b.min), max: a.max.max(b.max) }),
            (a, b) => a.or(b),
        }
    }

    /// Whether the two share a voxel.
    pub fn intersects(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Whether every voxel of `other` belongs to this box.
    pub fn contains(&self, other: &Self) -> bool {
        self.min.cmple(other.min).all() && other.max.cmple(self.max).all()
    }

    /// The voxels that belong to both; empty (`min` > `max`) unless they intersect.
    pub fn intersection(&self, other: &Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// Number of voxels in the box; saturates at `u64::MAX`.
    pub fn voxel_count(&self) -> u64 {
        let extent = |low: i32, high: i32| (i64::from(high) - i64::from(low) + 1).max(0) as u64;
        extent(self.min.x, self.max.x)
            .saturating_mul(extent(self.min.y, self.max.y))
            .saturating_mul(extent(self.min.z, self.max.z))
    }

    /// Every position of the box, z fastest.
    pub(super) fn positions(self) -> impl Iterator<Item = IVec3> {
        let Self { min, max } = self;
        (min.x..=max.x).flat_map(move |x| {
            (min.y..=max.y).flat_map(move |y| (min.z..=max.z).map(move |z| IVec3::new(x, y, z)))
        })
    }
}
