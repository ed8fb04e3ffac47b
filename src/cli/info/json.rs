//! A volume file for programs.

use glam::IVec3;
use serde::Serialize;

use crate::error::{Error, NO_PROGRESS, Result};
use crate::scene::sequence::NumberedSet;
use crate::scene::{self, GridDescription, VolumeCache};
use crate::volume::Taper;
use crate::volume::file::GridInfo;
use crate::volume::grid::IndexBox;

/// The frames of a sequence, of which the largest file is described.
#[derive(Serialize)]
struct SequenceJson {
    pattern: String,
    frames: Vec<i32>,
    /// First and last frame of each hole.
    missing: Vec<[i32; 2]>,
}

/// A volume file: what it is, and its grids in the order of the file.
#[derive(Serialize)]
struct FileJson {
    file: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    sequence: Option<SequenceJson>,
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
    /// Rows of the matrix that takes index positions to the world, the translation last in each; of
    /// a frustum after its `taper`.
    transform: [[f64; 4]; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    taper: Option<TaperJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unsupported: Option<String>,
    #[serde(flatten)]
    voxels: Option<VoxelsJson>,
}

/// Widening of the slices of a frustum: index (i, j, k) goes to (i − center[0]) s,
/// (j − center[1]) s, k − near with s = 1 + growth (k − near).
#[derive(Serialize)]
struct TaperJson {
    center: [f64; 2],
    near: f64,
    growth: f64,
}

impl TaperJson {
    fn new(taper: Taper) -> Self {
        Self { center: taper.center.to_array(), near: taper.near, growth: taper.growth }
    }
}

#[derive(Serialize)]
struct VoxelsJson {
    active_voxels: u64,
    min: f32,
    max: f32,
    mean: f32,
    /// First and last voxel stored; none of an empty grid.
    index_bounds: Option<[[i32; 3]; 2]>,
    world_bounds: Option<[[f64; 3]; 2]>,
    memory_bytes: usize,
}

/// The description of a volume file, as JSON.
///
/// # Errors
/// The file cannot be read or a grid of it is damaged; names it.
pub(super) fn volume(file: &str) -> Result<String> {
    let cache = VolumeCache::default();
    let description = scene::describe(file, &cache, NO_PROGRESS)?;
    let opened = cache.file(&description.file, NO_PROGRESS)?;
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
        sequence: NumberedSet::of_pattern_or_folder(file)?.map(SequenceJson::new),
        format: directory.format.to_string(),
        version: directory.version.clone(),
        metadata: description.metadata,
        grids,
    };
    let text = serde_json::to_string_pretty(&report);
    text.map(|text| text + "\n").map_err(|error| Error::invalid(file, "", error.to_string()))
}

impl SequenceJson {
    fn new(set: NumberedSet) -> Self {
        Self {
            pattern: set.pattern.spelling().display().to_string(),
            frames: set.files.files().iter().map(|file| file.number).collect(),
            missing: set.files.holes(),
        }
    }
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
            taper: info.transform.taper.map(TaperJson::new),
            unsupported: grid.unsupported.clone(),
            voxels,
        }
    }
}
