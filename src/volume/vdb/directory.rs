//! List of a file's grids, read without their voxels.

use std::borrow::Cow;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use super::entry::{GridInfo, TreePlace};
use super::file::{VdbFile, VdbGrid};
use super::header::{self, VdbHeader};
use super::load::load;
use super::metadata::{self, Metadata};
use super::reader::{Reader, Source};
use super::stream::{Fault, Result as Step};
use crate::error::{Error, Progress, Result, report};
use crate::files;
use crate::volume::grid::VoxelValues;

/// A file's list of grids, from which single ones can be loaded.
pub struct Directory {
    file: String,
    source: Source,
    /// Version of the file format.
    pub version: u32,
    /// The file's own named values.
    pub metadata: Metadata,
    /// The grids in the order of the file.
    pub grids: Vec<GridInfo>,
}

impl Directory {
    /// Reads a file's list of grids.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read, [`Error::Invalid`] if it is damaged or no OpenVDB
    /// file, [`Error::Unsupported`] for another version, [`Error::Cancelled`].
    pub fn open(path: impl AsRef<Path>, progress: Progress) -> Result<Self> {
        let path = path.as_ref();
        let source = Source::of_file(files::open_checked(path, header::check_start)?)
            .map_err(|error| Error::io(path, error))?;
        Self::list(path.display().to_string(), source, progress)
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
        Self::list(file.into(), Source::Memory(bytes.into()), progress)
    }

    fn list(file: String, source: Source, progress: Progress) -> Result<Self> {
        report(progress, 0.0)?;
        let mut reader = Reader::of_list(&source);
        let in_file = |fault: Fault| fault.into_error(&file, "");
        let header = reader.step("header", VdbHeader::read).map_err(in_file)?;
        let metadata = reader.step("metadata", metadata::read).map_err(in_file)?;
        // Three texts and three offsets are the least that a grid takes.
        let count = reader.step("list of grids", |stream| stream.count(36)).map_err(in_file)?;
        let mut grids = Vec::new();
        for _ in 0..count {
            let mut name = String::new();
            let grid = GridInfo::read(&mut reader, &header, &mut name, progress);
            grids.push(grid.map_err(|fault| fault.into_error(&file, &name))?);
        }
        Ok(Self { file, version: header.version, metadata, grids, source })
    }

    /// Loads the voxels of the grid at `index` of the list, or the reason why they cannot be
    /// loaded.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the grid is damaged, there is none at `index` or the file has changed
    /// since it was opened, [`Error::Io`] if it can no longer be read, [`Error::Unsupported`] if it
    /// would take absurd memory, [`Error::Cancelled`].
    pub fn load(&self, index: usize, progress: Progress) -> Result<VoxelValues> {
        let Some(grid) = self.grids.get(index) else {
            let reason = format!("there is no grid {index}, the file has {}", self.grids.len());
            return Err(Error::invalid(&self.file, "", reason));
        };
        if let Some(reason) = &grid.unsupported {
            return Ok(VoxelValues::Unsupported(reason.clone()));
        }
        let values = self.load_tree(grid, progress);
        if self.source.has_changed() {
            let reason = "the file was changed while it was read; load it again";
            return Err(Error::invalid(&self.file, "", reason));
        }
        values.map_err(|fault| fault.into_error(&self.file, &grid.name))
    }

    /// Loads every grid; those that share a tree share its voxels.
    ///
    /// # Errors
    /// Same errors as [`Directory::load`].
    pub fn load_all(self, progress: Progress) -> Result<VdbFile> {
        let count = self.grids.len() as f32;
        let mut values: Vec<VoxelValues> = Vec::new();
        for (index, grid) in self.grids.iter().enumerate() {
            let earlier = match &grid.tree {
                TreePlace::Shared(name) if grid.unsupported.is_none() => {
                    self.position(name).and_then(|parent| values.get(parent).cloned())
                }
                _ => None,
            };
            let part = |fraction: f32| progress((index as f32 + fraction) / count);
            values.push(match earlier {
                Some(values) => values,
                None => self.load(index, &part)?,
            });
        }
        let Self { version, metadata, grids, .. } = self;
        let grids = grids.into_iter().zip(values);
        let grids = grids.map(|(info, values)| VdbGrid { info, values }).collect();
        Ok(VdbFile { version, metadata, grids })
    }

    fn position(&self, unique_name: &str) -> Option<usize> {
        self.grids.iter().position(|grid| grid.unique_name == unique_name)
    }

    fn load_tree(&self, grid: &GridInfo, progress: Progress) -> Step<VoxelValues> {
        let place = match &grid.tree {
            TreePlace::Shared(name) => self.position(name).map(|parent| &self.grids[parent].tree),
            own => Some(own),
        };
        match place {
            Some(TreePlace::Own { bytes, layout }) => {
                let mut reader = Reader::of_tree(&self.source, bytes.clone());
                Ok(match layout.components {
                    1 => VoxelValues::Float(Arc::new(load(&mut reader, *layout, progress)?)),
                    _ => VoxelValues::Vec3(Arc::new(load(&mut reader, *layout, progress)?)),
                })
            }
            _ => Ok(VoxelValues::Unsupported(
                "shares the voxels of a grid that is not in the file or cannot be loaded".into(),
            )),
        }
    }
}

impl fmt::Debug for Directory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Directory")
            .field("file", &self.file)
            .field("version", &self.version)
            .field("metadata", &self.metadata)
            .field("grids", &self.grids)
            .finish_non_exhaustive()
    }
}
