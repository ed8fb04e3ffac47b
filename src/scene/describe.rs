//! The description of a volume file for people: its grids with their sizes and ranges.

use glam::Vec3A;
use serde::Serialize;

use super::cache::{GridValues, PlacedGrid, Stamp, VolumeCache, VolumeFile, stamp_of};
use super::sequence::listed;
use crate::error::{Progress, Result};
use crate::math::Aabb;
use crate::volume::file::GridInfo;
use crate::volume::grid::Histogram;

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
    /// Name of the grid.
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
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Memory of the voxels in bytes.
    pub memory_bytes: usize,
    /// Histogram of the values from `min` to `max`; of vectors of their largest components.
    pub histogram: Histogram,
}

/// Describes a volume file, or the largest file of a sequence; what is read of it stays in `cache`.
///
/// # Errors
/// The file cannot be read or a grid of it is damaged; names it.
pub fn describe(name: &str, cache: &VolumeCache, progress: Progress) -> Result<FileDescription> {
    let frames = listed(name)?;
    let fullest = frames.as_ref().and_then(|(_, files)| files.fullest());
    let name = fullest.map_or(name.to_owned(), |file| file.path.display().to_string());
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
    let frames = listed(name).ok()?;
    let fullest = frames.as_ref().and_then(|(_, files)| files.fullest());
    let name = fullest.map_or(name.to_owned(), |file| file.path.display().to_string());
    stamp_of(&name).ok()
}

fn grid(
    file: &VolumeFile,
    index: usize,
    info: &GridInfo,
    progress: Progress,
) -> Result<GridDescription> {
    let voxels = match &info.unsupported {
        Some(_) => None,
        None => Some(voxels(&file.grid_at(index, &info.name, progress)?)),
    };
    let half = if info.is_half { "half " } else { "" };
    Ok(GridDescription {
        name: info.name.clone(),
        type_name: format!("{half}{}", info.value_type),
        class: info.class.to_string(),
        voxel_size: info.transform.voxel_size.to_array(),
        voxels,
        unsupported: info.unsupported.clone(),
    })
}

fn voxels(grid: &PlacedGrid) -> VoxelDescription {
    let bounds = grid_bounds(grid).map(|bounds| [bounds.min.to_array(), bounds.max.to_array()]);
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

/// The box around a grid's stored voxels, in the file's space.
pub(super) fn grid_bounds(grid: &PlacedGrid) -> Option<Aabb> {
    let bounds = grid.bounds()?;
    let half_voxel = Vec3A::splat(0.5);
    let in_index = Aabb::new(
        Vec3A::from(bounds.min.as_vec3()) - half_voxel,
        Vec3A::from(bounds.max.as_vec3()) + half_voxel,
    );
    Some(in_index.transformed(&grid.world_from_index.as_affine3a()))
}
