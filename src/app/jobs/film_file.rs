//! Films on their way into files: the copy that a session makes, and the header of a snapshot.

use std::path::Path;
use std::sync::mpsc;

use crate::error::{Error, NO_PROGRESS, Result};
use crate::image::exr::SnapshotHeader;
use crate::render::Film;
use crate::scene::{self, Settings};
use crate::transport::PATH_VERSION;

/// The film, once the session has copied it; `path` is what it is wanted for.
pub fn receive(path: &Path, film: &mpsc::Receiver<Film>) -> Result<Film> {
    film.recv().map_err(|_| {
        let reason = "there is no picture to save, or not enough memory to copy it";
        Error::invalid(path.display().to_string(), "", reason)
    })
}

/// The header of a snapshot of `settings`, rendered in so many seconds and so many of CPU time.
pub fn header(settings: &Settings, [seconds, cpu_seconds]: [f64; 2]) -> Result<SnapshotHeader> {
    let strategy = toml::to_string(&settings.strategy)
        .map_err(|error| Error::invalid("", "strategy", error.to_string()))?;
    Ok(SnapshotHeader {
        scene: scene::to_toml(settings, None)?,
        strategy,
        seed: settings.film.seed,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        path_version: PATH_VERSION,
        wall_seconds: seconds,
        cpu_seconds_render: cpu_seconds,
        files: scene::fingerprints(settings, NO_PROGRESS)?,
        ..SnapshotHeader::default()
    })
}
