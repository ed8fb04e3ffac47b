//! The folder that stores snapshots between runs, one folder each:
//!
//! ```text
//! snapshots/1764268212345/picture.exr     all there is, to go on from
//!                         thumbnail.png   the picture, small, as it was shown
//!                         snapshot.toml   name, note and figures
//! deleted/                                what was deleted, until the program ends
//! ```
//!
//! A snapshot is put together beside the others and then moved to its place, so that it is there
//! whole or not at all. Everything here reads or writes the disk and has no place on the window's
//! thread.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::record::Record;
use super::thumbnail::Thumbnail;
use crate::error::{Error, Result};
use crate::files::replace;
use crate::image::exr::{self, SnapshotHeader};
use crate::image::png;
use crate::image::tone::Tone;
use crate::render::Film;

const PICTURE: &str = "picture.exr";
const THUMBNAIL: &str = "thumbnail.png";
const RECORD: &str = "snapshot.toml";
/// A record is a few lines; what is longer is something else.
const LONGEST_RECORD: u64 = 1 << 16;

/// The folder of all snapshots.
#[derive(Clone, Debug)]
pub struct Store {
    kept: PathBuf,
    deleted: PathBuf,
}

/// A stored snapshot.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredSnapshot {
    /// Name of the snapshot's own folder.
    pub id: String,
    /// Record beside the picture.
    pub record: Record,
    /// Size on the disk in bytes.
    pub bytes: u64,
}

/// The contents of the folder.
#[derive(Debug, Default, PartialEq)]
pub struct Listing {
    /// The snapshots, the oldest first.
    pub entries: Vec<StoredSnapshot>,
    /// Things there that are no snapshots, one sentence each.
    pub problems: Vec<String>,
}

/// Contents of a new snapshot.
pub struct Fresh<'a> {
    /// Film with its samples.
    pub film: &'a Film,
    /// The header of the picture's file.
    pub header: &'a SnapshotHeader,
    /// Record beside the picture.
    pub record: Record,
    /// The picture, small.
    pub thumbnail: &'a Thumbnail,
    /// Tone mapping of the thumbnail.
    pub tone: Tone,
}

impl Store {
    /// The snapshots among the program's `data`. Nothing is read or made yet.
    pub fn new(data: &Path) -> Self {
        Self { kept: data.join("snapshots"), deleted: data.join("deleted") }
    }

    /// The file of the picture with all there is.
    pub fn picture(&self, id: &str) -> PathBuf {
        self.kept.join(id).join(PICTURE)
    }

    /// The file of the small picture.
    pub fn thumbnail(&self, id: &str) -> PathBuf {
        self.kept.join(id).join(THUMBNAIL)
    }

    /// The snapshot whose picture is the file at `path`, if it is one of these.
    pub fn id_of(&self, path: &Path) -> Option<String> {
        let id = path.strip_prefix(&self.kept).ok()?.parent()?.to_str()?;
        (path == self.picture(id)).then(|| id.to_owned())
    }

    /// Reads all snapshots. What is broken or belongs to something else is left alone and reported.
    pub fn list(&self) -> Listing {
        let mut listing = Listing::default();
        let Ok(folder) = fs::read_dir(&self.kept) else { return listing };
        for item in folder.flatten() {
            let name = item.file_name().to_string_lossy().into_owned();
            if name.starts_with('.') {
                continue;
            }
            match self.entry(name) {
                Ok(entry) => listing.entries.push(entry),
                Err(error) => listing.problems.push(error.to_string()),
            }
        }
        listing.entries.sort_by(|a, b| (a.record.kept, &a.id).cmp(&(b.record.kept, &b.id)));
        listing.problems.sort_unstable();
        listing
    }

    fn entry(&self, id: String) -> Result<StoredSnapshot> {
        let folder = self.kept.join(&id);
        let record = read_record(&folder.join(RECORD))?;
        let bytes = size(&self.picture(&id))?;
        let bytes = bytes + size(&self.thumbnail(&id)).unwrap_or(0);
        Ok(StoredSnapshot { id, record, bytes })
    }

    /// Writes a new snapshot.
    ///
    /// # Errors
    /// When the system refuses; names the file. Nothing is left of it then.
    pub fn add(&self, fresh: Fresh<'_>) -> Result<StoredSnapshot> {
        for folder in [&self.kept, &self.deleted] {
            fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
        }
        let builder = tempfile::Builder::new().prefix("new-").tempdir_in(&self.deleted);
        let half = builder.map_err(|e| Error::io(&self.deleted, e))?;
        let Fresh { film, header, record, thumbnail, tone } = fresh;
        exr::write(&half.path().join(PICTURE), film, header)?;
        png::write(&half.path().join(THUMBNAIL), thumbnail.size, &thumbnail.pixels, tone)?;
        write_record(&half.path().join(RECORD), &record)?;
        let mut place = record.kept;
        while self.kept.join(place.to_string()).exists() {
            place += 1;
        }
        let id = place.to_string();
        let folder = self.kept.join(&id);
        fs::rename(half.path(), &folder).map_err(|e| Error::io(&folder, e))?;
        // It is a temporary folder no more.
        let _ = half.keep();
        self.entry(id)
    }

    /// Writes another name or note.
    ///
    /// # Errors
    /// When the system refuses; names the file.
    pub fn describe(&self, id: &str, record: &Record) -> Result<()> {
        write_record(&self.kept.join(id).join(RECORD), record)
    }

    /// Takes a snapshot out of the folder, to where it can be brought back from.
    ///
    /// # Errors
    /// When the system refuses; names the folder.
    pub fn delete(&self, id: &str) -> Result<()> {
        fs::create_dir_all(&self.deleted).map_err(|e| Error::io(&self.deleted, e))?;
        let folder = self.kept.join(id);
        fs::rename(&folder, self.deleted.join(id)).map_err(|e| Error::io(&folder, e))
    }

    /// Brings a deleted snapshot back.
    ///
    /// # Errors
    /// When it is gone for good, or the system refuses; names the folder.
    pub fn restore(&self, id: &str) -> Result<()> {
        let folder = self.deleted.join(id);
        fs::rename(&folder, self.kept.join(id)).map_err(|e| Error::io(&folder, e))
    }

    /// Removes deleted snapshots for good.
    pub fn forget(&self, ids: &[String]) {
        for id in ids {
            // What cannot be removed now is removed at the next start.
            let _ = fs::remove_dir_all(self.deleted.join(id));
        }
    }

    /// Removes for good what was deleted or half written longer ago than `age`, as it is left
    /// behind by a program that did not end as it should.
    pub fn clean(&self, age: Duration) {
        let Ok(folder) = fs::read_dir(&self.deleted) else { return };
        for item in folder.flatten() {
            let modified = item.metadata().and_then(|data| data.modified());
            let elapsed = modified.ok().and_then(|time| time.elapsed().ok());
            if elapsed.is_some_and(|elapsed| elapsed >= age) {
                // The next start tries again.
                let _ = fs::remove_dir_all(item.path());
            }
        }
    }

    /// Removes snapshots for good until the rest takes `limit` bytes at most; never `newest`.
    /// Returns what was removed.
    pub fn make_room(&self, limit: u64, newest: &str) -> Vec<StoredSnapshot> {
        let entries = self.list().entries;
        let mut gone = victims(&entries, limit, newest);
        gone.retain(|entry| fs::remove_dir_all(self.kept.join(&entry.id)).is_ok());
        gone
    }
}

/// Entries of `entries`, the oldest first, that have to go so that the rest takes `limit` bytes at
/// most: the oldest without a note, and only where that is not enough those with one; never
/// `newest`.
fn victims(entries: &[StoredSnapshot], limit: u64, newest: &str) -> Vec<StoredSnapshot> {
    let mut total: u64 = entries.iter().map(|entry| entry.bytes).sum();
    let (noted, plain): (Vec<&StoredSnapshot>, Vec<&StoredSnapshot>) = entries
        .iter()
        .filter(|entry| entry.id != newest)
        .partition(|entry| !entry.record.note.is_empty());
    let mut gone = Vec::new();
    for entry in plain.into_iter().chain(noted) {
        if total <= limit {
            break;
        }
        total -= entry.bytes;
        gone.push(entry.clone());
    }
    gone
}

fn size(path: &Path) -> Result<u64> {
    fs::metadata(path).map(|data| data.len()).map_err(|e| Error::io(path, e))
}

fn read_record(path: &Path) -> Result<Record> {
    if size(path)? > LONGEST_RECORD {
        let reason = "too long for the record of a snapshot";
        return Err(Error::invalid(path.display().to_string(), "", reason));
    }
    let text = fs::read_to_string(path).map_err(|e| Error::io(path, e))?;
    toml::from_str(&text)
        .map_err(|e| Error::invalid(path.display().to_string(), "", e.message().to_owned()))
}

fn write_record(path: &Path, record: &Record) -> Result<()> {
    let text = toml::to_string(record)
        .map_err(|e| Error::invalid(path.display().to_string(), "", e.to_string()))?;
    replace(path, |file| file.write_all(text.as_bytes()).map_err(|e| Error::io(path, e)))
}

#[cfg(test)]
mod tests;
