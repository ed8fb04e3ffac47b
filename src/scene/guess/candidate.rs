//! The grids of a file that may be seen as smoke or fire, and the reasons why others may not.

use crate::error::{Error, Progress, Result};
use crate::scene::cache::{GridValues, PlacedGrid, VolumeFile};
use crate::scene::file_box::FileBox;
use crate::scene::grid_names::{is_other, is_seen};
use crate::volume::file::GridInfo;
use crate::volume::grid::GridClass;
use crate::volume::grid::IndexBox;

/// A grid of numbers or colors that is worth rendering.
pub(super) struct Candidate {
    pub(super) grid: PlacedGrid,
    /// Name of the grid in the file, which others may have too.
    pub(super) name: String,
    /// Smallest active value of the grid; for colors of the smallest channel.
    pub(super) min: f32,
    /// Largest active value of the grid; for colors of the largest channel.
    pub(super) max: f32,
    /// Mean of the grid's active values.
    pub(super) mean: f32,
    /// The box that is looked at, in the file's space.
    pub(super) core: FileBox,
    /// The box around all stored voxels, in the file's space.
    pub(super) bounds: FileBox,
    /// Shortest edge of a voxel in the file's space.
    pub(super) voxel: f64,
}

/// A grid that is no candidate, and why.
pub(super) struct LeftOut {
    /// Address of the grid.
    pub(super) name: String,
    pub(super) reason: String,
    /// Whether it would be looked for in the picture.
    pub(super) is_missed: bool,
}

/// The grids of the file that have something above zero and may be seen, and the others.
pub(super) fn candidates(
    file: &VolumeFile,
    progress: Progress,
) -> Result<(Vec<Candidate>, Vec<LeftOut>)> {
    let infos = &file.directory().grids;
    let count = infos.len().max(1) as f32;
    let (mut grids, mut left_out) = (Vec::new(), Vec::new());
    for (index, info) in infos.iter().enumerate() {
        let part = |fraction: f32| progress((index as f32 + fraction) / count);
        match candidate(file, index, info, &part)? {
            Ok(candidate) => grids.push(candidate),
            Err(reason) => left_out.push(LeftOut {
                name: file.address(index),
                reason,
                is_missed: is_seen(&info.name)
                    || info.unsupported.is_some() && !is_other(&info.name),
            }),
        }
    }
    Ok((grids, left_out))
}

/// One grid, or the reason why it is none that may be seen.
fn candidate(
    file: &VolumeFile,
    index: usize,
    info: &GridInfo,
    progress: Progress,
) -> Result<Result<Candidate, String>> {
    if let Some(reason) = &info.unsupported {
        return Ok(Err(reason.clone()));
    }
    if info.class == GridClass::LevelSet {
        let address = toml::Value::String(file.address(index));
        return Ok(Err(format!(
            "a level set, distances to a surface; a scene shows its inside as fog with density = \
             {{ grid = {address}, level_set = true }}"
        )));
    }
    if let Some(reason) = useless(info) {
        return Ok(Err(reason.to_owned()));
    }
    match file.grid_at(index, &info.name, progress) {
        Ok(grid) => Ok(Candidate::of(grid, info)),
        Err(Error::Unsupported { reason, .. }) => Ok(Err(reason)),
        Err(error) => Err(error),
    }
}

/// Why a grid of that class and name is neither smoke nor fire, whatever its values.
fn useless(info: &GridInfo) -> Option<&'static str> {
    match info.class {
        GridClass::Staggered => Some("a component of a staggered vector such as a velocity"),
        _ if is_other(&info.name) => Some("by its name it is neither smoke nor fire"),
        _ => None,
    }
}

impl Candidate {
    fn of(grid: PlacedGrid, info: &GridInfo) -> Result<Self, String> {
        let (min, max, mean, core) = match &grid.values {
            GridValues::Float(values) => {
                let stats = values.stats();
                (stats.min, stats.max, stats.mean, values.core_bounds())
            }
            GridValues::Vector(values) => {
                let stats = values.stats();
                let (min, max) = (stats.min.min_element(), stats.max.max_element());
                (min, max, stats.mean.max_element(), values.core_bounds())
            }
        };
        let Some((bounds, core)) = grid.bounds().zip(core) else {
            return Err("it is empty".to_owned());
        };
        if max <= 0.0 {
            return Err("it has no values above zero".to_owned());
        }
        let in_file = |voxels: &IndexBox| {
            FileBox::around(voxels, &grid.world_from_index, grid.taper.as_ref())
        };
        Ok(Self {
            name: info.name.clone(),
            core: in_file(&core),
            bounds: in_file(&bounds),
            voxel: info.transform.voxel_size.min_element(),
            grid,
            min,
            max,
            mean,
        })
    }

    pub(super) fn is_number(&self) -> bool {
        matches!(self.grid.values, GridValues::Float(_))
    }

    pub(super) fn is_named(&self, names: &[&str]) -> bool {
        self.rank(names).is_some()
    }

    /// Position of the grid's name among `names`.
    pub(super) fn rank(&self, names: &[&str]) -> Option<usize> {
        names.iter().position(|name| self.name.eq_ignore_ascii_case(name))
    }
}
