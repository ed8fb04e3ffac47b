//! A fire whose noise-free picture is known, against every combination of the toggles.

use std::sync::Arc;

use crate::common::{
    self, Expected, Verdicts, build, half_of_strategies, name, seed, shared, with_strategy,
};
use flambeau::{
    image::npy,
    render::{
        Film,
        estimate::{PixelEstimate, gray},
    },
    transport::{
        PreparedFrame, Scene,
        strategy::{BoostMode, Preset, Strategy},
    },
};
use glam::UVec2;
use rayon::prelude::*;

/// Pixels along an edge of the exact picture.
const SIDE: usize = 128;
/// Of its rows and columns every second is rendered.
const STEP: usize = 2;
/// Pixels along the edge of a block; each block of each picture is one comparison.
const BLOCK: usize = 16;

/// The pixels that are rendered, by block.
fn pixels() -> impl Iterator<Item = (usize, UVec2)> {
    let places = (0..SIDE).step_by(STEP).flat_map(|y| (0..SIDE).step_by(STEP).map(move |x| (x, y)));
    places.map(|(x, y)| (y / BLOCK * (SIDE / BLOCK) + x / BLOCK, UVec2::new(x as u32, y as u32)))
}

/// A picture that is rendered further and further.
struct Picture {
    frame: PreparedFrame,
    films: Vec<Film>,
    samples: u32,
}

impl Picture {
    fn new(scene: Scene, number: u64) -> Self {
        let (size, seed) = (UVec2::splat(SIDE as u32), seed().wrapping_add(number));
        let films = pixels().map(|_| Film::new(UVec2::ONE).unwrap()).collect();
        Self { frame: crate::common::frame_of(Arc::new(scene), size, seed), films, samples: 0 }
    }

    /// The gray mean, with its variance, by so many samples a pixel: of the picture, then of each of
    /// the `blocks`. By stratified sampling each pixel's own variance counts, not the picture's.
    fn means(&mut self, samples: u32, blocks: &[usize]) -> Vec<[f64; 2]> {
        let (frame, present) = (&self.frame, self.samples);
        let pixels: Vec<(usize, UVec2)> = pixels().collect();
        self.films.par_iter_mut().zip(&pixels).for_each(|(film, (_, pixel))| {
            (present..samples).for_each(|s| film.add(UVec2::ZERO, &frame.sample(*pixel, s)));
        });
        self.samples = samples;
        let values: Vec<(usize, [f64; 2])> = std::iter::zip(&self.films, &pixels)
            .map(|(film, (block, _))| {
                let estimate = PixelEstimate::of(film, UVec2::ZERO).unwrap();
                (*block, [gray(estimate.mean()), estimate.gray_variance().unwrap()])
            })
            .collect();
        let of = |wanted: Option<usize>| {
            let inside = values.iter().filter(|(block, _)| wanted.is_none_or(|w| w == *block));
            let (mut sum, mut count) = ([0.0; 2], 0.0);
            for (_, value) in inside {
                (0..2).for_each(|i| sum[i] += value[i]);
                count += 1.0;
            }
            [sum[0] / count, sum[1] / (count * count)]
        };
        std::iter::once(None).chain(blocks.iter().copied().map(Some)).map(of).collect()
    }
}

/// The mean of the exact picture's pixels that are rendered, then those of its blocks, and which
/// blocks these are. Blocks the fire hardly touches are too dark to be found by a few thousand paths.
fn expected(exact: &[f64]) -> (Expected, Vec<usize>) {
    let mean = |wanted: Option<usize>| {
        let inside = pixels().filter(|(block, _)| wanted.is_none_or(|w| w == *block));
        let values: Vec<f64> =
            inside.map(|(_, at)| exact[at.y as usize * SIDE + at.x as usize]).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let brightest = exact.iter().copied().fold(0.0, f64::max);
    let blocks = (0..(SIDE / BLOCK).pow(2)).filter(|block| mean(Some(*block)) >= 1e-3 * brightest);
    let blocks: Vec<usize> = blocks.collect();
    let values = std::iter::once(None).chain(blocks.iter().copied().map(Some)).map(mean);
    (Expected::known(&values.collect::<Vec<_>>()).deciding(1), blocks)
}

#[test]
fn fire_absorb_matches_its_exact_picture() {
    let Some(file) = shared("peers/flame.vdb") else { return };
    let Some(exact) = shared("peers/fire_absorb_exact.npy") else { return };
    let (_, exact) = npy::read(&exact).unwrap();
    let exact: Vec<f64> =
        exact.iter().map(|p| p[..3].iter().map(|&v| f64::from(v)).sum::<f64>() / 3.0).collect();
    let scene = build(&format!(
        r#"
        [camera]
        position = [0, -5, 0.4]
        target = [0, 0, 0]
        fov_x = 32
        [[volume]]
        file = "{}"
        albedo = 0.0
        emission = {{ mode = "grid", grid = "emission" }}
        "#,
        file.display()
    ));
    let (expected, blocks) = expected(&exact);
    let (mut verdicts, mut closely) =
        (Verdicts::default(), Verdicts::of_power(0.3 * common::POWER));
    let mut optimal = Strategy::default();
    optimal.advanced.boost_mode = BoostMode::Optimal;
    // Nothing scatters, so that a look at the fire never happens: once is enough.
    let looking = half_of_strategies().into_iter().filter(|strategy| strategy.nee);
    for strategy in looking.chain([optimal]) {
        // The default brings a far lower error at the same cost.
        let is_default = strategy.preset() == Some(Preset::Full)
            && strategy.advanced.boost_mode == BoostMode::default();
        let verdicts = if is_default { &mut closely } else { &mut verdicts };
        let mut picture = Picture::new(with_strategy(&scene, strategy), verdicts.next_seed());
        let label = format!("{} {:?}", name(&strategy), strategy.advanced.boost_mode);
        verdicts.follow(&label, &strategy, 16_384, &expected, |samples| {
            picture.means(samples, &blocks)
        });
    }
    verdicts.finish();
    closely.finish();
}
