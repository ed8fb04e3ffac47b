//! Where writing to a path leads.

use std::fs::{File, FileType, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::folder::folder_of;
use crate::error::{Error, Result};

/// Symbolic links that are followed one after the other, as Linux does.
const MOST_LINKS: usize = 40;

/// Where a path leads that something is to be written to.
#[derive(Debug)]
pub(crate) enum Target {
    /// A plain file, there or not yet, at the end of all symbolic links.
    File(PathBuf),
    /// What takes content and cannot be replaced.
    Stream(Stream),
}

/// A pipe or a character device, such as a terminal, or a file that is open already.
#[derive(Debug)]
pub(crate) struct Stream(PathBuf);

impl Target {
    /// Follows the symbolic links of `path`.
    ///
    /// # Errors
    /// A folder, a disk or a socket is there; names `path`.
    pub(crate) fn of(path: &Path) -> Result<Self> {
        let place = followed(path).map_err(|e| Error::io(path, e))?;
        match std::fs::metadata(&place) {
            Ok(metadata) if metadata.is_dir() => {
                Err(Error::io(path, io::Error::from(ErrorKind::IsADirectory)))
            }
            Ok(metadata) if is_stream(metadata.file_type()) => Ok(Self::Stream(Stream(place))),
            Ok(metadata) if !metadata.is_file() => {
                let reason = "it is a disk or a socket; name a file, a pipe or a terminal";
                Err(Error::invalid(path.display().to_string(), "", reason))
            }
            Ok(_) if is_open_file(&place) => Ok(Self::Stream(Stream(place))),
            Ok(_) => Ok(Self::File(place)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Self::File(place)),
            Err(error) => Err(Error::io(path, error)),
        }
    }
}

impl Stream {
    /// Writes all of `content` into it. A reader that goes before the end wants no more of it.
    pub(crate) fn take(&self, content: &mut File) -> io::Result<()> {
        let mut stream = match own_stream(&self.0) {
            Some(file) => file?,
            None => OpenOptions::new().append(true).open(&self.0)?,
        };
        match io::copy(content, &mut stream) {
            Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
            _ => Ok(()),
        }
    }
}

/// The end of a chain of symbolic links, which need not be there. The names of open files, such as
/// `/proc/self/fd/1`, look like links and are followed no further: what they lead to may have no
/// name.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut place = path.to_owned();
    for _ in 0..MOST_LINKS {
        let is_link = std::fs::symlink_metadata(&place).is_ok_and(|there| there.is_symlink());
        if !is_link || is_open_file(&place) {
            return Ok(place);
        }
        // A relative link starts from its own folder; an absolute one replaces that.
        place = folder_of(&place).join(std::fs::read_link(&place)?);
    }
    Err(io::Error::other("its symbolic links lead in a circle; name the file itself"))
}

#[cfg(unix)]
fn is_stream(kind: FileType) -> bool {
    use std::os::unix::fs::FileTypeExt;
    kind.is_fifo() || kind.is_char_device()
}

#[cfg(not(unix))]
fn is_stream(_: FileType) -> bool {
    false
}

/// Whether a path names an open file by its number.
#[cfg(unix)]
fn is_open_file(place: &Path) -> bool {
    let folder = folder_of(place).canonicalize();
    folder.is_ok_and(|folder| folder.starts_with("/proc") && folder.ends_with("fd"))
}

#[cfg(not(unix))]
fn is_open_file(_: &Path) -> bool {
    false
}

/// Standard output or standard error where `place` is one of them, so that what else is written
/// there goes on behind it.
#[cfg(unix)]
fn own_stream(place: &Path) -> Option<io::Result<File>> {
    use std::os::fd::AsFd;
    let own = Path::new("/proc/self/fd").canonicalize().ok()?;
    if folder_of(place).canonicalize().ok()? != own {
        return None;
    }
    let stream = match place.file_name()?.to_str()? {
        "1" => io::stdout().as_fd().try_clone_to_owned(),
        "2" => io::stderr().as_fd().try_clone_to_owned(),
        _ => return None,
    };
    Some(stream.map(File::from))
}

#[cfg(not(unix))]
fn own_stream(_: &Path) -> Option<io::Result<File>> {
    None
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    fn place(path: &Path) -> PathBuf {
        match Target::of(path).unwrap() {
            Target::File(place) => place,
            Target::Stream(stream) => panic!("{} is a stream: {stream:?}", path.display()),
        }
    }

    #[test]
    fn links_lead_to_their_end_whether_it_is_there_or_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("deep")).unwrap();
        symlink("deep/link", at("first")).unwrap();
        symlink("../file", at("deep/link")).unwrap();
        assert_eq!(place(&at("first")), at("deep").join("../file"));
        std::fs::write(at("file"), "x").unwrap();
        assert_eq!(place(&at("first")), at("deep").join("../file"));
        assert_eq!(place(&at("absent")), at("absent"));
        symlink("circle", at("circle")).unwrap();
        let error = Target::of(&at("circle")).unwrap_err().to_string();
        assert!(error.contains("circle: ") && error.contains("in a circle"), "{error}");
    }

    #[test]
    fn what_is_no_plain_file_is_a_stream_or_refused() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("nothing");
        symlink("/dev/null", &link).unwrap();
        for stream in [Path::new("/dev/null"), &link] {
            assert!(matches!(Target::of(stream), Ok(Target::Stream(_))), "{}", stream.display());
        }
        let error = Target::of(folder.path()).unwrap_err().to_string();
        assert!(error.contains("it is a folder"), "{error}");
        let socket = folder.path().join("socket");
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        let error = Target::of(&socket).unwrap_err().to_string();
        assert!(error.contains("socket: it is a disk or a socket"), "{error}");
    }

    /// What standard output leads to may be a plain file, and is not replaced all the same.
    #[cfg(target_os = "linux")]
    #[test]
    fn open_files_are_streams_by_whichever_name() {
        use std::os::fd::AsRawFd;
        let open = tempfile::NamedTempFile::new().unwrap();
        let number = open.as_file().as_raw_fd();
        for name in [format!("/proc/self/fd/{number}"), format!("/dev/fd/{number}")] {
            assert!(matches!(Target::of(Path::new(&name)), Ok(Target::Stream(_))), "{name}");
        }
        let mut content = tempfile::tempfile().unwrap();
        io::Write::write_all(&mut content, b"text").unwrap();
        io::Seek::rewind(&mut content).unwrap();
        let name = PathBuf::from(format!("/proc/self/fd/{number}"));
        Stream(name).take(&mut content).unwrap();
        assert_eq!(std::fs::read_to_string(open.path()).unwrap(), "text");
    }
}
