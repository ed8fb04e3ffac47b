//! Motion of a volume by the velocity grids of its file.

use glam::{Affine3A, DAffine3, DVec3, IVec3, Mat3A};

use super::source::GridSource;
use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::cache::{GridValues, PlacedGrid};
use crate::scene::file_box::FileBox;
use crate::scene::settings::{TimeSettings, VelocitySettings, VelocityUnit, VolumeSettings};
use crate::volume::field::{GridField, ScalarField};
use crate::volume::grid::{GridClass, IndexBox, SparseGrid, Voxel};
use crate::volume::{Motion, Shutter, Taper, VelocityField};

/// Index coordinates of a face before the middle of its voxel.
const TO_FACE: f64 = 0.5;
/// Largest difference, in voxels, of two places that are the same but for rounding.
const SAME: f64 = 1e-3;

/// The time within its frame that the look of a volume depends on; `None` for one that stands
/// still, since it has no velocity or is seen at the time of its grids alone.
pub(super) fn time_in_motion(
    settings: &VolumeSettings,
    time: &TimeSettings,
) -> Option<TimeSettings> {
    let frame = time.since_whole_frame();
    let moves = settings.velocity.is_some() && (frame, time.shutter) != (0.0, 0.0);
    moves.then_some(TimeSettings { frame, range: None, ..*time })
}

/// Motion of the volume that the grids asked for so far make up; they must not be empty.
pub(super) fn motion(
    grids: &mut GridSource,
    settings: &VelocitySettings,
    time: &TimeSettings,
    key: &str,
) -> Result<Motion> {
    let mut support = Aabb::EMPTY;
    let field = match (&settings.grids, &settings.grid) {
        (Some(names), _) => {
            components(grids, names, &format!("{key}.velocity.grids"), &mut support)
        }
        (None, name) => {
            let name = name.as_deref().unwrap_or_default();
            vectors(grids, name, &format!("{key}.velocity.grid"), &mut support)
        }
    }?;
    let per_second = match settings.unit {
        VelocityUnit::Second => 1.0,
        VelocityUnit::Frame => time.fps,
    };
    let local_from_file = grids.file_from_local().matrix3.inverse();
    let local_from_velocity = local_from_file * (f64::from(settings.scale) * per_second);
    let [frame, open] =
        [time.since_whole_frame(), time.shutter].map(|frames| (frames / time.fps) as f32);
    Ok(Motion::new(
        field,
        support,
        Mat3A::from(local_from_velocity.as_mat3()),
        grids.bounds(),
        Shutter { frame, open },
    ))
}

/// The velocities of a grid of vectors; zero if the file lacks it.
fn vectors(
    grids: &mut GridSource,
    name: &str,
    field: &str,
    support: &mut Aabb,
) -> Result<VelocityField> {
    let Some(grid) = grids.find(name, field)? else {
        return Ok(VelocityField::Components([const { ScalarField::Constant(0.0) }; 3]));
    };
    let GridValues::Vector(values) = &grid.values else {
        let reason = format!(
            "the grid \"{name}\" holds single numbers; name one of vectors, or three of numbers in \
             velocity.grids"
        );
        return Err(Error::invalid(grids.file_name(), field, reason));
    };
    let place = Place::of(grids, &grid, grid.class == GridClass::Staggered, support);
    Ok(match place.at_faces {
        true => VelocityField::Faces([0, 1, 2].map(|axis| place.field(values, axis))),
        false => VelocityField::Centers(place.field(values, 0)),
    })
}

/// The velocities of three grids of numbers; those that the file lacks are zero.
fn components(
    grids: &mut GridSource,
    names: &[String; 3],
    field: &str,
    support: &mut Aabb,
) -> Result<VelocityField> {
    let mut found = Vec::with_capacity(names.len());
    for name in names {
        let grid = grids.find(name, field)?;
        if grid.as_ref().is_some_and(|grid| matches!(grid.values, GridValues::Vector(_))) {
            let reason = format!("the grid \"{name}\" holds vectors; name it in velocity.grid");
            return Err(Error::invalid(grids.file_name(), field, reason));
        }
        found.push(grid);
    }
    // Some programs place each grid at its faces already.
    let mut there = found.iter().flatten();
    let first = there.next().map(|first| file_from_stored(first).inverse());
    let is_same = |place: DAffine3| place.abs_diff_eq(DAffine3::IDENTITY, SAME);
    let are_alike = there.all(|grid| first.is_some_and(|f| is_same(f * file_from_stored(grid))));
    let at_faces = |grid: &PlacedGrid| are_alike && grid.class == GridClass::Staggered;
    let mut field_of = |axis: usize| match found.get(axis).and_then(Option::as_ref) {
        None => ScalarField::Constant(0.0),
        Some(grid) => match &grid.values {
            GridValues::Vector(_) => ScalarField::Constant(0.0),
            GridValues::Float(values) => {
                let place = Place::of(grids, grid, at_faces(grid), support);
                ScalarField::Grid(place.field(values, axis))
            }
        },
    };
    Ok(VelocityField::Components([field_of(0), field_of(1), field_of(2)]))
}

/// Transform from the index space of a grid as the file has it, of a frustum from its spread space,
/// to the file's space.
fn file_from_stored(grid: &PlacedGrid) -> DAffine3 {
    let offset = match &grid.values {
        GridValues::Float(values) => values.origin(),
        GridValues::Vector(values) => values.origin(),
    };
    match grid.taper {
        // The origin moved the taper and not the transform.
        Some(_) => grid.world_from_index,
        None => grid.world_from_index * DAffine3::from_translation(-offset.as_dvec3()),
    }
}

/// Place of the samples of a velocity grid in the volume's space.
struct Place {
    grid_from_local: DAffine3,
    taper: Option<Taper>,
    /// Whether a component is sampled at the faces across its axis, below the middles of voxels.
    at_faces: bool,
}

impl Place {
    /// The place of a grid; its box is added to `support`.
    fn of(grids: &mut GridSource, grid: &PlacedGrid, at_faces: bool, support: &mut Aabb) -> Self {
        let local_from_grid = grids.local_from_grid(grid);
        if let Some(IndexBox { min, max }) = grid.bounds() {
            let more = IVec3::splat(at_faces.into());
            let (min, max) = (min.saturating_sub(more), max.saturating_add(more));
            let voxels = IndexBox { min, max };
            let around = FileBox::around(&voxels, &local_from_grid, grid.taper.as_ref());
            *support = support.union(&around.to_aabb());
        }
        Self { grid_from_local: local_from_grid.inverse(), taper: grid.taper, at_faces }
    }

    /// The values of a grid, placed for a component.
    fn field<V: Voxel>(&self, values: &std::sync::Arc<SparseGrid<V>>, axis: usize) -> GridField<V> {
        let mut offset = DVec3::ZERO;
        if self.at_faces {
            offset[axis] = TO_FACE;
        }
        // The last step of either way to index space is a translation.
        let (grid_from_local, taper) = match self.taper {
            None => (DAffine3::from_translation(offset) * self.grid_from_local, None),
            Some(taper) => {
                let center = taper.center + offset.truncate();
                let taper = Taper { center, near: taper.near + offset.z, ..taper };
                (self.grid_from_local, Some(taper))
            }
        };
        let grid_from_local: Affine3A = grid_from_local.as_affine3a();
        GridField::new(values.clone(), grid_from_local, taper.as_ref())
    }
}
