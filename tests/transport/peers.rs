//! A fire whose noise-free picture is known, against every combination of the toggles.

use std::sync::Arc;

use crate::common::{self, Z_LIMIT, build, half_of_strategies, name, seed, shared, with_strategy};
use flambeau::{
    image::npy,
    render::{
        Film,
        estimate::{PixelEstimate, gray},
    },
    transport::{
        Scene,
        strategy::{BoostMode, Preset, Strategy},
    },
};
use glam::UVec2;
use rayon::prelude::*;

const SIDE: usize = 128;
/// Pixels along the edge of a block; each block of each picture is one comparison.
const BLOCK: usize = 16;

/// Gray mean of one pixel and the variance of it, as the film's accumulators tell it.
type Pixel = [f64; 2];

fn render(scene: &Scene, samples: u32) -> Vec<Pixel> {
    let size = UVec2::splat(SIDE as u32);
    let frame = crate::common::frame_of(Arc::new(scene.clone()), size, seed());
    (0..size.element_product())
        .into_par_iter()
        .map(|i| {
            let mut film = Film::new(UVec2::ONE).unwrap();
            let pixel = UVec2::new(i % size.x, i / size.x);
            (0..samples).for_each(|s| film.add(UVec2::ZERO, &frame.sample(pixel, s)));
            let estimate = PixelEstimate::of(&film, UVec2::ZERO).unwrap();
            [gray(estimate.mean()), estimate.gray_variance().unwrap()]
        })
        .collect()
}

/// Mean over the pixels, and the variance of that mean, by stratified sampling: each pixel's own
/// variance counts, not the picture's.
fn mean_and_variance<'a>(pixels: impl Iterator<Item = &'a Pixel>) -> (f64, f64) {
    let (mut mean, mut variance, mut count) = (0.0, 0.0, 0.0);
    for pixel in pixels {
        mean += pixel[0];
        variance += pixel[1];
        count += 1.0;
    }
    (mean / count, variance / (count * count))
}

#[test]
fn fire_absorb_matches_its_exact_picture() {
    let Some(file) = shared("peers/flame.vdb") else { return };
    let Some(exact) = shared("peers/fire_absorb_exact.npy") else { return };
    let (_, exact) = npy::read(&exact).unwrap();
    let exact: Vec<f64> = exact
        .iter()
        .map(|&[r, g, b, _]| [r, g, b].map(f64::from).iter().sum::<f64>() / 3.0)
        .collect();
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
    let mut failures = Vec::new();
    let mut optimal = Strategy::default();
    optimal.advanced.boost_mode = BoostMode::Optimal;
    // Nothing scatters, so that a look at the fire never happens: once is enough.
    let looking = half_of_strategies().into_iter().filter(|strategy| strategy.nee);
    for strategy in looking.chain([optimal]) {
        // Samples that bring the picture's standard error to 0.46 %, by how much each brings; evenly
        // spread samples along a walk of their own bring it lower still.
        let samples = match (
            strategy.emission_ratio_tracking,
            strategy.emission_decoupling,
            strategy.majorant_boost,
        ) {
            (true, _, true) => 64,
            (false, true, true) => 240,
            (true, _, false) | (_, true, false) => 768,
            (false, false, _) => 1536,
        };
        // The default brings it far lower at the same cost.
        let is_default = strategy.preset() == Some(Preset::Full)
            && strategy.advanced.boost_mode == BoostMode::default();
        let power = if is_default { 0.0015 } else { common::POWER };
        let pixels = render(&with_strategy(&scene, strategy), samples);
        let mut name = name(&strategy);
        if strategy.advanced.boost_mode == BoostMode::Optimal {
            name += ", optimal";
        }
        compare(&name, &pixels, &exact, power, &mut failures);
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

fn compare(name: &str, pixels: &[Pixel], exact: &[f64], power: f64, failures: &mut Vec<String>) {
    let (mean, variance) = mean_and_variance(pixels.iter());
    let expected = exact.iter().sum::<f64>() / exact.len() as f64;
    let (error, z) = (variance.sqrt(), (mean - expected) / variance.sqrt());
    println!("{name}: {mean:.6} ± {error:.6}, exact {expected:.6}, z {z:.2}");
    if z.abs() > Z_LIMIT || error > power * expected {
        failures.push(format!("{name}: {mean} ± {error}, exact {expected}"));
    }
    for by in (0..SIDE).step_by(BLOCK) {
        for bx in (0..SIDE).step_by(BLOCK) {
            let inside = |i: &usize| {
                (bx..bx + BLOCK).contains(&(i % SIDE)) && (by..by + BLOCK).contains(&(i / SIDE))
            };
            let block: Vec<usize> = (0..SIDE * SIDE).filter(inside).collect();
            let (mean, variance) = mean_and_variance(block.iter().map(|&i| &pixels[i]));
            let expected = block.iter().map(|&i| exact[i]).sum::<f64>() / block.len() as f64;
            // Blocks the fire hardly touches are too dark to be found by a few thousand paths.
            if expected < 1e-3 * exact.iter().copied().fold(0.0, f64::max) {
                continue;
            }
            let z = (mean - expected) / variance.sqrt().max(1e-12);
            if z.abs() > Z_LIMIT {
                failures.push(format!("{name}: block {bx}, {by}: {mean}, exact {expected}, z {z}"));
            }
        }
    }
}
