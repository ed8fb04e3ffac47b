//! Going on from a snapshot: whether its samples and new ones would be of the same picture.

use std::path::Path;

use super::{Overrides, Settings, parse, to_toml};
use crate::error::Result;
use crate::files::Fingerprint;
use crate::image::exr::SnapshotHeader;
use crate::transport::PATH_VERSION;

/// Why new samples may not join those of a snapshot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blocker {
    /// What is not as it was.
    pub what: String,
    /// What to do about it.
    pub fix: &'static str,
}

/// How a snapshot stands to a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Compatibility {
    /// What keeps it from being continued, if anything does.
    pub blocker: Option<Blocker>,
    /// What could not be made sure of, one sentence each.
    pub warnings: Vec<String>,
}

/// The settings that the snapshot `name` was rendered with.
///
/// # Errors
/// Its header holds no scene of this version; names the key and the mend.
pub fn settings_of(header: &SnapshotHeader, name: &str) -> Result<Settings> {
    parse(&header.scene, name, Path::new("/"), &Overrides::default())
}

/// Compares the snapshot `name` with `settings`, whose `files` are as they are now. The number of
/// samples may differ.
///
/// # Errors
/// As [`settings_of`].
pub fn compatibility(
    header: &SnapshotHeader,
    name: &str,
    settings: &Settings,
    files: &[Fingerprint],
) -> Result<Compatibility> {
    let mut warnings = Vec::new();
    if let Some(blocker) = other_paths(header) {
        return Ok(Compatibility { blocker: Some(blocker), warnings });
    }
    let mut blocker = difference(&settings_of(header, name)?, settings)?.map(|difference| {
        let what =
            format!("the snapshot was rendered with other settings than this scene: {difference}");
        Blocker { what, fix: "Render anew, or give the settings it has" }
    });
    for file in files {
        match header.files.iter().find(|then| then.name == file.name) {
            Some(then) => blocker = blocker.or_else(|| change(then, file)),
            None => warnings.push(format!(
                "{name} does not say what {} held when it was rendered; if that has changed since, \
                 two pictures are being mixed",
                file.name
            )),
        }
    }
    Ok(Compatibility { blocker, warnings })
}

/// The blocker of a snapshot whose samples follow other paths than this version would. The scene in
/// it may well have keys that are not known here, and need not be understood to say so.
fn other_paths(header: &SnapshotHeader) -> Option<Blocker> {
    let what = format!(
        "the snapshot has path version {}, of Flambeau {}, and this is Flambeau {} with path version \
         {PATH_VERSION}; the same settings lead to other paths there",
        header.path_version,
        header.version,
        env!("CARGO_PKG_VERSION")
    );
    let fix = "Render anew, or go on with the version of Flambeau that wrote it";
    (header.path_version != PATH_VERSION).then_some(Blocker { what, fix })
}

/// What has become of a file.
fn change(then: &Fingerprint, now: &Fingerprint) -> Option<Blocker> {
    if then == now {
        return None;
    }
    let change = match then.bytes == now.bytes {
        true => "has other content".to_owned(),
        false => format!("had {} bytes and now has {}", then.bytes, now.bytes),
    };
    Some(Blocker {
        what: format!("{} {change} since the snapshot was rendered", now.name),
        fix: "Going on would mix two pictures: render anew, or put the old file back",
    })
}

/// The first line in which two settings differ, the number of samples apart.
fn difference(theirs: &Settings, ours: &Settings) -> Result<Option<String>> {
    let text = |settings: &Settings| {
        let mut settings = settings.clone();
        settings.film.spp = 0;
        to_toml(&settings, None)
    };
    let (theirs, ours) = (text(theirs)?, text(ours)?);
    if theirs == ours {
        return Ok(None);
    }
    let mut section = "";
    let mut lines = std::iter::zip(theirs.lines(), ours.lines());
    let different = lines.find(|(theirs, ours)| {
        if theirs == ours && theirs.starts_with('[') {
            section = theirs;
        }
        theirs != ours
    });
    Ok(Some(match different {
        Some((theirs, ours)) => format!("{section} {theirs:?} there, {ours:?} here"),
        None => "one has more volumes, lights or surfaces than the other".to_owned(),
    }))
}
