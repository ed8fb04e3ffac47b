//! Files of scenes in memory: each volume is read once, each grid of it when first needed, and what
//! was derived from them is reused while only other numbers of the scene change.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::DAffine3;

use super::radiance_maps::RadianceMaps;
use super::sequence::Gap;
use super::settings::{TimeSettings, VolumeSettings};
use super::stamp::{Stamp, stamp_of};
use super::{embedded, grid_address};
use crate::error::{Error, Progress, Result};
use crate::files::path_of;
use crate::volume::file::{Directory, GridInfo};
use crate::volume::grid::{GridClass, IndexBox, SparseGrid, VoxelValues};
use crate::volume::{Taper, Volume};

/// Part of the progress that reading a level set takes; the rest is its fog.
const READING: f32 = 0.7;

/// Volume files and the volumes built from them, shared by everything that builds scenes.
#[derive(Default)]
pub struct VolumeCache {
    files: Mutex<HashMap<String, Arc<VolumeFile>>>,
    /// The volumes, those that were used last at the end.
    volumes: Mutex<Vec<BuiltVolume>>,
    environment: RadianceMaps,
    /// Bytes that frames which no scene shows may take.
    room: usize,
}

/// A volume as it was built, before it is placed.
#[derive(Clone)]
pub(super) struct BuiltVolume {
    /// The settings without name and placement.
    pub(super) settings: VolumeSettings,
    /// The time within its frame, of a volume in motion.
    pub(super) time: Option<TimeSettings>,
    /// The file it was built from, if any.
    pub(super) file: Option<Arc<VolumeFile>>,
    /// The volume that was built.
    pub(super) volume: Arc<Volume>,
    /// Transform from the volume's own space to that of the file.
    pub(super) file_from_local: DAffine3,
    /// Grids that this frame of a sequence lacks.
    pub(super) gaps: Vec<Gap>,
}

/// A volume file whose grids are loaded when they are asked for.
pub struct VolumeFile {
    name: String,
    stamp: Option<Stamp>,
    directory: Directory,
    grids: Mutex<Vec<Option<VoxelValues>>>,
    /// The fogs of level sets, by the places of the grids in the directory.
    fogs: Mutex<HashMap<usize, Arc<SparseGrid<f32>>>>,
}

/// A grid in memory with its place in the file's space.
#[derive(Clone)]
pub struct PlacedGrid {
    /// Address of the grid in the file: its name, with `[n]` after it from the second of one name
    /// on.
    pub name: String,
    /// Class of the grid, as its writer declared it.
    pub class: GridClass,
    /// Voxels of the grid.
    pub values: GridValues,
    /// Transform from the grid's index space to the file's world; of a frustum from its spread
    /// space.
    pub world_from_index: DAffine3,
    /// The way from index space to spread space, of a frustum.
    pub taper: Option<Taper>,
}

/// The voxels of a grid.
#[derive(Clone)]
pub enum GridValues {
    /// Single numbers.
    Float(Arc<SparseGrid<f32>>),
    /// Vectors or colors.
    Vector(Arc<SparseGrid<glam::Vec3A>>),
}

impl VolumeCache {
    /// A cache with room for so many bytes of frames which no scene shows, so that going back and
    /// forth on the time line need not read them again.
    pub fn with_room(room: usize) -> Self {
        Self { room, ..Self::default() }
    }

    /// The map of the environment.
    pub(super) fn environment(&self) -> &RadianceMaps {
        &self.environment
    }

    /// Bytes that frames which no scene shows may take.
    pub fn room(&self) -> usize {
        self.room
    }

    /// Memory of the grids of all volumes that are kept, in bytes.
    pub fn bytes(&self) -> usize {
        locked(&self.volumes).iter().map(BuiltVolume::bytes).sum()
    }

    /// The volume file of that name (`builtin:NAME` for an embedded one), read again if it has
    /// changed.
    ///
    /// # Errors
    /// It cannot be read or is not a volume file; names the file.
    pub fn file(&self, name: &str, progress: Progress) -> Result<Arc<VolumeFile>> {
        let embedded = embedded::volume(name)?;
        let stamp = match embedded {
            Some(_) => None,
            None => Some(stamp_of(name)?),
        };
        let known = locked(&self.files).get(name).cloned();
        if let Some(known) = known.filter(|known| known.stamp == stamp) {
            return Ok(known);
        }
        let directory = match embedded {
            Some(bytes) => Directory::parse(name, bytes, progress)?,
            None => Directory::open(path_of(name), progress)?,
        };
        let grids = Mutex::new(vec![None; directory.grids.len()]);
        let (name_of_file, fogs) = (name.to_owned(), Mutex::default());
        let file = Arc::new(VolumeFile { name: name_of_file, stamp, directory, grids, fogs });
        locked(&self.files).insert(name.to_owned(), file.clone());
        Ok(file)
    }

    /// A volume built before from the same settings, for the same time within its frame and from
    /// the same state of the file.
    pub(super) fn built(
        &self,
        settings: &VolumeSettings,
        time: Option<TimeSettings>,
        file: Option<&Arc<VolumeFile>>,
    ) -> Option<BuiltVolume> {
        let volumes = locked(&self.volumes);
        volumes.iter().find(|built| built.is_of(settings, time, file)).cloned()
    }

    /// Keeps a volume until a scene is built without it.
    pub(super) fn keep(&self, built: BuiltVolume) {
        locked(&self.volumes).push(built);
    }

    /// Lets go of every volume and file that the scene just built does not use, but for other
    /// frames of its sequences that there is room for, those used last first.
    pub(super) fn retain(&self, used: &[Arc<Volume>]) {
        let mut volumes = locked(&self.volumes);
        let is_used = |built: &BuiltVolume| used.iter().any(|v| Arc::ptr_eq(v, &built.volume));
        let (shown, others): (Vec<_>, Vec<_>) = volumes.drain(..).partition(is_used);
        let mut room = self.room;
        let mut kept: Vec<BuiltVolume> = Vec::new();
        for built in others.into_iter().rev() {
            let is_of =
                |one: &BuiltVolume| one.settings == built.settings && one.time == built.time;
            let is_frame = shown.iter().any(is_of);
            let bytes = built.bytes();
            if is_frame && bytes <= room {
                room -= bytes;
                kept.push(built);
            }
        }
        volumes.extend(kept.into_iter().rev().chain(shown));
        let in_use = |file: &Arc<VolumeFile>| {
            volumes.iter().filter_map(|v| v.file.as_ref()).any(|used| Arc::ptr_eq(used, file))
        };
        locked(&self.files).retain(|_, file| in_use(file));
    }
}

impl BuiltVolume {
    /// Memory of the grids of its file, in bytes.
    fn bytes(&self) -> usize {
        self.file.as_ref().map_or(0, |file| file.bytes())
    }

    fn is_of(
        &self,
        settings: &VolumeSettings,
        time: Option<TimeSettings>,
        file: Option<&Arc<VolumeFile>>,
    ) -> bool {
        let same_file = match (&self.file, file) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        same_file && self.settings == *settings && self.time == time
    }
}

impl VolumeFile {
    /// Name by which the file was requested.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Memory of the grids that were loaded, in bytes.
    fn bytes(&self) -> usize {
        let bytes = |values: &VoxelValues| match values {
            VoxelValues::Float(grid) => grid.stats().memory_bytes,
            VoxelValues::Vec3(grid) => grid.stats().memory_bytes,
            VoxelValues::Unsupported(_) => 0,
        };
        let grids: usize = locked(&self.grids).iter().flatten().map(bytes).sum();
        let fogs: usize = locked(&self.fogs).values().map(|fog| fog.stats().memory_bytes).sum();
        grids + fogs
    }

    /// Directory of the file: its grids without their voxels.
    pub fn directory(&self) -> &Directory {
        &self.directory
    }

    /// Whether there is a grid of that name.
    pub fn has_grid(&self, name: &str) -> bool {
        grid_address::find(self.grid_names(), name).is_some()
    }

    /// The grid of that name, or with `[n]` after it the n-th of a name, loaded if it is not yet.
    ///
    /// # Errors
    /// There is none (`field` is the key that asked for it), it cannot be read, or it is of a type
    /// that holds no values to render.
    pub fn grid(&self, name: &str, field: &str, progress: Progress) -> Result<PlacedGrid> {
        self.grid_at(self.index_of(name, field)?, field, progress)
    }

    /// The grid at `index` of the directory; as [`VolumeFile::grid`].
    ///
    /// # Errors
    /// As [`VolumeFile::grid`].
    pub fn grid_at(&self, index: usize, field: &str, progress: Progress) -> Result<PlacedGrid> {
        let Some(info) = self.directory.grids.get(index) else {
            let reason = format!("there is no grid {index}; the file has {}", self.names());
            return Err(Error::invalid(&self.name, field, reason));
        };
        let known = locked(&self.grids).get(index).cloned().flatten();
        let values = match known {
            Some(values) => values,
            None => {
                let values = rebased(self.directory.load(index, progress)?);
                if let Some(place) = locked(&self.grids).get_mut(index) {
                    *place = Some(values.clone());
                }
                values
            }
        };
        let values = match values {
            VoxelValues::Float(grid) => GridValues::Float(grid),
            VoxelValues::Vec3(grid) => GridValues::Vector(grid),
            VoxelValues::Unsupported(reason) => {
                let address = self.address(index);
                let reason = format!("the grid \"{address}\" cannot be rendered: {reason}");
                return Err(Error::unsupported(&self.name, field, reason));
            }
        };
        let grid = PlacedGrid::new(self.address(index), info, values);
        let reaches_tip = grid.taper.zip(grid.bounds()).is_some_and(|(taper, b)| !taper.holds(&b));
        if reaches_tip {
            let reason = "it reaches behind the tip of its frustum; cut off that part";
            return Err(Error::unsupported(&self.name, field, reason));
        }
        Ok(grid)
    }

    /// The fog of a level set: as [`VolumeFile::grid`], with the values of
    /// [`SparseGrid::fog_of_level_set`].
    ///
    /// # Errors
    /// As [`VolumeFile::grid`]; or the grid is no level set, or one without an inside.
    pub fn fog(&self, name: &str, field: &str, progress: Progress) -> Result<PlacedGrid> {
        let index = self.index_of(name, field)?;
        let grid = self.grid_at(index, field, &|part| progress(READING * part))?;
        let refused = |reason: &str| {
            let reason = format!("the grid \"{name}\" cannot be read as a level set: {reason}");
            Error::invalid(&self.name, field, reason)
        };
        let distances = match (&grid.values, grid.class) {
            (GridValues::Vector(_), _) => return Err(refused("it holds vectors")),
            (_, class @ (GridClass::FogVolume | GridClass::Staggered)) => {
                return Err(refused(&format!("its class is {class}; leave out level_set")));
            }
            (GridValues::Float(distances), _) => distances,
        };
        let known = locked(&self.fogs).get(&index).cloned();
        let fog = match known {
            Some(fog) => fog,
            None => {
                let rest = |part: f32| progress(READING + (1.0 - READING) * part);
                let made = distances.fog_of_level_set(&rest).map_err(|error| match error {
                    Error::Invalid { reason, .. } => refused(&reason),
                    other => other,
                });
                let fog = Arc::new(made?);
                locked(&self.fogs).insert(index, fog.clone());
                fog
            }
        };
        Ok(PlacedGrid { values: GridValues::Float(fog), class: GridClass::FogVolume, ..grid })
    }

    fn index_of(&self, name: &str, field: &str) -> Result<usize> {
        let found = grid_address::find(self.grid_names(), name);
        found.ok_or_else(|| Error::invalid(&self.name, field, self.no_such_grid(name)))
    }

    /// Address of the grid at `index`, by which [`VolumeFile::grid`] finds it.
    pub fn address(&self, index: usize) -> String {
        grid_address::of(self.grid_names(), index)
    }

    fn grid_names(&self) -> impl Iterator<Item = &str> + Clone {
        self.directory.grids.iter().map(|grid| grid.name.as_str())
    }

    /// The names of the grids, as a sentence lists them.
    fn names(&self) -> String {
        let indices = 0..self.directory.grids.len();
        let names: Vec<String> =
            indices.map(|index| format!("\"{}\"", self.address(index))).collect();
        if names.is_empty() { "no grids".to_owned() } else { names.join(", ") }
    }

    fn no_such_grid(&self, name: &str) -> String {
        format!("there is no grid \"{name}\"; the file has {}", self.names())
    }
}

impl PlacedGrid {
    fn new(name: String, info: &GridInfo, values: GridValues) -> Self {
        let origin = match &values {
            GridValues::Float(grid) => grid.origin(),
            GridValues::Vector(grid) => grid.origin(),
        };
        let file_from_stored = info.transform.index_to_world;
        let taper = info.transform.taper.map(|taper| taper.rebased(origin));
        let world_from_index = match taper {
            Some(_) => file_from_stored,
            None => file_from_stored * DAffine3::from_translation(origin.as_dvec3()),
        };
        Self { name, class: info.class, values, world_from_index, taper }
    }

    /// Box around the stored voxels in index space, both ends included; `None` if empty.
    pub fn bounds(&self) -> Option<IndexBox> {
        match &self.values {
            GridValues::Float(grid) => grid.bounds(),
            GridValues::Vector(grid) => grid.bounds(),
        }
    }
}

/// The values with their voxels near the origin, as look-ups in single precision need them.
fn rebased(mut values: VoxelValues) -> VoxelValues {
    match &mut values {
        VoxelValues::Float(grid) => Arc::get_mut(grid).into_iter().for_each(SparseGrid::rebase),
        VoxelValues::Vec3(grid) => Arc::get_mut(grid).into_iter().for_each(SparseGrid::rebase),
        VoxelValues::Unsupported(_) => {}
    }
    values
}

/// The contents, also after a panic elsewhere: they are sound after every statement.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
