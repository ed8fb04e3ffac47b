//! A thread that reads and builds scenes and starts to render them, so that nothing blocks the
//! window. The latest request wins: a new one cancels the one at work, and only its outcome is
//! reported.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::sync::{Arc, mpsc};

use super::built::{BuiltScene, Grids, RenderStart};
use super::mailbox::Mailbox;
use super::probe_placer::ProbePlacer;
use super::reopen::{self, Reopened};
use crate::error::{Error, Progress, Result};
use crate::scene::Stamp;
use crate::scene::sequence::time_range;
use crate::scene::{self, Assembled, Overrides, Settings, VolumeCache};

/// Frames that are read in advance, relative to the one that is shown, in their order.
const PREFETCHED: [i32; 7] = [1, -1, 2, -2, 3, 4, 5];

/// A job of the loader.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadJob {
    /// Read a scene, a volume or a snapshot (a path or `builtin:NAME`) and build it.
    Open(String),
    /// Build these settings.
    Build(Box<Settings>),
}

/// A report of the loader.
pub enum LoadReport {
    /// A job has ended.
    Ended(Box<LoadOutcome>),
    /// The grids of all files seen so far.
    Grids(Arc<Grids>),
}

/// The outcome of a job.
pub struct LoadOutcome {
    /// The number of the request, as [`Loader::request`] gave it.
    pub number: u64,
    /// The job.
    pub job: LoadJob,
    /// The settings and the scene built from them.
    pub result: Result<BuiltScene>,
    /// The render that was started, if one was asked for and the scene could be built.
    pub started: Option<RenderStart>,
    /// Continuation of a snapshot, where one was opened.
    pub reopened: Option<Reopened>,
}

/// The handle of the thread. Dropping it cancels and ends the thread.
pub struct Loader {
    shared: Arc<Shared>,
    reports: mpsc::Receiver<LoadReport>,
    thread: Option<std::thread::JoinHandle<()>>,
}

struct Shared {
    requests: Mailbox<LoadRequest>,
    /// Counts the requests; work for an older one is cancelled.
    latest: AtomicU64,
    /// Percents done of the present job.
    percent: AtomicU32,
}

/// A job with its number and the render that it starts.
struct LoadRequest {
    number: u64,
    job: LoadJob,
    start: Option<RenderStart>,
}

impl Loader {
    /// Starts the thread, which starts renders by `probe_placer` and keeps volumes in `cache`.
    /// `on_news` is called after each report and as work proceeds.
    ///
    /// # Errors
    /// When the system refuses to start a thread.
    pub fn new(
        probe_placer: Arc<ProbePlacer>,
        cache: Arc<VolumeCache>,
        on_news: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self> {
        let shared = Arc::new(Shared {
            requests: Mailbox::default(),
            latest: AtomicU64::new(0),
            percent: AtomicU32::new(0),
        });
        let (sender, reports) = mpsc::channel();
        let worker = shared.clone();
        let thread = std::thread::Builder::new()
            .name("loader".to_owned())
            .spawn(move || work(&worker, &probe_placer, &cache, &sender, &on_news))
            .map_err(|error| Error::io("the loader thread", error))?;
        Ok(Self { shared, reports, thread: Some(thread) })
    }

    /// Asks for `job`, and to `start` a render of what it builds; cancels any other. Gives the
    /// number of the request.
    pub fn request(&self, job: LoadJob, start: Option<RenderStart>) -> u64 {
        let number = self.shared.latest.fetch_add(1, Ordering::Relaxed) + 1;
        self.shared.requests.post(LoadRequest { number, job, start });
        number
    }

    /// Cancels what is at work or waiting.
    pub fn cancel(&self) {
        self.shared.latest.fetch_add(1, Ordering::Relaxed);
        self.shared.requests.clear();
    }

    /// The next report, if there is one.
    pub fn poll(&self) -> Option<LoadReport> {
        self.reports.try_recv().ok()
    }

    /// The fraction done of the job at work, in 0..=1; `None` while idle.
    pub fn progress(&self) -> Option<f32> {
        let is_busy = self.shared.requests.is_busy();
        is_busy.then(|| self.shared.percent.load(Ordering::Relaxed) as f32 / 100.0)
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.cancel();
        self.shared.requests.stop();
        if let Some(thread) = self.thread.take() {
            // A panic over there was reported there already.
            let _ = thread.join();
        }
    }
}

fn work(
    shared: &Shared,
    probe_placer: &ProbePlacer,
    cache: &VolumeCache,
    reports: &mpsc::Sender<LoadReport>,
    on_news: &(dyn Fn() + Sync),
) {
    let mut described = DescribedFiles::default();
    while let Some(LoadRequest { number, job, start }) = shared.requests.take() {
        shared.percent.store(0, Ordering::Relaxed);
        let is_latest = || shared.latest.load(Ordering::Relaxed) == number;
        let progress = |fraction: f32| {
            let percent = (100.0 * fraction) as u32;
            if shared.percent.swap(percent, Ordering::Relaxed) != percent {
                on_news();
            }
            is_latest()
        };
        let result = run(&job, cache, &progress);
        if !is_latest() {
            on_news();
            continue;
        }
        shared.requests.finish();
        let (result, reopened) = match result {
            Ok((built, reopened)) => (Ok(built), reopened),
            Err(error) => (Err(error), None),
        };
        let settings = result.as_ref().ok().map(|built| built.settings.clone());
        let started = start.filter(|start| match &result {
            Ok(built) => {
                probe_placer.start(built, *start, None);
                true
            }
            Err(_) => false,
        });
        // The receiver lives as long as this thread: the loader joins it.
        let outcome = LoadOutcome { number, job, result, started, reopened };
        let _ = reports.send(LoadReport::Ended(Box::new(outcome)));
        on_news();
        let Some(settings) = settings else { continue };
        let still_latest = |_: f32| is_latest();
        // A failure here is reported when the grid is asked for.
        if let Ok(true) = described.add_missing(&settings, cache, &still_latest) {
            let _ = reports.send(LoadReport::Grids(Arc::new(described.grids.clone())));
            on_news();
        }
        prefetch(&settings, cache, &still_latest);
    }
}

fn run(
    job: &LoadJob,
    cache: &VolumeCache,
    progress: Progress<'_>,
) -> Result<(BuiltScene, Option<Reopened>)> {
    let (settings, notes, reopened) = match job {
        LoadJob::Open(source) if reopen::is_snapshot(source) => {
            let (settings, reopened) = reopen::open(source)?;
            (settings, Vec::new(), Some(reopened))
        }
        LoadJob::Open(source) => {
            let opened = scene::open(source, &Overrides::default(), cache, progress)?;
            (opened.settings, opened.notes, None)
        }
        LoadJob::Build(settings) => ((**settings).clone(), Vec::new(), None),
    };
    let Assembled { scene, gaps } = scene::assemble_frame(&settings, cache, progress)?;
    let scene = Arc::new(scene);
    Ok((BuiltScene { settings, notes, gaps, scene }, reopened))
}

/// Reads the frames around that of `settings` while nothing else is asked for and there is room.
/// One that cannot be read is reported when the scene goes to it.
fn prefetch(settings: &Settings, cache: &VolumeCache, progress: Progress<'_>) {
    let Some([first, last]) = time_range(settings) else { return };
    let frame = settings.time.whole_frame();
    let around = PREFETCHED.into_iter().map(|offset| frame.saturating_add(offset));
    for frame in around.filter(|frame| (first..=last).contains(frame)) {
        if !progress(0.0) || cache.bytes() > cache.room() {
            return;
        }
        let mut settings = settings.clone();
        settings.time.frame = f64::from(frame);
        let _ = scene::prefetch(&settings, cache, progress);
    }
}

/// The grids of all files seen so far.
#[derive(Default)]
struct DescribedFiles {
    grids: Grids,
    /// Time and size of each file when it was described.
    stamps: HashMap<String, Option<Stamp>>,
}

impl DescribedFiles {
    /// Adds the grids of the files of `settings` that are not described as they are now, and reads
    /// those that the scene itself does not need. Whether there were any.
    fn add_missing(
        &mut self,
        settings: &Settings,
        cache: &VolumeCache,
        progress: Progress<'_>,
    ) -> Result<bool> {
        let mut added = false;
        for name in settings.volume.iter().filter_map(|volume| volume.file.as_ref()) {
            let stamp = scene::stamp(name);
            if self.stamps.get(name) != Some(&stamp) {
                let described = scene::describe(name, cache, progress)?;
                self.grids.insert(name.clone(), described.grids);
                self.stamps.insert(name.clone(), stamp);
                added = true;
            }
        }
        Ok(added)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Session;
    use std::time::{Duration, Instant};

    fn loader() -> Loader {
        let session = Arc::new(Session::new(Some(1), || ()).unwrap());
        let probe_placer = Arc::new(ProbePlacer::new(session, Some(1)).unwrap());
        Loader::new(probe_placer, Arc::default(), || ()).unwrap()
    }

    fn wait(loader: &Loader) -> LoadOutcome {
        let start = Instant::now();
        loop {
            if let Some(LoadReport::Ended(outcome)) = loader.poll() {
                return *outcome;
            }
            assert!(start.elapsed() < Duration::from_secs(60), "no outcome");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn the_latest_request_wins() {
        let loader = loader();
        for seed in 0..50 {
            let mut settings = Settings::default();
            settings.film.seed = seed;
            loader.request(LoadJob::Build(Box::new(settings)), None);
        }
        loop {
            let outcome = wait(&loader);
            if outcome.result.unwrap().settings.film.seed == 49 {
                break;
            }
        }
        assert!(loader.poll().is_none());
    }

    #[test]
    fn a_cancelled_job_has_no_outcome() {
        let loader = loader();
        loader.request(LoadJob::Open(scene::DEFAULT_SCENE.to_owned()), None);
        loader.cancel();
        let start = Instant::now();
        while loader.progress().is_some() {
            assert!(start.elapsed() < Duration::from_secs(60), "still at work");
            std::thread::sleep(Duration::from_millis(1));
        }
        assert!(loader.poll().is_none());
    }

    #[test]
    fn failures_name_what_was_asked_for() {
        let loader = loader();
        loader.request(LoadJob::Open("no/such/file.vdb".to_owned()), None);
        let outcome = wait(&loader);
        assert_eq!(outcome.job, LoadJob::Open("no/such/file.vdb".to_owned()));
        assert!(outcome.result.is_err());
        assert_eq!(loader.progress(), None);
    }
}
