//! Emissive volumes as lights: the density over directions is one, it is that of the directions
//! drawn, and it leaves out nothing that emits.
//!
//! Chi-square tests compare bins of at least 20 expected counts; their statistic, made normal by
//! Wilson and Hilferty's cube root, may be up to 5 (one false alarm in 3.5e6 tests). With 60 000
//! draws, densities off by 5 % at half of the directions would give 6 or more.

use std::{f64::consts::TAU, sync::Arc};

use crate::common::{self, Z_LIMIT, build};
use flambeau::error::NO_PROGRESS;
use flambeau::math::{Aabb, OrthonormalBasis, PathRng, Ray, Rgb, luminance};
use flambeau::sampling::warp::about_axis;
use flambeau::volume::emission::Emission;
use flambeau::volume::field::{RgbField, ScalarField};
use flambeau::volume::phase::Phase;
use flambeau::volume::world::{Instance, World};
use flambeau::volume::{MediumProperties, Region, Volume};
use glam::{Affine3A, EulerRot, Quat, UVec2, Vec3, Vec3A};
use rayon::prelude::*;

/// Bins of the sphere or cone of directions along each of its two coordinates.
const BINS: usize = 16;
/// Points per bin at which the density is read, on a Fibonacci lattice: the edges of a volume are
/// not in line with it.
const POINTS: usize = 987;
const GOLDEN: f64 = 0.618_033_988_749_894_9;
const DRAWS: u32 = 60_000;

const TORCH: &str = r#"
    file = "../assets/torch_hd.vdb"
    emission = { mode = "blackbody", grid = "temperature", kelvin_scale = 1000.0 }
"#;
const NOISE: &str = r#"
    shape = "noise"
    half_size = [1, 0.7, 0.4]
    frequency = 1.5
    octaves = 2
    contrast = 6.0
    emission = { mode = "source", le = 2.0 }
"#;
const SPARKS: &str = r#"
    shape = "noise"
    half_size = [1, 0.7, 0.4]
    frequency = 1.0
    octaves = 7
    contrast = 1.7
    emission = { mode = "ramp", grid = "density", stops = [[0.8, 0, 0, 0], [1, 1, 1, 1]] }
"#;
const BOX: &str = r#"
    shape = "box"
    half_size = [1, 0.7, 0.4]
    emission = { mode = "constant", value = 2.0 }
"#;
const SPHERE: &str = r#"
    shape = "sphere"
    radius = 0.8
    emission = { mode = "constant", value = 2.0 }
"#;

fn world(volumes: &[(&str, &str)]) -> World {
    let volumes = volumes.iter().map(|(what, place)| format!("[[volume]]\n{what}\n{place}\n"));
    build(&format!("[camera]\nposition = [0, -9, 0]\n{}", volumes.collect::<String>())).world
}

fn point(rng: &mut PathRng) -> Vec3A {
    Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform())
}

fn draw(instance: &Instance, rng: &mut PathRng) -> Vec3A {
    let pick = f64::from(rng.uniform());
    instance.sample_emission(pick, point(rng)).unwrap()
}

/// The directions from a point to a volume: a cone around its box, or all of them.
struct Directions {
    from: Vec3A,
    frame: OrthonormalBasis,
    one_minus_cos: f64,
}

impl Directions {
    fn new(from: Vec3A, bounds: &Aabb) -> Self {
        let towards = bounds.center() - from;
        let (distance, radius) =
            (f64::from(towards.length()), 0.5001 * f64::from(bounds.diagonal()));
        let one_minus_cos =
            if distance > radius { 1.0 - (1.0 - (radius / distance).powi(2)).sqrt() } else { 2.0 };
        let axis = if distance > 0.0 { towards.normalize() } else { Vec3A::Z };
        Self { from, frame: OrthonormalBasis::around(axis), one_minus_cos }
    }

    /// The ray at coordinates in [0, 1)², over which solid angle is even.
    fn ray(&self, u: f64, v: f64) -> Ray {
        let local = about_axis((u * self.one_minus_cos) as f32, (TAU * v) as f32);
        Ray::new(self.from, self.frame.world_from_local(local))
    }

    fn bin(&self, to: Vec3A) -> usize {
        let local = self.frame.local_from_world((to - self.from).normalize());
        let u = 0.5 * f64::from((local - Vec3A::Z).length_squared()) / self.one_minus_cos;
        let v = (f64::from(local.y).atan2(f64::from(local.x)) / TAU).rem_euclid(1.0);
        let bin = |coordinate: f64| ((coordinate * BINS as f64) as usize).min(BINS - 1);
        bin(u) * BINS + bin(v)
    }

    /// ∫ of the density over each bin.
    fn integrals(&self, instance: &Instance) -> Vec<f64> {
        let solid_angle = TAU * self.one_minus_cos / (BINS * BINS * POINTS) as f64;
        (0..BINS * BINS)
            .into_par_iter()
            .map(|bin| {
                let [low_u, low_v] = [bin / BINS, bin % BINS].map(|low| low as f64);
                let sum: f64 = (0..POINTS)
                    .map(|i| {
                        let u = low_u + (i as f64 + 0.5) / POINTS as f64;
                        let v = low_v + (i as f64 * GOLDEN).fract();
                        let ray = self.ray(u / BINS as f64, v / BINS as f64);
                        f64::from(instance.emission_pdf_along(&ray))
                    })
                    .sum();
                solid_angle * sum
            })
            .collect()
    }
}

/// A volume placed as it is and one turned, stretched and mirrored.
fn placements(what: &str) -> [(&'static str, Instance, Affine3A); 2] {
    let volume = world(&[(what, "")]).instances()[0].volume().clone();
    let turn = Quat::from_euler(EulerRot::XYZ, 0.4, -0.6, 0.9);
    let scale = Vec3::new(1.5, -0.6, 1.1);
    let turned = Affine3A::from_scale_rotation_translation(scale, turn, Vec3::new(0.3, -2.0, 1.0));
    [("as it is", Affine3A::IDENTITY), ("turned", turned)]
        .map(|(name, place)| (name, Instance::new(volume.clone(), place), place))
}

/// Outside near and far, inside, on a face and on an edge of the box around what emits.
fn places(instance: &Instance, world_from_local: &Affine3A) -> [(&'static str, Vec3A); 5] {
    let local = instance.energy().unwrap().bounds();
    [
        ("outside", Vec3A::new(1.9, -0.7, 0.3)),
        ("far", Vec3A::new(-30.0, 20.0, 9.0)),
        ("inside", Vec3A::new(0.43, 0.61, 0.37)),
        ("face", Vec3A::new(1.0, 0.37, 0.61)),
        ("edge", Vec3A::new(0.0, 1.0, 0.61)),
    ]
    .map(|(name, u)| (name, world_from_local.transform_point3a(local.min + u * local.size())))
}

/// The normal deviate that stands for a chi-square value.
fn wilson_hilferty(chi_square: f64, degrees: f64) -> f64 {
    let spread = 2.0 / (9.0 * degrees);
    ((chi_square / degrees).cbrt() - (1.0 - spread)) / spread.sqrt()
}

fn chi_square_deviate(counts: &[u32], probabilities: &[f64]) -> f64 {
    let (mut chi_square, mut degrees) = (0.0, 0.0_f64);
    let (mut count, mut expected) = (0.0, 0.0);
    let mut left = probabilities.iter().sum::<f64>() * f64::from(DRAWS);
    for (drawn, probability) in counts.iter().zip(probabilities) {
        count += f64::from(*drawn);
        expected += probability * f64::from(DRAWS);
        left -= probability * f64::from(DRAWS);
        // The last bins go together.
        if expected >= 20.0 && left >= 20.0 {
            chi_square += (count - expected).powi(2) / expected;
            degrees += 1.0;
            (count, expected) = (0.0, 0.0);
        }
    }
    chi_square += (count - expected).powi(2) / expected.max(1e-9);
    wilson_hilferty(chi_square, degrees.max(1.0))
}

#[test]
fn directions_have_the_density_that_is_said_and_it_integrates_to_one() {
    let mut failures = Vec::new();
    for (name, what) in [("torch", TORCH), ("noise", NOISE), ("box", BOX), ("sphere", SPHERE)] {
        for (placed, instance, world_from_local) in placements(what) {
            for (position, from) in places(&instance, &world_from_local) {
                let directions = Directions::new(from, &instance.emission_bounds());
                let integrals = directions.integrals(&instance);
                let mut rng = PathRng::new(common::seed(), UVec2::ZERO, 0);
                let mut counts = vec![0; BINS * BINS];
                for _ in 0..DRAWS {
                    counts[directions.bin(draw(&instance, &mut rng))] += 1;
                }
                let integral: f64 = integrals.iter().sum();
                let deviate = chi_square_deviate(&counts, &integrals);
                let label =
                    format!("{name} {placed}, {position}: ∫ {integral:.5}, χ² {deviate:.2}");
                println!("{label}");
                if (integral - 1.0).abs() > 2e-3 || deviate > Z_LIMIT {
                    failures.push(label);
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn points_have_the_density_that_is_said() {
    for (name, what) in [("torch", TORCH), ("noise", NOISE), ("box", BOX), ("sphere", SPHERE)] {
        let [_, (_, instance, _)] = placements(what);
        let mut rng = PathRng::new(common::seed(), UVec2::ZERO, 0);
        // Slabs of the world across a direction that is no axis of anything.
        let across = Vec3A::new(0.3, 0.5, -0.8).normalize();
        let heights = instance.emission_bounds().corners().map(|corner| across.dot(corner));
        let (low, high) = heights
            .iter()
            .fold((f32::MAX, f32::MIN), |(low, high), &height| (low.min(height), high.max(height)));
        let bin = |p: Vec3A| ((across.dot(p) - low) / (high - low) * BINS as f32) as usize;
        let mut counts = vec![0; BINS];
        for _ in 0..DRAWS {
            let p = draw(&instance, &mut rng);
            assert!(instance.emission_pdf_at(p) > 0.0, "{name} at {p}");
            counts[bin(p).min(BINS - 1)] += 1;
        }
        // A grid of points over the box integrates the density.
        let bounds = instance.emission_bounds();
        let steps = 100;
        let volume = f64::from(bounds.size().element_product()) / f64::from(steps * steps * steps);
        let mut expected = vec![0.0; BINS];
        for i in 0..steps * steps * steps {
            let [x, y, z] = [i % steps, i / steps % steps, i / steps / steps];
            let u = (Vec3A::new(x as f32, y as f32, z as f32) + 0.5) / steps as f32;
            let p = bounds.min + u * bounds.size();
            expected[bin(p).min(BINS - 1)] += volume * f64::from(instance.emission_pdf_at(p));
        }
        let integral: f64 = expected.iter().sum();
        let deviate = chi_square_deviate(&counts, &expected);
        println!("{name}: ∫ {integral:.5}, χ² {deviate:.2}");
        assert!((integral - 1.0).abs() < 4e-3 && deviate < Z_LIMIT, "{name}: {integral} {deviate}");
    }
}

/// Wherever there is emission, spilled beyond the last voxel or a spark far smaller than a cell,
/// sampling finds it too.
#[test]
fn all_that_emits_can_be_sampled() {
    for (name, what) in [("torch", TORCH), ("noise", NOISE), ("sparks", SPARKS)] {
        let [_, (_, instance, world_from_local)] = placements(what);
        let (volume, energy) = (instance.volume(), instance.energy().unwrap());
        let bounds = volume.region().bounds();
        let mut rng = PathRng::new(common::seed(), UVec2::ZERO, 0);
        let mut emitting = 0;
        for _ in 0..200_000 {
            let local = bounds.min + point(&mut rng) * bounds.size();
            if luminance(volume.properties().at(local).emission) <= 0.0 {
                continue;
            }
            emitting += 1;
            assert!(energy.pdf_at(local) > 0.0, "{name} at {local}");
            let to = world_from_local.transform_point3a(local);
            let from = to + (point(&mut rng) - 0.5) * instance.bounds().size();
            let ray = Ray::new(from, (to - from).normalize());
            assert!(instance.emission_pdf_along(&ray) > 0.0, "{name}: {ray:?}");
        }
        println!("{name}: {emitting} points emit");
        assert!((100..190_000).contains(&emitting), "{name}: {emitting}");
    }
}

fn glowing(region: Region, emission: f32) -> Arc<Volume> {
    let properties = MediumProperties {
        density: ScalarField::Constant(0.0),
        density_scale: Rgb::ZERO,
        albedo: RgbField::Constant(Rgb::ZERO),
        phase: Phase::default(),
        emission: Emission::Field {
            field: RgbField::Constant(Rgb::splat(emission)),
            scale: Rgb::ONE,
        },
    };
    Arc::new(match region {
        Region::Box(bounds) => {
            let cells = 0.3 * bounds.size().max(Vec3A::splat(1e-30));
            Volume::varying(bounds, properties, cells, None, NO_PROGRESS).unwrap()
        }
        region => Volume::uniform(region, properties),
    })
}

#[test]
fn the_power_is_the_emission_over_the_world_volume() {
    let turn = Quat::from_euler(EulerRot::XYZ, 0.3, 0.7, -1.1);
    let place = Affine3A::from_scale_rotation_translation(Vec3::new(2.0, -0.5, 3.0), turn, Vec3::X);
    let half_size = Vec3A::new(1.0, 2.0, 0.5);
    for (region, volume) in [
        (Region::Box(Aabb::centered(half_size)), 8.0 * 3.0),
        (Region::Sphere { radius: 0.5 }, std::f32::consts::PI / 6.0 * 3.0),
    ] {
        let instance = Instance::new(glowing(region, 7.0), place);
        let power = instance.emitted_power();
        assert!((power / (7.0 * volume) - 1.0).abs() < 1e-4, "{power} for {volume}");
    }
    let everywhere = Instance::new(glowing(Region::Everywhere, 7.0), place);
    assert!(everywhere.energy().is_none() && everywhere.emitted_power() == 0.0);
    let dark = Instance::new(glowing(Region::Sphere { radius: 1.0 }, 0.0), place);
    assert!(dark.sample_emission(0.5, Vec3A::ZERO).is_none());
}

/// The mean of the torch's emission as the energy has it, against a far finer quadrature.
#[test]
fn the_power_of_a_file_is_its_emission_integrated() {
    let world = world(&[(TORCH, "")]);
    let instance = &world.instances()[0];
    let (volume, energy) = (instance.volume(), instance.energy().unwrap());
    let bounds = energy.bounds();
    let dims = (bounds.size() * 2.0).as_uvec3();
    let sum: f64 = (0..dims.z)
        .into_par_iter()
        .map(|z| {
            let mut sum = 0.0;
            for i in 0..dims.x * dims.y {
                let cell = glam::UVec3::new(i % dims.x, i / dims.x, z);
                let p = bounds.min + (cell.as_vec3a() + 0.5) / dims.as_vec3a() * bounds.size();
                sum += f64::from(luminance(volume.properties().at(p).emission));
            }
            sum
        })
        .sum();
    let per_point = f64::from(bounds.size().element_product()) / f64::from(dims.element_product());
    let ratio = f64::from(energy.power()) / (sum * per_point);
    println!("power {} against {}: {ratio}", energy.power(), sum * per_point);
    assert!((0.95..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn numbers_at_the_ends_of_single_precision_stay_finite() {
    let mut rng = PathRng::new(0, UVec2::ZERO, 0);
    for emission in [1e-44, 1e-30, 1.0, 1e30, 3e38, f32::INFINITY] {
        for size in [1e-12, 1.0, 1e12] {
            for region in
                [Region::Box(Aabb::centered(Vec3A::splat(size))), Region::Sphere { radius: size }]
            {
                for scale in [1e-9, 1.0, 1e9] {
                    let volume = glowing(region, emission);
                    if volume.energy().is_none() {
                        assert!(emission < 1e-40);
                        continue;
                    }
                    let place = Affine3A::from_scale(Vec3::splat(scale));
                    let instance = Instance::new(volume, place);
                    let power = instance.emitted_power();
                    assert!(power > 0.0 && power.is_finite());
                    let p = draw(&instance, &mut rng);
                    let at = instance.emission_pdf_at(p);
                    assert!(p.is_finite() && at > 0.0 && at.is_finite());
                    for from in [Vec3A::ZERO, 3.0 * size * scale * Vec3A::X, Vec3A::splat(1e15)] {
                        let ray = Ray::new(from, (p - from).normalize());
                        let pdf = instance.emission_pdf_along(&ray);
                        assert!(pdf.is_finite() && pdf >= 0.0, "{emission} {region:?} {scale}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_ray_visits_every_emissive_volume_it_meets_with_its_density() {
    let mut volumes = vec![(SPHERE.to_owned(), String::new()); 40];
    let mut rng = PathRng::new(0, UVec2::ZERO, 0);
    for (index, volume) in volumes.iter_mut().enumerate() {
        let p = 6.0 * point(&mut rng);
        volume.1 = format!("translate = [{}, {}, {}]", p.x, p.y, p.z);
        if index % 4 == 0 {
            volume.0 = "shape = \"box\"\ndensity = { scale = 1.0 }\n".to_owned();
        }
    }
    let volumes: Vec<(&str, &str)> = volumes.iter().map(|v| (v.0.as_str(), v.1.as_str())).collect();
    let many = world(&volumes);
    let emissive: Vec<u32> = (0..40).filter(|i| i % 4 != 0).collect();
    assert_eq!(many.emissive(), emissive);
    let mut met = 0;
    for _ in 0..500 {
        let ray = Ray::new(6.0 * point(&mut rng), (point(&mut rng) - 0.5).normalize());
        let expected: Vec<(u32, f32)> = emissive
            .iter()
            .map(|&i| (i, many.instances()[i as usize].emission_pdf_along(&ray)))
            .filter(|(_, pdf)| *pdf > 0.0)
            .collect();
        let mut visited = Vec::new();
        many.emissive_along(&ray, |index, pdf| visited.push((index, pdf)));
        visited.sort_by_key(|visit| visit.0);
        assert_eq!(visited, expected);
        met += visited.len();
    }
    assert!(met > 300, "{met}");
    assert_eq!(world(&volumes[..1]).emissive(), [] as [u32; 0]);
}
