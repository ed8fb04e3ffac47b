//! Rendering behind a window: a thread of its own that takes the latest request, refines it and
//! hands over pictures. No call here waits for sampling.
//!
//! A request is provisional while its sampler still lacks its light probes: it shows a picture at
//! once, with more noise, and [`Session::improve`] brings the sampler that has them. Samples of
//! both are never mixed.

mod active;
mod phase;
mod request;
mod shared;
mod sharing;
mod worker;

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;

pub use request::{Request, Resume};
pub use sharing::{Sharing, TurnToken};

use super::area::Area;
use super::film::Film;
use super::picture::{Extras, Picture};
use super::pool::{Failure, Pool, Priority};
use crate::error::{Error, Result};
use crate::transport::PixelSampler;
use shared::{Improvement, Shared, lock};
use worker::Worker;

/// A progressive render in the background. Dropping it ends it within one sample a thread.
pub struct Session {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
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
        let shared = Arc::new(Shared::new(on_publish));
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
        self.shared.post(|mailbox| {
            mailbox.request = Some(request);
            self.shared.requested.store(true, Ordering::Relaxed);
        });
    }

    /// Brings the provisional request of that generation the sampler it waits for, or says that
    /// none will come; in vain if it is no longer the latest. The render starts over with it, just
    /// as if it had begun so, and the picture of before stays until the new one has as many paths:
    /// it neither goes blank nor gets coarser. A paused render starts over when it is resumed. One
    /// that goes on from a film has waited for the sampler and goes on with it.
    pub fn improve(&self, generation: u64, sampler: Option<Arc<dyn PixelSampler>>) {
        self.shared.post(|mailbox| {
            mailbox.improvement = Some(Improvement { generation, sampler });
            self.shared.improved.store(true, Ordering::Relaxed);
        });
    }

    /// Holds or resumes refinement. A request started while paused still brings its first, coarse
    /// picture.
    pub fn set_paused(&self, paused: bool) {
        self.shared.post(|mailbox| mailbox.paused = paused);
    }

    /// Sets what pictures bring along beside their light. It costs a little to read, so it is left
    /// out unless asked for; asking brings a new picture of what there is, also while paused or
    /// finished.
    pub fn set_extras(&self, extras: Extras) {
        self.shared.post(|mailbox| mailbox.extras = extras);
    }

    /// Takes turns with the session that has the other token, or has the machine for itself again.
    pub fn take_turns_by(&self, token: Option<TurnToken>) {
        self.shared.post(|mailbox| mailbox.turn_token = token);
    }

    /// Gives all samples to the pixels of `area` once every pixel has one, or to all pixels, which
    /// catch up. Of another film's size, it is what of it lies on that.
    pub fn render_region_only(&self, area: Option<Area>) {
        self.shared.post(|mailbox| mailbox.area = area);
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
        self.shared.post(|mailbox| mailbox.snapshots.push(sender));
        receiver
    }

    /// Failure that stopped the latest request, with its generation; `None` while all is well.
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
