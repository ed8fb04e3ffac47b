//! The files that a render leaves behind.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::clashes::{Named, refuse_clashes};
use super::exit::Refusal;
use super::frames::path_of_frame;
use super::rescue;
use crate::error::{Error, Result};
use crate::files::{self, check_writable};
use crate::image::tone::Tone;
use crate::image::{exr, npy, png};
use crate::render::Film;
use crate::render::picture::resolve;

/// The formats of `-o`, by their endings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Exr,
    Png,
    Npy,
}

/// A file to write.
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
            _ if text == "-" => {
                let reason = "standard output has no ending that says the format; name a file that \
                              ends in .exr, .png or .npy";
                return Err(reason.to_owned());
            }
            _ => return Err("the name must end in .exr, .png or .npy".to_owned()),
        };
        Ok(Self { path, format })
    }
}

impl Output {
    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file of a frame: the same one unless its name has a place for the number.
    pub fn of_frame(&self, frame: i32) -> Self {
        Self { path: path_of_frame(&self.path, frame), format: self.format }
    }

    /// Whether the file is a snapshot, which can be resumed.
    pub fn is_snapshot(&self) -> bool {
        self.format == Format::Exr
    }

    /// Name and kind of the file, for telling it from what the command reads.
    pub fn named(&self) -> Named<'_> {
        match self.is_snapshot() {
            true => Named::snapshot("-o", &self.path),
            false => Named::new("-o", &self.path),
        }
    }
}

/// Writes every output, to another place where its own fails. One that fails does not keep the
/// others from being written; the last error is returned, and the others are reported.
pub fn write_all(outputs: &[Output], film: &Film, header: &exr::SnapshotHeader) -> Result<()> {
    let mut pixels = Vec::new();
    if outputs.iter().any(|output| output.format != Format::Exr) {
        resolve(film, &mut pixels);
    }
    let write = |output: &Output| {
        rescue::write_file(&output.path, &|path| match output.format {
            Format::Exr => exr::write(path, film, header),
            Format::Png => png::write(path, film.size(), &pixels, Tone::default()),
            Format::Npy => npy::write(path, film.size(), &pixels),
        })
    };
    rescue::told(outputs.iter().map(write))
}

/// Makes the folder of the results and finds out whether it takes `files`, before anything is
/// rendered in vain and without harm to what is read.
pub(super) fn make_folder(folder: &Path, files: &[&str], reads: &[Named]) -> Result<(), Refusal> {
    let files: Vec<PathBuf> = files.iter().map(|name| folder.join(name)).collect();
    let writes: Vec<Named> = files.iter().map(|path| Named::new("-o", path)).collect();
    refuse_clashes(reads, &writes)?;
    if !folder.is_dir() {
        std::fs::create_dir(folder).map_err(|e| Error::io(folder, e))?;
    }
    files.iter().try_for_each(|path| check_writable(path))?;
    Ok(())
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
        assert!(format("-").unwrap_err().contains("standard output"));
    }
}
