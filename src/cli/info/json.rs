//! A volume file for programs.

use glam::IVec3;
use serde::Serialize;

use crate::error::{Error, NO_PROGRESS, Result};
use crate::scene::{self, GridDescription, VolumeCache};
use crate::volume::file::GridInfo;
use crate::volume::grid::IndexBox;

/// A volume file: what it is, and its grids in the order of the file.
#[derive(Serialize)]
struct FileJson {
    file: String,
    format: String,
    version: String,
    metadata: Vec<(String, String)>,
    grids: Vec<GridJson>,
}

/// A grid. What needs its voxels is absent where they cannot be loaded, for the reason that
/// `unsupported` gives.
#[derive(Serialize)]
struct GridJson {
    name: String,
    #[serde(rename = "type")]
    value_type: String,
    class: String,
    voxel_size: [f64; 3],
    /// Rows of the matrix that takes index positions to the world, the translation last in each.
    transform: [[f64; 4]; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    unsupported: Option<String>,
    #[serde(flatten)]
    voxels: Option<VoxelsJson>,
}

#[derive(Serialize)]
struct VoxelsJson {
    active_voxels: u64,
    min: f32,
    max: f32,
    mean: f32,
    /// First and last voxel stored; none of an empty grid.
    index_bounds: Option<[[i32; 3]; 2]>,
    world_bounds: Option<[[f32; 3]; 2]>,
    memory_bytes: usize,
}

/// The description of a volume file, as JSON.
///
/// # Errors
/// The file cannot be read or a grid of it is damaged; names it.
pub(super) fn volume(file: &str) -> Result<String> {
    let cache = VolumeCache::default();
    let description = scene::describe(file, &cache, NO_PROGRESS)?;
    let opened = cache.file(file, NO_PROGRESS)?;
    let directory = opened.directory();
    let mut grids = Vec::new();
    for (index, (grid, info)) in description.grids.iter().zip(&directory.grids).enumerate() {
        let bounds = match grid.unsupported {
            Some(_) => None,
            None => opened.grid_at(index, &grid.name, NO_PROGRESS)?.bounds(),
        };
        grids.push(GridJson::new(grid, info, bounds));
    }
    let report = FileJson {
        file: description.file,
        format: directory.format.to_string(),
        version: directory.version.clone(),
        metadata: description.metadata,
        grids,
    };
    let text = serde_json::to_string_pretty(&report);
    text.map(|text| text + "\n").map_err(|error| Error::invalid(file, "", error.to_string()))
}

impl GridJson {
    fn new(grid: &GridDescription, info: &GridInfo, bounds: Option<IndexBox>) -> Self {
        let map = &info.transform.index_to_world;
        let row = |row: usize| {
            let axes = map.matrix3.row(row);
            [axes.x, axes.y, axes.z, map.translation[row]]
        };
        let corners =
            |bounds: IndexBox| [bounds.min, bounds.max].map(|corner: IVec3| corner.into());
        let voxels = grid.voxels.as_ref().map(|voxels| VoxelsJson {
            active_voxels: voxels.active,
            min: voxels.min,
            max: voxels.max,
            mean: voxels.mean,
            index_bounds: bounds.map(corners),
            world_bounds: voxels.bounds,
            memory_bytes: voxels.memory_bytes,
        });
        Self {
            name: grid.name.clone(),
            value_type: grid.type_name.clone(),
            class: grid.class.clone(),
            voxel_size: grid.voxel_size,
            transform: [row(0), row(1), row(2)],
            unsupported: grid.unsupported.clone(),
            voxels,
        }
    }
}
