//! Fingerprints of a scene's files: whether they are still those that a picture was rendered from.

use std::path::PathBuf;

use super::files::BUILTIN;
use super::sequence::{Listings, volume_frame};
use super::{Settings, embedded};
use crate::error::{Progress, Result};
use crate::files::{Fingerprint, path_of};

/// The fingerprint of every file that the scene reads in its frame, each once, in the scene's
/// order.
///
/// # Errors
/// A file cannot be read, or there is no such embedded volume; names it.
/// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
pub fn fingerprints(settings: &Settings, progress: Progress) -> Result<Vec<Fingerprint>> {
    let mut found: Vec<Fingerprint> = Vec::new();
    for name in frame_files(settings)? {
        if found.iter().any(|fingerprint| fingerprint.name == name) {
            continue;
        }
        found.push(match embedded::volume(&name)? {
            Some(bytes) => Fingerprint::of(&name, bytes, progress)?,
            None => Fingerprint::of_file(&name, progress)?,
        });
    }
    Ok(found)
}

/// The files on the disk that the scene reads in its frame, in the scene's order.
///
/// # Errors
/// The folder of a sequence cannot be read or has no frame.
pub fn files_on_disk(settings: &Settings) -> Result<Vec<PathBuf>> {
    let names = frame_files(settings)?.into_iter();
    Ok(names
        .filter(|name| !name.starts_with(BUILTIN))
        .map(|name| path_of(&name).into_owned())
        .collect())
}

/// The names of the files that the volumes show in the scene's frame, and of the environment.
fn frame_files(settings: &Settings) -> Result<Vec<String>> {
    let mut listings = Listings::default();
    let frame_of = |volume| volume_frame(volume, &settings.time, &mut listings);
    let frames = settings.volume.iter().map(frame_of);
    let files = frames.filter_map(|frame| frame.map(|frame| frame.file).transpose());
    files.chain(settings.environment.file.clone().map(Ok)).collect()
}
