//! Several renders of one scene that take turns on the same threads, in time slices, so that all
//! have had the same share whenever they are compared.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::UVec2;

use super::compare::NoiseHistory;
use super::estimate::{FEWEST_FOR_VARIANCE, FilmStats, samples_per_pixel};
use super::film::Film;
use super::pool::{Failure, Pool};
use super::progressive::{ProgressiveRender, RenderStep};
use super::schedule::Limits;
use super::turns::{self, Share, Usage};
use crate::error::Result;
use crate::transport::PixelSampler;

/// A side after its last time slice.
pub struct RenderedSide {
    /// The film, consistent however the render ended.
    pub film: Film,
    /// CPU time of the threads that sampled it, in seconds.
    pub cpu_seconds: f64,
    /// Wall time during which the threads sampled it, in seconds.
    pub seconds: f64,
    /// History of the noise of the side.
    pub history: NoiseHistory,
    /// Failure of the sample that ended the render.
    pub failure: Option<Failure>,
}

/// Amount of rendering per side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Amount {
    /// Samples a pixel; 0: as many as fit the counts.
    pub spp: u32,
    /// CPU time of the sampling threads, in seconds. With it the sides get equal shares of that,
    /// without it of samples. It ends with a whole piece of work, so it is exceeded by a little,
    /// which the sides tell.
    pub cpu_seconds: Option<f64>,
    /// Whether all pixels get equally many samples, two at least, whatever time that takes. Where
    /// there are few of them, one part of the picture would else count more than the other.
    pub evenly: bool,
}

impl Amount {
    /// Fraction of the amount that a side has had, in 0..=1; 0 where there is no limit.
    pub fn part(&self, usage: &Usage) -> f64 {
        let by_samples = if self.spp > 0 { usage.samples / f64::from(self.spp) } else { 0.0 };
        let by_time = self.cpu_seconds.map_or(0.0, |end| usage.cpu_seconds / end);
        by_samples.max(by_time).min(1.0)
    }

    fn limits(&self) -> Limits {
        Limits { spp: self.spp, seconds: None }
    }
}

/// Lets the sides have their turns until each has its amount or `interrupt` is set, calling
/// `progress` after every piece of work (a few times a second). A sample that cannot be taken ends
/// all of them. Whether the interrupt did.
pub(super) fn take_turns(
    sides: &mut [SideInProgress],
    pool: &Pool,
    interrupt: &AtomicBool,
    progress: &mut dyn FnMut(&[Usage]),
) -> bool {
    let by_time = sides.iter().any(|side| side.amount.cpu_seconds.is_some());
    let share = if by_time { Share::CpuTime } else { Share::Samples };
    let stop = || interrupt.load(Ordering::Relaxed);
    let mut usages = vec![Usage::default(); sides.len()];
    while let Some(next) = turns::next(&usages, share) {
        if stop() {
            return true;
        }
        let side = &mut sides[next];
        side.turn(pool, &stop);
        usages[next] = side.usage();
        if side.failure.is_some() {
            break;
        }
        progress(&usages);
    }
    false
}

/// A side that is being rendered.
pub(super) struct SideInProgress {
    render: ProgressiveRender,
    amount: Amount,
    history: NoiseHistory,
    closed: bool,
    failure: Option<Failure>,
}

impl SideInProgress {
    /// A side that has had nothing yet.
    ///
    /// # Errors
    /// When its film does not fit the memory.
    pub fn new(sampler: Arc<dyn PixelSampler>, size: UVec2, amount: Amount) -> Result<Self> {
        let render = ProgressiveRender::new(sampler, Film::new(size)?, amount.limits(), None);
        let history = NoiseHistory::default();
        Ok(Self { render, amount, history, closed: false, failure: None })
    }

    /// Does one piece of work, no longer than the CPU time left.
    fn turn(&mut self, pool: &Pool, stop: &(dyn Fn() -> bool + Sync)) {
        if let Some(all) = self.amount.cpu_seconds {
            let left = all - self.render.cpu_seconds();
            self.render.set_limits(self.limits(left, pool.threads()));
        }
        match self.render.step(pool, false, stop, stop) {
            RenderStep::Worked | RenderStep::Interrupted => {}
            RenderStep::Paused | RenderStep::Done => self.closed = true,
            RenderStep::Failed(failure) => (self.closed, self.failure) = (true, Some(failure)),
        }
        let is_over = |all: f64| self.render.cpu_seconds() >= all;
        self.closed |= self.amount.cpu_seconds.is_some_and(is_over) && !self.is_uneven();
        if self.history.wants(self.render.cpu_seconds()) {
            self.note_noise(pool);
        }
    }

    /// Limits of the next piece of work, with `left` seconds of CPU time to go. Work goes beyond
    /// them only to bring all pixels to the same number of samples.
    fn limits(&self, left: f64, threads: usize) -> Limits {
        let limits = self.amount.limits();
        if left > 0.0 {
            // The schedule counts seconds in which all threads work.
            let seconds = Some(self.render.seconds() + left / threads as f64);
            return Limits { seconds, ..limits };
        }
        let (_, most) = self.render.film().sample_range();
        Limits { spp: most.max(FEWEST_FOR_VARIANCE), seconds: None }
    }

    /// Whether some pixels still lack samples that others have.
    fn is_uneven(&self) -> bool {
        let (fewest, most) = self.render.film().sample_range();
        self.amount.evenly && (fewest < most || fewest < FEWEST_FOR_VARIANCE)
    }

    /// Adds the present noise to the history, once every pixel has a variance.
    fn note_noise(&mut self, pool: &Pool) {
        let film = self.render.film();
        let (fewest, _) = film.sample_range();
        if fewest < FEWEST_FOR_VARIANCE {
            return;
        }
        if let Some(noise) = pool.install(|| FilmStats::of(film)).noise {
            self.history.push(self.render.cpu_seconds(), noise);
        }
    }

    fn usage(&self) -> Usage {
        Usage {
            cpu_seconds: self.render.cpu_seconds(),
            samples: samples_per_pixel(self.render.film()),
            closed: self.closed,
        }
    }

    /// Ends the render of the side.
    pub fn finish(mut self, pool: &Pool) -> RenderedSide {
        self.note_noise(pool);
        let (cpu_seconds, seconds) = (self.render.cpu_seconds(), self.render.seconds());
        let (film, _) = self.render.into_parts();
        RenderedSide { film, cpu_seconds, seconds, history: self.history, failure: self.failure }
    }
}
