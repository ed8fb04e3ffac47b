//! The errors of the whole crate: each names the file or key, what is wrong and how to fix it.

use std::path::{Path, PathBuf};

/// `Result` with the crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Reason for which a request could not be carried out. `file` is a path or another name the user
/// knows (`builtin:torch`, `--set`); `field` is the dotted key, grid name or section inside it and
/// may be empty.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The operating system refused to read or write.
    #[error("{}: {}", path.display(), refusal(source))]
    Io {
        /// The file in question.
        path: PathBuf,
        /// Error of the operating system.
        #[source]
        source: std::io::Error,
    },
    /// The input breaks its format or a value is out of its range.
    #[error("{}{reason}", prefix(file, field))]
    Invalid {
        /// The file or source of the input.
        file: String,
        /// The key, grid or section; may be empty.
        field: String,
        /// Reason, and how to fix it.
        reason: String,
    },
    /// The input is well formed but asks for something that Flambeau does not do.
    #[error("{}not supported: {reason}", prefix(file, field))]
    Unsupported {
        /// The file or source of the input.
        file: String,
        /// The key, grid or section; may be empty.
        field: String,
        /// The unsupported feature, and what to do instead.
        reason: String,
    },
    /// The caller cancelled the work.
    #[error("cancelled")]
    Cancelled,
}

impl Error {
    /// An [`Error::Io`] for `path`.
    pub fn io(path: impl AsRef<Path>, source: std::io::Error) -> Self {
        Self::Io { path: path.as_ref().to_owned(), source }
    }

    /// An [`Error::Invalid`].
    pub fn invalid(
        file: impl Into<String>,
        field: impl Into<String>,
        reason: impl Into<String>,
    ) -> Self {
        Self::Invalid { file: file.into(), field: field.into(), reason: reason.into() }
    }

    /// An [`Error::Unsupported`].
    pub fn unsupported(
        file: impl Into<String>,
        field: impl Into<String>,
        reason: impl Into<String>,
    ) -> Self {
        Self::Unsupported { file: file.into(), field: field.into(), reason: reason.into() }
    }
}

/// Message of the operating system, with advice where there is some.
fn refusal(source: &std::io::Error) -> String {
    use std::io::ErrorKind as Kind;
    let known = match source.kind() {
        Kind::NotFound => "there is no such file or folder; check the path",
        Kind::PermissionDenied => {
            "the system does not permit it; choose another place or change its permissions"
        }
        Kind::IsADirectory => "it is a folder; name a file in it",
        Kind::NotADirectory => "a part of the path is a file and no folder; check the path",
        Kind::ReadOnlyFilesystem => "nothing can be written there; choose another place",
        Kind::StorageFull | Kind::QuotaExceeded => {
            "there is no room left; make some or choose another place"
        }
        _ => return source.to_string(),
    };
    known.to_owned()
}

fn prefix(file: &str, field: &str) -> String {
    [file, field].iter().filter(|part| !part.is_empty()).map(|part| format!("{part}: ")).collect()
}

/// Long work reports a fraction in 0..=1 here and stops with [`Error::Cancelled`] on `false`.
pub type Progress<'a> = &'a (dyn Fn(f32) -> bool + Sync);

/// A [`Progress`] that ignores the fraction and never cancels.
pub const NO_PROGRESS: Progress<'static> = &|_| true;

/// Tells `progress` that a `fraction` in 0..=1 of the work is done.
///
/// # Errors
/// [`Error::Cancelled`] where it says to stop.
pub fn report(progress: Progress, fraction: f32) -> Result<()> {
    if progress(fraction) { Ok(()) } else { Err(Error::Cancelled) }
}
