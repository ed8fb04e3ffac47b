//! Files read whole, once their first bytes and their size have been found good.

use std::fs::{File, Metadata};
use std::io::Read;
use std::path::Path;

use super::memory::reserve;
use crate::error::{Error, Progress, Result, report};

/// Length of the beginning by which a file is judged.
const START: u64 = 64;
/// Bytes read between two questions whether to go on, so that cancelling is prompt on slow disks.
const PIECE: u64 = 8 << 20;

/// Reads a file whole, if `check` finds its first bytes good, and there is memory for the rest.
///
/// # Errors
/// It cannot be read, is a folder, a pipe or a device, or larger than the free memory; or the
/// reason that `check` returns. Each names the file. [`Error::Cancelled`].
pub(crate) fn read_whole(
    path: &Path,
    check: impl FnOnce(&[u8]) -> Result<(), String>,
    progress: Progress,
) -> Result<Vec<u8>> {
    let (mut file, length) = open(path)?;
    let failed = |error| Error::io(path, error);
    let refused = |reason: String| Error::invalid(path.display().to_string(), "", reason);
    let mut start = Vec::new();
    file.by_ref().take(START).read_to_end(&mut start).map_err(failed)?;
    check(&start).map_err(refused)?;
    let mut bytes = reserve(usize::try_from(length).unwrap_or(usize::MAX)).map_err(refused)?;
    bytes.append(&mut start);
    // A file that grows meanwhile is read to the length that it had.
    while (bytes.len() as u64) < length {
        report(progress, 0.0)?;
        let piece = PIECE.min(length - bytes.len() as u64);
        if file.by_ref().take(piece).read_to_end(&mut bytes).map_err(failed)? == 0 {
            break;
        }
    }
    Ok(bytes)
}

/// Opens a file, if `check` finds its first bytes good.
///
/// # Errors
/// It cannot be read, is a folder, a pipe or a device; or the reason that `check` returns. Each
/// names the file.
pub(crate) fn open_checked(
    path: &Path,
    check: impl FnOnce(&[u8]) -> Result<(), String>,
) -> Result<File> {
    let (mut file, _) = open(path)?;
    let mut start = Vec::new();
    file.by_ref().take(START).read_to_end(&mut start).map_err(|error| Error::io(path, error))?;
    check(&start).map_err(|reason| Error::invalid(path.display().to_string(), "", reason))?;
    Ok(file)
}

/// The first bytes of a file, 64 at most.
///
/// # Errors
/// It cannot be read, or is a folder, a pipe or a device; names it.
pub(crate) fn first_bytes(path: &Path) -> Result<Vec<u8>> {
    let (file, _) = open(path)?;
    let mut start = Vec::new();
    file.take(START).read_to_end(&mut start).map_err(|error| Error::io(path, error))?;
    Ok(start)
}

/// Opens a file, and tells its length. A pipe would keep whoever opens it waiting, and a device
/// may have no end, so neither is opened.
fn open(path: &Path) -> Result<(File, u64)> {
    let failed = |error| Error::io(path, error);
    check_is_file(path, &std::fs::metadata(path).map_err(failed)?)?;
    let file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    check_is_file(path, &metadata)?;
    Ok((file, metadata.len()))
}

fn check_is_file(path: &Path, metadata: &Metadata) -> Result<()> {
    let reason = match metadata.is_dir() {
        _ if metadata.is_file() => return Ok(()),
        true => "it is a folder; name a file in it",
        false => "it is a pipe or a device and no file; copy its content to a file",
    };
    Err(Error::invalid(path.display().to_string(), "", reason))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::NO_PROGRESS;

    fn message(path: &Path) -> String {
        let check = |start: &[u8]| match start.starts_with(b"good") {
            true => Ok(()),
            false => Err("it does not start well".to_owned()),
        };
        read_whole(path, check, NO_PROGRESS).expect_err("refused").to_string()
    }

    #[test]
    fn what_starts_well_is_read_to_its_end() {
        let folder = tempfile::tempdir().unwrap();
        for length in [0, 4, 63, 64, 65, (9 << 20) + 1] {
            let path = folder.path().join("file");
            let content: Vec<u8> = (0..length).map(|n| (n % 253) as u8).collect();
            std::fs::write(&path, &content).unwrap();
            assert_eq!(read_whole(&path, |_| Ok(()), NO_PROGRESS).unwrap(), content);
            assert_eq!(first_bytes(&path).unwrap(), content[..content.len().min(64)]);
        }
        let path = folder.path().join("file");
        let cancelled = read_whole(&path, |_| Ok(()), &|_| false);
        assert!(matches!(cancelled, Err(Error::Cancelled)));
    }

    /// A file of many terabytes, all of it hole: its first bytes are looked at first, then its
    /// size, and nothing else is read.
    #[test]
    fn files_that_are_too_large_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sparse");
        std::fs::write(&path, b"bad").unwrap();
        let file = File::options().write(true).open(&path).unwrap();
        // Not every file system holds files of that size.
        if file.set_len(1 << 43).is_err() {
            return;
        }
        assert!(message(&path).contains("does not start well"));
        std::io::Write::write_all(&mut &file, b"good").unwrap();
        let text = message(&path);
        assert!(text.contains("sparse: ") && text.contains("memory"), "{text}");
    }

    #[cfg(unix)]
    #[test]
    fn pipes_and_devices_are_refused_at_once() {
        for path in ["/dev/zero", "/dev/null"] {
            assert!(message(Path::new(path)).contains("device"), "{path}");
        }
        let folder = tempfile::tempdir().unwrap();
        assert!(message(folder.path()).contains("folder"));
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        if made.is_ok_and(|status| status.success()) {
            assert!(message(&pipe).contains("pipe: it is a pipe"));
        }
    }
}
