//! Files as wholes: written whole or not at all, and told apart by what is in them.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Writes a file as a whole or not at all: to a temporary name in the same folder, which takes the
/// place of `path` once all of it is on the disk.
///
/// # Errors
/// What `write` returns, and where the system refuses; names the file.
pub(crate) fn replace(path: &Path, write: impl FnOnce(&mut File) -> Result<()>) -> Result<()> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        let (file, folder) = (path.display().to_string(), folder.display());
        let reason = format!("there is no folder {folder}; make it or choose another");
        return Err(Error::invalid(file, "", reason));
    }
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
    file.as_file().sync_all().map_err(|e| Error::io(path, e))?;
    file.persist(path).map_err(|e| Error::io(path, e.error))?;
    Ok(())
}

/// What tells one state of a file from another.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint {
    /// The file's name.
    pub name: String,
    /// Its length in bytes.
    pub bytes: u64,
    /// The 64-bit FNV-1a hash of its content, in hexadecimal.
    pub hash: String,
}

impl Fingerprint {
    /// The fingerprint of `content`, which is read to its end.
    ///
    /// # Errors
    /// When it cannot be read; names it by `name`.
    pub fn of(name: &str, mut content: impl BufRead) -> Result<Self> {
        let (mut bytes, mut hash) = (0, FNV_OFFSET);
        loop {
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
    /// When it cannot be read; names it.
    pub fn of_file(name: &str) -> Result<Self> {
        let file = File::open(name).map_err(|e| Error::io(name, e))?;
        Self::of(name, BufReader::with_capacity(1 << 16, file))
    }
}

/// Fowler, Noll and Vo, "The FNV Non-Cryptographic Hash Algorithm" (IETF draft), 64 bits.
const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0100_0000_01b3;

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

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

    #[test]
    fn fingerprints_are_those_of_the_draft() {
        // From the draft's test vectors.
        for (content, hash) in
            [("", "cbf29ce484222325"), ("a", "af63dc4c8601ec8c"), ("foobar", "85944171f73967e8")]
        {
            let found = Fingerprint::of("x", content.as_bytes()).unwrap();
            assert_eq!((found.bytes, found.hash.as_str()), (content.len() as u64, hash));
        }
        let long = "foobar".repeat(30_000);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("long");
        put(&path, &long).unwrap();
        let name = path.to_str().unwrap();
        assert_eq!(
            Fingerprint::of_file(name).unwrap(),
            Fingerprint::of(name, long.as_bytes()).unwrap()
        );
    }
}
