//! The grids of volume files, as the volume panel lists them.

use std::collections::HashMap;

use crate::error::{Progress, Result};
use crate::scene::cache::{GridValues, VolumeFile};
use crate::scene::{Settings, VolumeCache};

/// One grid of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSummary {
    /// Its name in the file.
    pub name: String,
    /// What it holds; the reason where it cannot be rendered.
    pub contents: Result<GridContents, String>,
}

/// What is in a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridContents {
    /// The lowest value; of vectors the lowest component.
    pub low: f32,
    /// The highest value; of vectors the highest component.
    pub high: f32,
    /// How many voxels hold a value.
    pub voxels: u64,
    /// Whether it holds single numbers, which density and temperature are read from.
    pub is_scalar: bool,
}

/// The grids of each file by the file's name.
pub type Grids = HashMap<String, Vec<GridSummary>>;

/// Adds the grids of the files of `settings` that `grids` does not have yet; reads those that the
/// scene itself does not need.
///
/// # Errors
/// A file cannot be read any more, or `progress` cancels.
pub fn add_missing(
    grids: &mut Grids,
    settings: &Settings,
    cache: &VolumeCache,
    progress: Progress<'_>,
) -> Result<bool> {
    let mut added = false;
    for name in settings.volume.iter().filter_map(|volume| volume.file.as_ref()) {
        if !grids.contains_key(name) {
            let file = cache.file(name, progress)?;
            grids.insert(name.clone(), summarize(&file, progress)?);
            added = true;
        }
    }
    Ok(added)
}

fn summarize(file: &VolumeFile, progress: Progress<'_>) -> Result<Vec<GridSummary>> {
    let mut summaries = Vec::new();
    for (index, info) in file.directory().grids.iter().enumerate() {
        let contents = match file.grid_at(index, "", progress) {
            Ok(grid) => Ok(contents(&grid.values)),
            Err(crate::error::Error::Cancelled) => return Err(crate::error::Error::Cancelled),
            Err(error) => Err(error.to_string()),
        };
        summaries.push(GridSummary { name: info.name.clone(), contents });
    }
    Ok(summaries)
}

fn contents(values: &GridValues) -> GridContents {
    match values {
        GridValues::Float(grid) => {
            let stats = grid.stats();
            let (low, high) = (stats.min, stats.max);
            GridContents { low, high, voxels: stats.active_voxels, is_scalar: true }
        }
        GridValues::Vector(grid) => {
            let stats = grid.stats();
            let (low, high) = (stats.min.min_element(), stats.max.max_element());
            GridContents { low, high, voxels: stats.active_voxels, is_scalar: false }
        }
    }
}
