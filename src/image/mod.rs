//! Pictures on disk and their way to a screen.
//!
//! [`exr`] keeps everything and can be continued; [`npy`] is the beauty for scripts; [`png`] is what
//! the screen shows, through the curves of [`tone`].

pub mod exr;
mod exr_layout;
pub mod npy;
pub mod png;
pub mod tone;

use std::fs::File;
use std::path::Path;

use crate::error::{Error, Result};

/// Writes a file as a whole or not at all: to a temporary name in the same folder, then renamed.
pub(crate) fn replace_file(path: &Path, write: impl FnOnce(&mut File) -> Result<()>) -> Result<()> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".flambeau-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any new file, less what the user's mask takes away.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(|e| Error::io(path, e))?;
    write(file.as_file_mut())?;
    file.persist(path).map_err(|e| Error::io(path, e.error))?;
    Ok(())
}
