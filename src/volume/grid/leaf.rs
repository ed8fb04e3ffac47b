//! Leaves: the blocks of voxels that a grid is built from.

use glam::IVec3;

/// A block of 8x8x8 voxels.
#[derive(Clone)]
pub struct Leaf<V> {
    /// The first voxel, a multiple of 8.
    pub origin: IVec3,
    /// The values, z fastest.
    pub values: [V; 512],
    /// One bit a voxel in the same order, lowest bit first.
    pub active: [u64; 8],
}

impl<V> Leaf<V> {
    /// The position of the voxel whose value is stored at `offset`.
    pub(super) fn voxel(&self, offset: usize) -> IVec3 {
        self.origin
            + IVec3::new((offset >> 6) as i32, (offset >> 3 & 7) as i32, (offset & 7) as i32)
    }
}
