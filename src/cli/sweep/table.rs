//! The ranked table of a sweep, for people and for programs.

use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use crate::cli::outputs::write_text;
use crate::cli::speed_up_row::SpeedUpRow;
use crate::error::{Error, Result};
use crate::format::{percent, rounded};
use crate::render::compare::{SideFigures, SpeedUp};
use crate::render::sweep::words::{headline, note, relative_time, remarks};
use crate::render::sweep::{Gain, RankedTrial, Ranking, Swept, Worth};
use crate::scene::settings::FilmSettings;
use crate::transport::strategy::Strategy;
use crate::transport::toggle::Toggle;

/// The figures of a sweep, named as in `table.json`.
#[derive(Debug, Serialize)]
pub struct SweepTable {
    scene: String,
    width: u32,
    height: u32,
    seed: u64,
    threads: usize,
    version: &'static str,
    interrupted: bool,
    /// CPU time of the whole program beside that of rendering, of placing probes above all.
    cpu_seconds_setup: f64,
    sentence: String,
    remarks: Vec<String>,
    /// The strategies, the fastest first.
    ranking: Vec<SweepTableRow>,
    /// The worth of each toggle.
    toggles: Vec<ToggleRow>,
}

/// A strategy with its figures; those that `render --stats` has too carry the same names.
#[derive(Debug, Serialize)]
struct SweepTableRow {
    name: String,
    strategy: Strategy,
    leave_on: bool,
    /// Whether no difference from the best is known.
    as_good_as_best: bool,
    /// Reason why there are no figures, or why they are another strategy's.
    note: Option<String>,
    spp: Option<f64>,
    fewest_samples: Option<u32>,
    cpu_seconds_render: Option<f64>,
    noise: Option<f64>,
    gray_variance_of_mean: Option<f64>,
    /// Standard error of the variance.
    gray_variance_error: Option<f64>,
    variance_times_time: Option<f64>,
    /// Speed-up over the baseline.
    over_baseline: Option<SpeedUpRow>,
    over_best: Option<SpeedUpRow>,
    #[serde(skip)]
    cells: [String; COLUMNS.len()],
}

/// The worth of a toggle.
#[derive(Debug, Serialize)]
struct ToggleRow {
    toggle: &'static str,
    /// Speed-up of the toggle alone over the baseline.
    alone: Option<SpeedUpRow>,
    /// Speed-up of everything else on over everything on.
    left_out: Option<SpeedUpRow>,
    #[serde(skip)]
    cells: [String; GAINS.len()],
}

/// The columns of the ranking. Times are for the same noise.
const COLUMNS: [&str; 6] =
    ["strategy", "of baseline's time", "of best's time", "noise", "variance x time", "spp"];
/// The columns of the toggles.
const GAINS: [&str; 3] = ["toggle", "alone, of baseline's time", "left out, of full's time"];

impl SweepTable {
    /// The table of what was swept of a scene with this name and film, by so many threads in so
    /// many CPU seconds.
    pub fn new(
        (scene, film): (&str, &FilmSettings),
        (swept, ranking): (&Swept, &Ranking),
        (threads, cpu_seconds): (usize, f64),
    ) -> Self {
        let rendering: f64 = swept.tried.iter().flatten().map(|tried| tried.side.cpu_seconds).sum();
        let rows = ranking.entries.iter().enumerate();
        Self {
            scene: scene.to_owned(),
            width: film.size[0],
            height: film.size[1],
            seed: film.seed,
            threads,
            version: env!("CARGO_PKG_VERSION"),
            interrupted: swept.interrupted,
            cpu_seconds_setup: (cpu_seconds - rendering).max(0.0),
            sentence: headline(ranking),
            remarks: remarks(ranking),
            ranking: rows
                .map(|(n, entry)| SweepTableRow::new(entry, ranking.leave_on == Some(n)))
                .collect(),
            toggles: ranking.worths.iter().map(ToggleRow::new).collect(),
        }
    }

    /// The table as people read it.
    pub fn text(&self) -> String {
        let ranking: Vec<_> = self.ranking.iter().map(|row| &row.cells[..]).collect();
        let toggles: Vec<_> = self.toggles.iter().map(|row| &row.cells[..]).collect();
        let (ranking, toggles) = (aligned(&COLUMNS, &ranking), aligned(&GAINS, &toggles));
        let mut text = format!("{ranking}\n{toggles}\n{}.\n", self.sentence);
        for remark in &self.remarks {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{remark}.");
        }
        let _ = writeln!(
            text,
            "{} x {} pixels; {} CPU seconds of setup, of all strategies together.",
            self.width,
            self.height,
            rounded(self.cpu_seconds_setup, 2)
        );
        if self.interrupted {
            text.push_str("It was interrupted.\n");
        }
        text
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

impl SweepTableRow {
    fn new(entry: &RankedTrial, leave_on: bool) -> Self {
        let side = entry.side.as_ref();
        let row = |speed_up: &Option<SpeedUp>| speed_up.as_ref().map(Into::into);
        Self {
            name: entry.trial.kind.name(),
            strategy: entry.trial.strategy,
            leave_on,
            as_good_as_best: entry.is_as_good_as_best(),
            note: note(entry),
            spp: side.map(|side| side.samples_per_pixel),
            fewest_samples: side.map(|side| side.fewest_samples),
            cpu_seconds_render: side.map(|side| side.cpu_seconds),
            noise: side.and_then(|side| side.noise),
            gray_variance_of_mean: side.and_then(|side| side.variance_of_mean),
            gray_variance_error: side.and_then(|side| side.variance_error),
            variance_times_time: side
                .and_then(SideFigures::variance_times_time)
                .map(|(product, _)| product),
            over_baseline: row(&entry.over_baseline),
            over_best: row(&entry.over_best),
            cells: cells(entry, leave_on),
        }
    }
}

/// The cells of a line of the ranking. A twin's figures are written where it was rendered.
fn cells(entry: &RankedTrial, leave_on: bool) -> [String; COLUMNS.len()] {
    let mark = if leave_on { "* " } else { "  " };
    let name = format!("{mark}{}", entry.trial.kind.name());
    let mut cells = [const { String::new() }; COLUMNS.len()];
    cells[0] = name;
    if let Some(note) = note(entry) {
        cells[1] = note;
        return cells;
    }
    let Some(side) = &entry.side else { return cells };
    let or_none = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
    let product = side.variance_times_time();
    cells[1] = or_none(entry.over_baseline.as_ref().map(relative_time));
    cells[2] = or_none(entry.over_best.as_ref().map(relative_time));
    cells[3] = or_none(side.noise.map(percent));
    cells[4] =
        or_none(product.map(|(product, error)| format!("{product:.2e} ± {}", percent(error))));
    cells[5] = rounded(side.samples_per_pixel, 3);
    cells
}

impl ToggleRow {
    fn new(worth: &Worth) -> Self {
        let row = |gain: &Gain| match gain {
            Gain::Of(speed_up) => Some(speed_up.into()),
            Gain::Nothing(_) | Gain::Unknown => None,
        };
        let cell = |gain: &Gain| match gain {
            Gain::Of(speed_up) => relative_time(speed_up),
            Gain::Nothing(_) => "no effect".to_owned(),
            Gain::Unknown => "not known".to_owned(),
        };
        Self {
            toggle: worth.toggle.key(),
            alone: row(&worth.alone),
            left_out: row(&worth.left_out),
            cells: [
                format!("  {}", worth.toggle.name().to_lowercase()),
                cell(&worth.alone),
                cell(&worth.left_out),
            ],
        }
    }
}

/// Lines with their columns under each other. What stands in place of the rest of a line may be
/// longer than its column.
fn aligned(heads: &[&str], rows: &[&[String]]) -> String {
    let letters = |cell: &str| cell.chars().count();
    let is_whole = |row: &&[String], column: usize| {
        column == 0 || row[column + 1..].iter().any(|cell| !cell.is_empty())
    };
    let width = |column: usize| {
        let rows = rows.iter().filter(|row| is_whole(row, column));
        rows.map(|row| letters(&row[column])).max().unwrap_or(0).max(letters(heads[column]))
    };
    let widths: Vec<usize> = (0..heads.len()).map(width).collect();
    let line = |cells: Vec<&str>| {
        let padded = std::iter::zip(cells, &widths).map(|(cell, &width)| format!("{cell:<width$}"));
        format!("{}\n", padded.collect::<Vec<_>>().join("   ").trim_end())
    };
    let rows = rows.iter().map(|row| line(row.iter().map(String::as_str).collect()));
    let heads = heads.iter().enumerate();
    let heads =
        heads.map(|(n, head)| if n == 0 { format!("  {head}") } else { (*head).to_owned() });
    let heads: Vec<String> = heads.collect();
    line(heads.iter().map(String::as_str).collect()) + &rows.collect::<String>()
}

/// The options that lead another command to the toggles of a strategy, each with a space before.
pub fn toggles_in_words(strategy: &Strategy) -> String {
    let set = |toggle: Toggle| format!(" --set {}={}", toggle.key(), toggle.is_on(strategy));
    Toggle::all().map(set).collect()
}
