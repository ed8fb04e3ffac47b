//! Ctrl-C: what there is gets written.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::exit::Exit;
use crate::error::{Error, Result};

/// Signals this soon after the first are the same request: `timeout` sends its signal to the
/// program and to its group, one right after the other. Nobody presses Ctrl-C again as soon as
/// that.
const ONE_REQUEST: Duration = Duration::from_millis(250);

/// A flag that Ctrl-C sets, and so does a polite request to end, as render farms and terminals
/// that close send it; a second request ends the program at once.
pub fn listen_for_interrupt() -> Result<Arc<AtomicBool>> {
    let interrupt = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupt);
    let mut requests = Requests::default();
    ctrlc::set_handler(move || {
        flag.store(true, Ordering::Relaxed);
        if requests.is_second(Instant::now()) {
            std::process::exit(Exit::Interrupted as i32);
        }
    })
    .map_err(|e| Error::invalid("", "Ctrl-C", format!("cannot listen for it: {e}")))?;
    Ok(interrupt)
}

/// Tells requests from signals.
#[derive(Default)]
struct Requests {
    first: Option<Instant>,
}

impl Requests {
    /// Whether a signal that comes `now` is another request than the first.
    fn is_second(&mut self, now: Instant) -> bool {
        let first = *self.first.get_or_insert(now);
        now.duration_since(first) > ONE_REQUEST
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_in_a_row_are_one_request() {
        let start = Instant::now();
        let at = |milliseconds| start + Duration::from_millis(milliseconds);
        let mut requests = Requests::default();
        for now in [0, 0, 2, 40] {
            assert!(!requests.is_second(at(now)), "after {now} ms");
        }
        for now in [300, 301, 5000] {
            assert!(requests.is_second(at(now)), "after {now} ms");
        }
    }
}
