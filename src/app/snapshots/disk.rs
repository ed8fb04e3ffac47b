//! Two threads that do what the strip needs of the disk: one writes, in the order it was asked, and
//! the other reads pictures meanwhile.

use std::path::PathBuf;
use std::sync::{Arc, mpsc};
use std::thread::JoinHandle;
use std::time::Duration;

use egui::ColorImage;

use super::record::Record;
use super::store::{Fresh, Listing, Store, StoredSnapshot};
use super::thumbnail::{self, Thumbnail};
use crate::app::jobs::film_file::{header, receive};
use crate::error::{Error, Result};
use crate::image::exr;
use crate::image::tone::Tone;
use crate::render::estimate::samples_per_pixel;
use crate::render::picture::{resolve, resolve_variance};
use crate::render::{Film, Picture};
use crate::scene::Settings;

/// Leftovers are removed at a start this much later; another window may be at work on
/// what is fresher.
const LEFT_BEHIND: Duration = Duration::from_secs(3600);

/// A job for the disk.
pub enum DiskJob {
    /// List all stored snapshots, after removing leftovers.
    List,
    /// Keep a picture.
    Keep(Box<Keep>),
    /// Another name or note.
    Describe(String, Record),
    /// Put a snapshot aside.
    Delete(String),
    /// Restore a deleted snapshot.
    Restore(String),
    /// Remove these for good, which were deleted.
    Forget(Vec<String>),
    /// Read the picture of this snapshot.
    Read(StoredSnapshot),
    /// Read a picture with the variance of its pixels, which takes as much memory as its film
    /// meanwhile.
    ReadWithVariance(StoredSnapshot),
}

/// A picture to keep.
pub struct Keep {
    /// The film, once the session has copied it.
    pub film: mpsc::Receiver<Film>,
    /// The settings of the film, with its size, seed and limit.
    pub settings: Settings,
    /// Seconds spent on the film.
    pub seconds: f64,
    /// CPU time spent on the film, in seconds.
    pub cpu_seconds: f64,
    /// Tone mapping of the thumbnail.
    pub tone: Tone,
    /// Name of the snapshot.
    pub name: String,
}

/// A snapshot with its small picture.
pub type SnapshotWithThumbnail = (StoredSnapshot, Option<ColorImage>);

/// A report of the disk workers.
pub enum DiskReport {
    /// The snapshots there are, and what else is in the folder.
    Listed(Vec<SnapshotWithThumbnail>, Vec<String>),
    /// A snapshot was stored.
    Kept {
        /// The snapshot on the disk.
        kept: SnapshotWithThumbnail,
        /// The picture.
        picture: Arc<Picture>,
        /// The snapshots removed so that the rest keeps within the limit.
        gone: Vec<StoredSnapshot>,
    },
    /// A snapshot could not be stored, for this reason.
    NotKept(String),
    /// The picture of a snapshot, or why it could not be read.
    Read(String, Result<Arc<Picture>, String>),
    /// A deleted snapshot could not be brought back.
    Lost(String, String),
    /// Something else could not be done.
    Failed(String),
}

/// The handles of the threads. Dropping it waits for what is being written.
pub struct DiskWorkers {
    writer: DiskThread,
    reader: DiskThread,
    reports: mpsc::Receiver<DiskReport>,
}

/// A thread that works on the disk.
struct DiskThread {
    jobs: Option<mpsc::Sender<DiskJob>>,
    thread: Option<JoinHandle<()>>,
}

/// The context that a worker thread works with.
struct WorkerContext {
    store: Option<Store>,
    limit: u64,
    reports: mpsc::Sender<DiskReport>,
}

impl DiskWorkers {
    /// Starts the threads on `store` (`None`: there is no place for one), which is to take `limit`
    /// bytes at most. `on_report` is called after each report.
    ///
    /// # Errors
    /// When the system refuses to start threads.
    pub fn new(
        store: Option<Store>,
        limit: u64,
        on_report: impl Fn() + Clone + Send + 'static,
    ) -> Result<Self> {
        let (sender, reports) = mpsc::channel();
        let start = |name: &str| {
            let context = WorkerContext { store: store.clone(), limit, reports: sender.clone() };
            DiskThread::new(name, context, on_report.clone())
        };
        Ok(Self { writer: start("snapshots")?, reader: start("snapshot")?, reports })
    }

    /// Asks the disk for something.
    pub fn ask(&self, job: DiskJob) {
        let reads = matches!(job, DiskJob::Read(_) | DiskJob::ReadWithVariance(_));
        let thread = if reads { &self.reader } else { &self.writer };
        if let Some(jobs) = &thread.jobs {
            // The thread lives as long as its handle.
            let _ = jobs.send(job);
        }
    }

    /// The next report, if there is one.
    pub fn poll(&self) -> Option<DiskReport> {
        self.reports.try_recv().ok()
    }

    /// Waits for everything that was asked for. Nothing is done any more afterwards.
    pub fn finish(&mut self) {
        self.writer.finish();
        self.reader.finish();
    }
}

impl Drop for DiskWorkers {
    fn drop(&mut self) {
        self.finish();
    }
}

impl DiskThread {
    fn new(
        name: &str,
        context: WorkerContext,
        on_report: impl Fn() + Send + 'static,
    ) -> Result<Self> {
        let (jobs, todo) = mpsc::channel();
        let thread = std::thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || {
                while let Ok(job) = todo.recv() {
                    context.work(job);
                    on_report();
                }
            })
            .map_err(|error| Error::io("the thread for snapshots", error))?;
        Ok(Self { jobs: Some(jobs), thread: Some(thread) })
    }

    fn finish(&mut self) {
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            // A panic over there was reported there already.
            let _ = thread.join();
        }
    }
}

impl WorkerContext {
    fn work(&self, job: DiskJob) {
        let told = match &self.store {
            Some(store) => self.report(store, job),
            None => no_place(&job),
        };
        if let Some(report) = told {
            // The strip may have gone.
            let _ = self.reports.send(report);
        }
    }

    fn report(&self, store: &Store, job: DiskJob) -> Option<DiskReport> {
        let done = match job {
            DiskJob::List => return Some(list(store)),
            DiskJob::Keep(keep) => {
                let kept = self.keep(store, *keep);
                return Some(kept.unwrap_or_else(|error| DiskReport::NotKept(error.to_string())));
            }
            DiskJob::Read(entry) => {
                let picture = read(store, &entry).map_err(|error| error.to_string());
                return Some(DiskReport::Read(entry.id, picture));
            }
            DiskJob::ReadWithVariance(entry) => {
                let picture = read_with_variance(store, &entry).map_err(|error| error.to_string());
                return Some(DiskReport::Read(entry.id, picture));
            }
            DiskJob::Describe(id, record) => store.describe(&id, &record),
            DiskJob::Delete(id) => store.delete(&id),
            DiskJob::Restore(id) => {
                let lost = store.restore(&id).err();
                return lost.map(|error| DiskReport::Lost(id, error.to_string()));
            }
            DiskJob::Forget(ids) => {
                store.forget(&ids);
                Ok(())
            }
        };
        done.err().map(|error| DiskReport::Failed(error.to_string()))
    }

    fn keep(&self, store: &Store, keep: Keep) -> Result<DiskReport> {
        let Keep { film, mut settings, seconds, cpu_seconds, tone, name } = keep;
        let film = receive(&PathBuf::from(&name), &film)?;
        settings.film.size = film.size().to_array();
        let mut picture = blank(&film.size().to_array());
        picture.stats.noise = resolve(&film, &mut picture.pixels);
        picture.stats.samples_per_pixel = samples_per_pixel(&film);
        picture.stats.seconds = seconds;
        let fresh = Fresh {
            film: &film,
            header: &header(&settings, [seconds, cpu_seconds])?,
            record: Record::new(name, &settings, &picture.stats),
            thumbnail: &Thumbnail::of(&picture),
            tone,
        };
        let entry = store.add(fresh)?;
        let gone = store.make_room(self.limit, &entry.id);
        Ok(DiskReport::Kept { kept: pictured(store, entry), picture: Arc::new(picture), gone })
    }
}

fn list(store: &Store) -> DiskReport {
    store.clean(LEFT_BEHIND);
    let Listing { entries, problems } = store.list();
    let entries = entries.into_iter().map(|entry| pictured(store, entry)).collect();
    DiskReport::Listed(entries, problems)
}

fn pictured(store: &Store, entry: StoredSnapshot) -> SnapshotWithThumbnail {
    let thumbnail = thumbnail::read(&store.thumbnail(&entry.id));
    (entry, thumbnail)
}

fn read(store: &Store, entry: &StoredSnapshot) -> Result<Arc<Picture>> {
    let (size, pixels) = exr::read_picture(&store.picture(&entry.id))?;
    let Record { spp, seconds, noise, .. } = entry.record;
    let mut picture = Picture { pixels, ..blank(&size.to_array()) };
    picture.stats.samples_per_pixel = spp;
    picture.stats.seconds = seconds;
    picture.stats.noise = noise;
    Ok(Arc::new(picture))
}

fn read_with_variance(store: &Store, entry: &StoredSnapshot) -> Result<Arc<Picture>> {
    let exr::Snapshot { film, header } = exr::read_snapshot(&store.picture(&entry.id))?;
    let mut picture = blank(&film.size().to_array());
    picture.stats.noise = resolve(&film, &mut picture.pixels);
    resolve_variance(&film, &mut picture.variance);
    picture.fewest_samples = film.sample_range().0;
    picture.stats.samples_per_pixel = samples_per_pixel(&film);
    picture.stats.seconds = header.wall_seconds;
    picture.stats.cpu_seconds = header.cpu_seconds_render;
    Ok(Arc::new(picture))
}

/// A picture without pixels yet.
fn blank(size: &[u32; 2]) -> Picture {
    Picture { size: (*size).into(), pixels: Vec::new(), complete: true, ..Picture::default() }
}

/// Without a folder no snapshot can be stored, and no other job can come.
fn no_place(job: &DiskJob) -> Option<DiskReport> {
    let text = "There is no folder for snapshots. Set FLAMBEAU_DATA to one.";
    match job {
        DiskJob::Keep(_) => Some(DiskReport::NotKept(text.to_owned())),
        DiskJob::List => Some(DiskReport::Listed(Vec::new(), Vec::new())),
        _ => None,
    }
}
