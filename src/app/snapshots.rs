//! Snapshots: pictures in a strip with all that is needed to go on from them, stored on the disk
//! between runs.
//!
//! - `strip`: which there are and which is shown; `record`, `thumbnail`: what is shown of each.
//! - `store`: the folder; `disk`: the workers that read and write it.
//! - `panel`: the strip on the screen.

mod disk;
pub mod panel;
mod record;
mod store;
mod strip;
mod thumbnail;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Context;

pub use disk::Keep;
pub use record::{now, strategy};
pub use strip::{SmallPicture, Strip, StripItem};
pub use thumbnail::LARGEST as LARGEST_THUMBNAIL;

use super::ui::notices::Notices;
use crate::error::Result;
use crate::render::Picture;
use disk::{DiskJob, DiskReport, DiskWorkers};
use store::Store;

/// Bytes that snapshots take on the disk at most.
const LIMIT: u64 = 2 << 30;

/// The strip and what stands behind it.
pub struct Snapshots {
    /// The snapshots and which one is shown.
    pub strip: Strip,
    /// Whether a snapshot is to be taken as soon as the picture is that of the present scene.
    pub wants_keep: bool,
    store: Option<Store>,
    workers: DiskWorkers,
    /// Number of snapshots being written.
    keeping: usize,
    /// Whether a picture is being read.
    reading: bool,
}

impl Snapshots {
    /// Starts to read the snapshots in the folder `data`, if there is one.
    ///
    /// # Errors
    /// When the system refuses to start threads.
    pub fn new(ctx: &Context, data: Option<PathBuf>) -> Result<Self> {
        let store = data.map(|data| Store::new(&data));
        let wake = ctx.clone();
        let workers = DiskWorkers::new(store.clone(), LIMIT, move || wake.request_repaint())?;
        workers.ask(DiskJob::List);
        let strip = Strip::default();
        Ok(Self { strip, wants_keep: false, store, workers, keeping: 0, reading: false })
    }

    /// Takes in what the disk has to say and asks for what is needed next. Called once a frame;
    /// `typing` is whether a name or note may still be being edited.
    pub fn update(&mut self, typing: bool, notices: &mut Notices) {
        while let Some(report) = self.workers.poll() {
            self.take_in(report, notices);
        }
        if !typing {
            self.strip.edited().into_iter().for_each(|job| self.workers.ask(job));
        }
        if !self.reading
            && let Some(job) = self.strip.wanted()
        {
            self.reading = true;
            self.workers.ask(job);
        }
    }

    fn take_in(&mut self, report: DiskReport, notices: &mut Notices) {
        match report {
            DiskReport::Listed(entries, problems) => {
                self.strip.fill(entries);
                if !problems.is_empty() {
                    let text = problems.join("\n");
                    notices.failed(format!("Some snapshots cannot be shown:\n{text}"));
                }
            }
            DiskReport::Kept { kept, picture, gone } => {
                self.keeping -= 1;
                self.strip.push(kept, picture);
                self.strip.remove(&gone);
                if !gone.is_empty() {
                    let names: Vec<&str> =
                        gone.iter().map(|entry| entry.record.name.as_str()).collect();
                    notices.done(format!(
                        "Snapshots may use {} of disk space, so the oldest were deleted: {}.",
                        size_in_words(LIMIT),
                        names.join(", ")
                    ));
                }
            }
            DiskReport::NotKept(reason) => {
                self.keeping -= 1;
                notices.failed(format!("The snapshot could not be kept. {reason}"));
            }
            DiskReport::Read(id, picture) => {
                self.reading = false;
                let failure = picture.as_ref().err().cloned();
                let wanted = self.strip.take_in(&id, picture.ok());
                if let Some(reason) = failure.filter(|_| wanted) {
                    self.strip.show(None);
                    notices.failed(reason);
                }
            }
            DiskReport::Lost(id, reason) => {
                self.strip.lose(&id);
                notices.failed(format!("The snapshot could not be restored. {reason}"));
            }
            DiskReport::Failed(reason) => notices.failed(reason),
        }
    }

    /// Keeps a picture.
    pub fn keep(&mut self, keep: Keep) {
        self.keeping += 1;
        self.workers.ask(DiskJob::Keep(Box::new(keep)));
    }

    /// Number of snapshots being written.
    pub fn keeping(&self) -> usize {
        self.keeping
    }

    /// Deletes the snapshot shown, until that is undone.
    pub fn delete(&mut self) {
        if let Some(job) = self.strip.delete() {
            self.workers.ask(job);
        }
    }

    /// Brings the snapshot deleted last back.
    pub fn undo_delete(&mut self) {
        if let Some(job) = self.strip.undo_delete() {
            self.workers.ask(job);
        }
    }

    /// The picture of the snapshot shown, once it is read.
    pub fn picture(&self) -> Option<&Arc<Picture>> {
        self.strip.shown_item()?.picture()
    }

    /// The file of a snapshot.
    pub fn file(&self, item: &StripItem) -> Option<PathBuf> {
        Some(self.store.as_ref()?.picture(&item.entry.id))
    }

    /// The user's name of the snapshot in this file, if it is one of the strip.
    pub fn name_of(&self, file: &Path) -> Option<&str> {
        let id = self.store.as_ref()?.id_of(file)?;
        Some(&self.strip.find(&id)?.record.name)
    }

    /// Writes down what was edited, forgets what was deleted and waits for what is being written.
    pub fn close(&mut self) {
        let edited = self.strip.edited();
        edited.into_iter().chain(self.strip.forget_deleted()).for_each(|job| self.workers.ask(job));
        self.workers.finish();
    }
}

/// A size on the disk: 1.2 GiB.
pub fn size_in_words(bytes: u64) -> String {
    let mebibytes = bytes as f64 / f64::from(1 << 20);
    match mebibytes {
        _ if mebibytes < 9.95 => format!("{mebibytes:.1} MiB"),
        _ if mebibytes < 1023.5 => format!("{mebibytes:.0} MiB"),
        _ => format!("{:.1} GiB", mebibytes / 1024.0),
    }
}
