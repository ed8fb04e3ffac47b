//! Rendering two settings of one scene without a window, on the same threads and in turns, so that
//! both have had the same share whenever they are compared.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::UVec2;

use super::compare::NoiseHistory;
use super::engine::{Engine, Step};
use super::estimate::{FilmStats, samples_per_pixel};
use super::film::Film;
use super::pool::{Failure, Pool, Priority};
use super::schedule::Limits;
use super::turns::{self, Account, Share};
use crate::error::Result;
use crate::transport::PixelSampler;

/// What to compare and for how long.
pub struct PairJob {
    /// What to sample for A and for B.
    pub samplers: [Arc<dyn PixelSampler>; 2],
    /// Width and height of both in pixels.
    pub size: UVec2,
    /// Samples a pixel of each side; 0: as many as fit the counts.
    pub spp: u32,
    /// CPU time of the sampling threads for each side, in seconds. With it the sides get equal
    /// shares of that, without it of samples. It ends with a whole piece of work, so it is exceeded
    /// by a little, which the sides tell.
    pub cpu_seconds: Option<f64>,
    /// Number of threads; none: one a core.
    pub threads: Option<usize>,
}

/// What became of one side.
pub struct RenderedSide {
    /// The film, consistent however the render ended.
    pub film: Film,
    /// CPU time of the threads that sampled it, in seconds.
    pub cpu_seconds: f64,
    /// Seconds during which they did.
    pub seconds: f64,
    /// How its noise went down.
    pub history: NoiseHistory,
    /// The sample that ended it.
    pub failure: Option<Failure>,
}

/// What became of both.
pub struct RenderedPair {
    /// A and B.
    pub sides: [RenderedSide; 2],
    /// The threads that rendered them.
    pub pool: Pool,
    /// Whether the interrupt ended it.
    pub interrupted: bool,
}

/// Renders both sides until their limits are reached or `interrupt` is set, calling `progress` after
/// every piece of work (a few times a second). A sample that cannot be taken ends both.
///
/// # Errors
/// When the films do not fit the memory or threads cannot be started.
pub fn render_side_by_side(
    job: PairJob,
    interrupt: &AtomicBool,
    progress: &mut dyn FnMut(&[Account; 2]),
) -> Result<RenderedPair> {
    let share = if job.cpu_seconds.is_some() { Share::CpuTime } else { Share::Samples };
    let pool = Pool::new(job.threads, Priority::Normal)?;
    let [a, b] = job.samplers;
    let limits = Limits { spp: job.spp, seconds: None };
    let mut sides = [
        Turning::new(Engine::new(a, Film::new(job.size)?, limits, None)),
        Turning::new(Engine::new(b, Film::new(job.size)?, limits, None)),
    ];
    let stop = || interrupt.load(Ordering::Relaxed);
    let mut accounts = [Account::default(); 2];
    let mut interrupted = false;
    while let Some(next) = turns::next(&accounts, share) {
        interrupted = stop();
        if interrupted {
            break;
        }
        let side = &mut sides[next];
        side.turn(&pool, limits, job.cpu_seconds, &stop);
        accounts[next] = side.account();
        if side.failure.is_some() {
            break;
        }
        progress(&accounts);
    }
    let sides = sides.map(|side| side.finish(&pool));
    Ok(RenderedPair { sides, pool, interrupted })
}

/// A side under way.
struct Turning {
    engine: Engine,
    history: NoiseHistory,
    closed: bool,
    failure: Option<Failure>,
}

impl Turning {
    fn new(engine: Engine) -> Self {
        Self { engine, history: NoiseHistory::default(), closed: false, failure: None }
    }

    /// Does one piece of work, no longer than what is left of `cpu_seconds`.
    fn turn(
        &mut self,
        pool: &Pool,
        limits: Limits,
        cpu_seconds: Option<f64>,
        stop: &(dyn Fn() -> bool + Sync),
    ) {
        if let Some(all) = cpu_seconds {
            // The schedule counts seconds in which all threads work.
            let left = (all - self.engine.cpu_seconds()) / pool.threads() as f64;
            let seconds = Some(self.engine.seconds() + left);
            self.engine.set_limits(Limits { seconds, ..limits });
        }
        match self.engine.step(pool, false, stop) {
            Step::Worked | Step::Interrupted => {}
            Step::Paused | Step::Done => self.closed = true,
            Step::Failed(failure) => (self.closed, self.failure) = (true, Some(failure)),
        }
        self.closed |= cpu_seconds.is_some_and(|all| self.engine.cpu_seconds() >= all);
        if self.history.wants(self.engine.cpu_seconds()) {
            self.note_noise(pool);
        }
    }

    /// Adds the present noise to the history, if every pixel has one.
    fn note_noise(&mut self, pool: &Pool) {
        let film = self.engine.film();
        let (fewest, _) = film.sample_range();
        if fewest < 2 {
            return;
        }
        if let Some(noise) = pool.install(|| FilmStats::of(film)).noise {
            self.history.push(self.engine.cpu_seconds(), noise);
        }
    }

    fn account(&self) -> Account {
        Account {
            cpu_seconds: self.engine.cpu_seconds(),
            samples: samples_per_pixel(self.engine.film()),
            closed: self.closed,
        }
    }

    fn finish(mut self, pool: &Pool) -> RenderedSide {
        self.note_noise(pool);
        let (cpu_seconds, seconds) = (self.engine.cpu_seconds(), self.engine.seconds());
        let (film, _) = self.engine.into_parts();
        RenderedSide { film, cpu_seconds, seconds, history: self.history, failure: self.failure }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::synthetic::{Level, Uniform};
    use crate::transport::PathSample;

    const SIZE: UVec2 = UVec2::new(40, 30);

    fn job(samplers: [Arc<dyn PixelSampler>; 2], spp: u32, cpu_seconds: Option<f64>) -> PairJob {
        PairJob { samplers, size: SIZE, spp, cpu_seconds, threads: Some(2) }
    }

    fn level(seed: u64) -> Arc<dyn PixelSampler> {
        Arc::new(Level { seed, mean: 1.0, spread: 1.0 })
    }

    /// B costs far more; both get their samples all the same, in step.
    #[test]
    fn with_a_number_of_samples_both_get_them_in_step() {
        let costly = Arc::new(Uniform { cost: 2000, ..Uniform::default() });
        let mut apart = 0.0_f64;
        let go_on = AtomicBool::new(false);
        let pair = render_side_by_side(job([level(0), costly], 70, None), &go_on, &mut |sides| {
            apart = apart.max((sides[0].samples - sides[1].samples).abs());
        });
        let pair = pair.unwrap();
        assert!(apart <= 64.0, "one side was {apart} samples ahead");
        assert!(!pair.interrupted);
        for side in &pair.sides {
            assert_eq!(side.film.sample_range(), (70, 70));
            assert!(side.history.points().last().unwrap()[0] <= side.cpu_seconds);
        }
        assert!(pair.sides[1].cpu_seconds > pair.sides[0].cpu_seconds);
    }

    /// The time is that of the threads, and no side gets less of it than was asked for.
    #[test]
    fn with_a_time_both_get_it() {
        let costly = Arc::new(Uniform { cost: 200, ..Uniform::default() });
        let go_on = AtomicBool::new(false);
        let job = job([level(0), costly], 0, Some(0.2));
        let pair = render_side_by_side(job, &go_on, &mut |_| {}).unwrap();
        assert!(pair.sides.iter().all(|side| side.cpu_seconds >= 0.2));
        let paths = pair.sides.map(|side| side.film.totals.paths);
        assert!(paths[0] > paths[1], "{paths:?}");
    }

    #[test]
    fn an_interrupt_ends_both_and_keeps_what_there_is() {
        let stop = AtomicBool::new(false);
        let mut pieces = 0;
        let pair = render_side_by_side(job([level(0), level(1)], 0, None), &stop, &mut |_| {
            pieces += 1;
            stop.store(pieces == 20, Ordering::Relaxed);
        });
        let pair = pair.unwrap();
        assert!(pair.interrupted && pieces == 20);
        assert!(pair.sides.iter().all(|side| side.film.totals.paths > 0));
    }

    #[test]
    fn a_failure_ends_both() {
        struct Faulty;
        impl PixelSampler for Faulty {
            fn sample(&self, _: UVec2, sample: u32) -> PathSample {
                assert!(sample < 2, "a fault on purpose");
                PathSample::default()
            }
        }
        let go_on = AtomicBool::new(false);
        let job = job([level(0), Arc::new(Faulty)], 0, None);
        let pair = render_side_by_side(job, &go_on, &mut |_| {}).unwrap();
        assert!(pair.sides[0].failure.is_none());
        assert!(pair.sides[1].failure.as_ref().unwrap().message.contains("on purpose"));
    }
}
