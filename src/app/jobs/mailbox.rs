//! A place for one message from the window to a thread: the latest wins.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Holds one message at most. A message replaces an earlier one that was not taken yet, so that a
/// thread that is slower than the window works on the latest only.
pub struct Mailbox<T> {
    state: Mutex<MailboxState<T>>,
    changed: Condvar,
}

struct MailboxState<T> {
    message: Option<T>,
    /// Whether the message taken last is still being worked on.
    is_busy: bool,
    is_stopped: bool,
}

impl<T> Default for Mailbox<T> {
    fn default() -> Self {
        let state = MailboxState { message: None, is_busy: false, is_stopped: false };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }
}

impl<T> Mailbox<T> {
    /// Puts a message in, in place of one that was not taken yet.
    pub fn post(&self, message: T) {
        self.state().message = Some(message);
        self.changed.notify_one();
    }

    /// Drops the message that was not taken yet.
    pub fn clear(&self) {
        self.state().message = None;
    }

    /// Takes the message out, or waits for one; `None` once the mailbox is stopped. Work on the
    /// message before is done.
    pub fn take(&self) -> Option<T> {
        let mut state = self.state();
        state.is_busy = false;
        let is_idle = |state: &mut MailboxState<T>| !state.is_stopped && state.message.is_none();
        let mut state =
            self.changed.wait_while(state, is_idle).unwrap_or_else(PoisonError::into_inner);
        if state.is_stopped {
            return None;
        }
        state.is_busy = true;
        state.message.take()
    }

    /// Says that the work on the message taken last is done, before the next one is taken.
    pub fn finish(&self) {
        self.state().is_busy = false;
    }

    /// Whether a message waits or is being worked on.
    pub fn is_busy(&self) -> bool {
        let state = self.state();
        state.is_busy || state.message.is_some()
    }

    /// Ends the thread that takes messages, once it asks for the next one.
    pub fn stop(&self) {
        self.state().is_stopped = true;
        self.changed.notify_all();
    }

    /// The state, also after a panic of another thread: it is sound after every statement.
    fn state(&self) -> MutexGuard<'_, MailboxState<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;
    use std::time::Duration;

    const LONG: Duration = Duration::from_secs(60);

    #[test]
    fn the_latest_message_is_taken_once() {
        let mailbox = Mailbox::default();
        assert!(!mailbox.is_busy());
        mailbox.post(1);
        mailbox.post(2);
        assert!(mailbox.is_busy());
        assert_eq!(mailbox.take(), Some(2));
        assert!(mailbox.is_busy(), "it is being worked on");
        mailbox.finish();
        assert!(!mailbox.is_busy());
        mailbox.post(3);
        mailbox.clear();
        assert!(!mailbox.is_busy());
        mailbox.post(4);
        mailbox.stop();
        assert_eq!(mailbox.take(), None, "nothing is taken any more");
    }

    #[test]
    fn a_thread_waits_for_messages_until_it_is_stopped() {
        let mailbox = Mailbox::default();
        let (sender, taken) = mpsc::channel();
        std::thread::scope(|scope| {
            let mailbox = &mailbox;
            scope.spawn(move || {
                while let Some(message) = mailbox.take() {
                    sender.send(message).unwrap();
                }
            });
            for message in 0..3 {
                mailbox.post(message);
                assert_eq!(taken.recv_timeout(LONG), Ok(message));
            }
            mailbox.stop();
            assert_eq!(taken.recv_timeout(LONG), Err(mpsc::RecvTimeoutError::Disconnected));
        });
    }
}
