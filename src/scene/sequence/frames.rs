//! The frames of a numbered set that lie on the disk, and which file shows a frame.

use std::path::{Path, PathBuf};

use super::Pattern;
use crate::error::{Error, Result};
use crate::scene::settings::Outside;

/// A file of a numbered set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameFile {
    /// Number of the frame.
    pub number: i32,
    /// Path of the file.
    pub path: PathBuf,
    /// Size of the file in bytes.
    pub bytes: u64,
}

/// The files of a numbered set, in the order of their numbers; there is at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FramesOnDisk {
    files: Vec<FrameFile>,
}

/// The frames of a volume: the files that lie on the disk, and what is shown outside of a range.
#[derive(Clone, Debug)]
pub struct Frames<'a> {
    /// The files.
    pub files: &'a FramesOnDisk,
    /// First and last frame; `None`: those of the files.
    pub range: Option<[i32; 2]>,
    /// Content of the frames before the first one and after the last.
    pub outside: Outside,
}

/// Content of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown<'a> {
    /// A file.
    File(&'a FrameFile),
    /// The file before this frame, as the frame's own is missing.
    Held(i32, &'a FrameFile),
    /// Nothing, as the frame's own file is missing and there is none before.
    Missing(i32),
    /// Nothing, outside of the range.
    Nothing,
}

impl FramesOnDisk {
    /// The files of `pattern`.
    ///
    /// # Errors
    /// The folder cannot be read, or there is no such file in it.
    pub fn of(pattern: &Pattern) -> Result<Self> {
        Self::of_paths(pattern, &paths_in(pattern.folder())?)
    }

    /// The files of `pattern` among the `paths` of its folder.
    ///
    /// # Errors
    /// There is none.
    pub(super) fn of_paths(pattern: &Pattern, paths: &[PathBuf]) -> Result<Self> {
        let mut files = Vec::new();
        for path in paths {
            let Some(number) = pattern.number_of_path(path) else { continue };
            // Through links, and without what is gone in the meantime.
            let Ok(metadata) = std::fs::metadata(path) else { continue };
            if metadata.is_file() {
                files.push(FrameFile { number, path: path.clone(), bytes: metadata.len() });
            }
        }
        if files.is_empty() {
            let name = pattern.spelling().display().to_string();
            let reason = "there is no file of that pattern; # stands for a digit of the frame";
            return Err(Error::invalid(name, "", reason));
        }
        files.sort_by_key(|file| file.number);
        Ok(Self { files })
    }

    /// The set that the file at `path` belongs to, with its number; `None` for a file without
    /// others of its kind.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn around(path: &Path) -> Result<Option<(Pattern, Self, i32)>> {
        let Some((padded, number)) = Pattern::of_file(path) else { return Ok(None) };
        // A number without zeros in front is one of a padded set or of one that is not.
        let plain = padded.with_width(1);
        let found = |pattern: Pattern| match pattern.number_of_path(path) {
            Some(_) => Self::of(&pattern).map(|files| Some((pattern, files, number))),
            None => Ok(None),
        };
        let sets = [found(padded)?, found(plain)?].into_iter().flatten();
        let largest = sets.rev().max_by_key(|(_, set, _)| set.files.len());
        Ok(largest.filter(|(_, set, _)| set.files.len() > 1))
    }

    /// The files in the order of their numbers.
    pub fn files(&self) -> &[FrameFile] {
        &self.files
    }

    /// Number of the first and of the last file.
    pub fn range(&self) -> [i32; 2] {
        let number = |file: Option<&FrameFile>| file.map_or(0, |file| file.number);
        [number(self.files.first()), number(self.files.last())]
    }

    /// The largest file, which shows most of what the set holds; the first of equal ones.
    pub fn fullest(&self) -> Option<&FrameFile> {
        self.files.iter().rev().max_by_key(|file| file.bytes)
    }

    /// Numbers between the first and the last file that have no file, as first and last of each
    /// hole.
    pub fn holes(&self) -> Vec<[i32; 2]> {
        let pairs = self.files.iter().zip(self.files.iter().skip(1));
        pairs
            .filter(|(a, b)| b.number > a.number + 1)
            .map(|(a, b)| [a.number + 1, b.number - 1])
            .collect()
    }

    /// The last file up to `number`.
    fn at_or_before(&self, number: i32) -> Option<&FrameFile> {
        let after = self.files.partition_point(|file| file.number <= number);
        after.checked_sub(1).and_then(|index| self.files.get(index))
    }
}

/// Paths of all that is in a folder.
///
/// # Errors
/// The folder cannot be read.
pub(super) fn paths_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let failed = |error| Error::io(folder, error);
    let entries = std::fs::read_dir(folder).map_err(failed)?;
    entries.map(|entry| entry.map(|entry| entry.path()).map_err(failed)).collect()
}

impl<'a> Frames<'a> {
    /// Content of `frame`, counted as the files are.
    pub fn at(&self, frame: i32) -> Shown<'a> {
        let [first, last] = self.range.unwrap_or_else(|| self.files.range());
        let is_inside = (first..=last).contains(&frame);
        let number = match self.outside {
            _ if is_inside => frame,
            Outside::Hold => frame.clamp(first, last.max(first)),
            Outside::Loop => wrapped(frame, first, last),
            Outside::None => return Shown::Nothing,
        };
        match self.files.at_or_before(number) {
            Some(file) if file.number == number => Shown::File(file),
            Some(file) => Shown::Held(number, file),
            None => Shown::Missing(number),
        }
    }
}

/// `frame` moved by whole lengths of `first..=last` until it lies inside.
fn wrapped(frame: i32, first: i32, last: i32) -> i32 {
    let length = (i64::from(last) - i64::from(first) + 1).max(1);
    let offset = (i64::from(frame) - i64::from(first)).rem_euclid(length);
    (i64::from(first) + offset) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_disk(numbers: &[i32]) -> FramesOnDisk {
        let file = |&number: &i32| FrameFile {
            number,
            path: PathBuf::from(format!("{number}.vdb")),
            bytes: if number == 3 { 9 } else { 5 },
        };
        FramesOnDisk { files: numbers.iter().map(file).collect() }
    }

    #[test]
    fn frames_outside_of_the_range_are_held_looped_or_empty() {
        let files = on_disk(&[2, 3, 4]);
        let shown = |outside, range, frame| {
            let frames = Frames { files: &files, range, outside };
            match frames.at(frame) {
                Shown::File(file) => Some(file.number),
                Shown::Nothing => None,
                other => panic!("{other:?}"),
            }
        };
        for (frame, hold, looped, none) in [
            (2, Some(2), Some(2), Some(2)),
            (5, Some(4), Some(2), None),
            (1, Some(2), Some(4), None),
            (-1, Some(2), Some(2), None),
            (i32::MAX, Some(4), Some(4), None),
        ] {
            assert_eq!(shown(Outside::Hold, None, frame), hold, "{frame}");
            assert_eq!(shown(Outside::Loop, None, frame), looped, "{frame}");
            assert_eq!(shown(Outside::None, None, frame), none, "{frame}");
        }
        assert_eq!(shown(Outside::Loop, Some([2, 3]), 4), Some(2));
        assert_eq!(shown(Outside::None, Some([3, 3]), 4), None);
    }

    #[test]
    fn a_hole_holds_the_frame_before() {
        let files = on_disk(&[2, 3, 7]);
        let frames = Frames { files: &files, range: Some([1, 9]), outside: Outside::Hold };
        assert_eq!(frames.at(5), Shown::Held(5, &files.files[1]));
        assert_eq!(frames.at(9), Shown::Held(9, &files.files[2]));
        assert_eq!(frames.at(1), Shown::Missing(1));
        assert_eq!(files.holes(), [[4, 6]]);
        assert_eq!(files.range(), [2, 7]);
        assert_eq!(files.fullest().map(|file| file.number), Some(3));
        assert_eq!(on_disk(&[5, 6]).fullest().map(|file| file.number), Some(5));
    }
}
