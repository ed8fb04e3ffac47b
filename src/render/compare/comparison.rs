//! The comparison of two films or two pictures.

use rayon::prelude::*;

use super::agreement::{ALARM, Agreement};
use super::side_figures::SideFigures;
use super::speed::{self, SpeedUp};
use super::tally::{PixelSource, Tally};
use crate::render::area::Area;
use crate::render::film::Film;
use crate::render::picture::Picture;

/// The comparison of two films of one scene, A and B.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Figures of A and of B.
    pub sides: [SideFigures; 2],
    /// Speed-up of B over A; `None` while nothing is known of it.
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

    /// Compares two pictures that brought their variance along. Of their pixels only the least
    /// number of samples is known.
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

    /// A sentence that says which side is faster and by which factor, with no more digits than are
    /// known and without a full stop.
    pub fn sentence(&self) -> String {
        speed::sentence(&self.sides, self.speed_up.as_ref())
    }
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

    /// The figures of a film on which the threads spent so many seconds of CPU time.
    ///
    /// Works on the threads of the calling pool, with the same result for any number of them.
    pub fn of(film: &Film, cpu_seconds: f64) -> Self {
        let blocks = Area::of(film.size()).blocks();
        let tallies: Vec<Tally> = blocks.par_iter().map(|block| Tally::of(film, block)).collect();
        let whole = tallies.iter().fold(Tally::default(), |sum, part| sum.plus(part));
        whole.side(cpu_seconds)
    }
}
