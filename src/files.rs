//! Files as wholes: written completely or not at all, and told apart by their contents.

mod folder;
mod identity;
mod memory;
mod name;
mod reading;
mod target;

use std::fs::File;
use std::io::{BufRead, BufReader, Seek};
use std::path::Path;

use serde::{Deserialize, Serialize};
use tempfile::NamedTempFile;

use crate::error::{Error, Progress, Result, report};
use folder::folder_of;
pub(crate) use identity::Identity;
pub(crate) use memory::reserve;
pub use name::{name_of, path_of};
pub(crate) use reading::{first_bytes, open_checked, read_whole};
pub(crate) use target::Target;

/// Writes a file as a whole or not at all: to a temporary name in the same folder, which takes the
/// place of `path` once all of it is on the disk. A symbolic link stays one and leads to the new
/// content; into a pipe or a device the content is written.
///
/// # Errors
/// The error that `write` returns, or the refusal of the system; names the file.
pub(crate) fn replace(path: &Path, write: impl FnOnce(&mut File) -> Result<()>) -> Result<()> {
    match Target::of(path)? {
        Target::File(place) => {
            let mut file = temporary(path, &place)?;
            write(file.as_file_mut())?;
            file.as_file().sync_all().map_err(|e| Error::io(path, e))?;
            file.persist(place).map_err(|e| Error::io(path, e.error))?;
            Ok(())
        }
        Target::Stream(stream) => {
            // Formats go back to their beginnings, which a stream cannot.
            let mut whole = tempfile::tempfile().map_err(|e| Error::io(path, e))?;
            write(&mut whole)?;
            whole.rewind().map_err(|e| Error::io(path, e))?;
            stream.take(&mut whole).map_err(|e| Error::io(path, e))
        }
    }
}

/// Finds out whether [`replace`] could write `path`, by making the temporary file that it would
/// make. Of a pipe or a device that is known only when it is written.
///
/// # Errors
/// Where the folder takes no new files, or something else than a file is in the way; names the
/// file.
pub(crate) fn check_writable(path: &Path) -> Result<()> {
    match Target::of(path)? {
        Target::File(place) => temporary(path, &place).map(drop),
        Target::Stream(_) => Ok(()),
    }
}

/// A temporary file beside `place`, which is where `path` leads.
fn temporary(path: &Path, place: &Path) -> Result<NamedTempFile> {
    let folder = folder_of(place);
    let refused = |reason: String| Error::invalid(path.display().to_string(), "", reason);
    if !folder.is_dir() {
        let folder = folder.display();
        return Err(refused(format!("there is no folder {folder}; make it or choose another")));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".flambeau-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any new file, less what the user's mask takes away.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            let folder = folder.display();
            refused(format!("the folder {folder} takes no new files; choose another"))
        }
        _ => Error::io(path, error),
    })
}

/// Fingerprint of a file: its name, size and hash, to tell it from others.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint {
    /// The file's name.
    pub name: String,
    /// Length of the file in bytes.
    pub bytes: u64,
    /// 64-bit FNV-1a hash of the content, in hexadecimal.
    pub hash: String,
}

impl Fingerprint {
    /// The fingerprint of `content`, which is read to its end.
    ///
    /// # Errors
    /// When it cannot be read; names it by `name`. [`Error::Cancelled`] where `progress`, which is
    /// asked after every piece, says so.
    pub fn of(name: &str, mut content: impl BufRead, progress: Progress) -> Result<Self> {
        let (mut bytes, mut hash) = (0, FNV_OFFSET);
        loop {
            report(progress, 0.0)?;
            let piece = match content.fill_buf() {
                Ok(piece) => piece,
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(Error::io(name, error)),
            };
            if piece.is_empty() {
                return Ok(Self { name: name.to_owned(), bytes, hash: format!("{hash:016x}") });
            }
            hash =
                piece.iter().fold(hash, |hash, &b| (hash ^ u64::from(b)).wrapping_mul(FNV_PRIME));
            let length = piece.len();
            bytes += length as u64;
            content.consume(length);
        }
    }

    /// The fingerprint of the file of that name.
    ///
    /// # Errors
    /// As of [`Fingerprint::of`].
    pub fn of_file(name: &str, progress: Progress) -> Result<Self> {
        let file = File::open(path_of(name)).map_err(|e| Error::io(path_of(name), e))?;
        Self::of(name, BufReader::with_capacity(1 << 16, file), progress)
    }
}

/// Fowler, Noll and Vo, "The FNV Non-Cryptographic Hash Algorithm" (IETF draft), 64 bits.
const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0100_0000_01b3;

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;
    use crate::error::NO_PROGRESS;

    fn put(path: &Path, text: &str) -> Result<()> {
        replace(path, |file| file.write_all(text.as_bytes()).map_err(|e| Error::io(path, e)))
    }

    #[test]
    fn writing_replaces_the_file_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        put(&path, "one").unwrap();
        put(&path, "two").unwrap();
        let failing = replace(&path, |file| {
            file.write_all(b"half").unwrap();
            Err(Error::Cancelled)
        });
        assert!(failing.is_err());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let error = put(&folder.path().join("no/scene.toml"), "x").unwrap_err().to_string();
        assert!(error.contains("no/scene.toml"), "{error}");
    }

    /// A link stays one, and what it leads to is replaced, wherever that is.
    #[cfg(unix)]
    #[test]
    fn writing_follows_links() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("farm")).unwrap();
        std::fs::write(at("farm/there.exr"), "old").unwrap();
        for name in ["there.exr", "new.exr"] {
            std::os::unix::fs::symlink(format!("farm/{name}"), at(name)).unwrap();
            put(&at(name), "new").unwrap();
            assert!(at(name).is_symlink(), "{name}");
            assert_eq!(std::fs::read_to_string(at("farm").join(name)).unwrap(), "new");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
    }

    /// A trial leaves nothing behind where a file could be written, and gives the reason where not.
    #[test]
    fn whether_a_file_could_be_written_is_tried() {
        let folder = tempfile::tempdir().unwrap();
        check_writable(&folder.path().join("new")).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        let refused = |path: &Path| check_writable(path).unwrap_err().to_string();
        assert!(refused(&folder.path().join("no/new")).contains("no/new: there is no folder"));
        assert!(refused(folder.path()).contains("it is a folder"));
        #[cfg(target_os = "linux")]
        assert!(refused(Path::new("/proc/new")).contains("/proc/new: "));
    }

    #[test]
    fn fingerprints_are_those_of_the_draft() {
        // From the draft's test vectors.
        for (content, hash) in
            [("", "cbf29ce484222325"), ("a", "af63dc4c8601ec8c"), ("foobar", "85944171f73967e8")]
        {
            let found = Fingerprint::of("x", content.as_bytes(), NO_PROGRESS).unwrap();
            assert_eq!((found.bytes, found.hash.as_str()), (content.len() as u64, hash));
        }
        let long = "foobar".repeat(30_000);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("long");
        put(&path, &long).unwrap();
        let name = path.to_str().unwrap();
        assert_eq!(
            Fingerprint::of_file(name, NO_PROGRESS).unwrap(),
            Fingerprint::of(name, long.as_bytes(), NO_PROGRESS).unwrap()
        );
    }
}
