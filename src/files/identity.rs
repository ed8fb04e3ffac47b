//! Whether two paths are one file, however they are spelled.

use std::path::{Path, PathBuf};

use super::folder::folder_of;
use super::target::Target;

/// Identity of a file, existing or not yet, that tells it from any other.
#[derive(Clone, Debug)]
pub(crate) struct Identity {
    /// Path without `.`, `..` and symbolic links, as far as it exists.
    place: PathBuf,
    /// Device and number, which hard links share; none where the system has no such thing.
    node: Option<(u64, u64)>,
}

impl Identity {
    /// Follows `path` to what is read from it, or written to it; `None` for pipes and devices,
    /// which have nothing that could be lost.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let place = match Target::of(path) {
            Ok(Target::File(place)) => place,
            // It may be a file that is open already.
            Ok(Target::Stream(_)) | Err(_) => path.to_owned(),
        };
        let there = std::fs::metadata(&place).ok();
        let is_file = there.as_ref().is_none_or(std::fs::Metadata::is_file);
        is_file.then(|| Self { place: canonical(&place), node: there.as_ref().and_then(node) })
    }

    /// Whether both are the same file.
    pub(crate) fn is(&self, other: &Self) -> bool {
        self.place == other.place || self.node.is_some() && self.node == other.node
    }
}

/// The path without `.`, `..` and symbolic links, as far as its folder exists.
fn canonical(path: &Path) -> PathBuf {
    let in_folder = || Some(folder_of(path).canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(in_folder).unwrap_or_else(|| path.to_owned())
}

#[cfg(unix)]
fn node(metadata: &std::fs::Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn node(_: &std::fs::Metadata) -> Option<(u64, u64)> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_of_a_path_are_one_file() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("deep")).unwrap();
        std::fs::write(at("there"), "x").unwrap();
        let identity = |name: &str| Identity::of(&at(name)).unwrap();
        let same = |a: &str, b: &str| identity(a).is(&identity(b));
        for name in ["there", "absent"] {
            assert!(same(name, name));
            assert!(same(name, &format!("./deep/.././{name}")));
            assert!(!same(name, &format!("deep/{name}")));
        }
        assert!(!same("there", "absent"));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("../there", at("deep/soft")).unwrap();
            std::os::unix::fs::symlink("absent", at("dangling")).unwrap();
            std::os::unix::fs::symlink("deep", at("shallow")).unwrap();
            std::fs::hard_link(at("there"), at("hard")).unwrap();
            assert!(same("there", "deep/soft") && same("there", "hard"));
            assert!(same("absent", "dangling") && same("deep/new", "shallow/new"));
            assert!(!same("hard", "absent") && !same("dangling", "there"));
            assert!(Identity::of(Path::new("/dev/null")).is_none());
        }
    }
}
