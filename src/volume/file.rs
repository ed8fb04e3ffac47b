//! Volume files of every format. Which one a file has is told by its first bytes alone, here and
//! nowhere else; the name does not matter.

use std::borrow::Cow;
use std::fmt;
use std::path::Path;

pub use super::vdb::{MetaValue, Metadata};

use super::grid::{GridClass, Transform, VoxelValues};
use super::{nvdb, vdb};
use crate::error::{Error, Progress, Result};
use crate::files;

/// Endings of the names of volume files, for dialogs and messages.
pub const EXTENSIONS: [&str; 2] = ["vdb", "nvdb"];

/// Format of a volume file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenVDB's own format, `.vdb`.
    OpenVdb,
    /// The memory of NanoVDB's grids, `.nvdb`.
    NanoVdb,
}

/// A grid of a file, without its voxels.
#[derive(Clone, Debug)]
pub struct GridInfo {
    /// The name; other grids of the file may have the same one.
    pub name: String,
    /// Type of the values as the file names it: `float`, `vec3s`, `Fp16`, ...
    pub value_type: String,
    /// Class of the grid.
    pub class: GridClass,
    /// Whether the values are stored as half floats.
    pub is_half: bool,
    /// Transform from index space to the world; [`Transform::IDENTITY`] if it is why the grid is
    /// unsupported.
    pub transform: Transform,
    /// The grid's own named values.
    pub metadata: Metadata,
    /// Reason why the grid cannot be loaded, if it cannot.
    pub unsupported: Option<String>,
}

/// A file's list of grids, from which single ones can be loaded.
#[derive(Debug)]
pub struct Directory {
    /// Format of the file.
    pub format: Format,
    /// Version of the format.
    pub version: String,
    /// The file's own named values.
    pub metadata: Metadata,
    /// The grids in the order of the file.
    pub grids: Vec<GridInfo>,
    reader: Reader,
}

#[derive(Debug)]
enum Reader {
    OpenVdb(vdb::Directory),
    NanoVdb(nvdb::Directory),
}

impl Format {
    /// The format of a file that starts with these bytes.
    ///
    /// # Errors
    /// The reason why it is no volume file.
    pub fn of(start: &[u8]) -> Result<Self, String> {
        if nvdb::is_nanovdb(start) {
            return Ok(Self::NanoVdb);
        }
        match vdb::is_openvdb(start) {
            true => Ok(Self::OpenVdb),
            // What is no volume at all gets its message there.
            false => vdb::check_start(start).map(|()| Self::OpenVdb),
        }
    }

    /// Whether the file of that name is a volume file.
    ///
    /// # Errors
    /// It cannot be read, or is a folder, a pipe or a device; names it.
    pub fn is_of(path: &Path) -> Result<bool> {
        let start = files::first_bytes(path)?;
        Ok(nvdb::is_nanovdb(&start) || vdb::is_openvdb(&start))
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OpenVdb => "OpenVDB",
            Self::NanoVdb => "NanoVDB",
        })
    }
}

impl Directory {
    /// Reads a file's list of grids.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read, [`Error::Invalid`] if it is damaged, no volume
    /// file or larger than the free memory, [`Error::Unsupported`] for a version that is not read,
    /// [`Error::Cancelled`].
    pub fn open(path: impl AsRef<Path>, progress: Progress) -> Result<Self> {
        let path = path.as_ref();
        match nvdb::is_nanovdb(&files::first_bytes(path)?) {
            true => nvdb::Directory::open(path, progress).map(Self::of_nanovdb),
            false => vdb::Directory::open(path, progress).map(Self::of_openvdb),
        }
    }

    /// Reads the list of grids from bytes in memory; `file` names them in messages.
    ///
    /// # Errors
    /// Same errors as [`Directory::open`], but for those of reading.
    pub fn parse(
        file: &str,
        bytes: impl Into<Cow<'static, [u8]>>,
        progress: Progress,
    ) -> Result<Self> {
        let bytes = bytes.into();
        match Format::of(&bytes).map_err(|reason| Error::invalid(file, "", reason))? {
            Format::NanoVdb => nvdb::Directory::parse(file, bytes, progress).map(Self::of_nanovdb),
            Format::OpenVdb => vdb::Directory::parse(file, bytes, progress).map(Self::of_openvdb),
        }
    }

    fn of_openvdb(reader: vdb::Directory) -> Self {
        Self {
            format: Format::OpenVdb,
            version: reader.version.to_string(),
            metadata: reader.metadata.clone(),
            grids: reader.grids.iter().map(GridInfo::of_openvdb).collect(),
            reader: Reader::OpenVdb(reader),
        }
    }

    fn of_nanovdb(reader: nvdb::Directory) -> Self {
        Self {
            format: Format::NanoVdb,
            version: reader.version.to_string(),
            metadata: Metadata::new(),
            grids: reader.grids.iter().map(GridInfo::of_nanovdb).collect(),
            reader: Reader::NanoVdb(reader),
        }
    }

    /// Loads the voxels of the grid at `index` of the list, or the reason why they cannot be
    /// loaded.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the grid is damaged or there is none at
    /// `index`, [`Error::Unsupported`] if it would take absurd
    /// memory, [`Error::Cancelled`].
    pub fn load(&self, index: usize, progress: Progress) -> Result<VoxelValues> {
        match &self.reader {
            Reader::OpenVdb(reader) => reader.load(index, progress),
            Reader::NanoVdb(reader) => reader.load(index, progress),
        }
    }
}

impl GridInfo {
    fn of_openvdb(grid: &vdb::GridInfo) -> Self {
        Self {
            name: grid.name.clone(),
            value_type: grid.value_type().to_owned(),
            class: grid.class,
            is_half: grid.is_half,
            transform: grid.transform,
            metadata: grid.metadata.clone(),
            unsupported: grid.unsupported.clone(),
        }
    }

    fn of_nanovdb(grid: &nvdb::GridInfo) -> Self {
        Self {
            name: grid.name.clone(),
            value_type: grid.type_name.clone(),
            class: grid.class,
            is_half: false,
            transform: grid.transform,
            metadata: Metadata::new(),
            unsupported: grid.unsupported.clone(),
        }
    }
}
