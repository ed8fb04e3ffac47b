//! Collisions per second on a real volume beside the bare work a collision cannot do without:
//! drawing a step and reading voxels, from a dense array.

use std::sync::Arc;

use divan::{Bencher, counter::ItemsCount};
use flambeau::{
    error::NO_PROGRESS,
    light::{Emitter, LightTree, Receiver},
    math::{Aabb, PathRng, Ray},
    scene::{self, Overrides, VolumeCache},
    transport::{
        PathSample, PreparedFrame, Scene, shadow,
        strategy::{Preset, TransmittanceEstimator},
    },
};
use glam::{UVec2, Vec3A};

fn main() {
    divan::main();
}

const SIDE: u32 = 48;

fn explosion(preset: Preset) -> Scene {
    let text = r#"
        [camera]
        position = [0, -14, 4]
        target = [0, 0, 3]
        fov_x = 36
        [environment]
        radiance = 0.2
        [[volume]]
        file = "explosion_hd.vdb"
        density = { scale = 8.0 }
        albedo = 0.8
        emission = { mode = "blackbody", grid = "temperature", kelvin_scale = 900.0 }
    "#;
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let settings = scene::parse(text, "bench", &folder, &Overrides::default()).unwrap();
    let scene = flambeau::scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
    scene.with_strategy(preset.strategy())
}

fn rays(scene: &Scene) -> Vec<Ray> {
    let size = UVec2::splat(SIDE);
    (0..SIDE * SIDE)
        .map(|i| scene.camera.ray(size, UVec2::new(i % SIDE, i / SIDE), glam::Vec2::splat(0.5)))
        .collect()
}

/// Ratio tracking along camera rays.
#[divan::bench]
fn tracked_collisions(bencher: Bencher) {
    let scene = explosion(Preset::Full);
    let rays = rays(&scene);
    let walk = || {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        rays.iter().fold(0u64, |sum, ray| {
            let medium = scene.world.along(*ray, f32::INFINITY);
            sum + u64::from(
                shadow::transmittance(medium, TransmittanceEstimator::Ratio, &mut rng).1,
            )
        })
    };
    bencher.counter(ItemsCount::new(walk())).bench(walk);
}

/// The density of light sampling along camera rays through the fire.
#[divan::bench]
fn pdf_along(bencher: Bencher) {
    let scene = explosion(Preset::Full);
    let rays = rays(&scene);
    let instance = &scene.world.instances()[0];
    let all = || rays.iter().map(|ray| instance.emission_pdf_along(ray)).sum::<f32>();
    bencher.counter(ItemsCount::new(rays.len())).bench(all);
}

/// Choosing one of many lights, with its probability once more as MIS needs it.
#[divan::bench(args = [1, 200, 100_000])]
fn light_tree_sample(bencher: Bencher, count: u32) {
    let mut rng = PathRng::new(0, UVec2::ZERO, 0);
    let mut point = || Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
    let emitters: Vec<Emitter> = (0..count)
        .map(|_| {
            let at = 100.0 * point();
            let bounds = Aabb::new(at, at + Vec3A::splat(0.2));
            Emitter { bounds, intensity: 1.0, cone: None }
        })
        .collect();
    let tree = LightTree::new(&emitters);
    let receivers: Vec<Receiver> =
        (0..1000).map(|_| Receiver { position: 100.0 * point(), normal: None }).collect();
    let all = || {
        receivers.iter().enumerate().fold(0.0, |sum, (i, to)| {
            let chosen = tree.sample(to, i as f64 / receivers.len() as f64);
            sum + chosen.map_or(0.0, |(index, _)| tree.probability(index, to))
        })
    };
    bencher.counter(ItemsCount::new(receivers.len())).bench(all);
}

/// Whole paths, counted in collisions.
#[divan::bench(args = ["baseline", "full"])]
fn path_collisions(bencher: Bencher, preset: &str) {
    let scene = Arc::new(explosion(preset.parse().unwrap()));
    let frame = PreparedFrame::new(scene, UVec2::splat(SIDE), 0, NO_PROGRESS).unwrap();
    let paths = || {
        (0..SIDE * SIDE).fold(0u64, |sum, i| {
            let sample: PathSample = frame.sample(UVec2::new(i % SIDE, i / SIDE), 0);
            sum + u64::from(sample.tracking_steps)
        })
    };
    bencher.counter(ItemsCount::new(paths())).bench(paths);
}

/// The same number of steps with nothing but an exponential, a trilinear read of a dense array of
/// about the explosion's size and a product.
#[divan::bench]
fn bare_loop(bencher: Bencher) {
    const EDGE: usize = 128;
    let voxels: Vec<f32> = (0..EDGE * EDGE * EDGE).map(|i| (i % 97) as f32 / 97.0).collect();
    let directions: Vec<Vec3A> =
        rays(&explosion(Preset::Full)).iter().map(|ray| ray.direction).collect();
    let walk = || {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let (mut steps, mut weights) = (0u64, 0.0);
        for direction in &directions {
            let (mut t, mut weight) = (0.0, 1.0_f32);
            loop {
                t += rng.exponential() * 6.0;
                let p = Vec3A::new(60.0, 4.0, 60.0) + t * *direction;
                if !(p.cmpge(Vec3A::ONE) & p.cmplt(Vec3A::splat(EDGE as f32 - 2.0))).all() {
                    break;
                }
                steps += 1;
                weight *= 1.0 - trilinear(&voxels, EDGE, p);
            }
            weights += weight;
        }
        (steps, weights)
    };
    bencher.counter(ItemsCount::new(walk().0)).bench(walk);
}

fn trilinear(voxels: &[f32], edge: usize, p: Vec3A) -> f32 {
    let floor = p.floor();
    let [x, y, z] = floor.as_ivec3().to_array().map(|c| c as usize);
    let f = p - floor;
    let at = |i: usize, j: usize, k: usize| voxels[(x + i) + edge * ((y + j) + edge * (z + k))];
    let lerp = |a: f32, b: f32, t: f32| a + t * (b - a);
    let row = |j, k| lerp(at(0, j, k), at(1, j, k), f.x);
    lerp(lerp(row(0, 0), row(1, 0), f.y), lerp(row(0, 1), row(1, 1), f.y), f.z)
}
