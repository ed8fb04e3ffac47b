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
//! [`Directory`] lists what a file holds without touching a voxel and loads single grids; [`read`]
//! loads everything. Half, float and double grids of the usual 5-4-3 tree, and vec3h, vec3s and
//! vec3d ones, with an affine or a frustum transform are loaded, stored in full or as half floats,
//! compressed by ZIP, Blosc, active masks or not at all. Other grids are listed with the reason why
//! they are not loaded.

mod compression;
mod directory;
mod entry;
mod file;
mod header;
mod load;
mod metadata;
mod reader;
mod stream;
mod transform;
mod tree;
mod values;

use std::path::Path;

pub use directory::Directory;
pub use entry::GridInfo;
pub use file::{VdbFile, VdbGrid};
pub(super) use header::{check_start, is_openvdb};
pub use metadata::{MetaValue, Metadata};

use crate::error::{Progress, Result};

/// Loads a file with all its grids.
///
/// # Errors
/// Same errors as [`Directory::open`] and [`Directory::load`].
pub fn read(path: impl AsRef<Path>, progress: Progress) -> Result<VdbFile> {
    Directory::open(path, progress)?.load_all(progress)
}
