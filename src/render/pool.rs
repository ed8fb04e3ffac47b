//! The pool of sampling threads, and the one loop that samples.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};

use glam::UVec2;
use rayon::prelude::*;

use super::coarse::representative;
use super::film::{Film, Sums, TILE, Totals, add_sample, row_pixels};
use super::schedule::Work;
use super::thread_time::thread_seconds;
use crate::error::{Error, Result};
use crate::transport::{PixelSampler, Prepared, SampleNumber};

/// Priority of the threads against other programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Priority {
    /// Normal priority, that of any other program.
    Normal,
    /// Lower priority than others, so that a window stays fluent while all cores sample. On systems
    /// other than Linux the same as [`Priority::Normal`].
    Background,
}

/// A private pool of sampling threads.
pub struct Pool {
    threads: rayon::ThreadPool,
}

/// A sample that could not be taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The pixel and the sample in question; none where the render could not begin.
    pub at: Option<(UVec2, u32)>,
    /// The reason.
    pub message: String,
}

impl Failure {
    /// The options of `flambeau replay` that follow the failed path, given a scene, the film's
    /// size and the seed.
    pub fn replay_options(&self) -> Option<String> {
        self.at.map(|(pixel, sample)| format!("--pixel {},{} --sample {sample}", pixel.x, pixel.y))
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.at {
            Some((pixel, sample)) => {
                let message = &self.message;
                write!(f, "pixel {},{} failed at sample {sample}: {message}", pixel.x, pixel.y)
            }
            None => f.write_str(&self.message),
        }
    }
}

/// The outcome of a piece of work.
#[derive(Debug)]
pub struct WorkOutcome {
    /// Counts of the work done, complete or not.
    pub totals: Totals,
    /// CPU time that the threads spent on the work, in seconds, without that of a sampler's own
    /// threads.
    pub cpu_seconds: f64,
    /// Whether the whole piece was done.
    pub complete: bool,
    /// First failure that a thread reported.
    pub failure: Option<Failure>,
}

impl Pool {
    /// Starts `threads` threads, or as many as the machine has cores.
    ///
    /// # Errors
    /// When the system refuses to start them.
    pub fn new(threads: Option<usize>, priority: Priority) -> Result<Self> {
        let threads = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.unwrap_or(0))
            .thread_name(|index| format!("sampler {index}"))
            .start_handler(move |_| {
                if priority == Priority::Background {
                    yield_to_others();
                }
            })
            .build()
            .map_err(|e| Error::invalid("", "threads", format!("cannot start threads: {e}")))?;
        Ok(Self { threads })
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.threads.current_num_threads()
    }

    /// Runs parallel iterators of `f` on these threads.
    pub fn install<R: Send>(&self, f: impl FnOnce() -> R + Send) -> R {
        self.threads.install(f)
    }

    /// Runs the pilot pass of `sampler` on these threads; `None` if `stop` said so earlier.
    ///
    /// # Errors
    /// The failure of a thread.
    pub fn prepare(
        &self,
        sampler: &dyn PixelSampler,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<Prepared>, Failure> {
        let go_on = |_: f32| !stop();
        let prepare = || self.threads.install(|| sampler.prepare(&go_on));
        let message = match catch_unwind(AssertUnwindSafe(prepare)) {
            Ok(Ok(prepared)) => return Ok(Some(prepared)),
            Ok(Err(Error::Cancelled)) => return Ok(None),
            Ok(Err(error)) => error.to_string(),
            Err(panic) => panic_message(&*panic),
        };
        Err(Failure { at: None, message })
    }

    /// Does `work` on `film`. Without `prepared` only first samples are taken. `stop` is asked
    /// before every sample; a piece broken off leaves the film consistent, and doing the same work
    /// again completes it.
    pub fn sample(
        &self,
        film: &mut Film,
        sampler: &dyn PixelSampler,
        prepared: Option<&Prepared>,
        work: &Work,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> WorkOutcome {
        let failure = Mutex::new(None);
        let row =
            RowContext { sampler, prepared, work, size: film.size(), tiles: film.tiles(), stop };
        let first_row = work.tiles.start * TILE as usize;
        let (counts, sums) = film.tiles_mut(work.tiles.clone());
        let Done { totals, cpu_seconds, complete } = self.threads.install(|| {
            counts
                .par_chunks_mut(TILE as usize)
                .zip(sums.par_chunks_mut(TILE as usize))
                .enumerate()
                .with_max_len(rows_at_once(work.stride))
                .map(|(index, (counts, sums))| {
                    row.sample(first_row + index, counts, sums, &failure)
                })
                .reduce(Done::nothing, Done::plus)
        });
        film.totals = film.totals.plus(totals);
        let failure = failure.into_inner().unwrap_or_else(PoisonError::into_inner);
        WorkOutcome { totals, cpu_seconds, complete: complete && failure.is_none(), failure }
    }
}

/// Number of rows of a tile that a thread takes at once: enough for a path or more at that stride.
fn rows_at_once(stride: u32) -> usize {
    (stride * stride / TILE).max(1) as usize
}

/// The outcome of some rows.
struct Done {
    totals: Totals,
    cpu_seconds: f64,
    complete: bool,
}

impl Done {
    fn nothing() -> Self {
        Self { totals: Totals::default(), cpu_seconds: 0.0, complete: true }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            totals: self.totals.plus(other.totals),
            cpu_seconds: self.cpu_seconds + other.cpu_seconds,
            complete: self.complete && other.complete,
        }
    }
}

/// The values that the rows of one piece of work share.
struct RowContext<'a> {
    sampler: &'a dyn PixelSampler,
    prepared: Option<&'a Prepared>,
    work: &'a Work,
    size: UVec2,
    tiles: UVec2,
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl RowContext<'_> {
    /// Whether pixels of the row that begins with `first` stand for a block.
    fn has_work(&self, first: UVec2, width: u32) -> bool {
        width > 0 && representative(first, self.work.stride, self.size).y == first.y
    }

    /// The sample with that index, if it may be taken.
    fn number(&self, index: u32) -> Option<SampleNumber<'_>> {
        match (index, self.prepared) {
            (0, _) => Some(SampleNumber::First),
            (_, prepared) => prepared.map(|prepared| SampleNumber::Later(index, prepared)),
        }
    }

    /// Samples one row of a tile.
    fn sample(
        &self,
        row: usize,
        counts: &mut [u32],
        sums: &mut [Sums],
        failure: &Mutex<Option<Failure>>,
    ) -> Done {
        let (first, width) = row_pixels(self.size, self.tiles, row);
        if !self.has_work(first, width) {
            // Most rows of a coarse pass: to ask for the time would take longer than all the
            // others.
            return Done::nothing();
        }
        let start = thread_seconds();
        let at = Cell::new(None);
        let totals = Cell::new(Totals::default());
        // The sums of a pixel change only after its sample is complete, so a panicking sampler
        // leaves nothing half done.
        let done = catch_unwind(AssertUnwindSafe(|| {
            for x in 0..width {
                let pixel = UVec2::new(first.x + x, first.y);
                let is_meant = self.work.area.is_none_or(|area| area.contains(pixel));
                if !is_meant || representative(pixel, self.work.stride, self.size) != pixel {
                    continue;
                }
                let count = &mut counts[x as usize];
                let sums = &mut sums[x as usize];
                while *count < self.work.target {
                    let Some(number) = self.number(*count) else { break };
                    if (self.stop)() {
                        return false;
                    }
                    at.set(Some((pixel, *count)));
                    let sample = self.sampler.sample(pixel, number);
                    totals.set(totals.get().plus(add_sample(count, sums, &sample)));
                }
            }
            true
        }));
        let done = done.unwrap_or_else(|panic| {
            let mut failure = failure.lock().unwrap_or_else(PoisonError::into_inner);
            failure.get_or_insert(Failure { at: at.get(), message: panic_message(&*panic) });
            false
        });
        Done { totals: totals.get(), cpu_seconds: thread_seconds() - start, complete: done }
    }
}

fn panic_message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "the sampler stopped without a message".to_owned())
}

/// Lowers the priority of the calling thread.
#[cfg(target_os = "linux")]
fn yield_to_others() {
    // On Linux the priority of the "process 0" is that of the calling thread. Where the system
    // refuses, the thread works at the priority it has.
    let _ = rustix::process::setpriority_process(None, 10);
}

#[cfg(not(target_os = "linux"))]
fn yield_to_others() {}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

    use super::*;
    use crate::render::synthetic::Uniform;
    use crate::transport::PathSample;

    const SIZE: UVec2 = UVec2::new(53, 37);

    fn prepared(sampler: &impl PixelSampler) -> Option<Prepared> {
        sampler.prepare(crate::error::NO_PROGRESS).ok()
    }

    fn whole(film: &Film, target: u32) -> Work {
        Work { stride: 1, target, tiles: 0..film.tile_count(), area: None }
    }

    fn rendered(threads: usize) -> Film {
        let pool = Pool::new(Some(threads), Priority::Normal).unwrap();
        let mut film = Film::new(SIZE).unwrap();
        let work = whole(&film, 11);
        let outcome = pool.sample(
            &mut film,
            &Uniform::default(),
            prepared(&Uniform::default()).as_ref(),
            &work,
            &|| false,
        );
        assert!(outcome.complete);
        film
    }

    #[test]
    fn the_same_bits_for_any_number_of_threads() {
        let one = rendered(1);
        assert_eq!(one.totals.paths, u64::from(SIZE.x * SIZE.y) * 11);
        assert_eq!(one.sample_range(), (11, 11));
        assert_eq!(rendered(2), one);
        assert_eq!(rendered(4), one);
    }

    /// More work costs more CPU time, on whichever threads it is done.
    #[test]
    fn the_cpu_time_is_that_of_the_work() {
        let seconds = |cost| {
            let pool = Pool::new(Some(2), Priority::Normal).unwrap();
            let mut film = Film::new(SIZE).unwrap();
            let work = whole(&film, 11);
            let sampler = Uniform { cost, ..Uniform::default() };
            pool.sample(&mut film, &sampler, prepared(&sampler).as_ref(), &work, &|| false)
                .cpu_seconds
        };
        let (light, heavy) = (seconds(0), seconds(5000));
        assert!(light > 0.0 && heavy > 3.0 * light, "{light} s and {heavy} s");
    }

    #[test]
    fn stopping_takes_at_most_a_sample_a_thread() {
        let sampler = Uniform::default();
        let stop = AtomicBool::new(false);
        let threads = 3;
        let after = AtomicU64::new(0);
        struct Stopping<'a>(&'a Uniform, &'a AtomicBool, &'a AtomicU64);
        impl PixelSampler for Stopping<'_> {
            fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
                if self.1.load(Ordering::SeqCst) {
                    self.2.fetch_add(1, Ordering::SeqCst);
                }
                if self.0.calls.load(Ordering::SeqCst) == 500 {
                    self.1.store(true, Ordering::SeqCst);
                }
                self.0.sample(pixel, number)
            }
        }
        let pool = Pool::new(Some(threads), Priority::Background).unwrap();
        let mut film = Film::new(SIZE).unwrap();
        let work = whole(&film, 2);
        let stopping = Stopping(&sampler, &stop, &after);
        let outcome =
            pool.sample(&mut film, &stopping, prepared(&stopping).as_ref(), &work, &|| {
                stop.load(Ordering::SeqCst)
            });
        assert!(!outcome.complete && outcome.failure.is_none());
        assert!(after.load(Ordering::SeqCst) <= threads as u64);
        assert_eq!(film.totals.paths, sampler.calls.load(Ordering::SeqCst));

        // Doing the same work again gives what it would have given at once.
        pool.sample(&mut film, &sampler, prepared(&sampler).as_ref(), &work, &|| false);
        let mut straight = Film::new(SIZE).unwrap();
        pool.sample(&mut straight, &sampler, prepared(&sampler).as_ref(), &work, &|| false);
        assert_eq!(film, straight);
    }

    #[test]
    fn a_panic_names_its_pixel_and_sample() {
        struct Faulty;
        impl PixelSampler for Faulty {
            fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
                assert!(pixel != UVec2::new(20, 30) || number.index() < 2, "a fault on purpose");
                PathSample::default()
            }
        }
        let pool = Pool::new(Some(2), Priority::Normal).unwrap();
        let mut film = Film::new(SIZE).unwrap();
        let work = whole(&film, 4);
        let outcome = pool.sample(&mut film, &Faulty, prepared(&Faulty).as_ref(), &work, &|| false);
        let failure = outcome.failure.unwrap();
        assert_eq!(failure.at, Some((UVec2::new(20, 30), 2)));
        assert!(!outcome.complete);
        let text = failure.to_string();
        assert!(text.contains("20,30") && text.contains("on purpose"), "{text}");
        assert_eq!(failure.replay_options().unwrap(), "--pixel 20,30 --sample 2");
        assert_eq!(film.samples(UVec2::new(20, 30)), 2);
    }
}
