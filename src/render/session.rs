//! Rendering behind a window: a thread of its own that takes the latest request, refines it and
//! hands over pictures. No call here waits for sampling.

mod sharing;
mod worker;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use glam::UVec2;

use super::area::Area;
use super::film::Film;
use super::pool::{Failure, Pool, Priority};
use super::publish::{Extras, Picture};
use crate::error::{Error, Result};
use crate::transport::PixelSampler;
use worker::Worker;

pub use sharing::{Seat, Sharing};

/// Something to render.
pub struct Request {
    /// What to sample.
    pub sampler: Arc<dyn PixelSampler>,
    /// Width and height in pixels.
    pub size: UVec2,
    /// Samples a pixel; 0: until stopped.
    pub spp: u32,
    /// The caller's number, which the pictures carry.
    pub generation: u64,
    /// What to go on from, a film of the same size. It waits for a better sampler that is in the
    /// making, so that the samples of two never mix.
    pub resume: Option<Resume>,
    /// Whether a better sampler of the same picture is in the making, which
    /// [`Session::improve`] will bring. Until then the render is not finished, whatever its limit,
    /// and a snapshot waits, unless it is paused.
    pub provisional: bool,
}

/// A render to go on from.
#[derive(Debug)]
pub struct Resume {
    /// The samples it has.
    pub film: Film,
    /// Seconds of rendering that they took.
    pub seconds: f64,
    /// CPU time that the sampling threads spent on them, in seconds.
    pub cpu_seconds: f64,
}

/// A progressive render in the background. Dropping it ends it within one sample a thread.
pub struct Session {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

/// What callers have asked for and the render thread has not yet seen.
#[derive(Default)]
struct Mail {
    request: Option<Request>,
    improvement: Option<Improvement>,
    snapshots: Vec<Sender<Film>>,
    paused: bool,
    extras: Extras,
    seat: Option<Seat>,
    area: Option<Area>,
}

/// What becomes of a provisional request.
struct Improvement {
    generation: u64,
    /// `None`: it stays as it is.
    sampler: Option<Arc<dyn PixelSampler>>,
}

struct Shared {
    mail: Mutex<Mail>,
    bell: Condvar,
    /// Grows with every letter; work that began under an older number breaks off.
    epoch: AtomicU64,
    quit: AtomicBool,
    /// Whether an improvement came that has not been seen, for which a render that shows nothing
    /// yet breaks off at once.
    improved: AtomicBool,
    latest: Mutex<Option<Arc<Picture>>>,
    failure: Mutex<Option<(u64, Failure)>>,
    on_publish: Box<dyn Fn() + Send + Sync>,
}

impl Session {
    /// Starts a session with `threads` sampling threads, or one a core. `on_publish` is called from
    /// the render thread after each published picture and after a failure.
    ///
    /// # Errors
    /// When the system refuses to start threads.
    pub fn new(
        threads: Option<usize>,
        on_publish: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self> {
        let pool = Pool::new(threads, Priority::Background)?;
        let shared = Arc::new(Shared {
            mail: Mutex::default(),
            bell: Condvar::new(),
            epoch: AtomicU64::new(0),
            quit: AtomicBool::new(false),
            improved: AtomicBool::new(false),
            latest: Mutex::default(),
            failure: Mutex::default(),
            on_publish: Box::new(on_publish),
        });
        let worker = Worker::new(Arc::clone(&shared), pool);
        let thread = std::thread::Builder::new()
            .name("render".to_owned())
            .spawn(move || worker.run())
            .map_err(|e| Error::invalid("", "threads", format!("cannot start a thread: {e}")))?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Renders `request` from now on. The latest wins: what runs is given up within one sample a
    /// thread (or, if it has nothing to show yet, when it has, or after a second), and
    /// a request that has not begun is dropped.
    pub fn start(&self, request: Request) {
        self.shared.post(|mail| mail.request = Some(request));
    }

    /// Brings the provisional request of that generation the sampler it waits for, or says that
    /// none will come; in vain if it is no longer the latest. The render starts over with it, just
    /// as if it had begun so, and the picture of before stays until the new one has as many paths:
    /// it neither goes blank nor gets coarser. A paused render starts over when it is resumed. One
    /// that goes on from a film has waited for the sampler and goes on with it.
    pub fn improve(&self, generation: u64, sampler: Option<Arc<dyn PixelSampler>>) {
        self.shared.post(|mail| {
            mail.improvement = Some(Improvement { generation, sampler });
            self.shared.improved.store(true, Ordering::Relaxed);
        });
    }

    /// Holds or resumes refinement. A request started while paused still brings its first, coarse
    /// picture.
    pub fn set_paused(&self, paused: bool) {
        self.shared.post(|mail| mail.paused = paused);
    }

    /// What pictures bring along beside their light. It costs a little to read, so it is left out
    /// unless asked for; asking brings a new picture of what there is, also while paused or
    /// finished.
    pub fn set_extras(&self, extras: Extras) {
        self.shared.post(|mail| mail.extras = extras);
    }

    /// Takes turns with the session of the other seat, or has the machine for itself again.
    pub fn take_seat(&self, seat: Option<Seat>) {
        self.shared.post(|mail| mail.seat = seat);
    }

    /// Gives all samples to the pixels of `area` once every pixel has one, or to all pixels, which
    /// catch up. Of another film's size, it is what of it lies on that.
    pub fn focus(&self, area: Option<Area>) {
        self.shared.post(|mail| mail.area = area);
    }

    /// The latest picture. After [`Self::start`] the old one stays until the new request has its
    /// first.
    pub fn latest(&self) -> Option<Arc<Picture>> {
        lock(&self.shared.latest).clone()
    }

    /// Asks for a consistent copy of the film of the latest request, for saving; it comes as soon
    /// as there is a picture, also while paused or finished. The channel closes without one when
    /// there is nothing to copy or no memory for it.
    pub fn snapshot(&self) -> Receiver<Film> {
        let (sender, receiver) = channel();
        self.shared.post(|mail| mail.snapshots.push(sender));
        receiver
    }

    /// Why the latest request stopped before its end, with its generation; none while all is well.
    pub fn last_failure(&self) -> Option<(u64, Failure)> {
        lock(&self.shared.failure).clone()
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.shared.post(|_| self.shared.quit.store(true, Ordering::Relaxed));
        if let Some(thread) = self.thread.take() {
            // The render thread catches what samplers do; should it have panicked all the same,
            // there is nothing left to end.
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn post(&self, change: impl FnOnce(&mut Mail)) {
        let mut mail = lock(&self.mail);
        change(&mut mail);
        self.epoch.fetch_add(1, Ordering::Relaxed);
        self.bell.notify_one();
    }
}

/// Locks; what the mutexes guard is replaced as a whole, so a panic elsewhere cannot have left it
/// half written.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
