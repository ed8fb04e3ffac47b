//! A sweep renders every toggle alone and left out, for a few seconds each. It finds the strategy
//! to leave on for a shot, the gain of each toggle alone, and the loss without it.
//!
//! [`plan()`] lists the trials, [`sweep`] renders them in time slices on the same threads,
//! [`Ranking`] compares them pairwise as a comparison of two does, and [`words`] puts the result
//! into sentences.
//!
//! Noise is measured on a film of few pixels: the mean variance of a pixel and the cost of a path
//! depend on the shot and hardly on the number of pixels. So a few seconds bring each pixel enough
//! samples to estimate its variance from.

mod plan;
mod ranking;
pub mod words;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::UVec2;

pub use plan::{Idle, Trial, TrialKind, TrialSource, plan};
pub use ranking::{Gain, RankedTrial, Ranking, Worth};

use super::compare::SideFigures;
use super::estimate::FEWEST_FOR_VARIANCE;
use super::film::Totals;
use super::pool::{Failure, Pool};
use super::time_slice::{Amount, RenderedSide, SideInProgress, take_turns};
use super::turns::Usage;
use crate::error::{self, Error, Result, report};
use crate::transport::prepare::SceneProbes;
use crate::transport::probes::Probes;
use crate::transport::spending::Spending;
use crate::transport::strategy::Strategy;
use crate::transport::{Frame, PixelSampler, PreparedFrame, Scene};

/// Default CPU seconds of each strategy.
pub const DEFAULT_SECONDS: f64 = 3.0;

/// Most pixels of a film whose size is not set.
const MOST_PIXELS: f32 = 8192.0;

/// Size of a film that is quick to measure and representative of one of `size` pixels.
pub fn quick_size(size: UVec2) -> UVec2 {
    let pixels = size.x as f32 * size.y as f32;
    let scale = (MOST_PIXELS / pixels.max(1.0)).sqrt().min(1.0);
    (size.as_vec2() * scale).round().as_uvec2().max(UVec2::ONE)
}

/// A sweep: the scene, its trials and their limits.
pub struct SweepJob<'a> {
    /// The scene; its own strategy does not matter.
    pub scene: &'a Scene,
    /// The strategies.
    pub trials: &'a [Trial],
    /// Width and height of the films in pixels.
    pub size: UVec2,
    /// Seed of the random numbers of all trials.
    pub seed: u64,
    /// Amount of rendering per trial.
    pub amount: Amount,
}

/// Progress of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SweepProgress {
    /// Number of strategies that have their probes and their pilot, and number of all.
    Preparing(usize, usize),
    /// Rendering: the fraction of the samples or of the time that is spent, in 0..=1.
    Rendering(f64),
}

/// Film and figures of a rendered trial.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tried {
    /// Noise and cost.
    pub side: SideFigures,
    /// Counts of what was done.
    pub totals: Totals,
}

/// Results of a sweep.
pub struct Swept {
    /// Result of each trial; `None` for those that were not rendered.
    pub tried: Vec<Option<Tried>>,
    /// Whether the interrupt ended the sweep.
    pub interrupted: bool,
    /// Number of the trial that ended the sweep, and the sample that could not be taken.
    pub failure: Option<(usize, Failure)>,
}

impl Swept {
    /// Ranks the trials that these results belong to.
    pub fn ranking(&self, trials: &[Trial]) -> Ranking {
        let sides: Vec<Option<SideFigures>> =
            self.tried.iter().map(|tried| tried.map(|tried| tried.side)).collect();
        Ranking::new(trials, &sides)
    }
}

/// Renders the trials on the threads of `pool` until each has its amount or `interrupt` is set,
/// calling `progress` a few times a second. A sample that cannot be taken ends all.
///
/// # Errors
/// When the films do not fit the memory, or the interrupt comes before anything is rendered.
pub fn sweep(
    job: &SweepJob<'_>,
    pool: &Pool,
    interrupt: &AtomicBool,
    progress: &mut dyn FnMut(SweepProgress),
) -> Result<Swept> {
    let frames = prepare_all(job, pool, interrupt, progress)?;
    let numbers: Vec<usize> = frames.iter().map(|(number, _)| *number).collect();
    let spending: Vec<Option<Spending>> =
        frames.iter().map(|(_, frame)| frame.spending().copied()).collect();
    let begin = |(_, frame): (usize, PreparedFrame)| {
        let sampler: Arc<dyn PixelSampler> = Arc::new(frame);
        SideInProgress::new(sampler, job.size, job.amount)
    };
    let mut sides = frames.into_iter().map(begin).collect::<Result<Vec<_>>>()?;
    let interrupted = take_turns(&mut sides, pool, interrupt, &mut |usages| {
        let part = |usage: &Usage| job.amount.part(usage);
        let sum: f64 = usages.iter().map(part).sum();
        progress(SweepProgress::Rendering(sum / usages.len() as f64));
    });
    let mut swept = Swept { tried: vec![None; job.trials.len()], interrupted, failure: None };
    for ((number, spending), side) in std::iter::zip(numbers.into_iter().zip(spending), sides) {
        let rendered = side.finish(pool);
        let side = SideFigures { spending, ..pool.install(|| measured(&rendered)) };
        swept.tried[number] = Some(Tried { side, totals: rendered.film.totals });
        swept.failure = swept.failure.or(rendered.failure.map(|failure| (number, failure)));
    }
    Ok(swept)
}

/// Noise and cost of a strategy; no noise where some pixels have none yet, as those that do are no
/// fair part of the picture.
fn measured(rendered: &RenderedSide) -> SideFigures {
    let side = SideFigures::of(&rendered.film, rendered.cpu_seconds);
    match side.fewest_samples < FEWEST_FOR_VARIANCE {
        true => SideFigures { variance_of_mean: None, variance_error: None, noise: None, ..side },
        false => side,
    }
}

/// Frames the scene with every strategy that is to be rendered; their probes, placed once for all
/// that have the same, and their pilots are then no part of the rendering.
fn prepare_all(
    job: &SweepJob<'_>,
    pool: &Pool,
    interrupt: &AtomicBool,
    progress: &mut dyn FnMut(SweepProgress),
) -> Result<Vec<(usize, PreparedFrame)>> {
    let go_on = |_: f32| !interrupt.load(Ordering::Relaxed);
    let is_rendered = |(_, trial): &(usize, &Trial)| trial.source == TrialSource::Rendered;
    let rendered: Vec<(usize, &Trial)> =
        job.trials.iter().enumerate().filter(is_rendered).collect();
    let mut known: Vec<(Strategy, Arc<SceneProbes>)> = Vec::new();
    let mut frames = Vec::with_capacity(rendered.len());
    for (done, (number, trial)) in rendered.iter().enumerate() {
        progress(SweepProgress::Preparing(done, rendered.len()));
        let scene = job.scene.clone().with_strategy(trial.strategy);
        let frame = pool.install(|| {
            let probes = probes(&scene, &mut known, &go_on)?;
            let (scene, size) = (Arc::new(scene), job.size);
            let frame = Frame::try_with_probes(scene, size, job.seed, probes, &go_on)?;
            let frame = frame.prepared(&go_on)?;
            report(&go_on, 1.0)?;
            Ok::<_, Error>(frame)
        })?;
        frames.push((*number, frame));
    }
    Ok(frames)
}

/// The probes of a scene, if its strategy asks for any: those of `known` that are the same, or new
/// ones, which are known from then on.
fn probes(
    scene: &Scene,
    known: &mut Vec<(Strategy, Arc<SceneProbes>)>,
    go_on: error::Progress,
) -> Result<Option<Arc<SceneProbes>>> {
    let Some(recipe) = Probes::recipe(scene.strategy()) else { return Ok(None) };
    if let Some((_, probes)) = known.iter().find(|(other, _)| *other == recipe) {
        return Ok(Some(probes.clone()));
    }
    let probes = SceneProbes::placed(scene, go_on)?.map(Arc::new);
    known.extend(probes.clone().map(|probes| (recipe, probes)));
    Ok(probes)
}

#[cfg(test)]
mod tests;
