//! Every combination of the toggles with the finer keys pairwise: one picture, block by block.

use crate::common::{Estimate, Z_LIMIT, build, every_setting, framed, full_name, with_strategy};
use flambeau::{
    render::{Film, estimate::PixelEstimate},
    transport::{PathSample, Scene, strategy::Preset},
};
use glam::UVec2;
use rayon::prelude::*;

const SIDE: u32 = 32;
/// Largest standard error of the mean over the film, relative to it. The toggles alone are held
/// closer elsewhere; what is wrong with a finer key shows in dozens of settings here.
const POWER: f64 = 0.01;
/// Samples that are added at once.
const ROUND: u32 = 16;
/// Blocks along an edge of the film.
const BLOCKS: u32 = 2;

/// Fire in front of which smoke hangs, over a floor with a glossy ball, and lights of other kinds.
/// No vertex lies in the fire, where looks at one point of it have infinite variance.
const FIRE_AND_SMOKE: &str = r#"
    [camera]
    position = [0, -5, 1.5]
    target = [0.2, 0, -0.1]
    fov_x = 38
    [environment]
    radiance = [0.02, 0.03, 0.05]
    [[volume]]
    name = "fire"
    shape = "noise"
    half_size = [0.5, 0.4, 0.8]
    rotate = [0, 0, 30]
    frequency = 2.0
    contrast = 3.0
    density = { scale = [1.0, 1.5, 2.0] }
    albedo = 0.0
    emission = { mode = "source", le = [8.0, 4.0, 2.0] }
    [[volume]]
    name = "smoke"
    shape = "noise"
    half_size = [1.0, 0.4, 0.7]
    translate = [-0.2, -1.3, 0.0]
    frequency = 1.0
    contrast = 2.0
    density = { scale = 2.0 }
    albedo = [0.9, 0.8, 0.7]
    phase = { g = 0.5 }
    [[light]]
    type = "sphere"
    center = [1.5, -1.0, 1.2]
    radius = 0.2
    radiance = [2.0, 4.0, 8.0]
    [[light]]
    type = "sun"
    direction = [-1, 1, -1]
    irradiance = 0.5
    angle = 3
    [[light]]
    type = "spot"
    position = [-2, -2, 3]
    target = [0, 0, 0]
    intensity = 4.0
    cone = 30
    blend = 0.5
    [[surface]]
    shape = "plane"
    point = [0, 0, -1.0]
    normal = [0, 0, 1]
    half_size = 5.0
    material = { type = "diffuse", reflectance = 0.5 }
    [[surface]]
    shape = "sphere"
    center = [1.2, -0.6, -0.6]
    radius = 0.4
    material = { type = "conductor", alpha = 0.15, reflectance = 0.9 }
"#;

/// What the camera sees itself and what light brings to what it sees: each with the mean and its
/// variance of every block of the film, and of all of it last.
///
/// So many samples as bring the standard error of the means over the film within `power`, and `most`
/// at most.
fn seen_and_lit(scene: &Scene, power: f64, most: u32) -> [Vec<Estimate>; 2] {
    let frame = framed(scene, SIDE);
    let blank = || [0, 1].map(|_| Film::new(UVec2::ONE).unwrap());
    let mut pixels: Vec<[Film; 2]> = (0..SIDE * SIDE).map(|_| blank()).collect();
    let mut samples = 0;
    loop {
        pixels.par_iter_mut().enumerate().for_each(|(i, films)| {
            let pixel = UVec2::new(i as u32 % SIDE, i as u32 / SIDE);
            for s in samples..samples + ROUND {
                add_apart(films, &frame.sample(pixel, s));
            }
        });
        samples += ROUND;
        let parts = [0, 1].map(|part| {
            blocks(&pixels.iter().map(|films| estimate(&films[part])).collect::<Vec<_>>())
        });
        let all = parts.each_ref().map(|part| *part.last().unwrap());
        let enough = |all: &Estimate| all.error(0) <= 0.98 * power * all.mean[0];
        if samples >= most || all.iter().all(enough) {
            return parts;
        }
    }
}

fn add_apart(films: &mut [Film; 2], path: &PathSample) {
    let PathSample { emission, background, direct, indirect, .. } = *path;
    films[0].add(UVec2::ZERO, &PathSample { emission, background, ..Default::default() });
    films[1].add(UVec2::ZERO, &PathSample { direct, indirect, ..Default::default() });
}

fn estimate(film: &Film) -> Estimate {
    assert_eq!(film.totals.non_finite, 0);
    let estimate = PixelEstimate::of(film, UVec2::ZERO).unwrap();
    Estimate { mean: estimate.mean(), variance: estimate.variance().unwrap() }
}

fn blocks(pixels: &[Estimate]) -> Vec<Estimate> {
    let edge = SIDE / BLOCKS;
    let block = |i: usize| {
        let (x, y) = (i as u32 % SIDE / edge, i as u32 / SIDE / edge);
        y * BLOCKS + x
    };
    (0..=BLOCKS * BLOCKS)
        .map(|wanted| {
            let inside = |i: &usize| wanted == BLOCKS * BLOCKS || block(*i) == wanted;
            let chosen: Vec<&Estimate> =
                (0..pixels.len()).filter(inside).map(|i| &pixels[i]).collect();
            let count = chosen.len() as f64;
            Estimate {
                mean: [0, 1, 2].map(|c| chosen.iter().map(|p| p.mean[c]).sum::<f64>() / count),
                variance: [0, 1, 2]
                    .map(|c| chosen.iter().map(|p| p.variance[c]).sum::<f64>() / (count * count)),
            }
        })
        .collect()
}

#[test]
fn every_setting_gives_one_picture() {
    let scene = build(FIRE_AND_SMOKE);
    let references =
        seen_and_lit(&with_strategy(&scene, Preset::Full.strategy()), 0.25 * POWER, 1024);
    let mut failures = Vec::new();
    let settings = every_setting();
    assert!(settings.len() > 60, "{}", settings.len());
    for setting in settings {
        let found = seen_and_lit(&with_strategy(&scene, setting), POWER, 512);
        for (part, what) in ["seen", "lit"].into_iter().enumerate() {
            let name = format!("{what}, {}", full_name(&setting));
            for (place, (a, b)) in std::iter::zip(&found[part], &references[part]).enumerate() {
                for c in 0..3 {
                    let error = (a.variance[c] + b.variance[c]).sqrt();
                    let z = (a.mean[c] - b.mean[c]) / error.max(1e-12);
                    if z.abs() > Z_LIMIT {
                        failures.push(format!("{name}, place {place}: {a:?}, {b:?}, z {z:.1}"));
                    }
                }
            }
            let all = found[part].last().unwrap();
            let (mean, error) = (all.mean[0], all.error(0));
            println!("{name}: {mean:.6} ± {error:.6}, {:.2} %", 100.0 * error / mean);
            if error > POWER * mean {
                failures.push(format!("{name}: too weak, {error} of {mean}"));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
