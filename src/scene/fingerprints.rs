//! Fingerprints of a scene's files: whether they are still those that a picture was rendered from.

use std::path::Path;

use super::files::BUILTIN;
use super::{Settings, embedded};
use crate::error::{Progress, Result};
use crate::files::Fingerprint;

/// The fingerprint of every file that the scene names, each once, in the scene's order.
///
/// # Errors
/// A file cannot be read, or there is no such embedded volume; names it.
/// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
pub fn fingerprints(settings: &Settings, progress: Progress) -> Result<Vec<Fingerprint>> {
    let mut found: Vec<Fingerprint> = Vec::new();
    for name in settings.volume.iter().filter_map(|volume| volume.file.as_deref()) {
        if found.iter().any(|fingerprint| fingerprint.name == name) {
            continue;
        }
        found.push(match embedded::volume(name)? {
            Some(bytes) => Fingerprint::of(name, bytes, progress)?,
            None => Fingerprint::of_file(name, progress)?,
        });
    }
    Ok(found)
}

/// The files on the disk that the scene names, in the scene's order.
pub fn volume_files(settings: &Settings) -> impl Iterator<Item = &Path> {
    let names = settings.volume.iter().filter_map(|volume| volume.file.as_deref());
    names.filter(|name| !name.starts_with(BUILTIN)).map(Path::new)
}
