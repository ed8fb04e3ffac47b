//! Rendering two settings of one scene without a window: a pair of renders that take turns, by
//! `time_slice`.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::UVec2;

use super::pool::{Pool, Priority};
use super::time_slice::{Amount, SideInProgress, take_turns};
use super::turns::Usage;
use crate::error::Result;
use crate::transport::PixelSampler;

pub use super::time_slice::RenderedSide;

/// A comparison without a window: two samplers and their limits.
pub struct PairJob {
    /// Samplers of A and B.
    pub samplers: [Arc<dyn PixelSampler>; 2],
    /// Width and height of both in pixels.
    pub size: UVec2,
    /// Samples a pixel of each side; 0: as many as fit the counts.
    pub spp: u32,
    /// CPU time of the sampling threads for each side, in seconds. With it the sides get equal
    /// shares of that, without it of samples. It ends with a whole piece of work, so it is exceeded
    /// by a little, which the sides tell.
    pub cpu_seconds: Option<f64>,
    /// Number of threads; `None`: one per core.
    pub threads: Option<usize>,
}

/// Films and figures of both sides.
pub struct RenderedPair {
    /// A and B.
    pub sides: [RenderedSide; 2],
    /// The threads that rendered both sides.
    pub pool: Pool,
    /// Whether the interrupt ended the render.
    pub interrupted: bool,
}

/// Renders both sides until their limits are reached or `interrupt` is set, calling `progress`
/// after every piece of work (a few times a second). A sample that cannot be taken ends both.
///
/// # Errors
/// When the films do not fit the memory or threads cannot be started.
pub fn render_side_by_side(
    job: PairJob,
    interrupt: &AtomicBool,
    progress: &mut dyn FnMut(&[Usage; 2]),
) -> Result<RenderedPair> {
    let pool = Pool::new(job.threads, Priority::Normal)?;
    let amount = Amount { spp: job.spp, cpu_seconds: job.cpu_seconds, evenly: false };
    let [a, b] = job.samplers;
    let mut sides =
        [SideInProgress::new(a, job.size, amount)?, SideInProgress::new(b, job.size, amount)?];
    let interrupted = take_turns(&mut sides, &pool, interrupt, &mut |usages| {
        if let [a, b] = usages {
            progress(&[*a, *b]);
        }
    });
    let sides = sides.map(|side| side.finish(&pool));
    Ok(RenderedPair { sides, pool, interrupted })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;

    use super::*;
    use crate::render::synthetic::{GrayLevel, Uniform};
    use crate::transport::{PathSample, SampleNumber};

    const SIZE: UVec2 = UVec2::new(40, 30);

    fn job(samplers: [Arc<dyn PixelSampler>; 2], spp: u32, cpu_seconds: Option<f64>) -> PairJob {
        PairJob { samplers, size: SIZE, spp, cpu_seconds, threads: Some(2) }
    }

    fn level(seed: u64) -> Arc<dyn PixelSampler> {
        Arc::new(GrayLevel { seed, mean: 1.0, spread: 1.0 })
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
            fn sample(&self, _: UVec2, number: SampleNumber) -> PathSample {
                assert!(number.index() < 2, "a fault on purpose");
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
