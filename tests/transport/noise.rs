//! The noise that a film shows is the noise there is: what its accumulators say of one render
//! agrees with the spread between renders of different seeds.

use std::sync::Arc;

use crate::common::{Z_LIMIT, build, with_strategy};
use flambeau::{
    math::ACCUMULATORS,
    render::{Film, estimate::PixelEstimate},
    transport::{Frame, PreparedFrame, Scene, strategy::Strategy},
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

/// For every pixel: the mean over seeds of the variance that the accumulators give for the mean of
/// `samples` samples, and the variance of that mean between seeds.
fn variances(scene: &Scene, samples: u32) -> Vec<[f64; 2]> {
    let (scene, size) = (Arc::new(scene.clone()), UVec2::splat(SIDE));
    let probes = crate::common::probes_of(&scene).map(Arc::new);
    let frame = |seed| {
        crate::common::prepared(Frame::with_probes(scene.clone(), size, seed, probes.clone()))
    };
    let frames: Vec<PreparedFrame> = (0..SEEDS).map(frame).collect();
    (0..SIDE * SIDE)
        .into_par_iter()
        .map(|i| {
            let pixel = UVec2::new(i % SIDE, i / SIDE);
            let (mut within, mut means) = (0.0, Vec::new());
            for frame in &frames {
                let mut film = Film::new(UVec2::ONE).unwrap();
                (0..samples).for_each(|s| film.add(UVec2::ZERO, &frame.sample(pixel, s)));
                let estimate = PixelEstimate::of(&film, UVec2::ZERO).unwrap();
                within += estimate.gray_variance().unwrap() / SEEDS as f64;
                means.push(flambeau::render::estimate::gray(estimate.mean()));
            }
            let mean = means.iter().sum::<f64>() / SEEDS as f64;
            let between = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>();
            [within, between / (SEEDS - 1) as f64]
        })
        .collect()
}

/// The two variances agree within five standard errors, one of which is at most 3 %; evenly spread
/// or independent, equal accumulators or not.
#[test]
fn accumulators_tell_the_noise_between_seeds() {
    let scene = build(SCENE);
    let mut noise = Vec::new();
    for (low_discrepancy, samples) in [(true, 13), (true, 32), (false, 32)] {
        let mut strategy = Strategy::default();
        strategy.advanced.low_discrepancy = low_discrepancy;
        let pixels = variances(&with_strategy(&scene, strategy), samples);
        let sum = |of: &dyn Fn(&[f64; 2]) -> f64| pixels.iter().map(of).sum::<f64>();
        let [within, between] = [0, 1].map(|k| sum(&|pixel| pixel[k]));
        let error = sum(&|pixel| (pixel[0] - pixel[1]).powi(2)).sqrt();
        let z = (within - between) / error;
        println!("{samples} samples: within {within}, between {between} ± {error}, z {z:.2}");
        assert!(z.abs() < Z_LIMIT, "{samples} samples: {within} for {between}, z {z}");
        assert!(error < 0.03 * between, "{samples} samples: too weak, {error} of {between}");
        noise.push(within);
    }
    println!("evenly spread samples have {:.3} of the variance", noise[1] / noise[2]);
    assert!(noise[1] < 0.9 * noise[2], "{noise:?}");
    assert_eq!(ACCUMULATORS, 8, "thirty-two samples are four of each");
}
