//! The voxels of a grid of a file.

use std::sync::Arc;

use glam::Vec3A;

use super::sparse_grid::SparseGrid;

/// The voxels of a grid as they were read from a file.
#[derive(Clone, Debug)]
pub enum VoxelValues {
    /// The voxels of a grid of single numbers.
    Float(Arc<SparseGrid<f32>>),
    /// The voxels of a grid of vectors of three components.
    Vec3(Arc<SparseGrid<Vec3A>>),
    /// Voxels that are not loaded, for this reason.
    Unsupported(String),
}
