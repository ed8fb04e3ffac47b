//! Pictures read from a film: colors, variance, a layer and figures at one time of the render.

use glam::UVec2;
use rayon::prelude::*;

use super::area::Area;
use super::coarse::{representative, shown_pixel};
use super::estimate::{FilmStats, LineStats, PixelEstimate, samples_per_pixel};
use super::film::Film;
use super::layers::{Layer, LayerMap};
use crate::transport::spending::Spending;

/// A finished image of an unfinished render.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// Generation of the request that the picture belongs to, numbered by the caller.
    pub generation: u64,
    /// Width and height.
    pub size: UVec2,
    /// Linear RGBA before exposure, row 0 on top. A pixel without samples shows its block.
    pub pixels: Vec<[f32; 4]>,
    /// Values of the requested layer; empty unless one is requested.
    pub layer: LayerMap,
    /// Samples that every pixel has.
    pub fewest_samples: u32,
    /// The region that alone is rendered, and the samples of its pixel that has fewest.
    pub region: Option<(Area, u32)>,
    /// Variance of the gray mean of each pixel, and the variance of that; row 0 on top, NaN below
    /// two samples; empty unless asked for, and while pixels have no sample.
    pub variance: Vec<[f32; 2]>,
    /// Whether every pixel has at least one sample of its own.
    pub complete: bool,
    /// Blocks of 2 to this power pixels squared are of one color each, so that one pixel of each
    /// tells all; 0: any pixel may differ from the next.
    pub block_log2: u32,
    /// Figures at the time of the picture.
    pub stats: RenderStats,
}

/// The data that a picture brings along beside its light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extras {
    /// The layer to read beside the light.
    pub layer: Option<Layer>,
    /// The variance of its pixels.
    pub variance: bool,
}

impl Extras {
    /// Whether this request has anything that `other` lacks.
    pub fn adds_to(self, other: Self) -> bool {
        self.layer.is_some() && self.layer != other.layer || self.variance && !other.variance
    }
}

/// Progress and figures of a render.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RenderStats {
    /// Mean number of samples of a pixel.
    pub samples_per_pixel: f64,
    /// Seconds of rendering, pauses not counted.
    pub seconds: f64,
    /// CPU time that the threads have spent sampling, in seconds.
    pub cpu_seconds: f64,
    /// Tentative collisions so far.
    pub tracking_steps: u64,
    /// Paths traced so far.
    pub paths: u64,
    /// Samples that were not finite and count as zero.
    pub non_finite: u64,
    /// Paths that were cut, see [`PathSample::was_cut`](crate::transport::PathSample::was_cut).
    pub guard_hits: u64,
    /// Relative standard error of the picture, see [`FilmStats::noise`]; none before two samples.
    pub noise: Option<f64>,
    /// Guided flights of a camera ray, relative to those that the probes propose, see
    /// [`Prepared::guided_flights`](crate::transport::Prepared::guided_flights).
    pub guided_flights: Option<f32>,
    /// How the time is spent, see [`Prepared::spending`](crate::transport::Prepared::spending).
    pub spending: Option<Spending>,
    /// Whether the limit is reached.
    pub finished: bool,
}

/// Reads the picture into `pixels`, which gets the size of the film; returns the noise (see
/// [`FilmStats::noise`]). Runs on the threads of the calling pool.
pub fn resolve(film: &Film, pixels: &mut Vec<[f32; 4]>) -> Option<f64> {
    let size = film.size();
    pixels.resize(size.x as usize * size.y as usize, [0.0; 4]);
    let lines: Vec<LineStats> = pixels
        .par_chunks_mut(size.x as usize)
        .enumerate()
        .map(|(y, line)| resolve_line(film, y as u32, line))
        .collect();
    FilmStats::from_lines(film, &lines).noise
}

/// Reads a picture of blocks of `side`² pixels into `pixels`, which gets the size of the film: what
/// [`resolve`] says of a film that has just the samples of the stride `side`, for less. Runs on the
/// threads of the calling pool.
pub fn resolve_blocks(film: &Film, side: u32, pixels: &mut Vec<[f32; 4]>) {
    let size = film.size();
    let width = size.x as usize;
    pixels.resize(width * size.y as usize, [0.0; 4]);
    pixels.par_chunks_mut(width * side as usize).enumerate().for_each(|(row, lines)| {
        let (first, others) = lines.split_at_mut(width);
        for (column, block) in first.chunks_mut(side as usize).enumerate() {
            let corner = UVec2::new(column as u32, row as u32) * side;
            block.fill(color(film, representative(corner, side, size)));
        }
        others.chunks_mut(width).for_each(|line| line.copy_from_slice(first));
    });
}

/// The color that the samples of `pixel` show; black without any.
fn color(film: &Film, pixel: UVec2) -> [f32; 4] {
    PixelEstimate::of(film, pixel).map_or([0.0; 4], |estimate| rgba(&estimate, estimate.mean()))
}

fn rgba(estimate: &PixelEstimate<'_>, mean: [f64; 3]) -> [f32; 4] {
    let [r, g, b] = mean.map(|value| value as f32);
    [r, g, b, estimate.alpha() as f32]
}

/// Reads the variance of the gray mean of every pixel and the variance of that into `variance`,
/// which gets the size of the film. Runs on the threads of the calling pool.
pub fn resolve_variance(film: &Film, variance: &mut Vec<[f32; 2]>) {
    let size = film.size();
    variance.resize(size.x as usize * size.y as usize, [f32::NAN; 2]);
    variance.par_chunks_mut(size.x as usize).enumerate().for_each(|(y, line)| {
        for (x, out) in line.iter_mut().enumerate() {
            let pixel = PixelEstimate::of(film, UVec2::new(x as u32, y as u32));
            let variance = pixel
                .and_then(|pixel| pixel.gray_variance().zip(pixel.gray_variance_uncertainty()));
            *out = variance.map_or([f32::NAN; 2], |(of, again)| [of as f32, again as f32]);
        }
    });
}

fn resolve_line(film: &Film, y: u32, line: &mut [[f32; 4]]) -> LineStats {
    let mut stats = LineStats::default();
    // Neighbors that show the same block are read once.
    let mut last = (UVec2::MAX, [0.0; 4]);
    for (x, out) in line.iter_mut().enumerate() {
        let pixel = UVec2::new(x as u32, y);
        let shown = shown_pixel(film, pixel);
        if shown != last.0 {
            last = (shown, [0.0; 4]);
            if let Some(estimate) = PixelEstimate::of(film, shown) {
                let mean = estimate.mean();
                if shown == pixel {
                    stats.add(&estimate, mean);
                }
                last.1 = rgba(&estimate, mean);
            }
        }
        *out = last.1;
    }
    stats
}

/// The figures of `film` after `seconds` of rendering.
pub(crate) fn render_stats(
    film: &Film,
    seconds: f64,
    noise: Option<f64>,
    finished: bool,
) -> RenderStats {
    RenderStats {
        samples_per_pixel: samples_per_pixel(film),
        seconds,
        cpu_seconds: 0.0,
        tracking_steps: film.totals.tracking_steps,
        paths: film.totals.paths,
        non_finite: film.totals.non_finite,
        guard_hits: film.totals.guard_hits,
        noise,
        guided_flights: None,
        spending: None,
        finished,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::render::synthetic::{Uniform, sampled};
    use crate::transport::PathSample;

    fn red(value: f32) -> PathSample {
        PathSample { emission: Rgb::new(value, 0.0, 0.0), alpha: 0.25, ..Default::default() }
    }

    #[test]
    fn an_unsampled_pixel_shows_its_smallest_sampled_block() {
        let mut film = Film::new(UVec2::new(21, 17)).unwrap();
        let mut pixels = Vec::new();
        film.add(UVec2::new(8, 8), &red(16.0));
        film.add(UVec2::new(4, 4), &red(8.0));
        film.add(UVec2::new(2, 2), &red(4.0));
        film.add(UVec2::new(1, 0), &red(1.0));
        film.add(UVec2::new(20, 4), &red(20.0));
        resolve(&film, &mut pixels);
        let red_at = |x: usize, y: usize| pixels[y * 21 + x][0];
        assert_eq!(red_at(1, 0), 1.0);
        assert_eq!(red_at(0, 0), 4.0);
        assert_eq!(red_at(3, 3), 4.0);
        assert_eq!(red_at(5, 7), 8.0);
        assert_eq!(red_at(9, 7), 16.0);
        assert_eq!(red_at(15, 15), 16.0);
        assert_eq!(red_at(17, 0), 20.0);
        assert_eq!(pixels[0], [4.0, 0.0, 0.0, 0.25]);
        assert_eq!(pixels[16 * 21], [0.0; 4]);
    }

    #[test]
    fn blocks_are_read_as_their_pixels_would_be() {
        let size = UVec2::new(75, 50);
        for side in [4, 32] {
            let mut film = Film::new(size).unwrap();
            for index in 0..size.x * size.y {
                let pixel = UVec2::new(index % size.x, index / size.x);
                if representative(pixel, side, size) == pixel {
                    film.add(pixel, &red(index as f32));
                }
            }
            let (mut blocks, mut single) = (Vec::new(), Vec::new());
            resolve_blocks(&film, side, &mut blocks);
            assert_eq!(resolve(&film, &mut single), None);
            assert_eq!(blocks, single);
        }
    }

    #[test]
    fn the_noise_is_that_of_the_film() {
        let size = UVec2::new(33, 20);
        let film = sampled(&Uniform::default(), size, 9);
        assert_eq!(resolve(&film, &mut Vec::new()), FilmStats::of(&film).noise);
    }

    #[test]
    fn bad_paths_are_in_the_figures() {
        let mut film = Film::new(UVec2::ONE).unwrap();
        film.add(UVec2::ZERO, &PathSample { was_cut: true, ..red(1.0) });
        film.add(UVec2::ZERO, &red(f32::NAN));
        let stats = render_stats(&film, 0.0, None, false);
        assert_eq!((stats.paths, stats.guard_hits, stats.non_finite), (2, 1, 1));
    }
}
