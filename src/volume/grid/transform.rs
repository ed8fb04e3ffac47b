//! The map from index space to the world.

use glam::{DAffine3, DVec3};

use crate::volume::Taper;

/// Index space to world with column vectors, and the lengths of a voxel's edges in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// World position = `index_to_world` x index position; voxel (i, j, k) is a sample at the
    /// image of (i, j, k). Of a frustum the affine part alone, from spread space on.
    pub index_to_world: DAffine3,
    /// Edges of a voxel along i, j and k, in world units; of a frustum those in its near slice.
    pub voxel_size: DVec3,
    /// The part of a frustum transform that is not affine.
    pub taper: Option<Taper>,
}

impl Transform {
    /// Index space itself.
    pub const IDENTITY: Self =
        Self { index_to_world: DAffine3::IDENTITY, voxel_size: DVec3::ONE, taper: None };

    /// Reason why a map is refused.
    pub const UNUSABLE: &str = "a transform that flattens space or is not finite; give the grid a \
                                voxel size above zero";

    /// The transform with this map; `None`, with [`Transform::UNUSABLE`] as the reason, if it
    /// flattens space or is not finite.
    pub fn new(index_to_world: DAffine3) -> Option<Self> {
        let matrix = index_to_world.matrix3;
        let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::length);
        let volume = matrix.determinant().abs();
        let usable = index_to_world.is_finite() && volume.is_finite() && volume > 0.0;
        let voxel_size = DVec3::new(x, y, z);
        usable.then_some(Self { index_to_world, voxel_size, taper: None })
    }

    /// World position of a position in index space.
    pub fn point(&self, index: DVec3) -> DVec3 {
        self.index_to_world.transform_point3(self.taper.map_or(index, |taper| taper.spread(index)))
    }
}
