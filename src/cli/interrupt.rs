//! Ctrl-C: what there is gets written.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::exit::Exit;
use crate::error::{Error, Result};

/// After an interrupt, another one this much later ends the program without waiting for files.
const IMPATIENCE: Duration = Duration::from_secs(1);

/// A flag that Ctrl-C sets, and so does a polite request to end, as render farms and terminals
/// that close send it; another one later ends the program at once.
pub fn listen_for_interrupt() -> Result<Arc<AtomicBool>> {
    let interrupt = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupt);
    let mut first = None;
    ctrlc::set_handler(move || {
        flag.store(true, Ordering::Relaxed);
        // `timeout` sends its signal twice in a row; only a later one means that writing shall stop.
        if first.get_or_insert_with(Instant::now).elapsed() > IMPATIENCE {
            std::process::exit(Exit::Interrupted as i32);
        }
    })
    .map_err(|e| Error::invalid("", "Ctrl-C", format!("cannot listen for it: {e}")))?;
    Ok(interrupt)
}
