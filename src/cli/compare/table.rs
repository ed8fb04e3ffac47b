//! The table of a comparison, for people and for programs.

use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use super::errors::Errors;
use crate::cli::outputs::write_text;
use crate::cli::speed_up_row::SpeedUpRow;
use crate::cli::stats::Spent;
use crate::error::{Error, Result};
use crate::format::{percent, rounded};
use crate::render::compare::{ALARM, Agreement, Difference, FEWEST_SAMPLES, SideFigures, Verdict};
use crate::render::estimate::gray;
use crate::render::side_by_side::RenderedSide;
use crate::transport::strategy::Strategy;

/// The figures of a comparison, named as in `table.json`.
#[derive(Debug, Serialize)]
pub struct CompareTable {
    pub scene: String,
    pub width: u32,
    pub height: u32,
    pub seed: u64,
    pub threads: usize,
    pub version: &'static str,
    pub interrupted: bool,
    pub a: SideRow,
    pub b: SideRow,
    pub speed_up: Option<SpeedUpRow>,
    pub sentence: String,
    pub agreement: AgreementRow,
}

/// Figures of one side; those that `render --stats` has too carry the same names.
#[derive(Debug, Serialize)]
pub struct SideRow {
    #[serde(skip)]
    name: &'static str,
    /// The strategy as the command line names it.
    choice: String,
    strategy: Strategy,
    spp: f64,
    fewest_samples: u32,
    wall_seconds: f64,
    cpu_seconds_setup: f64,
    cpu_seconds_render: f64,
    mean_rgb: [f64; 3],
    noise: Option<f64>,
    gray_variance_of_mean: Option<f64>,
    /// Standard error of the variance.
    gray_variance_error: Option<f64>,
    paths: u64,
    tracking_steps: u64,
    non_finite_samples: u64,
    guard_hits: u64,
    /// Errors against the reference, if there is one.
    errors: Option<Errors>,
    /// Pairs of CPU seconds of rendering and noise.
    noise_over_time: Vec<[f64; 2]>,
}

impl SideRow {
    /// The figures of the side called `name` that was rendered with `strategy`.
    pub fn new(
        (name, choice): (&'static str, &str),
        strategy: Strategy,
        side: &SideFigures,
        rendered: &RenderedSide,
        (spent, errors): (Spent, Option<Errors>),
    ) -> Self {
        let totals = rendered.film.totals;
        Self {
            name,
            choice: choice.to_owned(),
            strategy,
            spp: side.samples_per_pixel,
            fewest_samples: side.fewest_samples,
            wall_seconds: spent.wall,
            cpu_seconds_setup: spent.cpu_setup,
            cpu_seconds_render: spent.cpu_render,
            mean_rgb: side.mean_rgb,
            noise: side.noise,
            gray_variance_of_mean: side.variance_of_mean,
            gray_variance_error: side.variance_error,
            paths: totals.paths,
            tracking_steps: totals.tracking_steps,
            non_finite_samples: totals.non_finite,
            guard_hits: totals.guard_hits,
            errors,
            noise_over_time: rendered.history.points().to_vec(),
        }
    }
}

/// The names of the rows.
const NAMES: [&str; 10] = [
    "",
    "strategy",
    "samples per pixel",
    "CPU seconds of rendering",
    "CPU seconds of setup",
    "mean (R + G + B) / 3",
    "noise",
    "variance of the mean",
    "relMSE",
    "FLIP",
];

impl SideRow {
    /// Cells of this side's column.
    fn cells(&self) -> [String; NAMES.len()] {
        let or_none = |value: Option<String>| value.unwrap_or_else(|| "none yet".to_owned());
        let variance = self.gray_variance_of_mean.zip(self.gray_variance_error);
        let variance = variance.map(|(variance, error)| {
            let share = if variance > 0.0 { error / variance } else { 0.0 };
            format!("{variance:.2e} ± {}", percent(share))
        });
        [
            self.name.to_owned(),
            self.choice.clone(),
            rounded(self.spp, 4),
            rounded(self.cpu_seconds_render, 3),
            rounded(self.cpu_seconds_setup, 2),
            rounded(gray(self.mean_rgb), 4),
            or_none(self.noise.map(percent)),
            or_none(variance),
            self.errors.map_or_else(String::new, |errors| format!("{:.3e}", errors.rel_mse)),
            self.errors.map_or_else(String::new, |errors| rounded(errors.flip, 3)),
        ]
    }
}

/// Whether both sides show the same picture.
#[derive(Debug, Serialize)]
pub struct AgreementRow {
    /// "agree", "differ" or "too_few_samples".
    verdict: &'static str,
    /// Differences looked at.
    tests: usize,
    /// Probability of a false alarm in all tests together.
    alarm: f64,
    overall: Option<DifferenceRow>,
    worst: Option<DifferenceRow>,
}

#[derive(Debug, Serialize)]
struct DifferenceRow {
    /// First column, first row, width and height in pixels.
    area: [u32; 4],
    mean_a: f64,
    mean_b: f64,
    /// A − B in standard errors.
    standard_errors: f64,
    probability: f64,
}

impl From<&Difference> for DifferenceRow {
    fn from(difference: &Difference) -> Self {
        let (first, size) = (difference.area.first, difference.area.size);
        let [mean_a, mean_b] = difference.means;
        Self {
            area: [first.x, first.y, size.x, size.y],
            mean_a,
            mean_b,
            standard_errors: difference.standard_errors(),
            probability: difference.probability,
        }
    }
}

impl From<&Agreement> for AgreementRow {
    fn from(agreement: &Agreement) -> Self {
        Self {
            verdict: match agreement.verdict {
                Verdict::Agree => "agree",
                Verdict::Differ => "differ",
                Verdict::TooFewSamples => "too_few_samples",
            },
            tests: agreement.tests,
            alarm: ALARM,
            overall: agreement.overall.as_ref().map(Into::into),
            worst: agreement.worst.as_ref().map(Into::into),
        }
    }
}

impl AgreementRow {
    fn sentence(&self) -> String {
        let Some(worst) = &self.worst else { return "There is nothing to compare yet".to_owned() };
        let [x, y, width, height] = worst.area;
        match self.verdict {
            "agree" => "A and B show the same picture within their noise".to_owned(),
            "differ" => {
                let difference = (worst.mean_a - worst.mean_b).abs();
                let level = worst.mean_a.abs().max(worst.mean_b.abs());
                format!(
                    "A and B show different pictures: {} apart, {} standard errors, in the {width} x \
                     {height} pixels from {x},{y}",
                    percent(difference / level),
                    rounded(worst.standard_errors.abs(), 2)
                )
            }
            _ => format!(
                "There are too few samples to tell whether both show the same picture; every pixel \
                 needs {FEWEST_SAMPLES}"
            ),
        }
    }
}

impl CompareTable {
    /// The table as people read it.
    pub fn text(&self) -> String {
        let [a, b] = [self.a.cells(), self.b.cells()];
        let width = |cells: &[String]| cells.iter().map(|cell| cell.chars().count()).max();
        let (first, second) = (NAMES.map(str::len).into_iter().max(), width(&a));
        let (first, second) = (first.unwrap_or(0), second.unwrap_or(0));
        let mut text = String::new();
        for (name, (a, b)) in std::iter::zip(NAMES, std::iter::zip(&a, &b)) {
            // Without a reference there are no errors.
            if a.is_empty() {
                continue;
            }
            let line = format!("{name:<first$}   {a:<second$}   {b}");
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{}", line.trim_end());
        }
        let _ = writeln!(text, "\n{}{}.", self.sentence, self.interval());
        let _ = writeln!(text, "{}.", self.agreement.sentence());
        if self.interrupted {
            let _ = writeln!(text, "It was interrupted.");
        }
        text
    }

    /// The figure behind the sentence.
    fn interval(&self) -> String {
        self.speed_up.as_ref().map_or(String::new(), |speed_up| {
            format!(
                " (A's time over B's: {}, with 95 % between {} and {})",
                rounded(speed_up.ratio, 3),
                rounded(speed_up.low, 3),
                rounded(speed_up.high, 3)
            )
        })
    }

    /// Writes `table.txt` and `table.json` to `folder`.
    ///
    /// # Errors
    /// When the system refuses to.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let path = folder.join("table.json");
        let json = serde_json::to_string_pretty(self)
            .map_err(|e| Error::invalid(path.display().to_string(), "", e.to_string()))?;
        write_text(&path, &format!("{json}\n"))?;
        write_text(&folder.join("table.txt"), &self.text())
    }
}
