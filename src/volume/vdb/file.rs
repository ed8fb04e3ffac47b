//! A file that has been read: its grids with their voxels.

use std::sync::Arc;

use glam::Vec3A;

use super::entry::GridInfo;
use super::metadata::Metadata;
use crate::volume::grid::SparseGrid;

/// A file with all its grids loaded.
#[derive(Debug)]
pub struct VdbFile {
    /// Version of the file format.
    pub version: u32,
    /// The file's own named values.
    pub metadata: Metadata,
    /// The grids in the order of the file.
    pub grids: Vec<VdbGrid>,
}

/// A grid with its voxels.
#[derive(Debug)]
pub struct VdbGrid {
    /// Name, class, transform and all else but the voxels.
    pub info: GridInfo,
    /// The voxels.
    pub values: VdbValues,
}

/// The voxels of a grid.
#[derive(Clone, Debug)]
pub enum VdbValues {
    /// The voxels of a half, float or double grid.
    Float(Arc<SparseGrid<f32>>),
    /// The voxels of a vec3h, vec3s or vec3d grid.
    Vec3(Arc<SparseGrid<Vec3A>>),
    /// Voxels that are not loaded, for this reason.
    Unsupported(String),
}
