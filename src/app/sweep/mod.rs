//! A sweep of every strategy on the shot, on a thread of its own, while the live render waits.
//!
//! - `results`: the ranking in a window; `bar`: its bars.

pub mod bar;
pub mod results;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

use glam::UVec2;

use super::jobs::live_render::{LiveRender, same_shot};
use crate::error::{Error, Result};
use crate::render::pool::{Pool, Priority};
use crate::render::sweep::{
    DEFAULT_SECONDS, Ranking, SweepJob, SweepProgress, Trial, plan, quick_size, sweep,
};
use crate::render::time_slice::Amount;
use crate::scene::Settings;
use crate::scene::effect::no_effect_with;
use crate::transport::Scene;

/// The part of a sweep after which every strategy has begun, which takes longer than to go on.
const SET_UP: f64 = 0.1;
/// Fraction of the sweep behind that by which its pace is known.
const PACED: f64 = 0.05;

/// The sweep under way and the results of the last one.
pub struct Sweep {
    /// CPU seconds of each strategy.
    pub seconds: f64,
    /// Whether the results are shown, once there are any.
    pub open: bool,
    /// Whether the sweep starts as soon as the scene is built.
    wanted: bool,
    running: Option<Running>,
    results: Option<Results>,
    threads: Option<usize>,
}

/// The results of a sweep.
pub struct Results {
    /// The settings of the shot.
    settings: Settings,
    /// The strategies, ranked.
    pub ranking: Ranking,
    /// Whether the sweep was cancelled before all strategies had their time.
    pub interrupted: bool,
}

/// A sweep under way. Dropping it stops it.
struct Running {
    settings: Settings,
    stop: Arc<AtomicBool>,
    reports: mpsc::Receiver<SweepReport>,
    progress: SweepProgress,
    /// Time and fraction at which all strategies were at work, so that the pace is known.
    since: Option<(Instant, f64)>,
}

/// A report of the thread.
enum SweepReport {
    Progress(SweepProgress),
    /// The ranking and whether it was cancelled before its end, or what failed.
    Ended(Result<(Ranking, bool)>),
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

impl Sweep {
    /// No sweep yet; one will have `threads` workers (`None`: as many as fit).
    pub fn new(threads: Option<usize>) -> Self {
        let (seconds, open) = (DEFAULT_SECONDS, false);
        Self { seconds, open, wanted: false, running: None, results: None, threads }
    }

    /// Asks for a new sweep, or for the results if they are there and were closed.
    pub fn request(&mut self, settings: &Settings) {
        let known = self.results.as_ref().is_some_and(|results| !results.is_stale(settings));
        self.wanted = self.running.is_none() && (self.open || !known);
        self.open = true;
    }

    /// Ends the sweep under way; what it has found so far becomes the result.
    pub fn cancel(&mut self) {
        self.wanted = false;
        if let Some(running) = &self.running {
            running.stop.store(true, Ordering::Relaxed);
        }
    }

    /// Lets go of everything, as another scene was opened.
    pub fn forget(&mut self) {
        (self.running, self.results, self.wanted) = (None, None, false);
    }

    /// The results of the last sweep.
    pub fn results(&self) -> Option<&Results> {
        self.results.as_ref()
    }

    /// Whether the sweep runs or is about to.
    pub fn is_running(&self) -> bool {
        self.wanted || self.running.is_some()
    }

    /// Progress of the sweep while it runs, and the time left once that is known.
    pub fn progress(&self) -> Option<(SweepProgress, Option<Duration>)> {
        let Some(running) = &self.running else {
            return self.wanted.then_some((SweepProgress::Preparing(0, 1), None));
        };
        let left = match running.progress {
            SweepProgress::Rendering(part) => {
                let since = running.since.filter(|(_, then)| part > then + PACED);
                since.map(|(since, then)| since.elapsed().mul_f64((1.0 - part) / (part - then)))
            }
            _ => None,
        };
        Some((running.progress, left))
    }

    /// Whether the live render of `settings` waits, so that the strategies have the machine. Not
    /// once that shows something else.
    pub fn holds(&self, settings: &Settings) -> bool {
        self.running.as_ref().is_some_and(|running| same_shot(&running.settings, settings))
    }

    /// Takes in what the thread has done, and starts what was asked for once the scene of
    /// `settings` is built, for a film of `size`. `wake` asks the window for a frame.
    ///
    /// # Errors
    /// When a strategy cannot be rendered or the system refuses to start threads.
    pub fn update(
        &mut self,
        settings: &Settings,
        live_render: &LiveRender,
        size: UVec2,
        wake: impl Fn() + Send + 'static,
    ) -> Result<()> {
        let scene = live_render.built().filter(|built| same_shot(&built.settings, settings));
        if let Some(built) = scene.filter(|_| self.wanted && self.running.is_none()) {
            self.wanted = false;
            self.running = Some(self.start(settings, built.scene.clone(), size, wake)?);
        }
        let Some(running) = &mut self.running else { return Ok(()) };
        let Some(ended) = running.poll() else { return Ok(()) };
        let settings = running.settings.clone();
        self.running = None;
        let (ranking, interrupted) = match ended {
            Ok(ended) => ended,
            Err(Error::Cancelled) => return Ok(()),
            Err(error) => return Err(error),
        };
        self.results = Some(Results { settings, ranking, interrupted });
        self.open = true;
        Ok(())
    }

    fn start(
        &self,
        settings: &Settings,
        scene: Arc<Scene>,
        size: UVec2,
        wake: impl Fn() + Send + 'static,
    ) -> Result<Running> {
        let (sender, reports) = mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let trials = plan(&settings.strategy, &|toggle, strategy| {
            no_effect_with(toggle, settings, strategy)
        });
        let work = SweepWork {
            scene,
            trials,
            size: quick_size(size),
            seed: settings.picture_seed(),
            seconds: self.seconds,
            threads: self.threads,
            stop: stop.clone(),
        };
        let run = move || {
            let report = |report| {
                // Nobody listens any more where another scene was opened meanwhile.
                let _ = sender.send(report);
                wake();
            };
            let ended = work.run(&mut |progress| report(SweepReport::Progress(progress)));
            report(SweepReport::Ended(ended));
        };
        std::thread::Builder::new()
            .name("sweep".to_owned())
            .spawn(run)
            .map_err(|error| Error::io("the thread that tries strategies", error))?;
        let (settings, progress) = (settings.clone(), SweepProgress::Preparing(0, 1));
        Ok(Running { settings, stop, reports, progress, since: None })
    }
}

impl Results {
    /// Whether the scene, the camera or a finer choice of the strategy has changed since the sweep.
    pub fn is_stale(&self, settings: &Settings) -> bool {
        let (tried, now) = (&self.settings.strategy, &settings.strategy);
        !same_shot(&self.settings, settings)
            || tried.advanced != now.advanced
            || tried.integrator != now.integrator
    }
}

impl Running {
    /// Takes in what the thread has done; the result of the sweep, once it has ended.
    fn poll(&mut self) -> Option<Result<(Ranking, bool)>> {
        loop {
            match self.reports.try_recv() {
                Ok(SweepReport::Progress(progress)) => {
                    if let SweepProgress::Rendering(part) = progress
                        && part > SET_UP
                        && self.since.is_none()
                    {
                        self.since = Some((Instant::now(), part));
                    }
                    self.progress = progress;
                }
                Ok(SweepReport::Ended(ended)) => return Some(ended),
                Err(mpsc::TryRecvError::Empty) => return None,
                Err(mpsc::TryRecvError::Disconnected) => {
                    let reason = "the sweep was interrupted; sweep again";
                    return Some(Err(Error::invalid("", "", reason)));
                }
            }
        }
    }
}

/// The work of the thread.
struct SweepWork {
    scene: Arc<Scene>,
    trials: Vec<Trial>,
    size: UVec2,
    seed: u64,
    seconds: f64,
    threads: Option<usize>,
    stop: Arc<AtomicBool>,
}

impl SweepWork {
    fn run(&self, progress: &mut dyn FnMut(SweepProgress)) -> Result<(Ranking, bool)> {
        let pool = Pool::new(self.threads, Priority::Background)?;
        let job = SweepJob {
            scene: &self.scene,
            trials: &self.trials,
            size: self.size,
            seed: self.seed,
            amount: Amount { spp: 0, cpu_seconds: Some(self.seconds), evenly: true },
        };
        let swept = sweep(&job, &pool, &self.stop, progress)?;
        if let Some((number, failure)) = &swept.failure {
            let name = self.trials[*number].kind.name();
            return Err(Error::invalid("", "", format!("{name}: {failure}")));
        }
        Ok((swept.ranking(&self.trials), swept.interrupted))
    }
}
