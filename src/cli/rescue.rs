//! Other places for files that cannot be written where they should be: nothing rendered is lost.

use std::io;
use std::path::{Path, PathBuf};

use super::console::warn;
use crate::error::{Error, Result};

/// Lets `write` write a file to `path`, or to another place where that fails.
///
/// # Errors
/// Why it is not at `path`; names where it is instead.
pub fn write_file(path: &Path, write: &dyn Fn(&Path) -> Result<()>) -> Result<()> {
    let fresh = |folder: &Path| {
        let [stem, ending] = [path.file_stem(), path.extension()]
            .map(|part| part.map(|part| part.to_string_lossy().into_owned()).unwrap_or_default());
        let mut builder = tempfile::Builder::new();
        let (prefix, suffix) = (format!("{stem}-"), format!(".{ending}"));
        builder.prefix(&prefix);
        if !ending.is_empty() {
            builder.suffix(&suffix);
        }
        let (_, place) = builder.tempfile_in(folder)?.keep()?;
        Ok(place)
    };
    write(path).map_err(|error| rescued(&error, &places(), &fresh, write))
}

/// Lets `write` fill the folder at `path`, or another one where that fails.
///
/// # Errors
/// Why it is not all at `path`; names where it is instead.
pub fn write_folder(path: &Path, write: &dyn Fn(&Path) -> Result<()>) -> Result<()> {
    let fresh = |folder: &Path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Ok(tempfile::Builder::new().prefix(&format!("{name}-")).tempdir_in(folder)?.keep())
    };
    write(path).map_err(|error| rescued(&error, &places(), &fresh, write))
}

/// Complains about all failures but the last, which is returned.
pub fn told(results: impl IntoIterator<Item = Result<()>>) -> Result<()> {
    let mut last = Ok(());
    for failure in results.into_iter().filter(Result::is_err) {
        if let Err(earlier) = std::mem::replace(&mut last, failure) {
            warn(&earlier.to_string());
        }
    }
    last
}

/// Folders that are tried instead, one after the other.
fn places() -> Vec<PathBuf> {
    std::env::current_dir().into_iter().chain([std::env::temp_dir()]).collect()
}

/// Writes to a name of its own, which `fresh` makes in a folder, in the first of `places` that
/// takes it; returns what is to be said about it.
fn rescued(
    error: &Error,
    places: &[PathBuf],
    fresh: &dyn Fn(&Path) -> io::Result<PathBuf>,
    write: &dyn Fn(&Path) -> Result<()>,
) -> Error {
    for folder in places {
        let Ok(place) = fresh(folder) else { continue };
        if write(&place).is_ok() {
            let place = place.display();
            return Error::invalid("", "", format!("{error}; it was saved as {place} instead"));
        }
        // Nothing whole is there; if it stays, it is only in the way.
        let _ = if place.is_dir() {
            std::fs::remove_dir_all(&place)
        } else {
            std::fs::remove_file(&place)
        };
    }
    let tried: Vec<String> = places.iter().map(|place| place.display().to_string()).collect();
    let tried = tried.join(" and ");
    Error::invalid("", "", format!("{error}; nor could it be saved in {tried}, so it is lost"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn put(path: &Path) -> Result<()> {
        std::fs::write(path, "all").map_err(|e| Error::io(path, e))
    }

    #[test]
    fn what_has_no_place_gets_another() {
        let folder = tempfile::tempdir().unwrap();
        let absent = folder.path().join("absent");
        let error = put(&absent.join("x.exr")).unwrap_err();
        let fresh = |folder: &Path| {
            let place = folder.join("x-1.exr");
            std::fs::File::create_new(&place)?;
            Ok(place)
        };
        let places = [absent.clone(), folder.path().to_owned()];
        let text = rescued(&error, &places, &fresh, &put).to_string();
        let place = folder.path().join("x-1.exr");
        assert!(text.starts_with(&absent.join("x.exr").display().to_string()), "{text}");
        assert!(text.ends_with(&format!("saved as {} instead", place.display())), "{text}");
        assert_eq!(std::fs::read_to_string(place).unwrap(), "all");

        let text = rescued(&error, &places[..1], &fresh, &put).to_string();
        assert!(text.ends_with("so it is lost"), "{text}");
        // What fails half-way leaves nothing behind.
        let other = tempfile::tempdir().unwrap();
        let half = |path: &Path| put(path).and(Err(Error::Cancelled));
        let _ = rescued(&error, &[other.path().to_owned()], &fresh, &half);
        assert_eq!(std::fs::read_dir(other.path()).unwrap().count(), 0);
    }
}
