//! The figures against noise whose variance and cost are known.

use glam::UVec2;

use super::tally::Tally;
use super::*;
use crate::render::FilmStats;
use crate::render::synthetic::{Fireflies, GrayLevel, sampled};
use crate::render::{Area, Film};
use crate::transport::SampleNumber;

const SIZE: UVec2 = UVec2::new(40, 30);

fn level(seed: u64, mean: f32, spread: f32, samples: u32) -> Film {
    sampled(&GrayLevel { seed, mean, spread }, SIZE, samples)
}

/// A has 9 times the variance of B for a third of the samples and twice the CPU time: it needs
/// 9 × 3 × 2 times as long.
fn known(seed: u64) -> Comparison {
    let a = level(2 * seed, 1.0, 0.9, 16);
    let b = level(2 * seed + 1, 1.0, 0.3, 48);
    Comparison::of([&a, &b], [2.0, 1.0], None)
}

#[test]
fn the_speed_up_is_that_of_variance_and_cost() {
    for seed in 0..3 {
        let comparison = known(seed);
        let [low, high] = comparison.speed_up.unwrap().interval();
        assert!(low < 54.0 && 54.0 < high, "seed {seed}: {low} to {high}");
        assert!(high < 1.2 * low, "the test is too weak");
        let sentence = comparison.sentence();
        assert!(sentence.starts_with("B needs 1/5"), "{sentence}");
    }
}

/// Over many seeds the interval misses the truth about as often as it claims. The error of the
/// clock is not in these films, so their interval is taken without it.
#[test]
fn the_interval_covers_the_truth_as_often_as_it_says() {
    let covers = |a: &Film, b: &Film, truth: f64| {
        let sides = Comparison::of([a, b], [1.0, 1.0], None).sides;
        let relative = sides.map(|side| {
            let variance = side.variance_of_mean.unwrap();
            (variance, side.variance_error.unwrap() / variance)
        });
        let ratio = relative[0].0 / relative[1].0;
        let error = relative[0].1.hypot(relative[1].1);
        (ratio / truth).ln().abs() < 1.96 * error
    };
    let seeds = 200;
    let size = UVec2::new(16, 16);
    let mut uniform = 0;
    let mut rare = 0;
    for seed in 0..seeds {
        let film = |seed, spread| sampled(&GrayLevel { seed, mean: 1.0, spread }, size, 16);
        uniform += u32::from(covers(&film(2 * seed, 0.6), &film(2 * seed + 1, 0.3), 4.0));
        // 1 / chance − 1 of 49 and 499, with some 80 events on each film: no Gaussian formula
        // would know how far to trust that.
        let film =
            |seed, chance, samples| sampled(&Fireflies { seed, mean: 1.0, chance }, size, samples);
        let (a, b) = (film(2 * seed, 0.02, 16), film(2 * seed + 1, 0.002, 160));
        rare += u32::from(covers(&a, &b, 49.0 / 49.9));
    }
    for (name, covered) in [("uniform", uniform), ("rare", rare)] {
        let share = f64::from(covered) / seeds as f64;
        let error = (0.95 * 0.05 / seeds as f64).sqrt();
        assert!((share - 0.95).abs() < 3.5 * error, "{name}: {share}");
    }
}

#[test]
fn figures_are_those_of_the_films() {
    let (a, b) = (level(5, 1.0, 1.0, 12), level(6, 0.5, 1.0, 8));
    let comparison = Comparison::of([&a, &b], [1.5, 2.5], None);
    for (side, film) in std::iter::zip(&comparison.sides, [&a, &b]) {
        let stats = FilmStats::of(film);
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
        assert!(close(side.noise.unwrap(), stats.noise.unwrap()));
        assert!(close(side.variance_of_mean.unwrap(), stats.gray_variance_of_mean.unwrap()));
        assert!(close(side.mean_rgb[1], stats.mean_rgb[1]));
        assert_eq!(side.samples_per_pixel, stats.samples_per_pixel);
    }
    let counts = comparison.sides.map(|side| (side.fewest_samples, side.cpu_seconds));
    assert_eq!(counts, [(12, 1.5), (8, 2.5)]);
}

#[test]
fn an_area_has_figures_of_its_own() {
    /// Bright and noisy to the left of x = 20, dark and quiet to the right.
    struct Halves(u64);
    impl crate::transport::PixelSampler for Halves {
        fn sample(&self, pixel: UVec2, number: SampleNumber) -> crate::transport::PathSample {
            let (mean, spread) = if pixel.x < 20 { (2.0, 1.0) } else { (0.5, 0.1) };
            GrayLevel { seed: self.0, mean, spread }.sample(pixel, number)
        }
    }
    let films = [0, 1].map(|seed| sampled(&Halves(seed), SIZE, 16));
    let right = Area { first: UVec2::new(20, 3), size: UVec2::new(99, 9) };
    let comparison = Comparison::of([&films[0], &films[1]], [1.0, 1.0], Some(right));
    let side = comparison.sides[0];
    assert!((side.mean_rgb[0] - 0.5).abs() < 0.01);
    let expected = 0.01 / 12.0 / 16.0;
    let z = (side.variance_of_mean.unwrap() - expected) / side.variance_error.unwrap();
    assert!(z.abs() < 4.0, "{z}");
    let nowhere = Area { first: UVec2::new(40, 0), size: UVec2::ONE };
    let nothing = Comparison::of([&films[0], &films[1]], [1.0, 1.0], Some(nowhere));
    assert_eq!((nothing.speed_up, nothing.agreement.verdict), (None, Verdict::TooFewSamples));
}

#[test]
fn empty_and_black_films_have_no_verdict_and_no_fault() {
    let empty = Film::new(SIZE).unwrap();
    let comparison = Comparison::of([&empty, &empty], [0.0, 0.0], None);
    assert_eq!(comparison.agreement.verdict, Verdict::TooFewSamples);
    assert!(comparison.sentence().contains("too few samples"));
    let black = level(0, 0.0, 0.0, 8);
    let comparison = Comparison::of([&black, &black], [1.0, 1.0], None);
    assert_eq!(comparison.agreement.verdict, Verdict::Agree);
    assert!(comparison.sentence().starts_with("Neither"));
}

/// The verdict on two films, with the chance `alarm` of a false alarm.
fn verdict(a: &Film, b: &Film, alarm: f64) -> Verdict {
    let area = Area::of(a.size());
    let blocks = area.blocks();
    let tallies: Vec<[Tally; 2]> =
        blocks.iter().map(|block| [Tally::of(a, block), Tally::of(b, block)]).collect();
    let all =
        [0, 1].map(|side| tallies.iter().fold(Tally::default(), |sum, pair| sum.plus(&pair[side])));
    Agreement::new((&area, &all), &blocks, &tallies, alarm).verdict
}

/// Settings that agree raise no more alarms than stated, with even noise and with rare bright
/// samples, of which a block may not have met one. One in twenty is tested, as one in a thousand
/// would take too long to count; of those there must be hardly any.
#[test]
fn agreeing_films_raise_no_more_alarms_than_stated() {
    let seeds = 200;
    let (stated, mut alarms) = (0.05, [[0; 2]; 3]);
    for seed in 0..seeds {
        let fireflies = |seed, chance| sampled(&Fireflies { seed, mean: 1.0, chance }, SIZE, 8);
        let pairs = [
            (level(2 * seed, 1.0, 1.0, 8), level(2 * seed + 1, 1.0, 0.2, 8)),
            (fireflies(2 * seed, 0.002), level(2 * seed + 1, 1.0, 0.2, 8)),
            (fireflies(2 * seed, 0.02), fireflies(2 * seed + 1, 0.005)),
        ];
        for ((a, b), count) in std::iter::zip(&pairs, &mut alarms) {
            for (alarm, count) in std::iter::zip([stated, ALARM], count) {
                *count += u32::from(verdict(a, b, alarm) == Verdict::Differ);
            }
        }
    }
    let expected = stated * seeds as f64;
    for [often, rarely] in alarms {
        assert!(f64::from(often) < expected + 4.0 * expected.sqrt(), "{alarms:?}");
        assert!(rarely <= 2, "{alarms:?}");
    }
}

#[test]
fn a_bias_of_two_percent_is_found() {
    for seed in 0..3 {
        let a = level(2 * seed, 1.0, 1.0, 64);
        let biased = level(2 * seed + 1, 1.02, 1.0, 64);
        let right = level(2 * seed + 1, 1.0, 1.0, 64);
        assert_eq!(verdict(&a, &biased, ALARM), Verdict::Differ, "seed {seed}");
        assert_eq!(verdict(&a, &right, ALARM), Verdict::Agree, "seed {seed}");
        let few = level(2 * seed, 2.0, 1.0, 7);
        assert_eq!(verdict(&few, &right, ALARM), Verdict::TooFewSamples);
    }
}

/// A fault in one block is found where the whole picture hides it.
#[test]
fn a_local_bias_is_found_in_its_block() {
    struct Spot;
    impl crate::transport::PixelSampler for Spot {
        fn sample(&self, pixel: UVec2, number: SampleNumber) -> crate::transport::PathSample {
            let mean = if pixel.x < 16 && pixel.y < 16 { 1.05 } else { 0.986 };
            GrayLevel { seed: 9, mean, spread: 0.5 }.sample(pixel, number)
        }
    }
    let films = [level(8, 1.0, 0.5, 16), sampled(&Spot, SIZE, 16)];
    let agreement = Comparison::of([&films[0], &films[1]], [1.0, 1.0], None).agreement;
    assert_eq!((agreement.verdict, agreement.tests), (Verdict::Differ, 7));
    let worst = agreement.worst.unwrap();
    assert!(worst.probability < agreement.limit);
    assert_eq!(worst.area, Area { first: UVec2::ZERO, size: UVec2::splat(16) });
}

/// Constant pictures differ in the last digits when their samples are counted differently.
#[test]
fn rounding_is_no_difference() {
    let (a, b) = (level(0, 0.1, 0.0, 8), level(1, 0.1, 0.0, 13));
    assert_eq!(verdict(&a, &b, ALARM), Verdict::Agree);
    let brighter = level(1, 0.1001, 0.0, 13);
    assert_eq!(verdict(&a, &brighter, ALARM), Verdict::Differ);
}

/// Figures taken from pictures equal those taken from their films.
#[test]
fn pictures_tell_the_same_as_their_films() {
    use crate::render::picture::{Picture, resolve, resolve_variance};
    let films = [level(0, 1.0, 0.9, 16), level(1, 1.0, 0.3, 16)];
    let seconds = [2.0, 1.0];
    let pictures = [0, 1].map(|side| {
        let film: &Film = &films[side];
        let mut picture = Picture { size: SIZE, fewest_samples: 16, ..Picture::default() };
        picture.stats.cpu_seconds = seconds[side];
        picture.stats.samples_per_pixel = 16.0;
        resolve(film, &mut picture.pixels);
        resolve_variance(film, &mut picture.variance);
        picture
    });
    for area in [None, Some(Area { first: UVec2::new(3, 4), size: UVec2::new(9, 11) })] {
        let of_films = Comparison::of([&films[0], &films[1]], seconds, area);
        let of_pictures = Comparison::of_pictures([&pictures[0], &pictures[1]], area);
        assert_eq!(of_pictures.agreement.verdict, of_films.agreement.verdict);
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-4;
        for (one, other) in of_pictures.sides.iter().zip(&of_films.sides) {
            assert!(near(one.variance_of_mean.unwrap(), other.variance_of_mean.unwrap()));
            assert!(near(one.variance_error.unwrap(), other.variance_error.unwrap()));
            assert_eq!(one.samples_per_pixel, other.samples_per_pixel);
        }
        let [a, b] = [of_pictures, of_films].map(|comparison| comparison.speed_up.unwrap().ratio);
        assert!(near(a, b), "{a} for {b}");
    }
}

/// Where a region gets all samples, figures of the region use its samples, and the rest its own.
#[test]
fn a_region_with_all_samples_is_known_better_than_the_rest() {
    use crate::render::picture::Picture;
    let area = Area { first: UVec2::new(3, 4), size: UVec2::new(9, 11) };
    let pixels = vec![[1.0; 4]; (SIZE.x * SIZE.y) as usize];
    let picture = Picture {
        size: SIZE,
        pixels,
        fewest_samples: 1,
        region: Some((area, 40)),
        ..Default::default()
    };
    let inside = SideFigures::of_picture(&picture, Some(area));
    assert_eq!((inside.fewest_samples, inside.samples_per_pixel), (40, 40.0));
    assert_eq!(SideFigures::of_picture(&picture, None).fewest_samples, 1);
}
