//! The header of a snapshot, from the settings that it was rendered with.

use super::stats::Spent;
use crate::error::{Error, Result};
use crate::files::Fingerprint;
use crate::image::exr::SnapshotHeader;
use crate::scene::{self, Settings};
use crate::transport::PATH_VERSION;

/// The header of a snapshot of `settings` that read these files and took this time.
///
/// # Errors
/// When the settings cannot be written as TOML.
pub fn header(
    settings: &Settings,
    files: Vec<Fingerprint>,
    spent: Spent,
) -> Result<SnapshotHeader> {
    Ok(SnapshotHeader {
        scene: scene::to_toml(settings, None)?,
        strategy: toml::to_string(&settings.strategy)
            .map_err(|e| Error::invalid("", "strategy", e.to_string()))?,
        seed: settings.film.seed,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        path_version: PATH_VERSION,
        wall_seconds: spent.wall,
        cpu_seconds_setup: spent.cpu_setup,
        cpu_seconds_render: spent.cpu_render,
        files,
    })
}
