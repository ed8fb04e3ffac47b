//! Loading settings by name: a scene file, an embedded scene, or a bare volume.

use std::borrow::Cow;
use std::path::Path;

use super::files::{self, BUILTIN};
use super::guess::{About, Note};
use super::sequence::NumberedSet;
use super::{Overrides, Settings, VolumeCache, apply, embedded, guess, parse};
use crate::error::{Error, NO_PROGRESS, Progress, Result};
use crate::files::{name_of, path_of};
use crate::math::Aabb;
use crate::volume::file::Format;

/// A scene or volume that was opened.
#[derive(Clone, Debug, PartialEq)]
pub struct Opened {
    /// The scene.
    pub settings: Settings,
    /// Notes on the guesses for a bare volume; empty for scenes.
    pub notes: Vec<Note>,
    /// A box around what is seen of a bare volume; `None` for scenes.
    pub bounds: Option<Aabb>,
}

/// Whether the name is that of a scene, a file or an embedded one, and not of a bare volume.
pub fn is_scene(source: &str) -> bool {
    embedded::scene(source).is_some() || scene_file(source).is_some()
}

/// The file on the disk that the scene called `source` is read from; `None` for embedded scenes and
/// bare volumes.
pub fn scene_file(source: &str) -> Option<Cow<'_, Path>> {
    let path = path_of(source);
    (!source.starts_with(BUILTIN) && files::has_extension(&path, "toml")).then_some(path)
}

/// The settings of a scene file, of a bare volume, or of `builtin:NAME`.
///
/// # Errors
/// The source cannot be read, or something in it is wrong; names the file, the key and the fix.
pub fn load(source: &str) -> Result<Settings> {
    let cache = VolumeCache::default();
    open(source, &Overrides::default(), &cache, NO_PROGRESS).map(|opened| opened.settings)
}

/// Opens a source as [`load`] does, with overrides laid over it. Data read of a bare volume stays
/// in `cache`.
///
/// # Errors
/// The errors of [`load`], and [`Error::Cancelled`].
pub fn open(
    source: &str,
    overrides: &Overrides,
    cache: &VolumeCache,
    progress: Progress,
) -> Result<Opened> {
    if let Some(text) = embedded::scene(source) {
        return scene(text, source, Path::new(""), overrides);
    }
    let path = &*path_of(source);
    if let Some(frames) = sequence_named(source)? {
        return sequence(&frames, overrides, cache, progress);
    }
    if is_volume(source, path)? {
        let name = files::resolve(source, Path::new(""))?;
        let guess = guess::guess(&cache.file(&name, progress)?, progress)?;
        let settings = apply(&guess.settings, overrides)?;
        return Ok(Opened { settings, notes: guess.notes, bounds: Some(guess.bounds) });
    }
    if !files::has_extension(path, "toml") {
        let reason = "expected a scene (.toml), a volume (.vdb, .nvdb), a folder of numbered \
                      volumes, in the window a snapshot (.exr), or the name of an embedded scene \
                      (builtin:torch)";
        return Err(Error::unsupported(source, "", reason));
    }
    let text = std::fs::read_to_string(path).map_err(|e| Error::io(path, e))?;
    scene(&text, source, &files::folder_of(path)?, overrides)
}

/// The sequence that `source` names: a pattern, a file of a numbered set, or a folder of one.
fn sequence_named(source: &str) -> Result<Option<NumberedSet>> {
    let path = &*path_of(source);
    if path.is_dir() {
        return NumberedSet::of_folder(path).map(Some);
    }
    if source.starts_with(BUILTIN) || !files::is_named_volume(path) {
        return Ok(None);
    }
    NumberedSet::of_name(&files::resolve(source, Path::new(""))?)
}

/// A bare sequence. What is guessed is guessed once, from the largest file, which shows most of
/// what all of them hold.
fn sequence(
    set: &NumberedSet,
    overrides: &Overrides,
    cache: &VolumeCache,
    progress: Progress,
) -> Result<Opened> {
    let name = name_of(&set.fullest());
    let mut guess = guess::guess(&cache.file(&name, progress)?, progress)?;
    let mut settings = guess.settings;
    for (index, volume) in settings.volume.iter_mut().enumerate() {
        volume.file = Some(name_of(&set.pattern.spelling()));
        volume.name = guess::nth_name(&set.pattern.short_name(), index);
    }
    settings.time.frame = f64::from(set.frame);
    guess.notes.push(Note::new(About::Sequence, set.in_words()));
    let settings = apply(&settings, overrides)?;
    Ok(Opened { settings, notes: guess.notes, bounds: Some(guess.bounds) })
}

/// Whether the source is to be opened as a volume: one that is embedded, a file that is one by its
/// first bytes, or one that should be by its name, which then gets to hear why it is none.
fn is_volume(source: &str, path: &Path) -> Result<bool> {
    if source.starts_with(BUILTIN) {
        return Ok(true);
    }
    if files::has_extension(path, "toml") {
        return Ok(false);
    }
    Ok(files::is_named_volume(path) || path.exists() && Format::is_of(path)?)
}

fn scene(text: &str, source: &str, folder: &Path, overrides: &Overrides) -> Result<Opened> {
    let settings = parse(text, source, folder, overrides)?;
    Ok(Opened { settings, notes: Vec::new(), bounds: None })
}
