//! Rendering without a window.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::UVec2;

use super::film::Film;
use super::pool::{Failure, Pool, Priority};
use super::progressive::{ProgressiveRender, RenderStep};
use super::schedule::Limits;
use crate::error::{Error, Result};
use crate::transport::PixelSampler;

/// A render without a window: its sampler and its limits.
pub struct RenderJob {
    /// Sampler of the pixels.
    pub sampler: Arc<dyn PixelSampler>,
    /// Width and height in pixels.
    pub size: UVec2,
    /// Limits of samples and time; whatever the time, the render does not stop before every pixel
    /// has a sample. With neither limit only the interrupt ends it.
    pub limits: Limits,
    /// A film to go on from.
    pub resume: Option<Film>,
    /// Number of threads; `None`: one per core.
    pub threads: Option<usize>,
}

/// Result of a render without a window.
pub struct Headless {
    /// The film, consistent however the render ended.
    pub film: Film,
    /// Threads that rendered the film.
    pub pool: Pool,
    /// Seconds of rendering.
    pub seconds: f64,
    /// Whether the interrupt ended the render.
    pub interrupted: bool,
    /// Failure of the sample that ended the render.
    pub failure: Option<Failure>,
}

/// Renders until a limit is reached or `interrupt` is set, calling `progress` with the film and
/// the seconds so far after every piece of work (a few times a second).
///
/// # Errors
/// When the film does not fit the memory, `resume` has another size or threads cannot be started.
pub fn render_headless(
    job: RenderJob,
    interrupt: &AtomicBool,
    progress: &mut dyn FnMut(&Film, f64),
) -> Result<Headless> {
    let film = match job.resume {
        Some(film) => same_size(film, job.size)?,
        None => Film::new(job.size)?,
    };
    let pool = Pool::new(job.threads, Priority::Normal)?;
    let untimed = Limits { seconds: None, ..job.limits };
    let mut engine = ProgressiveRender::new(job.sampler, film, untimed, None);
    let stop = || interrupt.load(Ordering::Relaxed);
    let mut failure = None;
    let interrupted = loop {
        if engine.is_complete() {
            engine.set_limits(job.limits);
        }
        if stop() && !engine.is_finished() {
            break true;
        }
        match engine.step(&pool, false, &stop, &stop) {
            RenderStep::Worked => progress(engine.film(), engine.seconds()),
            RenderStep::Interrupted => {}
            RenderStep::Paused | RenderStep::Done => break false,
            RenderStep::Failed(what) => {
                failure = Some(what);
                break false;
            }
        }
    };
    let seconds = engine.seconds();
    let (film, _) = engine.into_parts();
    Ok(Headless { film, pool, seconds, interrupted, failure })
}

/// `film`, if it has the wanted size.
pub(crate) fn same_size(film: Film, size: UVec2) -> Result<Film> {
    if film.size() == size {
        return Ok(film);
    }
    let was = film.size();
    let reason = format!(
        "the picture to continue has {} x {} pixels and the scene asks for {} x {}",
        was.x, was.y, size.x, size.y
    );
    Err(Error::invalid("", "film.size", reason))
}
