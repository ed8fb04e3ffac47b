//! The noise that a film shows is the noise there is: what its accumulators say of one render
//! agrees with the spread between renders of different seeds.

use std::sync::Arc;

use crate::common::{
    build,
    sequential::{Comparison, Verdict},
    with_strategy,
};
use flambeau::{
    math::ACCUMULATORS,
    render::{Film, estimate::PixelEstimate},
    transport::{Frame, PreparedFrame, strategy::Strategy},
};
use glam::UVec2;
use rayon::prelude::*;

const SEEDS: u64 = 36;
const SIDE: u32 = 24;

/// A lamp, a fire and its smoke above a floor.
const SCENE: &str = r#"
    [camera]
    position = [0, -4, 1.5]
    target = [0, 0, 0]
    fov_x = 45
    [environment]
    radiance = 0.05
    [[volume]]
    shape = "noise"
    half_size = [0.6, 0.6, 0.8]
    frequency = 2.0
    contrast = 2.0
    density = { scale = 2.0 }
    albedo = 0.6
    emission = { mode = "source", le = [4.0, 2.0, 1.0] }
    [[light]]
    type = "sphere"
    center = [1.5, -1.0, 1.5]
    radius = 0.3
    radiance = 4.0
    [[surface]]
    shape = "plane"
    point = [0, 0, -0.9]
    normal = [0, 0, 1]
    half_size = 4.0
    material = { type = "diffuse", reflectance = 0.6 }
"#;

/// Pixels that are looked at together, spread over the film.
const BATCH: u32 = 48;

/// For some pixels: the mean over seeds of the variance that the accumulators give for the mean of
/// `samples` samples, and the variance of that mean between seeds.
fn variances(frames: &[PreparedFrame], samples: u32, batch: u32) -> Vec<[f64; 2]> {
    let seeds = frames.len() as f64;
    (0..BATCH)
        .into_par_iter()
        .map(|i| {
            let i = (batch + i * (SIDE * SIDE / BATCH)) % (SIDE * SIDE);
            let pixel = UVec2::new(i % SIDE, i / SIDE);
            let (mut within, mut means) = (0.0, Vec::new());
            for frame in frames {
                let mut film = Film::new(UVec2::ONE).unwrap();
                (0..samples).for_each(|s| film.add(UVec2::ZERO, &frame.sample(pixel, s)));
                let estimate = PixelEstimate::of(&film, UVec2::ZERO).unwrap();
                within += estimate.gray_variance().unwrap() / seeds;
                means.push(flambeau::render::estimate::gray(estimate.mean()));
            }
            let mean = means.iter().sum::<f64>() / seeds;
            let between = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>();
            [within, between / (seeds - 1.0)]
        })
        .collect()
}

/// The two variances agree, as tested in steps at the power of a fixed test with a standard error
/// of 3 %: the next pixels are looked at until that is clear. Evenly spread or independent, equal
/// accumulators or not.
#[test]
fn accumulators_tell_the_noise_between_seeds() {
    let scene = build(SCENE);
    let probes = crate::common::placed(&with_strategy(&scene, Strategy::default()));
    let mut noise = Vec::new();
    for (low_discrepancy, samples) in [(true, 13), (true, 32), (false, 32)] {
        let mut strategy = Strategy::default();
        strategy.advanced.low_discrepancy = low_discrepancy;
        let (scene, size) = (Arc::new(with_strategy(&scene, strategy)), UVec2::splat(SIDE));
        let frame = Frame::with_probes(scene, size, 0, probes.clone());
        let frame = crate::common::prepared(frame);
        let frames: Vec<PreparedFrame> = (0..SEEDS).map(|seed| frame.with_seed(seed)).collect();
        let (mut comparison, mut pixels) = (Comparison::of_power(0.03), Vec::new());
        for batch in 0..SIDE * SIDE / BATCH {
            pixels.extend(variances(&frames, samples, batch));
            let sum = |of: &dyn Fn(&[f64; 2]) -> f64| pixels.iter().map(of).sum::<f64>();
            let [within, between] = [0, 1].map(|k| sum(&|pixel| pixel[k]));
            let error = sum(&|pixel| (pixel[0] - pixel[1]).powi(2)).sqrt() / between;
            let deviation = within / between - 1.0;
            comparison.look(deviation, error);
            if (batch + 1) * BATCH == SIDE * SIDE {
                comparison.end(deviation, error);
            }
            if comparison.verdict != Verdict::Open {
                println!(
                    "{samples} samples: {deviation:.4} ± {error:.4} by {} pixels",
                    pixels.len()
                );
                break;
            }
        }
        assert_eq!(comparison.verdict, Verdict::Right, "{samples} samples");
        noise.push(pixels);
    }
    // Of the same pixels.
    let count = noise[1].len().min(noise[2].len());
    let [even, random] =
        [1, 2].map(|k| noise[k][..count].iter().map(|pixel: &[f64; 2]| pixel[0]).sum::<f64>());
    println!("evenly spread samples have {:.3} of the variance", even / random);
    assert!(even < 0.9 * random, "{even} of {random}");
    assert_eq!(ACCUMULATORS, 8, "thirty-two samples are four of each");
}
