//! Maps of two films: their difference and the noise of each.

use glam::UVec2;
use rayon::prelude::*;

use super::agreement::ROUNDING;
use crate::render::estimate::{PixelEstimate, gray};
use crate::render::film::Film;

/// Gray of B minus gray of A, relative to the mean of both pictures; 0 where a pixel has no sample.
/// Rows from the top. Both films have the same size.
pub fn difference(films: [&Film; 2]) -> Vec<f32> {
    let size = films[0].size().min(films[1].size());
    let grays = films.map(|film| of_pixels(film, size, |pixel| Some(gray(pixel.mean()))));
    let level = 0.5 * (mean(&grays[0]) + mean(&grays[1]));
    let pairs = std::iter::zip(&grays[0], &grays[1]);
    let relative = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
        (Some(a), Some(b)) if level > 0.0 => ((b - a) / level) as f32,
        _ => 0.0,
    };
    pairs.map(relative).collect()
}

/// Standard error of each pixel's gray relative to the mean of the picture; 0 where it is not known
/// or no more than rounding. Rows from the top. The root of the mean of the squares is the noise of
/// the picture.
pub fn noise(film: &Film) -> Vec<f32> {
    let size = film.size();
    let level = mean(&of_pixels(film, size, |pixel| Some(gray(pixel.mean()))));
    let variances = of_pixels(film, size, |pixel| pixel.gray_variance());
    let relative = |variance: &Option<f64>| match *variance {
        Some(variance) if level > 0.0 => {
            let error = variance.sqrt() / level;
            if error > ROUNDING { error as f32 } else { 0.0 }
        }
        _ => 0.0,
    };
    variances.iter().map(relative).collect()
}

/// Map of `value` over the pixels of a picture of that size, row by row.
fn of_pixels(
    film: &Film,
    size: UVec2,
    value: impl Fn(&PixelEstimate<'_>) -> Option<f64> + Sync,
) -> Vec<Option<f64>> {
    let line = |y: u32| {
        let pixels = (0..size.x).map(move |x| UVec2::new(x, y));
        pixels.map(|pixel| PixelEstimate::of(film, pixel).and_then(|p| value(&p))).collect()
    };
    let lines: Vec<Vec<_>> = (0..size.y).into_par_iter().map(line).collect();
    lines.concat()
}

fn mean(values: &[Option<f64>]) -> f64 {
    let known = || values.iter().flatten();
    known().sum::<f64>() / known().count().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::FilmStats;
    use crate::render::synthetic::{GrayLevel, sampled};

    const SIZE: UVec2 = UVec2::new(30, 20);

    #[test]
    fn the_map_of_noise_is_that_of_the_picture() {
        let film = sampled(&GrayLevel { seed: 1, mean: 2.0, spread: 1.0 }, SIZE, 16);
        let map = noise(&film);
        assert_eq!(map.len(), 600);
        let square = map.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>() / 600.0;
        let expected = FilmStats::of(&film).noise.unwrap();
        assert!((square.sqrt() / expected - 1.0).abs() < 1e-5);
        let constant = sampled(&GrayLevel { seed: 1, mean: 0.1, spread: 0.0 }, SIZE, 13);
        assert!(noise(&constant).iter().all(|&x| x == 0.0), "rounding is no noise");
        assert!(noise(&Film::new(SIZE).unwrap()).iter().all(|&x| x == 0.0));
    }

    #[test]
    fn differences_are_relative_and_signed() {
        let film = |mean| sampled(&GrayLevel { seed: 1, mean, spread: 0.0 }, SIZE, 2);
        let map = difference([&film(1.0), &film(3.0)]);
        assert!(map.iter().all(|&x| (x - 1.0).abs() < 1e-6));
        let empty = Film::new(SIZE).unwrap();
        assert!(difference([&film(3.0), &empty]).iter().all(|&x| x == 0.0));
    }
}
