//! The state that a session and its render thread share.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use super::request::Request;
use super::sharing::TurnToken;
use crate::render::area::Area;
use crate::render::film::Film;
use crate::render::picture::{Extras, Picture};
use crate::render::pool::Failure;
use crate::transport::PixelSampler;

/// Messages of the callers. The render thread takes requests, improvements and snapshots out when
/// it reads them; the rest stands until it is changed.
#[derive(Default)]
pub(super) struct Mailbox {
    pub request: Option<Request>,
    pub improvement: Option<Improvement>,
    /// Receivers of copies of the film.
    pub snapshots: Vec<Sender<Film>>,
    pub paused: bool,
    pub extras: Extras,
    pub turn_token: Option<TurnToken>,
    pub area: Option<Area>,
}

/// The outcome of the wait of a provisional request.
pub(super) struct Improvement {
    pub generation: u64,
    /// The better sampler; `None`: the request continues with its first one.
    pub sampler: Option<Arc<dyn PixelSampler>>,
}

/// The shared state: messages one way, pictures and failures the other.
pub(super) struct Shared {
    pub mailbox: Mutex<Mailbox>,
    /// Signaled with every message.
    pub changed: Condvar,
    /// Grows with every message; work that began under an older number breaks off.
    pub epoch: AtomicU64,
    pub quit: AtomicBool,
    /// Whether there is an unread improvement, for which a render that shows nothing yet breaks off
    /// at once.
    pub improved: AtomicBool,
    /// Whether there is an unread request, for which a pilot pass is given up.
    pub requested: AtomicBool,
    pub latest: Mutex<Option<Arc<Picture>>>,
    /// Failure that stopped the latest request, with its generation.
    pub failure: Mutex<Option<(u64, Failure)>>,
    on_publish: Box<dyn Fn() + Send + Sync>,
}

impl Shared {
    /// A state without messages; `on_publish` is called after each picture and each failure.
    pub fn new(on_publish: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            mailbox: Mutex::default(),
            changed: Condvar::new(),
            epoch: AtomicU64::new(0),
            quit: AtomicBool::new(false),
            improved: AtomicBool::new(false),
            requested: AtomicBool::new(false),
            latest: Mutex::default(),
            failure: Mutex::default(),
            on_publish: Box::new(on_publish),
        }
    }

    /// Posts a message to the render thread.
    pub fn post(&self, change: impl FnOnce(&mut Mailbox)) {
        let mut mailbox = lock(&self.mailbox);
        change(&mut mailbox);
        self.epoch.fetch_add(1, Ordering::Relaxed);
        self.changed.notify_one();
    }

    /// Hands a picture over.
    pub fn publish(&self, picture: Arc<Picture>) {
        *lock(&self.latest) = Some(picture);
        (self.on_publish)();
    }

    /// Reports that the request of this generation has stopped.
    pub fn fail(&self, generation: u64, failure: Failure) {
        *lock(&self.failure) = Some((generation, failure));
        (self.on_publish)();
    }
}

/// Locks a mutex. What the mutexes guard is replaced as a whole, so a panic elsewhere cannot have
/// left it half written.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
