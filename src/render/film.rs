//! Film: per-pixel sums of the samples.
//!
//! Pixels are stored tile by tile, so that a run of rows is one slice that threads can share out.
//! A pixel's sums mean nothing until it has a sample, which makes starting over as cheap as
//! clearing the counts.

use bytemuck::{Pod, Zeroable, bytes_of};
use glam::UVec2;

use super::area::Area;
use crate::error::{Error, Result};
use crate::math::two_float::{TwoFloat, add_rgb};
use crate::math::{ACCUMULATORS, Rgb};
use crate::transport::PathSample;

/// Pixels along the side of a tile.
pub const TILE: u32 = 16;

/// Pixels of a tile.
pub(crate) const TILE_PIXELS: usize = (TILE * TILE) as usize;

/// The most samples a pixel takes: counts are written as `f32` and stay exact up to here.
pub const MAX_SAMPLES: u32 = 1 << 24;

/// The largest value a sample may bring; [`MAX_SAMPLES`] of them still fit an `f32`.
const LARGEST_VALUE: f32 = 1.0e30;

/// The most pixels of a film, so that sizes in bytes stay far from overflow.
const MAX_PIXELS: u64 = 1 << 28;

/// The running sums of one pixel, one for each field of [`PathSample`] under the same name, but for
/// the beauty. The order of the fields is that of the `state.*` channels of a snapshot, which
/// `image::exr_layout` names.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Sums {
    /// Sums of [`PathSample::beauty`], one RGB sum for each accumulator.
    pub beauty: [[TwoFloat; 3]; ACCUMULATORS],
    /// Sum of [`PathSample::emission`].
    pub emission: [TwoFloat; 3],
    /// Sum of [`PathSample::background`].
    pub background: [TwoFloat; 3],
    /// Sum of [`PathSample::direct`].
    pub direct: [TwoFloat; 3],
    /// Sum of [`PathSample::indirect`].
    pub indirect: [TwoFloat; 3],
    /// Sum of [`PathSample::alpha`].
    pub alpha: TwoFloat,
    /// Sum of [`PathSample::depth`] over the samples that have one.
    pub depth: TwoFloat,
    /// Sum of [`PathSample::tracking_steps`], those of failed samples included.
    pub steps: TwoFloat,
    /// Number of samples that have a depth.
    pub depth_count: u32,
}

/// Counts over a whole film.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Paths traced, those that failed included.
    pub paths: u64,
    /// Tentative collisions of all paths.
    pub tracking_steps: u64,
    /// Samples that were not finite; each counts as a sample of value zero.
    pub non_finite: u64,
    /// Paths that were cut, see [`PathSample::was_cut`].
    pub guard_hits: u64,
}

impl Totals {
    /// Whether there were paths, and none of them met any volume.
    pub fn met_no_volume(&self) -> bool {
        self.paths > 0 && self.tracking_steps == 0
    }

    /// The sum of two counts, or the largest number that fits.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            paths: self.paths.saturating_add(other.paths),
            tracking_steps: self.tracking_steps.saturating_add(other.tracking_steps),
            non_finite: self.non_finite.saturating_add(other.non_finite),
            guard_hits: self.guard_hits.saturating_add(other.guard_hits),
        }
    }
}

/// The state of a progressive render: per-pixel sums, per-pixel sample counts, totals.
///
/// A pixel's samples are always added in order, so its sums depend on how many it has and not on
/// who added them or in which pieces.
pub struct Film {
    size: UVec2,
    tiles: UVec2,
    counts: Vec<u32>,
    sums: Vec<Sums>,
    /// Counts over the whole film.
    pub totals: Totals,
}

impl Film {
    /// An empty film of `size` pixels.
    ///
    /// # Errors
    /// When a side is zero or the film does not fit the memory.
    pub fn new(size: UVec2) -> Result<Self> {
        let too_large = || {
            let reason = format!(
                "{} x {} pixels do not fit the memory; choose a smaller size",
                size.x, size.y
            );
            Error::invalid("", "film.size", reason)
        };
        if size.x == 0 || size.y == 0 {
            return Err(Error::invalid("", "film.size", "both sides must be at least 1"));
        }
        let tiles = UVec2::new(size.x.div_ceil(TILE), size.y.div_ceil(TILE));
        let tile_count = u64::from(tiles.x) * u64::from(tiles.y);
        if tile_count > MAX_PIXELS / TILE_PIXELS as u64 {
            return Err(too_large());
        }
        let pixels = tile_count as usize * TILE_PIXELS;
        // Zeroed by the system, page by page as pixels are first sampled; too little memory is an
        // error and no abort.
        let sums = bytemuck::allocation::try_zeroed_vec(pixels).map_err(|()| too_large())?;
        Ok(Self { size, tiles, counts: vec![0; pixels], sums, totals: Totals::default() })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Number of tiles, row by row from the top left.
    pub fn tile_count(&self) -> usize {
        self.counts.len() / TILE_PIXELS
    }

    /// Forgets every sample.
    pub fn clear(&mut self) {
        self.counts.fill(0);
        self.totals = Totals::default();
    }

    /// Samples that `pixel` has.
    pub fn samples(&self, pixel: UVec2) -> u32 {
        self.counts[self.index(pixel)]
    }

    /// The sums of `pixel`, once it has a sample.
    pub fn sums(&self, pixel: UVec2) -> Option<&Sums> {
        let index = self.index(pixel);
        (self.counts[index] > 0).then(|| &self.sums[index])
    }

    /// Adds the next sample of `pixel`; its number is the count before.
    pub fn add(&mut self, pixel: UVec2, sample: &PathSample) {
        let index = self.index(pixel);
        let totals = add_sample(&mut self.counts[index], &mut self.sums[index], sample);
        self.totals = self.totals.plus(totals);
    }

    /// Puts back the samples of a pixel that were once read from this film or another of its size.
    pub fn restore(&mut self, pixel: UVec2, samples: u32, sums: &Sums) {
        let index = self.index(pixel);
        self.counts[index] = samples;
        self.sums[index] = *sums;
    }

    /// Fewest and most samples of a pixel.
    pub fn sample_range(&self) -> (u32, u32) {
        let mut range = (u32::MAX, 0);
        for row in 0..self.counts.len() / TILE as usize {
            let (_, width) = row_pixels(self.size, self.tiles, row);
            let start = row * TILE as usize;
            for &count in &self.counts[start..start + width as usize] {
                range = (range.0.min(count), range.1.max(count));
            }
        }
        range
    }

    /// Fewest samples of a pixel of `area`; 0 where none of its pixels lies on the film.
    pub fn fewest_samples(&self, area: Area) -> u32 {
        let pixels = area.within(self.size).iter();
        pixels.map(|pixel| self.samples(pixel)).min().unwrap_or(0)
    }

    /// A copy.
    ///
    /// # Errors
    /// When a second film does not fit the memory.
    pub fn try_clone(&self) -> Result<Self> {
        let mut copy = Self::new(self.size)?;
        copy.counts.copy_from_slice(&self.counts);
        copy.sums.copy_from_slice(&self.sums);
        copy.totals = self.totals;
        Ok(copy)
    }

    /// Counts and sums of a range of tiles, for threads to share out row by row.
    pub(crate) fn tiles_mut(&mut self, tiles: std::ops::Range<usize>) -> (&mut [u32], &mut [Sums]) {
        let range = tiles.start * TILE_PIXELS..tiles.end * TILE_PIXELS;
        (&mut self.counts[range.clone()], &mut self.sums[range])
    }

    /// Tiles across and down.
    pub(crate) fn tiles(&self) -> UVec2 {
        self.tiles
    }

    fn index(&self, pixel: UVec2) -> usize {
        assert!(pixel.x < self.size.x && pixel.y < self.size.y, "{pixel} is off the film");
        let tile = (pixel.y / TILE) as usize * self.tiles.x as usize + (pixel.x / TILE) as usize;
        tile * TILE_PIXELS + ((pixel.y % TILE) * TILE + pixel.x % TILE) as usize
    }
}

/// The `row`-th row of tiles (16 stored pixels): its first pixel and the number of its pixels on
/// the film; `None` below the last line.
pub(crate) fn row_pixels(size: UVec2, tiles: UVec2, row: usize) -> (UVec2, u32) {
    let (tile, line) = (row / TILE as usize, (row % TILE as usize) as u32);
    let tile = UVec2::new((tile % tiles.x as usize) as u32, (tile / tiles.x as usize) as u32);
    let first = UVec2::new(tile.x * TILE, tile.y * TILE + line);
    let width = if first.y < size.y { TILE.min(size.x - first.x) } else { 0 };
    (first, width)
}

/// Adds the next sample of a pixel to its sums and returns what it adds to the totals.
pub(crate) fn add_sample(count: &mut u32, sums: &mut Sums, sample: &PathSample) -> Totals {
    if *count == 0 {
        *sums = Sums::zeroed();
    }
    let accumulator = *count as usize % ACCUMULATORS;
    *count += 1;
    sums.steps.add(sample.tracking_steps as f32);
    let usable = is_usable(sample);
    if usable {
        add_rgb(&mut sums.beauty[accumulator], sample.beauty());
        add_rgb(&mut sums.emission, sample.emission);
        add_rgb(&mut sums.background, sample.background);
        add_rgb(&mut sums.direct, sample.direct);
        add_rgb(&mut sums.indirect, sample.indirect);
        sums.alpha.add(sample.alpha);
        if let Some(depth) = sample.depth {
            sums.depth.add(depth);
            sums.depth_count += 1;
        }
    }
    Totals {
        paths: 1,
        tracking_steps: u64::from(sample.tracking_steps),
        non_finite: u64::from(!usable),
        guard_hits: u64::from(sample.was_cut),
    }
}

fn is_usable(sample: &PathSample) -> bool {
    let in_range = |rgb: Rgb| rgb.abs().cmple(Rgb::splat(LARGEST_VALUE)).all();
    in_range(sample.emission)
        && in_range(sample.background)
        && in_range(sample.direct)
        && in_range(sample.indirect)
        && sample.alpha.abs() <= LARGEST_VALUE
        && sample.depth.is_none_or(|depth| depth.abs() <= LARGEST_VALUE)
}

impl PartialEq for Film {
    /// Whether both have the same samples, bit for bit.
    fn eq(&self, other: &Self) -> bool {
        self.size == other.size
            && self.totals == other.totals
            && self.counts == other.counts
            && std::iter::zip(&self.counts, std::iter::zip(&self.sums, &other.sums))
                .all(|(&count, (a, b))| count == 0 || bytes_of(a) == bytes_of(b))
    }
}

impl std::fmt::Debug for Film {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Film")
            .field("size", &self.size)
            .field("samples", &self.sample_range())
            .field("totals", &self.totals)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(value: f32) -> PathSample {
        PathSample { direct: Rgb::splat(value), alpha: 0.5, depth: Some(2.0), ..Default::default() }
    }

    #[test]
    fn samples_go_round_the_accumulators() {
        let mut film = Film::new(UVec2::new(20, 3)).unwrap();
        let pixel = UVec2::new(19, 2);
        for s in 0..11 {
            film.add(pixel, &gray(s as f32));
        }
        let sums = film.sums(pixel).unwrap();
        let beauty: Vec<f64> = sums.beauty.iter().map(|rgb| rgb[1].value()).collect();
        assert_eq!(beauty, [8.0, 10.0, 12.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        assert_eq!(sums.direct[2].value(), 55.0);
        assert_eq!((sums.depth.value(), sums.depth_count), (22.0, 11));
        assert_eq!(film.samples(pixel), 11);
        assert_eq!(film.sums(UVec2::new(18, 2)), None);
        assert_eq!(film.sample_range(), (0, 11));
    }

    #[test]
    fn bad_samples_count_but_add_nothing() {
        let mut film = Film::new(UVec2::ONE).unwrap();
        for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY, 1.0e31] {
            film.add(UVec2::ZERO, &gray(bad));
        }
        film.add(UVec2::ZERO, &PathSample { depth: Some(f32::NAN), ..gray(1.0) });
        film.add(UVec2::ZERO, &PathSample { alpha: f32::NAN, tracking_steps: 5, ..gray(1.0) });
        film.add(UVec2::ZERO, &PathSample { tracking_steps: 7, was_cut: true, ..gray(3.0) });
        let sums = film.sums(UVec2::ZERO).unwrap();
        assert_eq!((sums.direct[0].value(), sums.depth_count), (3.0, 1));
        assert_eq!(sums.steps.value(), 12.0, "what a failed sample cost was spent all the same");
        let expected = Totals { paths: 7, tracking_steps: 12, non_finite: 6, guard_hits: 1 };
        assert_eq!(film.totals, expected);
    }

    #[test]
    fn clearing_forgets_all() {
        let size = UVec2::new(5, 5);
        let mut film = Film::new(size).unwrap();
        film.add(UVec2::new(4, 4), &gray(3.0));
        film.clear();
        assert_eq!(film, Film::new(size).unwrap());
        film.add(UVec2::new(4, 4), &gray(1.0));
        assert_eq!(film.sums(UVec2::new(4, 4)).unwrap().direct[0].value(), 1.0);
    }

    #[test]
    fn every_pixel_has_a_place_of_its_own() {
        let size = UVec2::new(37, 18);
        let film = Film::new(size).unwrap();
        let mut seen = std::collections::HashSet::new();
        for y in 0..size.y {
            for x in 0..size.x {
                let index = film.index(UVec2::new(x, y));
                assert!(seen.insert(index));
                let (first, width) = row_pixels(size, film.tiles, index / TILE as usize);
                assert_eq!((first.x + index as u32 % TILE, first.y), (x, y));
                assert!(index as u32 % TILE < width);
            }
        }
        let rows = film.counts.len() / TILE as usize;
        let on_film: u32 = (0..rows).map(|row| row_pixels(size, film.tiles, row).1).sum();
        assert_eq!(on_film, size.x * size.y);
    }

    #[test]
    fn absurd_sizes_are_errors() {
        for (x, y) in [(0, 4), (4, 0), (u32::MAX, u32::MAX), (1 << 20, 1 << 20)] {
            assert!(Film::new(UVec2::new(x, y)).is_err(), "{x} x {y}");
        }
    }
}
