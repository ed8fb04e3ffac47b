//! Statistics that `--stats` writes.

use std::io::Write;
use std::path::Path;

use serde::Serialize;

use super::console::print;
use super::exit::Refusal;
use super::rescue;
use crate::error::Error;
use crate::files;
use crate::render::{Film, FilmStats};
use crate::transport::strategy::Strategy;

/// Seconds spent on a picture; those of a continued one include what came before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent {
    /// Wall clock, from the start of the program to the last sample.
    pub wall: f64,
    /// CPU time of setting up: reading and building the scene, placing the probes, the pilot pass.
    pub cpu_setup: f64,
    /// CPU time of rendering.
    pub cpu_render: f64,
}

impl Spent {
    /// The sum of two.
    pub fn plus(self, other: Self) -> Self {
        Self {
            wall: self.wall + other.wall,
            cpu_setup: self.cpu_setup + other.cpu_setup,
            cpu_render: self.cpu_render + other.cpu_render,
        }
    }
}

/// The figures of a render, named as in the file.
#[derive(Debug, Serialize)]
pub struct Stats {
    /// Samples a pixel; a fraction where an interrupt left some pixels ahead.
    spp: serde_json::Value,
    width: u32,
    height: u32,
    seed: u64,
    threads: usize,
    wall_seconds: f64,
    cpu_seconds_total: f64,
    cpu_seconds_setup: f64,
    cpu_seconds_render: f64,
    mean_rgb: [f64; 3],
    gray_variance_of_mean: Option<f64>,
    mean_relative_variance: Option<f64>,
    paths: u64,
    tracking_steps: u64,
    non_finite_samples: u64,
    guard_hits: u64,
    strategy: Strategy,
    version: &'static str,
}

/// Whether the name stands for standard output.
pub fn is_standard_output(path: &Path) -> bool {
    path == Path::new("-")
}

impl Stats {
    /// The figures of `film`, measured in `figures`.
    pub fn new(
        film: &Film,
        figures: &FilmStats,
        spent: Spent,
        seed: u64,
        threads: usize,
        strategy: Strategy,
    ) -> Self {
        let (fewest, most) = film.sample_range();
        let spp = if fewest == most { most.into() } else { figures.samples_per_pixel.into() };
        Self {
            spp,
            width: film.size().x,
            height: film.size().y,
            seed,
            threads,
            wall_seconds: spent.wall,
            cpu_seconds_total: spent.cpu_setup + spent.cpu_render,
            cpu_seconds_setup: spent.cpu_setup,
            cpu_seconds_render: spent.cpu_render,
            mean_rgb: figures.mean_rgb,
            gray_variance_of_mean: figures.gray_variance_of_mean,
            mean_relative_variance: figures.mean_relative_variance,
            paths: film.totals.paths,
            tracking_steps: film.totals.tracking_steps,
            non_finite_samples: film.totals.non_finite,
            guard_hits: film.totals.guard_hits,
            strategy,
            version: env!("CARGO_PKG_VERSION"),
        }
    }

    /// Writes the statistics as JSON, to another place where `path` fails.
    pub fn write(&self, path: &Path) -> Result<(), Refusal> {
        let json = serde_json::to_string_pretty(self)
            .map_err(|e| Error::invalid(path.display().to_string(), "", e.to_string()))?;
        if is_standard_output(path) {
            return print(&format!("{json}\n"));
        }
        rescue::write_file(path, &|path| {
            files::replace(path, |file| writeln!(file, "{json}").map_err(|e| Error::io(path, e)))
        })?;
        Ok(())
    }
}
