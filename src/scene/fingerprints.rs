//! Whether the files of a scene are still those that a picture was rendered from.

use super::{Settings, embedded};
use crate::error::Result;
use crate::files::Fingerprint;

/// The fingerprint of every file that the scene names, each once, in the scene's order.
///
/// # Errors
/// A file cannot be read, or there is no such embedded volume; names it.
pub fn fingerprints(settings: &Settings) -> Result<Vec<Fingerprint>> {
    let mut found: Vec<Fingerprint> = Vec::new();
    for name in settings.volume.iter().filter_map(|volume| volume.file.as_deref()) {
        if found.iter().any(|fingerprint| fingerprint.name == name) {
            continue;
        }
        found.push(match embedded::volume(name)? {
            Some(bytes) => Fingerprint::of(name, bytes)?,
            None => Fingerprint::of_file(name)?,
        });
    }
    Ok(found)
}
