//! Worth of the transmittance estimators and the trackers, ray by ray: variance x cost.
//!
//! `cargo bench --bench estimators` prints a table per medium. Rays leave random points of the
//! volume's box, for a lamp above it (transmittance) and for random directions (flights). The cost
//! is CPU time; all rows of a table are timed in alternating time slices, so that their ratios hold
//! on a busy machine.

use std::{hint::black_box, path::Path};

use flambeau::{
    cli::cpu_time::process_seconds,
    error::NO_PROGRESS,
    math::{PathRng, Ray, Rgb, mean},
    scene::{self, Overrides, VolumeCache},
    transport::{
        Scene, shadow,
        strategy::{Advanced, Preset, Strategy, Tracker, TransmittanceEstimator},
        tracking::{decomposition, event::Event, scattering},
    },
};
use glam::{UVec2, Vec3A};

const RAYS: usize = 1500;
/// Estimates along each ray in a time slice.
const ESTIMATES: u32 = 24;
const TURNS: u32 = 8;

/// A name and the volume's lines in a scene file.
const MEDIA: [(&str, &str); 8] = [
    ("explosion, thin", "file = 'explosion_hd.vdb'\ndensity.scale = 2.0"),
    ("explosion, thick", "file = 'explosion_hd.vdb'\ndensity.scale = 20.0"),
    ("explosion, colored", "file = 'explosion_hd.vdb'\ndensity.scale = [2.0, 5.0, 10.0]"),
    ("plume", "file = 'plume.vdb'\ndensity.scale = 8.0"),
    ("cloud", "file = 'cloud.vdb'\ndensity.scale = 20.0"),
    ("fog", "file = 'fog.vdb'\ndensity.scale = 1.0"),
    ("noise, thin", "shape = 'noise'\nfrequency = 1.5\noctaves = 4\ndensity.scale = 0.5"),
    ("noise, thick", "shape = 'noise'\nfrequency = 1.5\noctaves = 4\ndensity.scale = 8.0"),
];

fn main() {
    let measures = std::env::args().any(|argument| argument == "--bench");
    let filter = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    for (name, volume) in MEDIA {
        let scene = build(volume);
        if measures && filter.as_ref().is_none_or(|filter| name.contains(filter.as_str())) {
            transmittance(name, &scene);
            flights(name, &scene);
        }
    }
}

fn build(volume: &str) -> Scene {
    let text = format!("[[volume]]\n{volume}\nalbedo = 0.8");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let settings = scene::parse(&text, "bench", &folder, &Overrides::default()).unwrap();
    flambeau::scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap()
}

/// Points in the volume's box, each with a unit direction and a length.
fn rays(scene: &Scene, target: impl Fn(&mut PathRng, Vec3A) -> (Vec3A, f32)) -> Vec<(Ray, f32)> {
    let bounds = scene.world.instances()[0].bounds();
    let mut rng = PathRng::new(7, UVec2::ZERO, 0);
    (0..RAYS)
        .map(|_| {
            let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
            let origin = bounds.min + u * bounds.size();
            let (direction, length) = target(&mut rng, origin);
            (Ray::new(origin, direction), length)
        })
        .collect()
}

/// A row under measurement.
#[derive(Default)]
struct Tally {
    /// Σ x and Σ x² per channel, ray by ray.
    sums: Vec<[Rgb; 2]>,
    seconds: f64,
    reads: u64,
}

impl Tally {
    /// Variance of a single estimate: mean over the rays and the channels.
    fn variance(&self) -> f64 {
        let n = (TURNS * ESTIMATES) as f32;
        let of = |[sum, squares]: &[Rgb; 2]| mean((*squares - *sum * *sum / n) / (n - 1.0));
        self.sums.iter().map(|sums| f64::from(of(sums))).sum::<f64>() / RAYS as f64
    }

    fn mean(&self) -> f64 {
        let n = (TURNS * ESTIMATES) as usize * RAYS;
        self.sums.iter().map(|[sum, _]| f64::from(mean(*sum))).sum::<f64>() / n as f64
    }
}

/// Measures `estimate`, which takes the row, the ray and its length, for each of the rows.
fn measure<const N: usize>(
    rays: &[(Ray, f32)],
    mut estimate: impl FnMut(usize, Ray, f32, &mut PathRng) -> (Rgb, u32),
) -> [Tally; N] {
    let mut tallies: [Tally; N] = std::array::from_fn(|_| Tally::default());
    for turn in 0..TURNS {
        for (row, tally) in tallies.iter_mut().enumerate() {
            tally.sums.resize(RAYS, [Rgb::ZERO; 2]);
            let mut rng = PathRng::new(1, UVec2::new(row as u32, turn), 0);
            let start = process_seconds();
            for ((ray, length), sums) in std::iter::zip(rays, &mut tally.sums) {
                for _ in 0..ESTIMATES {
                    let (value, reads) = black_box(estimate(row, *ray, *length, &mut rng));
                    sums[0] += value;
                    sums[1] += value * value;
                    tally.reads += u64::from(reads);
                }
            }
            tally.seconds += process_seconds() - start;
        }
    }
    tallies
}

/// Prints the rows; all figures but the mean relative to the last, the plain one.
fn print(title: &str, names: &[&str], tallies: &[Tally]) {
    println!("\n## {title}\n");
    println!("| {:<14} | mean | reads | ns | variance | x variance | x cost | x both |", "");
    println!("|---|--:|--:|--:|--:|--:|--:|--:|");
    let Some(plain) = tallies.last() else { return };
    let count = f64::from(TURNS * ESTIMATES) * RAYS as f64;
    for (name, tally) in std::iter::zip(names, tallies) {
        let variance = tally.variance() / plain.variance();
        let cost = tally.seconds / plain.seconds;
        println!(
            "| {name:<14} | {:.4} | {:.2} | {:.0} | {:.3e} | {variance:.3} | {cost:.2} | {:.3} |",
            tally.mean(),
            tally.reads as f64 / count,
            1e9 * tally.seconds / count,
            tally.variance(),
            variance * cost,
        );
    }
}

fn transmittance(name: &str, scene: &Scene) {
    let bounds = scene.world.instances()[0].bounds();
    let lamp = bounds.max + 0.3 * bounds.size();
    let rays = rays(scene, |_, origin| {
        let towards = lamp - origin;
        (towards.normalize(), towards.length())
    });
    let estimators = [
        TransmittanceEstimator::Marching,
        TransmittanceEstimator::Residual,
        TransmittanceEstimator::Ratio,
    ];
    let tallies: [Tally; 3] = measure(&rays, |row, ray, length, rng| {
        shadow::transmittance(scene.world.along(ray, length), estimators[row], rng)
    });
    print(&format!("transmittance: {name}"), &["marching", "residual", "ratio"], &tallies);
}

fn flights(name: &str, scene: &Scene) {
    let rays = rays(scene, |rng, _| {
        let direction = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform()) - 0.5;
        (direction.normalize_or(Vec3A::X), f32::INFINITY)
    });
    let strategies = [Tracker::Decomposition, Tracker::Spectral, Tracker::Delta].map(|tracker| {
        let advanced = Advanced { tracker, ..Advanced::default() };
        Strategy { advanced, ..Preset::Emission.strategy() }
    });
    let tallies: [Tally; 3] = measure(&rays, |row, ray, length, rng| {
        let medium = scene.world.along(ray, length);
        let strategy = &strategies[row];
        let first = rng.exponential();
        let flight = match strategy.advanced.tracker {
            Tracker::Decomposition => {
                decomposition::scatter(medium, strategy, Rgb::ONE, first, rng)
            }
            _ => scattering::scatter(medium, strategy, Rgb::ONE, first, rng),
        };
        let scattered = matches!(flight.event, Event::Scattered { .. });
        (if scattered { flight.weight } else { Rgb::ZERO }, flight.collisions)
    });
    print(&format!("flights: {name}"), &["decomposition", "spectral", "delta"], &tallies);
}
