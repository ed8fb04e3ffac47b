//! Stamps of files, which tell whether they have changed.

use std::time::SystemTime;

use crate::error::{Error, Result};
use crate::files::path_of;

/// Time and size of a file, which tell whether it has changed.
pub type Stamp = (Option<SystemTime>, u64);

/// The stamp of the file of that name.
///
/// # Errors
/// It cannot be read or is a folder; names it.
pub(super) fn stamp_of(name: &str) -> Result<Stamp> {
    let metadata = std::fs::metadata(path_of(name)).map_err(|e| Error::io(path_of(name), e))?;
    if metadata.is_dir() {
        return Err(Error::invalid(name, "", "this is a folder; name a file in it"));
    }
    Ok((metadata.modified().ok(), metadata.len()))
}
