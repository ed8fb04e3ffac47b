//! Reader of OpenVDB files (`.vdb`), versions 220 to 225 of the format.
//!
//! ```text
//! header        magic, version, whether grids have offsets
//! metadata      named values of the file
//! list of grids for each: name, type, parent, offsets, then (at its offset) compression,
//!               metadata, transform and, unless it shares its parent's, the tree
//! tree          topology and tiles first, then the values of all leaves
//! ```
//!
//! [`Directory`] lists what a file holds without touching a voxel and loads single grids;
//! [`read`] loads everything. Float, double, vec3s and vec3d grids of the usual 5-4-3 tree with
//! an affine transform are loaded, as full or half floats, compressed by ZIP, Blosc, active masks
//! or not at all. Others are listed with the reason why they are not.

mod blosc;
mod compression;
mod directory;
mod entry;
mod header;
mod metadata;
mod stream;
mod transform;
mod tree;
mod values;

use std::path::Path;
use std::sync::Arc;

use glam::Vec3A;

pub use directory::Directory;
pub use entry::{GridClass, GridInfo};
pub use metadata::{MetaValue, Metadata};
pub use transform::Transform;

use super::grid::SparseGrid;
use crate::error::{Progress, Result};

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
    /// Of a float or double grid.
    Float(Arc<SparseGrid<f32>>),
    /// Of a vec3s or vec3d grid.
    Vec3(Arc<SparseGrid<Vec3A>>),
    /// Not loaded, for this reason.
    Unsupported(String),
}

/// Loads a file with all its grids.
///
/// # Errors
/// As [`Directory::open`] and [`Directory::load`].
pub fn read(path: impl AsRef<Path>, progress: Progress) -> Result<VdbFile> {
    Directory::open(path, progress)?.load_all(progress)
}
