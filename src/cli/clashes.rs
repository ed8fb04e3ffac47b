//! Outputs that would overwrite an input, or one another.

use std::borrow::Cow;
use std::path::Path;

use super::exit::Refusal;
use crate::error::{Error, Result};
use crate::files::Identity;
use crate::scene::{self, Settings};

/// A file that a command reads or writes.
pub struct Named<'a> {
    /// Name of the file in messages: an option for an output, words for an input.
    what: &'a str,
    path: Cow<'a, Path>,
    /// Whether the file is a snapshot to resume, or a picture that can be resumed: a snapshot may
    /// be replaced by its own continuation.
    continues: bool,
}

impl<'a> Named<'a> {
    /// A file and its name in messages.
    pub fn new(what: &'a str, path: impl Into<Cow<'a, Path>>) -> Self {
        Self { what, path: path.into(), continues: false }
    }

    /// A snapshot to resume, or one that continues it.
    pub fn snapshot(what: &'a str, path: impl Into<Cow<'a, Path>>) -> Self {
        Self { continues: true, ..Self::new(what, path) }
    }
}

/// The files that the scene called `name` is read from: its own, and those of its volumes and its
/// environment. What is embedded in the program is none.
///
/// # Errors
/// The folder of a sequence cannot be read or has no frame.
pub fn files_of_scene<'a>(name: &'a str, settings: &Settings) -> Result<Vec<Named<'a>>> {
    let own = scene::scene_file(name).map(|path| Named::new("the scene", path));
    let read = scene::files_on_disk(settings)?;
    let read = read.into_iter().map(|path| Named::new("a file of the scene", path));
    Ok(own.into_iter().chain(read).collect())
}

/// Refuses to write a file over one that is read, or two to the same place, however their paths are
/// spelled. Pipes and devices may be named as often as one likes.
pub fn refuse_clashes(reads: &[Named], writes: &[Named]) -> Result<(), Refusal> {
    let reads: Vec<(&Named, Identity)> = identified(reads);
    let mut known: Vec<(&Named, Identity)> = Vec::new();
    for (write, identity) in identified(writes) {
        let is_same = |other: &&(&Named, Identity)| identity.is(&other.1);
        let path = write.path.display().to_string();
        let may_replace = |read: &Named| read.continues && write.continues;
        if let Some((read, _)) = reads.iter().filter(|r| !may_replace(r.0)).find(is_same) {
            let reason = format!(
                "{} would overwrite {}, {}; name another file",
                write.what,
                read.what,
                read.path.display()
            );
            return Err(Refusal::usage(Error::invalid(path, "", reason)));
        }
        if let Some((other, _)) = known.iter().find(is_same) {
            let reason = format!(
                "{} would overwrite what {} {} writes; give each a file of its own",
                write.what,
                other.what,
                other.path.display()
            );
            return Err(Refusal::usage(Error::invalid(path, "", reason)));
        }
        known.push((write, identity));
    }
    Ok(())
}

fn identified<'n, 'a>(files: &'n [Named<'a>]) -> Vec<(&'n Named<'a>, Identity)> {
    files.iter().filter_map(|named| Some((named, Identity::of(&named.path)?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_snapshot_gives_way_to_its_continuation_alone() {
        let snapshot = [Named::snapshot("the snapshot", Path::new("a.exr"))];
        let refused = |writes: &[Named]| {
            let refusal = refuse_clashes(&snapshot, writes).err();
            refusal.map(|refusal| refusal.error.to_string()).unwrap_or_default()
        };
        let again = || Named::snapshot("-o", Path::new("./a.exr"));
        assert_eq!(refused(&[again()]), "");
        assert_eq!(refused(&[Named::new("-o", Path::new("b.png")), again()]), "");
        let stats = refused(&[Named::new("--stats", Path::new("a.exr"))]);
        assert!(stats.contains("--stats would overwrite the snapshot, a.exr"), "{stats}");
        if cfg!(unix) {
            let null = || Named::new("--stats", Path::new("/dev/null"));
            assert_eq!(refused(&[null(), null()]), "");
        }
        let twice = refused(&[again(), Named::snapshot("-o", Path::new("a.exr"))]);
        assert!(twice.contains("what -o ./a.exr writes"), "{twice}");
    }
}
