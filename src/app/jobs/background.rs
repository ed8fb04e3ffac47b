//! Values made off the window's thread, at low priority.

use std::sync::{Arc, mpsc};

use crate::error::Result;
use crate::render::pool::{Pool, Priority};

/// The threads that make values for the window. They give way to its own thread.
#[derive(Clone)]
pub struct BackgroundPool(Arc<Pool>);

impl BackgroundPool {
    /// A pool of `threads` threads (`None`: one a core).
    ///
    /// # Errors
    /// When the system refuses to start them.
    pub fn new(threads: Option<usize>) -> Result<Self> {
        Ok(Self(Arc::new(Pool::new(threads, Priority::Background)?)))
    }

    /// Runs `work` on the pool and returns at once. Work that the system has no thread to wait for
    /// is dropped.
    fn spawn(&self, work: impl FnOnce() + Send + 'static) {
        let pool = self.0.clone();
        let wait = move || pool.install(work);
        // Whoever waits for the outcome sees that it was dropped.
        let _ = std::thread::Builder::new().name("background".to_owned()).spawn(wait);
    }
}

/// Makes a `T` from an `S` on another thread, again whenever that changes, and keeps the last one
/// until then.
pub struct Background<S, T> {
    pool: BackgroundPool,
    done: Option<(S, T)>,
    under_way: Option<mpsc::Receiver<(S, T)>>,
}

impl<S: Send + 'static, T: Send + 'static> Background<S, T> {
    /// No value yet; values will be made on `pool`.
    pub fn new(pool: &BackgroundPool) -> Self {
        Self { pool: pool.clone(), done: None, under_way: None }
    }

    /// Lets go of the value and of what is under way.
    pub fn clear(&mut self) {
        (self.done, self.under_way) = (None, None);
    }

    /// Brings the value in line with `source`, or lets go of it where that is `None`. `same` says
    /// whether two sources make the same; `wake` is called when the value is made.
    pub fn update(
        &mut self,
        source: Option<S>,
        same: impl Fn(&S, &S) -> bool,
        make: impl FnOnce(&S) -> T + Send + 'static,
        wake: impl FnOnce() + Send + 'static,
    ) {
        let Some(source) = source else {
            self.clear();
            return;
        };
        if let Some(receiver) = &self.under_way {
            match receiver.try_recv() {
                Ok(done) => self.done = Some(done),
                Err(mpsc::TryRecvError::Empty) => return,
                // The thread failed; the next line tries again only if something is missing.
                Err(mpsc::TryRecvError::Disconnected) => {}
            }
            self.under_way = None;
        }
        match &mut self.done {
            // The newer source lets go of the older one.
            Some((known, _)) if same(known, &source) => *known = source,
            _ => self.start(source, make, wake),
        }
    }

    fn start(
        &mut self,
        source: S,
        make: impl FnOnce(&S) -> T + Send + 'static,
        wake: impl FnOnce() + Send + 'static,
    ) {
        let (sender, receiver) = mpsc::channel();
        self.pool.spawn(move || {
            let made = make(&source);
            // The window may have closed.
            let _ = sender.send((source, made));
            wake();
        });
        self.under_way = Some(receiver);
    }

    /// The value made last, and its source.
    pub fn done(&self) -> Option<&(S, T)> {
        self.done.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

    fn settled(background: &mut Background<u32, u32>, source: u32) -> (u32, u32) {
        let begun = Instant::now();
        loop {
            background.update(Some(source), |a, b| a == b, |source| 10 * source, || ());
            if let Some(done) = background.done().filter(|(known, _)| *known == source) {
                return *done;
            }
            assert!(begun.elapsed() < Duration::from_secs(60), "nothing is made of {source}");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn the_value_follows_its_source_and_goes_with_it() {
        let mut background = Background::new(&BackgroundPool::new(Some(1)).unwrap());
        assert_eq!(settled(&mut background, 1), (1, 10));
        assert_eq!(settled(&mut background, 2), (2, 20));
        background.update(None, |a, b| a == b, |source| *source, || ());
        assert!(background.done().is_none());
    }

    /// The pool lowers the priority of its threads, so that the window stays fluent.
    #[test]
    #[cfg(target_os = "linux")]
    fn values_are_made_at_low_priority() {
        let pool = BackgroundPool::new(Some(1)).unwrap();
        let mut background = Background::new(&pool);
        let (sender, priority) = mpsc::channel();
        let make = move |&(): &()| {
            sender.send(rustix::process::getpriority_process(None).unwrap()).unwrap();
        };
        background.update(Some(()), |(), ()| true, make, || ());
        let priority = priority.recv_timeout(Duration::from_secs(60)).unwrap();
        assert!(priority >= 10, "{priority}");
    }
}
