//! The cost of the window itself, for diagnosis: with the environment variable
//! `FLAMBEAU_FRAME_STATS` set to a file name, the figures are written there as JSON on exit.

use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Collects the figures of one run; absent unless asked for.
#[derive(Debug)]
pub struct FrameStats {
    file: PathBuf,
    opened: Instant,
    last: Option<(Instant, Option<Duration>)>,
    intervals: Vec<f64>,
    cpu: Vec<f64>,
    first_picture: Option<f64>,
    edit: Option<(Option<u64>, Instant)>,
    edits: Vec<f64>,
}

impl FrameStats {
    /// A collector when the environment asks for one.
    pub fn from_env() -> Option<Self> {
        let file = PathBuf::from(std::env::var_os("FLAMBEAU_FRAME_STATS")?);
        Some(Self {
            file,
            opened: Instant::now(),
            last: None,
            intervals: Vec::new(),
            cpu: Vec::new(),
            first_picture: None,
            edit: None,
            edits: Vec::new(),
        })
    }

    /// Marks the start of a frame. The CPU time between two starts is all that this thread did:
    /// input, layout, tessellation, upload and submission.
    pub fn frame(&mut self) {
        let now = (Instant::now(), thread_cpu());
        if let Some((time, cpu)) = self.last.replace(now) {
            self.intervals.push(milliseconds(now.0 - time));
            if let (Some(before), Some(after)) = (cpu, now.1) {
                self.cpu.push(milliseconds(after.saturating_sub(before)));
            }
        }
    }

    /// Marks the moment of an edit. Of edits that overtake one another the first counts.
    pub fn edited(&mut self) {
        self.edit.get_or_insert_with(|| (None, Instant::now()));
    }

    /// Marks the start of pictures of `generation`, which answer the edit.
    pub fn started(&mut self, generation: u64) {
        if let Some((wanted, _)) = &mut self.edit {
            wanted.get_or_insert(generation);
        }
    }

    /// Marks that a picture of `generation` is about to be shown.
    pub fn shown(&mut self, generation: u64) {
        let opened = self.opened;
        self.first_picture.get_or_insert_with(|| opened.elapsed().as_secs_f64());
        if let Some((_, since)) =
            self.edit.take_if(|(wanted, _)| wanted.is_some_and(|wanted| generation >= wanted))
        {
            self.edits.push(milliseconds(since.elapsed()));
        }
    }

    /// Writes the figures.
    pub fn write(&self) {
        let figures = serde_json::json!({
            "frames": self.intervals.len() + 1,
            "first_picture_seconds": self.first_picture,
            "ui_cpu_ms": summary(&self.cpu),
            "frame_interval_ms": summary(&self.intervals),
            "edit_to_picture_ms": summary(&self.edits),
            "frame_interval_ms_all": self.intervals,
            "ui_cpu_ms_all": self.cpu,
            "edit_to_picture_ms_all": self.edits,
        });
        if let Err(error) = std::fs::write(&self.file, format!("{figures:#}\n")) {
            eprintln!("{}: {error}", self.file.display());
        }
    }
}

fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

fn summary(values: &[f64]) -> serde_json::Value {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |fraction: f64| {
        let last = sorted.len().saturating_sub(1) as f64;
        sorted.get((fraction * last).round() as usize).copied()
    };
    serde_json::json!({ "count": sorted.len(), "median": at(0.5), "p95": at(0.95), "max": at(1.0) })
}

#[cfg(unix)]
fn thread_cpu() -> Option<Duration> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::try_from(time).ok()
}

#[cfg(not(unix))]
fn thread_cpu() -> Option<Duration> {
    None
}
