//! A numbered set of volume files that is opened by a pattern, by one of its files or by its
//! folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::{FramesOnDisk, Pattern};
use crate::error::{Error, Result};
use crate::files::{name_of, path_of};
use crate::scene::files::{is_named_volume, resolve};

/// A numbered set of volume files, and the frame that it opens at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberedSet {
    /// Pattern of the files' names.
    pub pattern: Pattern,
    /// The files.
    pub files: FramesOnDisk,
    /// The frame that it opens at: that of the file that was named, else the first.
    pub frame: i32,
}

impl NumberedSet {
    /// The set of a pattern, or the one that a numbered file belongs to. `None` for a file without
    /// others of its kind.
    ///
    /// # Errors
    /// The folder cannot be read, or there is no file of the pattern.
    pub fn of_name(name: &str) -> Result<Option<Self>> {
        if let Some(set) = Self::of_pattern(name)? {
            return Ok(Some(set));
        }
        let path = &*path_of(name);
        // A file that is not there is reported by its own name.
        if !path.is_file() {
            return Ok(None);
        }
        let around = FramesOnDisk::around(path)?;
        Ok(around.map(|(pattern, files, frame)| Self { pattern, files, frame }))
    }

    /// The set of a pattern or of a folder; `None` for other names.
    ///
    /// # Errors
    /// The errors of [`NumberedSet::of_name`] and [`NumberedSet::of_folder`].
    pub fn of_pattern_or_folder(name: &str) -> Result<Option<Self>> {
        let path = path_of(name);
        if path.is_dir() { Self::of_folder(&path).map(Some) } else { Self::of_pattern(name) }
    }

    fn of_pattern(name: &str) -> Result<Option<Self>> {
        let Some(pattern) = Pattern::spelled(name) else { return Ok(None) };
        let files = FramesOnDisk::of(&pattern)?;
        let [frame, _] = files.range();
        Ok(Some(Self { pattern, files, frame }))
    }

    /// The set of a folder: the one with the most files, the first by name of several.
    ///
    /// # Errors
    /// The folder cannot be read, or no volumes are in it; names what is.
    pub fn of_folder(folder: &Path) -> Result<Self> {
        let entries = std::fs::read_dir(folder).map_err(|e| Error::io(folder, e))?;
        let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
        let mut volumes: Vec<PathBuf> = paths.filter(|path| is_named_volume(path)).collect();
        volumes.sort();
        let mut sets: BTreeMap<PathBuf, Self> = BTreeMap::new();
        for path in &volumes {
            if sets.values().any(|set| set.pattern.number_of_path(path).is_some()) {
                continue;
            }
            let name = resolve(&name_of(path), Path::new(""))?;
            if let Some((pattern, files, frame)) = FramesOnDisk::around(&path_of(&name))? {
                sets.insert(pattern.spelling(), Self { pattern, files, frame });
            }
        }
        let largest = sets.into_values().rev().max_by_key(|set| set.files.files().len());
        let mut set = largest.ok_or_else(|| {
            let reason = match volumes.as_slice() {
                [] => "there are no volumes (.vdb, .nvdb) in this folder".to_owned(),
                [first, ..] => format!(
                    "there is no numbered set of volumes in this folder; name a file in it, such \
                     as {}",
                    first.display()
                ),
            };
            Error::invalid(folder.display().to_string(), "", reason)
        })?;
        [set.frame, _] = set.files.range();
        Ok(set)
    }

    /// Path of the largest file.
    pub fn fullest(&self) -> PathBuf {
        self.files.fullest().map_or_else(PathBuf::new, |file| file.path.clone())
    }

    /// The frames in words, and the file that the other guesses are made from.
    pub fn in_words(&self) -> String {
        let [first, last] = self.files.range();
        let missing: i32 = self.files.holes().iter().map(|[from, to]| to - from + 1).sum();
        let missing = match missing {
            0 => String::new(),
            1 => ", one of them missing".to_owned(),
            count => format!(", {count} of them missing"),
        };
        let fullest = self.files.fullest().map_or(first, |file| file.number);
        let name = self.pattern.spelling();
        let name = name.file_name().unwrap_or_default().to_string_lossy();
        format!("frames {first} to {last} of {name}{missing}; all guesses are from frame {fullest}")
    }
}
