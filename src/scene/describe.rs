//! The description of a volume file for people: its grids with their sizes and ranges.

use serde::Serialize;

use super::cache::{GridValues, PlacedGrid, VolumeCache, VolumeFile};
use super::file_box::FileBox;
use super::grid_address;
use super::sequence::NumberedSet;
use super::stamp::{Stamp, stamp_of};
use crate::error::{Error, Progress, Result};
use crate::files::name_of;
use crate::volume::file::GridInfo;
use crate::volume::grid::{GridClass, Histogram};

/// A volume file in words and numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileDescription {
    /// Name by which the file was requested.
    pub file: String,
    /// The file's own named values.
    pub metadata: Vec<(String, String)>,
    /// Grids in the order of the file.
    pub grids: Vec<GridDescription>,
}

/// A grid of a file in words and numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GridDescription {
    /// Name of the grid, by which a scene names it: with `[n]` after it from the second of one name
    /// on.
    pub name: String,
    /// Type of the grid's values: `float`, `half float`, `vec3`, ... as the file says.
    pub type_name: String,
    /// Class that the file gives the grid: `fog volume`, `level set`, ...
    pub class: String,
    /// Edges of a voxel in the file's space.
    pub voxel_size: [f64; 3],
    /// Voxels of the grid, if it can be rendered.
    pub voxels: Option<VoxelDescription>,
    /// Reason why the grid cannot be rendered.
    pub unsupported: Option<String>,
}

/// The voxels of a grid in numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct VoxelDescription {
    /// Whether voxels are vectors, such as colors.
    pub is_vector: bool,
    /// Number of active voxels.
    pub active: u64,
    /// The smallest active value; of vectors the smallest component.
    pub min: f32,
    /// The largest active value; of vectors the largest component.
    pub max: f32,
    /// The mean of the active values; of vectors the mean of the components.
    pub mean: f32,
    /// The corners of the box around the stored voxels in the file's space; `None` if empty.
    pub bounds: Option<[[f64; 3]; 2]>,
    /// Memory of the voxels in bytes.
    pub memory_bytes: usize,
    /// Histogram of the values from `min` to `max`; of vectors of their largest components.
    pub histogram: Histogram,
}

impl GridDescription {
    /// Whether the values are distances to a surface.
    pub fn is_level_set(&self) -> bool {
        self.class == GridClass::LevelSet.to_string()
    }

    /// Whether a scene names the grid by `address`.
    pub fn is_called(&self, address: &str) -> bool {
        grid_address::is_same(&self.name, address)
    }
}

/// Describes a volume file, or the largest file of a sequence, by its pattern or folder; what is
/// read of it stays in `cache`.
///
/// # Errors
/// The file cannot be read or a grid of it is damaged; names it.
pub fn describe(name: &str, cache: &VolumeCache, progress: Progress) -> Result<FileDescription> {
    let name = described_file(name)?;
    let file = cache.file(&name, progress)?;
    let directory = file.directory();
    let metadata = directory.metadata.iter().map(|(k, v)| (k.clone(), v.to_string())).collect();
    let count = directory.grids.len().max(1) as f32;
    let describe_one = |(index, info)| {
        let part = |fraction: f32| progress((index as f32 + fraction) / count);
        grid(&file, index, info, &part)
    };
    let grids = directory.grids.iter().enumerate().map(describe_one).collect::<Result<_>>()?;
    Ok(FileDescription { file: name, metadata, grids })
}

/// Time and size of the file that [`describe`] would describe; `None` for embedded ones, and for
/// those that are not there.
pub fn stamp(name: &str) -> Option<Stamp> {
    stamp_of(&described_file(name).ok()?).ok()
}

/// The file that [`describe`] describes: the largest of a sequence, else `name` itself.
fn described_file(name: &str) -> Result<String> {
    let set = NumberedSet::of_pattern_or_folder(name)?;
    Ok(set.map_or(name.to_owned(), |set| name_of(&set.fullest())))
}

fn grid(
    file: &VolumeFile,
    index: usize,
    info: &GridInfo,
    progress: Progress,
) -> Result<GridDescription> {
    let (voxels, unsupported) = match &info.unsupported {
        Some(reason) => (None, Some(reason.clone())),
        None => match file.grid_at(index, &info.name, progress) {
            Ok(grid) => (Some(voxels(&grid)), None),
            Err(Error::Unsupported { reason, .. }) => (None, Some(reason)),
            Err(error) => return Err(error),
        },
    };
    let is_packed = info.is_half && !matches!(info.value_type.as_str(), "half" | "vec3h");
    let half = if is_packed { "half " } else { "" };
    Ok(GridDescription {
        name: file.address(index),
        type_name: format!("{half}{}", info.value_type),
        class: info.class.to_string(),
        voxel_size: info.transform.voxel_size.to_array(),
        voxels,
        unsupported,
    })
}

fn voxels(grid: &PlacedGrid) -> VoxelDescription {
    let bounds = grid
        .bounds()
        .map(|bounds| FileBox::around(&bounds, &grid.world_from_index, grid.taper.as_ref()));
    let bounds = bounds.map(|bounds| [bounds.min.to_array(), bounds.max.to_array()]);
    match &grid.values {
        GridValues::Float(values) => {
            let stats = values.stats();
            VoxelDescription {
                is_vector: false,
                active: stats.active_voxels,
                min: stats.min,
                max: stats.max,
                mean: stats.mean,
                bounds,
                memory_bytes: stats.memory_bytes,
                histogram: values.histogram([stats.min, stats.max]),
            }
        }
        GridValues::Vector(values) => {
            let stats = values.stats();
            let (min, max) = (stats.min.min_element(), stats.max.max_element());
            VoxelDescription {
                is_vector: true,
                active: stats.active_voxels,
                min,
                max,
                mean: stats.mean.element_sum() / 3.0,
                bounds,
                memory_bytes: stats.memory_bytes,
                histogram: values.histogram([min, max]),
            }
        }
    }
}
