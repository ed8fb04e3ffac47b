//! Every combination of the toggles with the finer keys pairwise: one picture, block by block.

use crate::common::{
    Expected, Verdicts, build, every_setting, framed_by_seed, full_name, with_strategy,
};
use flambeau::{
    render::{Film, estimate::PixelEstimate},
    transport::{PathSample, PreparedFrame, Scene, strategy::Preset},
};
use glam::UVec2;
use rayon::prelude::*;

const SIDE: u32 = 32;
/// Largest standard error of the mean over the film, relative to it. The toggles alone are held
/// closer elsewhere; what is wrong with a finer key shows in dozens of settings here.
const POWER: f64 = 0.01;
/// Samples that the settings are held against.
const REFERENCE: u32 = 512;
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

/// What the camera sees itself and what light brings to what it sees, on a film that is filled
/// further and further.
struct Picture {
    frame: PreparedFrame,
    pixels: Vec<[Film; 2]>,
    samples: u32,
}

impl Picture {
    fn new(scene: &Scene, seed: u64) -> Self {
        let blank = || [0, 1].map(|_| Film::new(UVec2::ONE).unwrap());
        let pixels = (0..SIDE * SIDE).map(|_| blank()).collect();
        Self { frame: framed_by_seed(scene, SIDE, seed), pixels, samples: 0 }
    }

    /// The mean of each channel of both, with its variance, by so many samples a pixel: of all of
    /// the film first, then of each of its blocks.
    fn means(&mut self, samples: u32) -> Vec<[f64; 2]> {
        let (frame, present) = (&self.frame, self.samples);
        self.pixels.par_iter_mut().enumerate().for_each(|(i, films)| {
            let pixel = UVec2::new(i as u32 % SIDE, i as u32 / SIDE);
            for s in present..samples {
                add_apart(films, &frame.sample(pixel, s));
            }
        });
        self.samples = samples;
        let blocks = std::iter::once(BLOCKS * BLOCKS).chain(0..BLOCKS * BLOCKS);
        let parts = blocks.flat_map(|block| [(block, 0), (block, 1)]);
        parts.flat_map(|(block, part)| self.mean_of_block(block, part)).collect()
    }

    /// Of one of the blocks, or of all where there is none of this number.
    fn mean_of_block(&self, wanted: u32, part: usize) -> [[f64; 2]; 3] {
        let edge = SIDE / BLOCKS;
        let block = |i: usize| (i as u32 / SIDE / edge) * BLOCKS + i as u32 % SIDE / edge;
        let inside = |i: &usize| wanted == BLOCKS * BLOCKS || block(*i) == wanted;
        let (mut sums, mut count) = ([[0.0; 2]; 3], 0.0);
        for films in (0..self.pixels.len()).filter(inside).map(|i| &self.pixels[i]) {
            assert_eq!(films[part].totals.non_finite, 0);
            let estimate = PixelEstimate::of(&films[part], UVec2::ZERO).unwrap();
            let (mean, variance) = (estimate.mean(), estimate.variance().unwrap());
            for (c, sum) in sums.iter_mut().enumerate() {
                sum[0] += mean[c];
                sum[1] += variance[c];
            }
            count += 1.0;
        }
        sums.map(|[mean, variance]| [mean / count, variance / (count * count)])
    }
}

fn add_apart(films: &mut [Film; 2], path: &PathSample) {
    let PathSample { emission, background, direct, indirect, .. } = *path;
    films[0].add(UVec2::ZERO, &PathSample { emission, background, ..Default::default() });
    films[1].add(UVec2::ZERO, &PathSample { direct, indirect, ..Default::default() });
}

#[test]
fn every_setting_gives_one_picture() {
    let scene = build(FIRE_AND_SMOKE);
    let full = with_strategy(&scene, Preset::Full.strategy());
    let expected = Expected::measured_all(&Picture::new(&full, 0).means(REFERENCE));
    // The six means over the whole film decide how many samples there are.
    let expected = expected.deciding(6);
    let mut verdicts = Verdicts::of_power(POWER);
    let settings = every_setting();
    assert!(settings.len() > 60, "{}", settings.len());
    for setting in settings {
        let mut picture = Picture::new(&with_strategy(&scene, setting), verdicts.next_seed());
        let means = |samples| picture.means(samples);
        verdicts.follow(&full_name(&setting), &setting, 512, &expected, means);
    }
    verdicts.finish();
}
