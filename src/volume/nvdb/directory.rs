//! List of a file's grids, read without their voxels.

use std::borrow::Cow;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use super::bytes::Bytes;
use super::entry::GridInfo;
use super::segments::{self, Version};
use super::tree;
use crate::error::{Error, Progress, Result, report};
use crate::files;
use crate::volume::grid::VoxelValues;

/// A file's list of grids, from which single ones can be loaded.
pub struct Directory {
    file: String,
    bytes: Cow<'static, [u8]>,
    /// Version of the format.
    pub version: Version,
    /// The grids in the order of the file.
    pub grids: Vec<GridInfo>,
}

impl Directory {
    /// Reads a file's list of grids.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read, [`Error::Invalid`] if it is damaged or no NanoVDB
    /// file, [`Error::Unsupported`] for another version, [`Error::Cancelled`].
    pub fn open(path: impl AsRef<Path>, progress: Progress) -> Result<Self> {
        let path = path.as_ref();
        let bytes = files::read_whole(path, segments::check_start, progress)?;
        Self::parse(&path.display().to_string(), bytes, progress)
    }

    /// Reads the list of grids from bytes in memory; `file` names them in messages.
    ///
    /// # Errors
    /// Same errors as [`Directory::open`], except for [`Error::Io`].
    pub fn parse(
        file: &str,
        bytes: impl Into<Cow<'static, [u8]>>,
        progress: Progress,
    ) -> Result<Self> {
        let bytes = bytes.into();
        let found = segments::find(Bytes(&bytes));
        let (version, stored) = found.map_err(|error| named(error, file, "header"))?;
        let mut grids = Vec::new();
        for stored in stored {
            report(progress, 0.0)?;
            let field = field(&stored.name);
            let grid = GridInfo::read(Bytes(&bytes), stored);
            grids.push(grid.map_err(|error| named(error, file, &field))?);
        }
        Ok(Self { file: file.into(), version, grids, bytes })
    }

    /// Loads the voxels of the grid at `index` of the list, or the reason why they cannot be
    /// loaded.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the grid is damaged or there is none at `index`,
    /// [`Error::Unsupported`] if it would take absurd memory, [`Error::Cancelled`].
    pub fn load(&self, index: usize, progress: Progress) -> Result<VoxelValues> {
        let Some(grid) = self.grids.get(index) else {
            let reason = format!("there is no grid {index}, the file has {}", self.grids.len());
            return Err(Error::invalid(&self.file, "", reason));
        };
        self.load_grid(grid, progress).map_err(|error| named(error, &self.file, &field(&grid.name)))
    }

    fn load_grid(&self, grid: &GridInfo, progress: Progress) -> Result<VoxelValues> {
        let layout = match (&grid.unsupported, grid.layout) {
            (None, Some(layout)) => layout,
            (reason, _) => return Ok(VoxelValues::Unsupported(reason.clone().unwrap_or_default())),
        };
        let unpacking: Progress = &|fraction| progress(0.4 * fraction);
        let bytes = grid.stored.unpack(Bytes(&self.bytes), unpacking)?;
        let building: Progress = &|fraction| progress(0.4 + 0.6 * fraction);
        Ok(match layout.components {
            1 => VoxelValues::Float(Arc::new(tree::load(Bytes(&bytes), layout, building)?)),
            _ => VoxelValues::Vec3(Arc::new(tree::load(Bytes(&bytes), layout, building)?)),
        })
    }
}

impl fmt::Debug for Directory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Directory")
            .field("file", &self.file)
            .field("version", &self.version)
            .field("grids", &self.grids)
            .finish_non_exhaustive()
    }
}

/// How messages name a grid.
fn field(name: &str) -> String {
    if name.is_empty() { "a grid".to_owned() } else { format!("grid '{name}'") }
}

/// An error of what was read, with the file and the part of it that it is about.
fn named(error: Error, file: &str, field: &str) -> Error {
    match error {
        Error::Invalid { reason, .. } => Error::invalid(file, field, reason),
        Error::Unsupported { reason, .. } => Error::unsupported(file, field, reason),
        other => other,
    }
}
