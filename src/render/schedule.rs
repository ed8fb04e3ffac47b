//! The order of samples, and the times at which they are shown: pure logic, no threads and no
//! clocks.
//!
//! The first pass visits pixels coarse to fine. At stride s each block of s × s pixels is stood for
//! by the pixel in its middle, sampled at its own position, so nothing is thrown away; the pixels
//! met at a finer stride are those that have no sample yet. After that come whole passes. A piece
//! of work says "bring these pixels to so many samples": one that was broken off is simply given
//! out again, and a film that comes from anywhere is continued where each of its pixels stands.
//! That is also what lets a region have all samples for a while, and the others catch up later.

use std::ops::Range;

use glam::UVec2;

use super::area::Area;
use super::coarse::COARSEST_STRIDE;
use super::film::{MAX_SAMPLES, TILE, TILE_PIXELS};

/// Target time of the coarse picture, in seconds. In a drag an edit waits for two of them, or four
/// where two renders share time slices, and for a frame, which should not be more than 0.1 s.
const COARSE_SECONDS: f64 = 0.025;
/// Strides that the first pass may begin with, coarse to fine.
const FIRST_STRIDES: [u32; 4] = [COARSEST_STRIDE, 16, 8, 4];
/// The stride to begin with while the cost of a path is unknown.
const DEFAULT_STRIDE: u32 = 8;
/// Bounds of the time between pictures, in seconds; it grows from one to the other.
const PUBLISH_SECONDS: (f64, f64) = (0.1, 0.5);
/// Time between pictures, as a share of the time rendered so far.
const PUBLISH_GROWTH: f64 = 0.1;
/// A picture waits until this many times its own cost has passed. In the first second quick news
/// are worth up to a fifth of the time, later 4 % at most.
const PUBLISH_COST_RATIO: (f64, f64) = (5.0, 25.0);
/// The shortest piece of work worth sending to the threads, in seconds.
const SHORTEST_WORK: f64 = 0.02;
/// The most samples a pixel takes in one piece of work.
const MOST_PASSES_AT_ONCE: u32 = 64;
/// Weight of the newest measurement in the cost of a path.
const COST_WEIGHT: f64 = 0.3;

/// A piece of work for the threads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Work {
    /// Stride: only pixels that stand for a block of this side; 1: all.
    pub stride: u32,
    /// Number of samples to bring each pixel to.
    pub target: u32,
    /// Tiles of the film that the work covers.
    pub tiles: Range<usize>,
    /// Region to sample; `None`: the whole film.
    pub area: Option<Area>,
}

/// The answer of the schedule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    /// Do this.
    Work(Work),
    /// The render is paused, so there is nothing to do.
    Paused,
    /// The limit is reached.
    Done,
}

/// Limits of a render: samples and time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Samples a pixel; 0: as many as fit the counts.
    pub spp: u32,
    /// Seconds of rendering.
    pub seconds: Option<f64>,
}

/// The state of a progressive render as far as planning goes. Times are seconds of rendering since
/// it began or was continued.
#[derive(Clone, Debug)]
pub struct Schedule {
    size: UVec2,
    /// Region that gets all samples once every pixel has one; `None`: the whole film.
    area: Option<Area>,
    limits: Limits,
    stride: u32,
    target: u32,
    next_tile: usize,
    passes: u32,
    has_picture: bool,
    /// Whether samples were taken of a piece of work that is not done.
    is_amid_work: bool,
    pass_ended: bool,
    seconds_per_path: Option<f64>,
    published: Option<f64>,
    publish_cost: f64,
}

impl Schedule {
    /// A plan for a film of `size` pixels in which every pixel has `passes` samples or more.
    /// `seconds_per_path` is the cost measured before, with all threads at work.
    pub fn new(size: UVec2, passes: u32, limits: Limits, seconds_per_path: Option<f64>) -> Self {
        let pixels = u64::from(size.x) * u64::from(size.y);
        let stride = if passes == 0 { first_stride(pixels, seconds_per_path) } else { 1 };
        Self {
            size,
            area: None,
            limits,
            stride,
            target: passes.saturating_add(1),
            next_tile: 0,
            passes,
            has_picture: passes > 0,
            is_amid_work: false,
            pass_ended: false,
            seconds_per_path,
            published: None,
            publish_cost: 0.0,
        }
    }

    /// Gives all samples to the pixels of `area`, which lies on the film and whose pixels have
    /// `passes` samples or more, or to all pixels. The first pass goes over the whole film all the
    /// same, so that there is a picture.
    pub fn render_region_only(&mut self, area: Option<Area>, passes: u32) {
        self.area = area;
        if self.passes > 0 {
            self.passes = passes.max(1);
            self.target = self.passes.saturating_add(1);
            self.next_tile = self.band().start;
            // Whoever asked for it wants to see it at once.
            self.pass_ended = true;
        }
    }

    /// The next piece of work at time `now`. It stays the next one until [`Self::completed`] says
    /// that it is done. Paused, a render without a picture goes on until it has its first, coarse
    /// one, so that an edit shows.
    pub fn next(&mut self, now: f64, paused: bool) -> Next {
        if self.is_finished(now) {
            return Next::Done;
        }
        if paused && self.has_picture {
            return Next::Paused;
        }
        let seconds = self.work_seconds(now);
        let band = self.band();
        if self.next_tile == band.start && self.stride == 1 {
            self.target = self.passes + self.passes_at_once(seconds);
        }
        let last = self.next_tile + self.tiles_within(seconds);
        let tiles = self.next_tile..last.min(band.end);
        let area = self.sampled_region();
        Next::Work(Work { stride: self.stride, target: self.target, tiles, area })
    }

    /// Records that some paths took some seconds, whether their work was completed or not.
    pub fn measured(&mut self, paths: u64, seconds: f64) {
        if paths == 0 {
            return;
        }
        self.is_amid_work = true;
        let cost = seconds / paths as f64;
        self.seconds_per_path =
            Some(self.seconds_per_path.map_or(cost, |old| old + COST_WEIGHT * (cost - old)));
    }

    /// Takes note that the whole of `work` is done.
    pub fn completed(&mut self, work: &Work) {
        self.next_tile = work.tiles.end;
        self.is_amid_work = false;
        if self.next_tile < self.band().end {
            return;
        }
        self.has_picture = true;
        if self.stride > 1 {
            self.stride /= 2;
        } else {
            self.pass_ended |= self.passes == 0;
            self.passes = self.target;
        }
        self.next_tile = self.band().start;
    }

    /// Whether to show a picture at time `now`: the first as soon as it is there, then when the
    /// first pass is through, at the end, and in between ever more rarely.
    pub fn publish_due(&self, now: f64) -> bool {
        if !self.has_picture {
            return false;
        }
        match self.published {
            None => true,
            Some(last) => self.pass_ended || now - last >= self.publish_interval(now),
        }
    }

    /// Takes note that a picture was shown at time `now` and took `cost` seconds to prepare.
    pub fn published(&mut self, now: f64, cost: f64) {
        self.published = Some(now);
        self.publish_cost = cost;
        self.pass_ended = false;
    }

    /// Whether a limit is reached.
    pub fn is_finished(&self, now: f64) -> bool {
        self.passes >= self.most_samples() || self.limits.seconds.is_some_and(|end| now >= end)
    }

    /// Whether every block of the coarsest stride has a sample, so that there is something to show.
    pub fn has_picture(&self) -> bool {
        self.has_picture
    }

    /// The side of the blocks that stand for the pixels: as coarse as the last whole part of the
    /// first pass while nothing finer is sampled, then 1.
    pub fn blocks(&self) -> u32 {
        let is_coarse =
            self.has_picture && self.passes == 0 && self.next_tile == 0 && !self.is_amid_work;
        if is_coarse { self.stride * 2 } else { 1 }
    }

    /// Number of samples that every pixel has, or every pixel of the region that gets all.
    pub fn passes(&self) -> u32 {
        self.passes
    }

    /// Limits of the render.
    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// Changes the limits of the render.
    pub fn set_limits(&mut self, limits: Limits) {
        self.limits = limits;
    }

    /// The measured cost of a path with all threads at work, for the next plan.
    pub fn seconds_per_path(&self) -> Option<f64> {
        self.seconds_per_path
    }

    /// Region that gets all samples now; `None` while the whole film does.
    fn sampled_region(&self) -> Option<Area> {
        self.area.filter(|_| self.passes > 0)
    }

    /// The tiles that get samples now: whole rows of them.
    fn band(&self) -> Range<usize> {
        let across = self.size.x.div_ceil(TILE) as usize;
        let rows = match self.sampled_region() {
            Some(area) => area.first.y / TILE..(area.first.y + area.size.y).div_ceil(TILE),
            None => 0..self.size.y.div_ceil(TILE),
        };
        rows.start as usize * across..rows.end as usize * across
    }

    /// The number of pixels that get samples now.
    fn pixels(&self) -> f64 {
        self.sampled_region().unwrap_or(Area::of(self.size)).pixels() as f64
    }

    fn most_samples(&self) -> u32 {
        if self.limits.spp == 0 { MAX_SAMPLES } else { self.limits.spp.min(MAX_SAMPLES) }
    }

    fn publish_interval(&self, now: f64) -> f64 {
        let (shortest, longest) = PUBLISH_SECONDS;
        let (low, high) = PUBLISH_COST_RATIO;
        let ratio = (now * high).clamp(low, high);
        (now * PUBLISH_GROWTH).clamp(shortest, longest).max(self.publish_cost * ratio)
    }

    /// Target time of the next piece of work, in seconds: until the next picture or the end.
    fn work_seconds(&self, now: f64) -> f64 {
        let interval = self.publish_interval(now);
        let left = self.published.map_or(interval, |last| last + interval - now);
        let left = left.clamp(SHORTEST_WORK, interval);
        self.limits.seconds.map_or(left, |end| left.min(end - now))
    }

    /// Number of passes over the whole film that fit `seconds`; one at least, no more than wanted.
    /// The first pass comes alone, for the picture to be complete early.
    fn passes_at_once(&self, seconds: f64) -> u32 {
        let wanted = (self.most_samples() - self.passes).min(MOST_PASSES_AT_ONCE);
        let Some(cost) = self.seconds_per_path.filter(|_| self.passes > 0) else { return 1 };
        let fitting = seconds / (cost * self.pixels());
        (fitting as u32).clamp(1, wanted)
    }

    /// Number of tiles that fit `seconds`, one at least; an eighth of all while the cost is
    /// unknown.
    fn tiles_within(&self, seconds: f64) -> usize {
        let tiles = self.band().len();
        let Some(cost) = self.seconds_per_path else { return tiles.div_ceil(8) };
        let passes = f64::from(self.target - self.passes);
        let pixels = match self.sampled_region() {
            Some(_) => self.pixels() / tiles as f64,
            None => TILE_PIXELS as f64,
        };
        let paths = pixels / f64::from(self.stride * self.stride) * passes;
        ((seconds / (cost * paths)) as usize).clamp(1, tiles)
    }
}

/// The finest stride whose picture is quick enough.
fn first_stride(pixels: u64, seconds_per_path: Option<f64>) -> u32 {
    let Some(cost) = seconds_per_path else { return DEFAULT_STRIDE };
    let seconds = |stride: u32| cost * pixels as f64 / f64::from(stride * stride);
    let quick = FIRST_STRIDES.iter().rev().find(|&&stride| seconds(stride) <= COARSE_SECONDS);
    quick.copied().unwrap_or(FIRST_STRIDES[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::coarse::representative;

    const SIZE: UVec2 = UVec2::new(100, 50);

    fn spp(spp: u32) -> Limits {
        Limits { spp, seconds: None }
    }

    fn tile_of(pixel: UVec2) -> usize {
        (pixel.y / TILE * SIZE.x.div_ceil(TILE) + pixel.x / TILE) as usize
    }

    /// Plays a schedule on a film of counts, each path costing `cost` seconds; returns the counts
    /// and the pieces of work.
    fn play(schedule: &mut Schedule, counts: &mut [u32], cost: f64, mut now: f64) -> Vec<Work> {
        let mut all = Vec::new();
        while let Next::Work(work) = schedule.next(now, false) {
            let mut paths = 0;
            for y in 0..SIZE.y {
                for x in 0..SIZE.x {
                    let pixel = UVec2::new(x, y);
                    let count = &mut counts[(y * SIZE.x + x) as usize];
                    if work.tiles.contains(&tile_of(pixel))
                        && representative(pixel, work.stride, SIZE) == pixel
                        && work.area.is_none_or(|area| area.contains(pixel))
                    {
                        paths += work.target.saturating_sub(*count);
                        *count = (*count).max(work.target);
                    }
                }
            }
            let seconds = f64::from(paths) * cost;
            now += seconds;
            schedule.measured(u64::from(paths), seconds);
            schedule.completed(&work);
            if schedule.publish_due(now) {
                schedule.published(now, 1.0e-3);
            }
            all.push(work);
        }
        all
    }

    #[test]
    fn every_pixel_gets_its_samples() {
        for (limit, cost) in [(1, 1e-3), (3, 1e-5), (200, 1e-8)] {
            let mut counts = vec![0; (SIZE.x * SIZE.y) as usize];
            let mut schedule = Schedule::new(SIZE, 0, spp(limit), None);
            play(&mut schedule, &mut counts, cost, 0.0);
            assert!(counts.iter().all(|&count| count == limit), "{limit} spp at {cost} s a path");
            assert_eq!(schedule.passes(), limit);
        }
    }

    #[test]
    fn the_first_pass_goes_from_coarse_to_fine() {
        let mut counts = vec![0; (SIZE.x * SIZE.y) as usize];
        let works = play(&mut Schedule::new(SIZE, 0, spp(2), None), &mut counts, 1e-4, 0.0);
        let mut strides: Vec<(u32, u32)> = works.iter().map(|w| (w.stride, w.target)).collect();
        strides.dedup();
        assert_eq!(strides, [(8, 1), (4, 1), (2, 1), (1, 1), (1, 2)]);
    }

    /// The picture is one of blocks only between two parts of the first pass.
    #[test]
    fn blocks_are_as_large_as_the_last_whole_part_had_them() {
        let mut schedule = Schedule::new(SIZE, 0, spp(2), None);
        let mut sides = vec![schedule.blocks()];
        while let Next::Work(work) = schedule.next(0.0, false) {
            schedule.completed(&work);
            sides.push(schedule.blocks());
        }
        sides.dedup();
        assert_eq!(sides, [1, 8, 1, 4, 1, 2, 1]);

        // Nor is it one once something finer is sampled, if only in part.
        let mut schedule = Schedule::new(SIZE, 0, spp(2), None);
        while schedule.blocks() == 1 {
            let Next::Work(work) = schedule.next(0.0, false) else { panic!("no work") };
            schedule.measured(9, 1e-3);
            schedule.completed(&work);
        }
        schedule.measured(0, 1e-3);
        assert_eq!(schedule.blocks(), 8);
        schedule.measured(1, 1e-3);
        assert_eq!(schedule.blocks(), 1);
        assert_eq!(Schedule::new(SIZE, 1, spp(2), None).blocks(), 1);
    }

    #[test]
    fn the_first_stride_follows_the_cost() {
        let size = UVec2::new(960, 540);
        let stride = |cost| Schedule::new(size, 0, spp(0), cost).stride;
        assert_eq!(stride(None), 8);
        assert_eq!(stride(Some(1e-7)), 4);
        assert_eq!(stride(Some(3e-6)), 8);
        assert_eq!(stride(Some(1e-5)), 16);
        assert_eq!(stride(Some(3e-5)), 32);
        assert_eq!(stride(Some(1.0)), 32);
    }

    #[test]
    fn a_film_is_continued_where_it_stands() {
        let mut counts: Vec<u32> = (0..SIZE.x * SIZE.y).map(|i| 5 + i % 3).collect();
        let mut schedule = Schedule::new(SIZE, 5, spp(9), None);
        assert!(schedule.publish_due(0.0), "what was there before can be shown at once");
        play(&mut schedule, &mut counts, 1e-4, 0.0);
        assert!(counts.iter().all(|&count| count == 9));
        assert_eq!(Schedule::new(SIZE, 9, spp(9), None).next(0.0, false), Next::Done);
        assert_eq!(Schedule::new(SIZE, 9, spp(4), None).next(0.0, false), Next::Done);
    }

    /// The first pass covers the whole film, then all samples go to the region, and without it the
    /// others catch up.
    #[test]
    fn a_region_gets_all_samples_and_the_others_catch_up() {
        let area = Area { first: UVec2::new(20, 18), size: UVec2::new(30, 20) };
        let inside =
            |index: usize| area.contains(UVec2::new(index as u32 % SIZE.x, index as u32 / SIZE.x));
        let mut counts = vec![0; (SIZE.x * SIZE.y) as usize];
        let mut schedule = Schedule::new(SIZE, 0, spp(6), None);
        schedule.render_region_only(Some(area), 0);
        let works = play(&mut schedule, &mut counts, 1e-4, 0.0);
        for (index, &count) in counts.iter().enumerate() {
            assert_eq!(count, if inside(index) { 6 } else { 1 }, "pixel {index}");
        }
        let of_region = works.iter().filter(|work| work.area.is_some());
        assert!(of_region.clone().count() > 1 && of_region.clone().all(|work| work.target > 1));
        assert!(of_region.clone().all(|work| work.tiles.start >= 7 && work.tiles.end <= 21));
        schedule.render_region_only(None, 1);
        play(&mut schedule, &mut counts, 1e-4, 0.0);
        assert!(counts.iter().all(|&count| count == 6));
    }

    #[test]
    fn work_that_was_broken_off_comes_again() {
        let mut schedule = Schedule::new(SIZE, 0, spp(1), None);
        let first = schedule.next(0.0, false);
        schedule.measured(10, 1e-4);
        let Next::Work(again) = schedule.next(0.1, false) else { panic!("no work") };
        let Next::Work(first) = first else { panic!("no work") };
        assert_eq!((first.stride, first.tiles.start), (again.stride, again.tiles.start));
    }

    #[test]
    fn costly_passes_come_in_pieces_and_cheap_ones_together() {
        let size = UVec2::new(960, 540);
        let mut costly = Schedule::new(size, 3, spp(0), Some(1e-4));
        let Next::Work(work) = costly.next(0.0, false) else { panic!("no work") };
        let paths = work.tiles.len() * TILE_PIXELS;
        assert!((0.05..0.11).contains(&(paths as f64 * 1e-4)), "{work:?}");
        let mut cheap = Schedule::new(SIZE, 3, spp(0), Some(1e-7));
        let Next::Work(work) = cheap.next(10.0, false) else { panic!("no work") };
        assert_eq!(work, Work { stride: 1, target: 3 + 64, tiles: 0..28, area: None });
        let mut limited = Schedule::new(SIZE, 3, spp(5), Some(1e-7));
        let Next::Work(work) = limited.next(10.0, false) else { panic!("no work") };
        assert_eq!(work.target, 5);
    }

    #[test]
    fn the_time_limit_holds_and_cuts_the_last_work() {
        let limits = Limits { spp: 0, seconds: Some(1.0) };
        let size = UVec2::new(960, 540);
        let mut schedule = Schedule::new(size, 3, limits, Some(1e-5));
        let Next::Work(work) = schedule.next(0.99, false) else { panic!("no work") };
        assert!((work.tiles.len() * TILE_PIXELS) as f64 * 1e-5 <= 0.0101, "{work:?}");
        assert_eq!(schedule.next(1.0, false), Next::Done);
    }

    #[test]
    fn pause_waits_for_the_first_picture() {
        let mut schedule = Schedule::new(SIZE, 0, spp(1), Some(1e-6));
        let Next::Work(work) = schedule.next(0.0, true) else { panic!("no work") };
        assert_eq!((work.stride, work.tiles.clone()), (4, 0..28));
        schedule.completed(&work);
        assert_eq!(schedule.next(0.0, true), Next::Paused);
        assert!(matches!(schedule.next(0.0, false), Next::Work(Work { stride: 2, .. })));
    }

    #[test]
    fn pictures_come_at_once_and_then_ever_more_rarely() {
        let mut schedule = Schedule::new(SIZE, 0, spp(0), Some(1e-6));
        assert!(!schedule.publish_due(0.0), "nothing to show yet");
        for stride in [4, 2, 1] {
            let Next::Work(work) = schedule.next(0.01, false) else { panic!("no work") };
            schedule.completed(&work);
            assert_eq!(work.stride, stride);
            assert_eq!(schedule.publish_due(0.01), stride != 2, "stride {stride}");
            schedule.published(0.01, 0.001);
        }
        assert!(!schedule.publish_due(0.10));
        assert!(schedule.publish_due(0.12));
        schedule.published(3.0, 0.001);
        assert!(!schedule.publish_due(3.2));
        assert!(schedule.publish_due(3.4));
        schedule.published(0.5, 0.02);
        assert!(!schedule.publish_due(0.7) && schedule.publish_due(1.01));
        schedule.published(100.0, 0.1);
        assert!(!schedule.publish_due(102.0), "a picture of 100 ms has to wait for 2.5 s");
        assert!(schedule.publish_due(102.6));
    }
}
