//! Two films of one scene held against each other: which setting needs less time for the same
//! noise, by how much, how well that is known, and whether both show the same picture.
//!
//! All figures are read from the accumulators of the films and the CPU time spent on them, in one
//! pass over the pixels that costs about as much as reading both pictures. A stands for the first
//! film and B for the second.

mod agreement;
mod history;
pub mod maps;
mod speed;
mod tally;

use rayon::prelude::*;

pub use agreement::{ALARM, Agreement, Difference, FEWEST_SAMPLES, Verdict};
pub use history::NoiseHistory;
pub use speed::SpeedUp;

use super::area::Area;
use super::film::Film;
use super::publish::Picture;
use tally::{PixelSource, Tally};

/// Figures of one side. Colors are linear; gray is (R + G + B) / 3; means run over the pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SideFigures {
    /// Mean number of samples of a pixel.
    pub samples_per_pixel: f64,
    /// Samples of the pixel that has fewest.
    pub fewest_samples: u32,
    /// CPU time of the threads that sampled the whole film, in seconds.
    pub cpu_seconds: f64,
    /// Mean color.
    pub mean_rgb: [f64; 3],
    /// Mean over the pixels of the variance of the gray mean; none where no pixel has two samples.
    pub variance_of_mean: Option<f64>,
    /// Standard error of that, none with it.
    pub variance_error: Option<f64>,
    /// Relative standard error of the picture, as [`FilmStats::noise`](super::FilmStats::noise).
    pub noise: Option<f64>,
}

impl SideFigures {
    /// The figures of a picture that brought its variance along, over the pixels of `area`, or all.
    /// Of its pixels it is known only how many samples each has at least; the CPU time is that of
    /// the whole picture.
    ///
    /// Works on the threads of the calling pool, with the same result for any number of them.
    pub fn of_picture(picture: &Picture, area: Option<Area>) -> Self {
        let area = area.unwrap_or(Area::of(picture.size)).within(picture.size);
        let tallies: Vec<Tally> =
            area.blocks().par_iter().map(|block| Tally::of(picture, block)).collect();
        let whole = tallies.iter().fold(Tally::default(), |sum, tally| sum.plus(tally));
        let stats = &picture.stats;
        let side = whole.side(stats.cpu_seconds);
        // Where the area gets all samples, it has more than the picture has on average.
        let samples_per_pixel = stats.samples_per_pixel.max(side.samples_per_pixel);
        Self { samples_per_pixel, ..side }
    }

    /// Of a film on which the threads spent so many seconds of CPU time.
    ///
    /// Works on the threads of the calling pool, with the same result for any number of them.
    pub fn of(film: &Film, cpu_seconds: f64) -> Self {
        let blocks = Area::of(film.size()).blocks();
        let tallies: Vec<Tally> = blocks.par_iter().map(|block| Tally::of(film, block)).collect();
        let whole = tallies.iter().fold(Tally::default(), |sum, part| sum.plus(part));
        whole.side(cpu_seconds)
    }

    /// Whether no sample differed from another of its pixel.
    pub fn is_noiseless(&self) -> bool {
        self.variance_of_mean == Some(0.0)
    }

    /// Variance of the mean times CPU time, which hardly changes as a render goes on, with its
    /// relative standard error; none where there is no noise or no measured time.
    pub fn variance_times_time(&self) -> Option<(f64, f64)> {
        let variance = self.variance_of_mean.filter(|&variance| variance > 0.0)?;
        let relative_error = self.variance_error? / variance;
        (self.cpu_seconds > 0.0).then_some((variance * self.cpu_seconds, relative_error))
    }
}

/// What two films say about each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Figures of A and of B.
    pub sides: [SideFigures; 2],
    /// How much faster B is than A; none while that is not known at all.
    pub speed_up: Option<SpeedUp>,
    /// Whether both show the same picture.
    pub agreement: Agreement,
}

impl Comparison {
    /// Compares the films of A and B, on which the threads spent so many seconds of CPU time, over
    /// the pixels of `area`, or all that both have. Of an area the ratio of CPU times is that of
    /// the films: what a part of the picture cost is not known apart.
    ///
    /// Works on the threads of the calling pool, with the same result for any number of them.
    pub fn of(films: [&Film; 2], cpu_seconds: [f64; 2], area: Option<Area>) -> Self {
        Self::of_sources(films, cpu_seconds, area)
    }

    /// The same of two pictures that brought their variance along. Of their pixels it is known only
    /// how many samples each has at least.
    pub fn of_pictures(pictures: [&Picture; 2], area: Option<Area>) -> Self {
        let stats = pictures.map(|picture| &picture.stats);
        let mut comparison = Self::of_sources(pictures, stats.map(|s| s.cpu_seconds), area);
        for (side, stats) in comparison.sides.iter_mut().zip(stats) {
            side.samples_per_pixel = stats.samples_per_pixel;
        }
        comparison
    }

    fn of_sources<S: PixelSource>(
        sources: [&S; 2],
        cpu_seconds: [f64; 2],
        area: Option<Area>,
    ) -> Self {
        let area = area.unwrap_or(Area::of(sources[0].size()));
        let area = area.within(sources[0].size()).within(sources[1].size());
        let blocks = area.blocks();
        let tallies: Vec<[Tally; 2]> =
            blocks.par_iter().map(|block| sources.map(|source| Tally::of(source, block))).collect();
        let whole = [0, 1]
            .map(|side| tallies.iter().fold(Tally::default(), |sum, pair| sum.plus(&pair[side])));
        let sides = [0, 1].map(|side| whole[side].side(cpu_seconds[side]));
        let agreement = Agreement::new((&area, &whole), &blocks, &tallies, ALARM);
        Self { sides, speed_up: SpeedUp::new(&sides[0], &sides[1]), agreement }
    }

    /// Which side is faster and by how much, as one would say it, with no more digits than are
    /// known and without a full stop.
    pub fn sentence(&self) -> String {
        speed::sentence(&self.sides, self.speed_up.as_ref())
    }
}

#[cfg(test)]
mod tests;
