//! Things made behind the window's back.

use std::sync::mpsc;

/// Makes a `T` from an `S` on another thread, again whenever that changes, and keeps the last one
/// until then.
pub struct Background<S, T> {
    done: Option<(S, T)>,
    under_way: Option<mpsc::Receiver<(S, T)>>,
}

impl<S, T> Default for Background<S, T> {
    fn default() -> Self {
        Self { done: None, under_way: None }
    }
}

impl<S: Send + 'static, T: Send + 'static> Background<S, T> {
    /// Brings what is made in line with `source`, or lets go of it where that is `None`. `same`
    /// says whether two sources make the same; `wake` is called when it is made.
    pub fn update(
        &mut self,
        source: Option<S>,
        same: impl Fn(&S, &S) -> bool,
        make: impl FnOnce(&S) -> T + Send + 'static,
        wake: impl FnOnce() + Send + 'static,
    ) {
        let Some(source) = source else {
            *self = Self::default();
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
        rayon::spawn(move || {
            let made = make(&source);
            // The window may have closed.
            let _ = sender.send((source, made));
            wake();
        });
        self.under_way = Some(receiver);
    }

    /// What was made last, and what from.
    pub fn done(&self) -> Option<&(S, T)> {
        self.done.as_ref()
    }
}
