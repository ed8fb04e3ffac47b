//! Opens snapshot files as scenes, to go on from their samples where that is right.

use std::path::Path;

use crate::app::ui::notices::{Level, Notice};
use crate::app::ui::widgets::significant;
use crate::error::{Error, NO_PROGRESS, Result};
use crate::image::exr::{Snapshot, SnapshotHeader, read_info, read_snapshot};
use crate::render::estimate::samples_per_pixel;
use crate::render::{Film, Resume};
use crate::scene::{self, Settings};

/// A reopened snapshot: its film and a notice.
pub struct Reopened {
    /// Samples that the render goes on from; `None` where it starts anew.
    pub resume: Option<Resume>,
    /// Notice on how the render goes on, put behind the name of the snapshot.
    pub notice: Notice,
}

/// Whether a path is that of a snapshot, by its ending.
pub fn is_snapshot(source: &str) -> bool {
    let extension = Path::new(source).extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("exr"))
}

/// The scene of a snapshot, and its samples where they may be continued. A limit that they have
/// reached is lifted.
///
/// # Errors
/// The file cannot be read, was not written by Flambeau, or its header holds no scene; names it.
pub fn open(source: &str) -> Result<(Settings, Reopened)> {
    let path = &*crate::files::path_of(source);
    let Some(header) = read_info(path)?.header else {
        let reason = "this EXR was not written by Flambeau and contains no scene to open";
        return Err(Error::invalid(source, "", reason));
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut settings = scene::settings_of(&header, source)?;
    let reopened = match samples(path, &name, &header, &settings) {
        Ok((film, warnings)) => {
            let spp = significant(samples_per_pixel(&film));
            let mut text = format!("resumed from {spp} spp.");
            if lift_limit(&mut settings, &film) {
                text.push_str(" It had reached its max samples; the limit is now off.");
            }
            for warning in warnings {
                text.push_str(&format!("\n{warning}."));
            }
            let (seconds, cpu_seconds) = (header.wall_seconds, header.cpu_seconds_render);
            let resume = Some(Resume { film, seconds, cpu_seconds });
            Reopened { resume, notice: Notice { level: Level::Done, text } }
        }
        Err(reason) => {
            let text = format!("cannot be resumed and is rendered from the start: {reason}.");
            Reopened { resume: None, notice: Notice { level: Level::Failed, text } }
        }
    };
    Ok((settings, reopened))
}

/// The samples of a snapshot, with what could not be made sure of; or why they cannot be continued.
fn samples(
    path: &Path,
    name: &str,
    header: &SnapshotHeader,
    settings: &Settings,
) -> Result<(Film, Vec<String>), String> {
    let files = scene::fingerprints(settings, NO_PROGRESS).map_err(|error| error.to_string())?;
    let compatibility = scene::compatibility(header, name, settings, &files);
    let compatibility = compatibility.map_err(|error| error.to_string())?;
    if let Some(blocker) = compatibility.blocker {
        return Err(blocker.what);
    }
    let Snapshot { film, .. } = read_snapshot(path).map_err(|error| error.to_string())?;
    if film.size().to_array() != settings.film.size {
        return Err("its picture does not have the render size of its scene".to_owned());
    }
    Ok((film, compatibility.warnings))
}

/// Lets a render go on that has all the samples it was to have; whether it had.
fn lift_limit(settings: &mut Settings, film: &Film) -> bool {
    let reached = settings.film.spp > 0 && film.sample_range().0 >= settings.film.spp;
    if reached {
        settings.film.spp = 0;
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::exr;
    use crate::transport::PATH_VERSION;
    use glam::UVec2;

    /// A snapshot of nothing much, with a volume file beside it.
    fn write(folder: &Path, spp: u32) -> String {
        let volume = folder.join("fire.vdb");
        std::fs::write(&volume, b"voxels").unwrap();
        let mut settings = Settings::default();
        settings.film.size = [3, 2];
        settings.film.spp = spp;
        let volume = crate::scene::settings::VolumeSettings {
            file: Some(volume.to_str().unwrap().to_owned()),
            ..Default::default()
        };
        settings.volume = vec![volume];
        let header = SnapshotHeader {
            scene: scene::to_toml(&settings, None).unwrap(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            path_version: PATH_VERSION,
            wall_seconds: 7.0,
            files: scene::fingerprints(&settings, NO_PROGRESS).unwrap(),
            ..SnapshotHeader::default()
        };
        let mut film = Film::new(UVec2::new(3, 2)).unwrap();
        for pixel in 0..6 {
            film.add(UVec2::new(pixel % 3, pixel / 3), &Default::default());
        }
        let path = folder.join("out.EXR");
        exr::write(&path, &film, &header).unwrap();
        path.to_str().unwrap().to_owned()
    }

    #[test]
    fn samples_go_on_while_the_files_are_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let path = write(folder.path(), 9);
        assert!(is_snapshot(&path) && !is_snapshot("exr") && !is_snapshot("a/exr.toml"));
        let (settings, reopened) = open(&path).unwrap();
        let resume = reopened.resume.unwrap();
        assert_eq!((resume.film.sample_range(), resume.seconds), ((1, 1), 7.0));
        assert_eq!((settings.film.spp, reopened.notice.level), (9, Level::Done));

        std::fs::write(folder.path().join("fire.vdb"), b"other voxels").unwrap();
        let (settings, reopened) = open(&path).unwrap();
        assert!(reopened.resume.is_none() && settings.film.size == [3, 2]);
        let Notice { level, text } = reopened.notice;
        assert_eq!(level, Level::Failed);
        assert!(text.contains("fire.vdb had 6 bytes and now has 12"), "{text}");
    }

    #[test]
    fn samples_of_other_paths_are_shown_as_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = write(folder.path(), 9);
        let Snapshot { film, mut header } = read_snapshot(Path::new(&path)).unwrap();
        header.path_version = PATH_VERSION + 1;
        exr::write(Path::new(&path), &film, &header).unwrap();
        let (settings, reopened) = open(&path).unwrap();
        assert!(reopened.resume.is_none() && settings.film.size == [3, 2]);
        let Notice { level, text } = reopened.notice;
        assert_eq!(level, Level::Failed);
        let theirs = format!("the snapshot has path version {}", PATH_VERSION + 1);
        assert!(text.contains("from the start") && text.contains(&theirs), "{text}");
    }

    #[test]
    fn a_limit_that_was_reached_is_lifted() {
        let folder = tempfile::tempdir().unwrap();
        let (settings, reopened) = open(&write(folder.path(), 1)).unwrap();
        assert_eq!(settings.film.spp, 0);
        assert!(reopened.resume.is_some() && reopened.notice.text.contains("the limit is now off"));
    }

    #[test]
    fn pictures_of_other_programs_say_so() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("foreign.exr");
        ::exr::prelude::write_rgb_file(&path, 4, 4, |_, _| (0.5f32, 0.5f32, 0.5f32)).unwrap();
        let error = open(path.to_str().unwrap()).err().unwrap().to_string();
        assert!(error.contains("foreign.exr") && error.contains("not written by"), "{error}");
    }
}
