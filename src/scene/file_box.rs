//! Boxes in the space of a file, in double precision: files may lie far from their origin.

use glam::{DAffine3, DVec3};

use crate::math::Aabb;
use crate::volume::Taper;
use crate::volume::grid::IndexBox;

/// An axis-aligned box in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FileBox {
    pub(super) min: DVec3,
    pub(super) max: DVec3,
}

impl FileBox {
    /// The box around voxels of a grid, half a voxel beyond their samples.
    pub(super) fn around(
        voxels: &IndexBox,
        file_from_index: &DAffine3,
        taper: Option<&Taper>,
    ) -> Self {
        let half = DVec3::splat(0.5);
        let (min, max) = (voxels.min.as_dvec3() - half, voxels.max.as_dvec3() + half);
        let voxels = Self { min, max };
        // The corners of a frustum are those of its end slices.
        let spread = taper.map_or(voxels, |taper| voxels.mapped(|corner| taper.spread(corner)));
        spread.transformed(file_from_index)
    }

    pub(super) fn size(&self) -> DVec3 {
        self.max - self.min
    }

    pub(super) fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// The smallest box around both.
    pub(super) fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The smallest box around this one after `transform`.
    pub(super) fn transformed(&self, transform: &DAffine3) -> Self {
        self.mapped(|corner| transform.transform_point3(corner))
    }

    /// The smallest box around the images of the corners.
    pub(super) fn mapped(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        let corner = |n: usize| {
            let pick = |axis: usize| [self.min[axis], self.max[axis]][n >> axis & 1];
            map(DVec3::new(pick(0), pick(1), pick(2)))
        };
        (1..8).map(corner).fold(Self { min: corner(0), max: corner(0) }, |grown, corner| {
            grown.union(Self { min: corner, max: corner })
        })
    }

    /// The box in single precision.
    pub(super) fn to_aabb(self) -> Aabb {
        Aabb::new(self.min.as_vec3a(), self.max.as_vec3a())
    }
}
