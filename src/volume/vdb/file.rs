//! A file that has been read: its grids with their voxels.

use super::entry::GridInfo;
use super::metadata::Metadata;
use crate::volume::grid::VoxelValues;

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
    pub values: VoxelValues,
}
