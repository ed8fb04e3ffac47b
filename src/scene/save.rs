//! Settings to scene text: *save scene as*, and the scene in a snapshot's header.

use std::io::Write;
use std::path::Path;

use super::{Settings, files};
use crate::error::{Error, Result};
use crate::files::replace;

/// The scene as TOML. With a folder, the files in it are named relative to that folder where
/// that is possible; without, by their absolute names.
///
/// # Errors
/// A value that TOML cannot hold; none of those that a scene file can set.
pub fn to_toml(settings: &Settings, folder: Option<&Path>) -> Result<String> {
    let mut settings = settings.clone();
    if let Some(folder) = folder {
        let volumes = settings.volume.iter_mut().filter_map(|volume| volume.file.as_mut());
        for file in volumes.chain(settings.environment.file.as_mut()) {
            *file = files::relative(file, folder);
        }
    }
    toml::to_string(&settings).map_err(|e| Error::invalid("", "", e.to_string()))
}

/// Writes the scene so that loading it gives equal settings.
///
/// # Errors
/// As [`to_toml`], or the system refuses to write.
pub fn save(settings: &Settings, path: &Path) -> Result<()> {
    super::validate(settings, &path.display().to_string())?;
    let folder = files::folder_of(path)?;
    let text = to_toml(settings, Some(&folder))?;
    replace(path, |file| file.write_all(text.as_bytes()).map_err(|e| Error::io(path, e)))
}
