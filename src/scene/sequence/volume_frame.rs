//! The file that a volume shows in a frame.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;
use std::path::PathBuf;

use super::frames::paths_in;
use super::{Frames, FramesOnDisk, Pattern, Shown};
use crate::error::Result;
use crate::files::name_of;
use crate::scene::settings::{Settings, TimeSettings, VolumeSettings};

/// The file that a volume shows in a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VolumeFrame {
    /// Name of the file; `None` for a shape, and where the sequence shows nothing.
    pub file: Option<String>,
    /// Name of the largest file of the sequence, if the volume is one.
    pub fullest: Option<String>,
    /// The missing file of the frame, if it is missing.
    pub gap: Option<Gap>,
}

/// Something that a frame of a sequence lacks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Gap {
    /// The file of the frame is missing.
    Frame {
        /// Name of the file.
        file: String,
        /// Number of the frame of the files.
        frame: i32,
        /// Number of the frame that is shown in its place, if there is one before.
        held: Option<i32>,
    },
    /// There is nothing in the file to show.
    Empty {
        /// Name of the file.
        file: String,
    },
    /// A grid that other frames have is missing, and counts as zero.
    Grid {
        /// Name of the file.
        file: String,
        /// Name of the grid.
        grid: String,
    },
    /// Pixels of the environment's picture hold no radiance, and count as zero.
    Pixels {
        /// Name of the file.
        file: String,
        /// Number of the pixels.
        pixels: usize,
    },
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frame { frame, held: Some(held), .. } => {
                write!(f, "frame {frame} is missing; frame {held} is shown in its place")
            }
            Self::Frame { frame, held: None, .. } => {
                write!(f, "frame {frame} is missing; nothing is shown in its place")
            }
            Self::Empty { .. } => f.write_str("the volume is empty"),
            Self::Grid { grid, .. } => {
                write!(f, "this frame has no grid \"{grid}\", which counts as zero")
            }
            Self::Pixels { pixels, .. } => write!(
                f,
                "{pixels} of its pixels hold negative values or values that are no numbers, which \
                 count as zero"
            ),
        }
    }
}

impl Gap {
    /// Name of the file that is missing or lacks something.
    pub fn file(&self) -> &str {
        match self {
            Self::Frame { file, .. }
            | Self::Empty { file }
            | Self::Grid { file, .. }
            | Self::Pixels { file, .. } => file,
        }
    }
}

/// The sequences of several volumes as they are on the disk: each folder is listed once, so that
/// what is changed there in the meantime is not seen.
#[derive(Debug, Default)]
pub struct Listings {
    folders: HashMap<PathBuf, Vec<PathBuf>>,
    sets: HashMap<String, Option<(Pattern, FramesOnDisk)>>,
}

impl Listings {
    /// The frames that lie on the disk if `file` is the pattern of a sequence, `None` for other
    /// names.
    ///
    /// # Errors
    /// The folder cannot be read or has no file of that pattern.
    pub fn listed(&mut self, file: &str) -> Result<Option<&(Pattern, FramesOnDisk)>> {
        if !self.sets.contains_key(file) {
            let set = match Pattern::spelled(file) {
                None => None,
                Some(pattern) => {
                    let paths = match self.folders.entry(pattern.folder().to_owned()) {
                        Entry::Occupied(known) => known.into_mut(),
                        Entry::Vacant(place) => place.insert(paths_in(pattern.folder())?),
                    };
                    let files = FramesOnDisk::of_paths(&pattern, paths)?;
                    Some((pattern, files))
                }
            };
            self.sets.insert(file.to_owned(), set);
        }
        Ok(self.sets.get(file).and_then(Option::as_ref))
    }
}

/// The file that `volume` shows at `time`.
///
/// # Errors
/// As [`Listings::listed`].
pub fn volume_frame(
    volume: &VolumeSettings,
    time: &TimeSettings,
    listings: &mut Listings,
) -> Result<VolumeFrame> {
    let Some(name) = &volume.file else { return Ok(VolumeFrame::default()) };
    let Some((pattern, files)) = listings.listed(name)? else {
        return Ok(VolumeFrame { file: Some(name.clone()), ..VolumeFrame::default() });
    };
    let frames = Frames { files, range: volume.frame_range, outside: volume.outside };
    let missing =
        |frame, held| Some(Gap::Frame { file: name_of(&pattern.file(frame)), frame, held });
    let (file, gap) = match frames.at(time.whole_frame().saturating_add(volume.frame_offset)) {
        Shown::File(file) => (Some(file), None),
        Shown::Held(frame, file) => (Some(file), missing(frame, Some(file.number))),
        Shown::Missing(frame) => (None, missing(frame, None)),
        Shown::Nothing => (None, None),
    };
    let name = |file: &super::FrameFile| name_of(&file.path);
    Ok(VolumeFrame { file: file.map(name), fullest: files.fullest().map(name), gap })
}

/// First and last frame of the time line: `time.range`, else the frames that the sequences have on
/// the disk and those from the first to the last key of the camera. `None` for a scene that does
/// not change.
pub fn time_range(settings: &Settings) -> Option<[i32; 2]> {
    let mut listings = Listings::default();
    let of_volume = |volume: &VolumeSettings| {
        // A folder that cannot be read is reported where the scene is built.
        let (_, files) = listings.listed(volume.file.as_deref()?).ok()??;
        let range = volume.frame_range.unwrap_or_else(|| files.range());
        Some(range.map(|frame| frame.saturating_sub(volume.frame_offset)))
    };
    let on_disk = settings.volume.iter().filter_map(of_volume);
    let all = on_disk.chain(settings.camera.key_range());
    settings.time.range.or_else(|| all.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]))
}
