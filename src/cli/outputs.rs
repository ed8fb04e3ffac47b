//! The files that a render leaves behind.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::files;
use crate::image::tone::Tone;
use crate::image::{exr, npy, png};
use crate::render::Film;
use crate::render::publish::resolve;

/// The formats of `-o`, by their endings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Exr,
    Png,
    Npy,
}

/// One file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    path: PathBuf,
    format: Format,
}

impl std::str::FromStr for Output {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let format = match ending.to_ascii_lowercase().as_str() {
            "exr" => Format::Exr,
            "png" => Format::Png,
            "npy" => Format::Npy,
            _ => return Err("the name must end in .exr, .png or .npy".to_owned()),
        };
        Ok(Self { path, format })
    }
}

impl Output {
    /// Where it goes.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it can be continued.
    pub fn is_snapshot(&self) -> bool {
        self.format == Format::Exr
    }

    /// Fails early where it could not be written in the end.
    pub fn check_folder(&self) -> Result<()> {
        check_folder(&self.path)
    }
}

/// Fails where the folder of `path` does not exist.
pub fn check_folder(path: &Path) -> Result<()> {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            let reason = format!("there is no folder {}; make it first", folder.display());
            Err(Error::invalid(path.display().to_string(), "", reason))
        }
        _ => Ok(()),
    }
}

/// Writes every output. One that fails does not keep the others from being written; the first
/// error is returned.
pub fn write_all(outputs: &[Output], film: &Film, header: &exr::SnapshotHeader) -> Result<()> {
    let mut pixels = Vec::new();
    if outputs.iter().any(|output| output.format != Format::Exr) {
        resolve(film, &mut pixels);
    }
    let mut first = Ok(());
    for Output { path, format } in outputs {
        let result = match format {
            Format::Exr => exr::write(path, film, header),
            Format::Png => png::write(path, film.size(), &pixels, Tone::default()),
            Format::Npy => npy::write(path, film.size(), &pixels),
        };
        first = first.and(result);
    }
    first
}

/// Makes the folder of the results. Called before rendering, so that nothing is rendered in vain.
pub fn make_folder(folder: &Path) -> Result<()> {
    check_folder(folder)?;
    match folder.is_dir() {
        true => Ok(()),
        false => std::fs::create_dir(folder).map_err(|e| Error::io(folder, e)),
    }
}

/// Writes a file of text, whole or not at all.
///
/// # Errors
/// When the system refuses to.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    files::replace(path, |file| file.write_all(text.as_bytes()).map_err(|e| Error::io(path, e)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_chooses_the_format() {
        let format = |name: &str| name.parse::<Output>().map(|output| output.format);
        assert_eq!(format("a/b.exr"), Ok(Format::Exr));
        assert_eq!(format("B.PNG"), Ok(Format::Png));
        assert_eq!(format("x.y.npy"), Ok(Format::Npy));
        assert!(format("exr").is_err() && format("a.jpg").is_err());
    }
}
