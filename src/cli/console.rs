//! Standard output, standard error and the progress bar between them.

use std::io::{ErrorKind, Write};

use indicatif::{ProgressBar, ProgressStyle};

use super::exit::Refusal;
use crate::error::Error;
use crate::render::film::Totals;

/// Prints to standard output; a reader that has gone (`flambeau keys | head`) is no error.
pub fn print(text: &str) -> Result<(), Refusal> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Error::io("standard output", error).into())
        }
        _ => Ok(()),
    }
}

/// Prints a line to standard error. Where that is closed or full there is nobody to tell, and the
/// work goes on.
pub fn warn(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "flambeau: {text}");
}

/// A progress bar of `steps` on standard error, shown only if that is a terminal.
pub fn progress_bar(steps: u64) -> ProgressBar {
    let bar = ProgressBar::new(steps);
    let style = ProgressStyle::with_template("{bar:40} {msg} · {elapsed} · {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// Warns of samples that are missing from a picture; `prefix` names the picture where there are
/// several.
pub fn warn_of_lost_samples(totals: &Totals, prefix: &str) {
    let (non_finite, guard_hits) = (totals.non_finite, totals.guard_hits);
    if non_finite > 0 {
        warn(&format!("{prefix}{non_finite} samples were not finite and count as black"));
    }
    if guard_hits > 0 {
        warn(&format!("{prefix}{guard_hits} paths were cut by the guard"));
    }
}
