//! Watches the files of the scene, so that one that is written again, or a frame that is added, is
//! seen.
//!
//! A thread looks at their times and sizes once a second, which works on network disks too. A file
//! counts as changed once it has stayed the same for another second, so that it is not read while
//! it is being written.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

use crate::error::{Error, Result};

/// Time between two looks.
const INTERVAL: Duration = Duration::from_secs(1);

/// Time and size of a file or folder; `None` while it is not there.
type Stamp = Option<(SystemTime, u64)>;

/// Watches files and folders. Dropping it ends its thread.
pub struct FileWatch {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    ends: Condvar,
}

#[derive(Default)]
struct State {
    watched: Vec<Watched>,
    /// Files and folders that have changed since they were last asked for.
    changed: Vec<PathBuf>,
    ends: bool,
}

/// A file or folder as it was.
#[derive(Debug)]
struct Watched {
    path: PathBuf,
    /// Its state when it was read.
    known: Stamp,
    /// Its state at the last look.
    last: Stamp,
}

impl Watched {
    fn new(path: PathBuf) -> Self {
        let known = stamp(&path);
        Self { path, known, last: known }
    }

    /// Takes note of the present stamp; whether the file has changed and come to rest.
    fn look(&mut self, now: Stamp) -> bool {
        let rests = std::mem::replace(&mut self.last, now) == now;
        let is_changed = rests && now != self.known && now.is_some();
        if is_changed {
            self.known = now;
        }
        is_changed
    }
}

impl FileWatch {
    /// Starts the thread; `wake` is called when something has changed.
    ///
    /// # Errors
    /// When the system refuses to start a thread.
    pub fn new(wake: impl Fn() + Send + 'static) -> Result<Self> {
        let shared = Arc::new(Shared::default());
        let watched = shared.clone();
        let thread = std::thread::Builder::new()
            .name("file watch".to_owned())
            .spawn(move || watch(&watched, &wake))
            .map_err(|error| Error::io("the thread that watches files", error))?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Watches these files and folders, as they are now, in place of others. Those that were
    /// watched already are compared with what they were.
    pub fn watch(&self, paths: Vec<PathBuf>) {
        let mut state = self.shared.state();
        let mut known = std::mem::take(&mut state.watched);
        let watched = paths.into_iter().map(|path| {
            let place = known.iter().position(|watched| watched.path == path);
            place.map_or_else(|| Watched::new(path), |place| known.swap_remove(place))
        });
        state.watched = watched.collect();
    }

    /// Takes a file as it is now for known, since it was written from here.
    pub fn know(&self, path: &Path) {
        let now = stamp(path);
        let mut state = self.shared.state();
        for watched in state.watched.iter_mut().filter(|watched| watched.path == path) {
            (watched.known, watched.last) = (now, now);
        }
    }

    /// The files and folders that have changed since the last time this was asked.
    pub fn changed(&self) -> Vec<PathBuf> {
        std::mem::take(&mut self.shared.state().changed)
    }
}

impl Drop for FileWatch {
    fn drop(&mut self) {
        self.shared.state().ends = true;
        self.shared.ends.notify_all();
        if let Some(thread) = self.thread.take() {
            // Nothing in it can fail that anybody would want to know.
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn watch(shared: &Shared, wake: &dyn Fn()) {
    loop {
        let state = shared.state();
        let waited = shared.ends.wait_timeout_while(state, INTERVAL, |state| !state.ends);
        let (state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        if state.ends {
            return;
        }
        let paths: Vec<PathBuf> = state.watched.iter().map(|one| one.path.clone()).collect();
        // A disk may take its time, which the window does not wait for.
        drop(state);
        let stamps: Vec<Stamp> = paths.iter().map(|path| stamp(path)).collect();
        let mut state = shared.state();
        let before = state.changed.len();
        for (path, now) in std::iter::zip(paths, stamps) {
            let watched = state.watched.iter_mut().find(|watched| watched.path == path);
            if watched.is_some_and(|watched| watched.look(now)) {
                state.changed.push(path);
            }
        }
        let has_changed = state.changed.len() > before;
        drop(state);
        if has_changed {
            wake();
        }
    }
}

fn stamp(path: &Path) -> Stamp {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_counts_once_it_has_come_to_rest() {
        let at = |seconds: u64, bytes| {
            Some((SystemTime::UNIX_EPOCH + Duration::from_secs(seconds), bytes))
        };
        let known = at(1, 10);
        let mut watched = Watched { path: PathBuf::new(), known, last: known };
        assert!(!watched.look(at(1, 10)));
        assert!(!watched.look(at(2, 3)), "being written");
        assert!(!watched.look(at(3, 9)), "still");
        assert!(watched.look(at(3, 9)));
        assert!(!watched.look(at(3, 9)), "once");
        assert!(!watched.look(None) && !watched.look(None), "gone, which is no new content");
        assert!(!watched.look(at(4, 9)) && watched.look(at(4, 9)), "there again");
    }
}
