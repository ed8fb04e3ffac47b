//! The loop that both the window and the command line drive: ask the schedule, sample, take note.

use std::sync::Arc;
use std::time::Instant;

use super::area::Area;
use super::estimate::samples_per_pixel;
use super::film::Film;
use super::picture::{
    Extras, Picture, RenderStats, render_stats, resolve, resolve_blocks, resolve_variance,
};
use super::pool::{Failure, Pool};
use super::schedule::{Limits, Next, Schedule};
use crate::transport::{PixelSampler, Prepared};

/// A progressive render under way.
pub struct ProgressiveRender {
    sampler: Arc<dyn PixelSampler>,
    /// Result of the pilot pass, once that has run.
    prepared: Option<Prepared>,
    film: Film,
    schedule: Schedule,
    /// The pixels that get all samples.
    area: Option<Area>,
    /// Whether all samples are of this schedule.
    begun_empty: bool,
    seconds: f64,
    cpu_seconds: f64,
}

/// Result of one step of a render.
#[derive(Debug)]
pub enum RenderStep {
    /// A piece of work was done.
    Worked,
    /// The work was interrupted; the next step takes it up again.
    Interrupted,
    /// The render is paused, so there is nothing to do.
    Paused,
    /// The limit is reached.
    Done,
    /// A sample could not be taken. The film is as consistent as ever.
    Failed(Failure),
}

impl ProgressiveRender {
    /// A render on `film`, which may have samples already. `seconds_per_path` is what a path cost
    /// before, if known.
    pub fn new(
        sampler: Arc<dyn PixelSampler>,
        film: Film,
        limits: Limits,
        seconds_per_path: Option<f64>,
    ) -> Self {
        let (passes, most) = film.sample_range();
        let begun_empty = most == 0;
        let schedule = Schedule::new(film.size(), passes, limits, seconds_per_path);
        Self {
            sampler,
            prepared: None,
            film,
            schedule,
            area: None,
            begun_empty,
            seconds: 0.0,
            cpu_seconds: 0.0,
        }
    }

    /// Gives all samples to the pixels of `area` once every pixel has one, or to all pixels.
    pub fn render_region_only(&mut self, area: Option<Area>) {
        let film = &self.film;
        let area = area.map(|area| area.within(film.size())).filter(|area| area.pixels() > 0);
        if std::mem::replace(&mut self.area, area) == area {
            return;
        }
        let passes = match self.area {
            Some(area) => film.fewest_samples(area),
            None => film.sample_range().0,
        };
        self.schedule.render_region_only(self.area, passes);
    }

    /// Throws the samples away and begins again with another sampler.
    pub fn start_over(&mut self, sampler: Arc<dyn PixelSampler>) {
        self.film.clear();
        self.begun_empty = true;
        let (limits, cost) = (self.schedule.limits(), self.schedule.seconds_per_path());
        self.schedule = Schedule::new(self.film.size(), 0, limits, cost);
        self.schedule.render_region_only(self.area, 0);
        (self.seconds, self.cpu_seconds) = (0.0, 0.0);
        self.go_on_with(sampler);
    }

    /// Adds the CPU time, in seconds, of the samples that the render began with.
    pub fn count_in(&mut self, cpu_seconds: f64) {
        self.cpu_seconds += cpu_seconds;
    }

    /// Continues with another sampler of the same picture.
    pub fn go_on_with(&mut self, sampler: Arc<dyn PixelSampler>) {
        (self.sampler, self.prepared) = (sampler, None);
    }

    /// Does the next piece of work, unless `stop` says so earlier. A pilot pass, which would have
    /// to begin anew, heeds `give_up` instead.
    pub fn step(
        &mut self,
        pool: &Pool,
        paused: bool,
        stop: &(dyn Fn() -> bool + Sync),
        give_up: &(dyn Fn() -> bool + Sync),
    ) -> RenderStep {
        let work = match self.schedule.next(self.seconds, paused) {
            Next::Work(work) => work,
            Next::Paused => return RenderStep::Paused,
            Next::Done => return RenderStep::Done,
        };
        let start = Instant::now();
        // The first sample of a pixel waits for no pilot pass.
        if work.target > 1 && self.prepared.is_none() {
            match pool.prepare(&*self.sampler, give_up) {
                Ok(prepared) => self.prepared = prepared,
                Err(failure) => return RenderStep::Failed(failure),
            }
            self.seconds += start.elapsed().as_secs_f64();
            if self.prepared.is_none() {
                return RenderStep::Interrupted;
            }
        }
        let start = Instant::now();
        let prepared = self.prepared.as_ref();
        let outcome = pool.sample(&mut self.film, &*self.sampler, prepared, &work, stop);
        let seconds = start.elapsed().as_secs_f64();
        self.seconds += seconds;
        self.cpu_seconds += outcome.cpu_seconds;
        self.schedule.measured(outcome.totals.paths, seconds);
        if let Some(failure) = outcome.failure {
            return RenderStep::Failed(failure);
        }
        if !outcome.complete {
            return RenderStep::Interrupted;
        }
        self.schedule.completed(&work);
        RenderStep::Worked
    }

    /// Whether a picture should be shown now.
    pub fn publish_due(&self) -> bool {
        self.schedule.publish_due(self.seconds)
    }

    /// Reads the film into `picture`, with the extras that are wanted; its generation stays.
    pub fn read(&mut self, pool: &Pool, extras: Extras, picture: &mut Picture) {
        let start = Instant::now();
        let (film, is_complete) = (&self.film, self.is_complete());
        let blocks = if self.begun_empty { self.schedule.blocks() } else { 1 };
        let noise = pool.install(|| {
            picture.layer.read(film, extras.layer);
            match (extras.variance, is_complete) {
                (true, true) => resolve_variance(film, &mut picture.variance),
                // There is none yet; the memory is for the next picture.
                (true, false) => picture.variance.clear(),
                (false, _) => picture.variance = Vec::new(),
            }
            if blocks > 1 {
                resolve_blocks(film, blocks, &mut picture.pixels);
                return None;
            }
            resolve(film, &mut picture.pixels)
        });
        let cost = start.elapsed().as_secs_f64();
        self.seconds += cost;
        self.schedule.published(self.seconds, cost);
        (picture.size, picture.complete) = (self.film.size(), is_complete);
        picture.block_log2 = blocks.ilog2();
        picture.fewest_samples = self.film.sample_range().0;
        picture.region = self.area.map(|area| (area, self.film.fewest_samples(area)));
        picture.stats = RenderStats {
            cpu_seconds: self.cpu_seconds,
            spending: self.prepared.as_ref().and_then(Prepared::spending).copied(),
            guided_flights: self.prepared.as_ref().and_then(Prepared::guided_flights),
            ..render_stats(&self.film, self.seconds, noise, self.is_finished())
        };
    }

    /// Mean number of samples of a pixel.
    pub fn samples_per_pixel(&self) -> f64 {
        samples_per_pixel(&self.film)
    }

    /// Whether the limit is reached.
    pub fn is_finished(&self) -> bool {
        self.schedule.is_finished(self.seconds)
    }

    /// Whether there is a picture to show.
    pub fn has_picture(&self) -> bool {
        self.schedule.has_picture()
    }

    /// Whether every pixel has a sample of its own.
    pub fn is_complete(&self) -> bool {
        self.schedule.passes() > 0
    }

    /// Seconds of rendering so far.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// CPU time that the sampling threads have spent on the render, in seconds.
    pub fn cpu_seconds(&self) -> f64 {
        self.cpu_seconds
    }

    /// Changes when to stop.
    pub fn set_limits(&mut self, limits: Limits) {
        self.schedule.set_limits(limits);
    }

    /// The film in its present state.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// Ends the render; the film and what a path cost go on to the next.
    pub fn into_parts(self) -> (Film, Option<f64>) {
        (self.film, self.schedule.seconds_per_path())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

    use glam::UVec2;

    use super::*;
    use crate::error::{Progress, Result, report};
    use crate::math::Rgb;
    use crate::render::pool::Priority;
    use crate::render::synthetic::Uniform;
    use crate::transport::{PathSample, SampleNumber};

    /// The first picture of a film, with the side of its blocks.
    fn first_picture(film: Film) -> (Picture, u32) {
        let pool = Pool::new(Some(1), Priority::Normal).unwrap();
        let limits = Limits { spp: 2, seconds: None };
        let mut engine = ProgressiveRender::new(Arc::new(Uniform::default()), film, limits, None);
        while !engine.has_picture() {
            engine.step(&pool, false, &|| false, &|| false);
        }
        let mut picture = Picture::default();
        engine.read(&pool, Extras { variance: true, ..Extras::default() }, &mut picture);
        assert!(!picture.complete && picture.variance.is_empty());
        let side = 1 << picture.block_log2;
        (picture, side)
    }

    /// Has something to find out before all samples but the first, which takes many questions.
    #[derive(Default)]
    struct Pilot {
        questions: AtomicU32,
        found: AtomicBool,
    }

    /// Questions until it is found out.
    const QUESTIONS: u32 = 1000;

    impl PixelSampler for Pilot {
        fn sample(&self, _: UVec2, number: SampleNumber) -> PathSample {
            assert!(
                number.index() == 0 || self.found.load(Ordering::Relaxed),
                "it was not prepared"
            );
            PathSample::default()
        }

        fn prepare(&self, progress: Progress) -> Result<Prepared> {
            while self.questions.fetch_add(1, Ordering::Relaxed) < QUESTIONS {
                report(progress, 0.0)?;
            }
            self.found.store(true, Ordering::Relaxed);
            Ok(Prepared::NOTHING)
        }
    }

    /// The first pass waits for nothing, the second for what is found out before it, which is given
    /// up where the work is.
    #[test]
    fn the_second_pass_is_prepared_and_that_can_be_given_up() {
        let pool = Pool::new(Some(2), Priority::Normal).unwrap();
        let (pilot, limits) = (Arc::new(Pilot::default()), Limits { spp: 2, seconds: None });
        let film = Film::new(UVec2::new(40, 20)).unwrap();
        let mut engine = ProgressiveRender::new(pilot.clone(), film, limits, None);
        while !engine.is_complete() {
            assert!(matches!(engine.step(&pool, false, &|| false, &|| false), RenderStep::Worked));
        }
        let questions = || pilot.questions.load(Ordering::Relaxed);
        assert_eq!(questions(), 0);
        let stop = || questions() >= 10;
        assert!(matches!(engine.step(&pool, false, &|| true, &stop), RenderStep::Interrupted));
        assert_eq!((questions(), engine.film().sample_range()), (10, (1, 1)));
        // Whatever only breaks work off lets the pilot pass come to its end.
        assert!(matches!(engine.step(&pool, false, &|| true, &|| false), RenderStep::Interrupted));
        assert!(questions() > QUESTIONS && engine.film().sample_range() == (1, 1));
        while !engine.is_finished() {
            assert!(matches!(engine.step(&pool, false, &|| false, &|| false), RenderStep::Worked));
        }
        assert_eq!(engine.film().sample_range(), (2, 2));
    }

    #[test]
    fn what_cannot_be_found_out_is_a_failure() {
        struct Faulty;
        impl PixelSampler for Faulty {
            fn sample(&self, _: UVec2, _: SampleNumber) -> PathSample {
                PathSample::default()
            }
            fn prepare(&self, _: Progress) -> Result<Prepared> {
                panic!("a fault on purpose")
            }
        }
        let pool = Pool::new(Some(1), Priority::Normal).unwrap();
        let film = Film::new(UVec2::new(8, 8)).unwrap();
        let limits = Limits { spp: 2, seconds: None };
        let mut engine = ProgressiveRender::new(Arc::new(Faulty), film, limits, None);
        let failure = loop {
            match engine.step(&pool, false, &|| false, &|| false) {
                RenderStep::Worked => {}
                RenderStep::Failed(failure) => break failure,
                other => panic!("{other:?}"),
            }
        };
        assert!(failure.at.is_none() && failure.message.contains("on purpose"), "{failure}");
        assert_eq!(engine.film().sample_range(), (1, 1));
    }

    #[test]
    fn the_first_picture_is_of_blocks_but_hides_no_sample_of_before() {
        let size = UVec2::new(64, 48);
        let (picture, side) = first_picture(Film::new(size).unwrap());
        assert!(side > 1);
        assert_eq!(picture.pixels[0], picture.pixels[1]);

        let mut film = Film::new(size).unwrap();
        let bright = PathSample { emission: Rgb::splat(1000.0), ..PathSample::default() };
        film.add(UVec2::new(1, 0), &bright);
        let (picture, side) = first_picture(film);
        assert_eq!(side, 1);
        assert_eq!(picture.pixels[1][0], 1000.0);
        assert!(picture.pixels[0][0] < 500.0);
    }
}
