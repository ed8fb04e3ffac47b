//! Noise and cost of one strategy on one scene.

use std::sync::{Arc, atomic::AtomicBool};

use flambeau::{
    cli::cpu_time::process_seconds,
    error::NO_PROGRESS,
    render::{
        RenderJob,
        estimate::{PixelEstimate, gray},
        render_headless,
        schedule::Limits,
    },
    transport::{PreparedFrame, Scene},
};
use glam::UVec2;
use rayon::prelude::*;

/// Pixels along each side.
pub const SIDE: u32 = 128;
/// Fewest and most pictures that variances are taken from.
pub const SEEDS: [usize; 2] = [8, 64];
/// Seconds are CPU seconds of all threads over this number, whatever the number of threads: the
/// convention under which other renderers were measured.
pub const THREADS: f64 = 2.0;

/// Amount of work for one figure.
pub struct Plan {
    /// Samples per pixel of a picture.
    pub spp: u32,
    /// Relative standard error of the variance that is enough.
    pub error: f64,
    /// CPU seconds after which no further picture is begun.
    pub budget: f64,
    /// Whether film and schedule are used instead of a bare loop.
    pub film: bool,
}

/// Noise and cost of a row, measured on its pictures.
pub struct Noise {
    /// Gray mean over all pictures.
    pub mean: f64,
    /// Relative standard error of `mean`.
    pub mean_error: f64,
    /// Variance of a picture of N samples times N, gray, mean over the pixels.
    pub variance: f64,
    /// Relative standard error of `variance`.
    pub variance_error: f64,
    /// Seconds that placing the probes and the pilot took, before all else.
    pub setup: f64,
    /// Seconds per sample of every pixel.
    pub seconds: f64,
    /// Tracking steps per path.
    pub steps: f64,
    /// Pictures, each of a seed of its own.
    pub seeds: usize,
}

impl Noise {
    /// 1 / (variance · seconds).
    pub fn efficiency(&self) -> f64 {
        1.0 / (self.variance * self.seconds)
    }
}

/// A picture in gray, and its steps.
struct Picture {
    pixels: Vec<f64>,
    steps: u64,
}

/// Renders with seed after seed until the variance is known well enough.
pub fn measure(scene: &Arc<Scene>, plan: &Plan, left_out: Option<([f32; 2], f32)>) -> Noise {
    let counts: Vec<bool> = (0..SIDE * SIDE)
        .map(|index| {
            left_out.is_none_or(|(center, radius)| {
                pixel(index).as_vec2().distance(center.into()) > radius
            })
        })
        .collect();
    let render = if plan.film { with_film } else { bare };
    // What is first touched or learned by the first picture is no part of the steady state.
    let start = process_seconds();
    let size = UVec2::splat(SIDE);
    let first =
        PreparedFrame::new(scene.clone(), size, u64::MAX, NO_PROGRESS).expect("nothing cancels it");
    let setup = (process_seconds() - start) / THREADS;
    let frame = |seed| first.with_seed(seed);
    render(first.clone(), plan.spp.min(4));
    let (mut pictures, mut steps) = (Vec::new(), 0);
    let start = process_seconds();
    loop {
        let picture = render(frame(pictures.len() as u64), plan.spp);
        pictures.push(picture.pixels);
        steps += picture.steps;
        let spent = process_seconds() - start;
        if pictures.len() < SEEDS[0] {
            continue;
        }
        let [variance, variance_error] = variance(&pictures, &counts);
        let enough = variance_error <= plan.error || spent >= plan.budget;
        if enough || pictures.len() == SEEDS[1] {
            let [mean, mean_error] = mean_with_error(pictures.iter().map(|p| mean_of(p)));
            let spp = (pictures.len() as u64 * u64::from(plan.spp)) as f64;
            return Noise {
                mean,
                mean_error,
                variance: variance * f64::from(plan.spp),
                variance_error,
                setup,
                seconds: spent / spp / THREADS,
                steps: steps as f64 / (spp * f64::from(SIDE * SIDE)),
                seeds: pictures.len(),
            };
        }
    }
}

/// Mean over the pixels that count of the variance between pictures, and its relative standard error. Each
/// picture's squared distance from the mean picture is one estimate of it; they are nearly
/// independent of each other, and pixels that share their noise do no harm.
fn variance(pictures: &[Vec<f64>], counts: &[bool]) -> [f64; 2] {
    let counted = counts.iter().filter(|counts| **counts).count() as f64;
    let k = pictures.len() as f64;
    let mean: Vec<f64> = (0..pictures[0].len())
        .map(|i| pictures.iter().map(|picture| picture[i]).sum::<f64>() / k)
        .collect();
    mean_with_error(pictures.iter().map(|picture| {
        let pixels = picture.iter().zip(&mean).zip(counts).filter(|(_, counts)| **counts);
        let squares = pixels.map(|((value, mean), _)| (value - mean).powi(2));
        squares.sum::<f64>() / counted * k / (k - 1.0)
    }))
}

/// Mean and relative standard error of the mean.
fn mean_with_error(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let values: Vec<f64> = values.collect();
    let mean = mean_of(&values);
    let n = values.len() as f64;
    let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
    let error = (squares / (n * (n - 1.0))).sqrt();
    [mean, if error > 0.0 { error / mean } else { 0.0 }]
}

fn mean_of(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn pixel(index: u32) -> UVec2 {
    UVec2::new(index % SIDE, index / SIDE)
}

/// Renders by a loop over the pixels that keeps nothing but sums.
fn bare(frame: PreparedFrame, spp: u32) -> Picture {
    let (pixels, steps): (Vec<f64>, Vec<u64>) = (0..SIDE * SIDE)
        .into_par_iter()
        .map(|index| {
            (0..spp).fold((0.0, 0), |(sum, steps), sample| {
                let path = frame.sample(pixel(index), sample);
                let value = gray(path.beauty().to_array().map(f64::from)) / f64::from(spp);
                (sum + value, steps + u64::from(path.tracking_steps))
            })
        })
        .unzip();
    Picture { pixels, steps: steps.iter().sum() }
}

/// Renders with film and schedule, as the command line does.
fn with_film(frame: PreparedFrame, spp: u32) -> Picture {
    let job = RenderJob {
        sampler: Arc::new(frame),
        size: UVec2::splat(SIDE),
        limits: Limits { spp, seconds: None },
        resume: None,
        threads: None,
    };
    let rendered = render_headless(job, &AtomicBool::new(false), &mut |_, _| ())
        .expect("a film of this size fits the memory");
    let value = |index| {
        PixelEstimate::of(&rendered.film, pixel(index)).map_or(0.0, |pixel| gray(pixel.mean()))
    };
    Picture {
        pixels: (0..SIDE * SIDE).map(value).collect(),
        steps: rendered.film.totals.tracking_steps,
    }
}
