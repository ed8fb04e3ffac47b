//! Whether the full preset is at least as good as any combination of the toggles, scene by scene.
//!
//! Every picture is rendered from nothing by the program itself, on one thread, and its CPU time
//! counts from the start, setting up included. In two stages: all combinations roughly, then those
//! near the best, and full, with fresh seeds. Combinations that differ only in toggles without
//! effect in the scene are one. A program of another build takes part as well, if it is given.

use std::path::{Path, PathBuf};
use std::process::Command;

use flambeau::transport::Scene;
use flambeau::transport::strategy::{Preset, Strategy};
use flambeau::transport::toggle::Toggle;

use super::measure::SIDE;
use super::scenes::BenchScene;

/// CPU seconds that pictures are compared at.
const TIMES: [f64; 2] = [3.0, 30.0];
/// Combinations up to this factor below the best take part in the second stage.
const NEAR: f64 = 1.25;

/// Amount of work.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// CPU seconds of each picture, in both stages.
    pub seconds: [f64; 2],
    /// Pictures of each combination, in both stages.
    pub seeds: [u64; 2],
}

impl Effort {
    /// Figures good to about 2 %, or to 10 %.
    pub fn new(quick: bool) -> Self {
        match quick {
            true => Self { seconds: [1.5, 3.0], seeds: [1, 2] },
            false => Self { seconds: [3.0, 30.0], seeds: [1, 4] },
        }
    }
}

/// Efficiency of one combination by one program.
struct Rated {
    name: String,
    strategy: Strategy,
    program: PathBuf,
    /// Efficiency at each of [`TIMES`].
    efficiency: [f64; 2],
    /// Relative standard error between pictures.
    error: f64,
}

/// Prints a row for `scene`: how many times as efficient the best combination is as full.
pub fn print(scene: &BenchScene, built: &Scene, effort: Effort, other: Option<&Path>) {
    let here = PathBuf::from(env!("CARGO_BIN_EXE_flambeau"));
    let programs: Vec<PathBuf> =
        std::iter::once(here.clone()).chain(other.map(Path::to_owned)).collect();
    let mut first: Vec<Rated> = Vec::new();
    for program in &programs {
        for strategy in combinations(built, program == &here) {
            let rated = rate(scene, strategy, program, effort.seconds[0], 0..effort.seeds[0]);
            first.extend(rated);
        }
    }
    for (index, time) in TIMES.iter().enumerate() {
        let best = first.iter().map(|rated| rated.efficiency[index]).fold(0.0, f64::max);
        let is_full = |rated: &Rated| {
            rated.program == here && rated.strategy == effective(built, Preset::Full.strategy())
        };
        let near: Vec<&Rated> = first
            .iter()
            .filter(|rated| is_full(rated) || rated.efficiency[index] * NEAR >= best)
            .collect();
        let seeds = 1000..1000 + effort.seeds[1];
        let seconds = effort.seconds[1].min(*time);
        let again =
            |rated: &&Rated| rate(scene, rated.strategy, &rated.program, seconds, seeds.clone());
        let second: Vec<Rated> = near.iter().filter_map(again).collect();
        row(scene.name, *time, index, &second, is_full);
    }
}

/// One line: full, the best combination and the quotient of their efficiencies.
fn row(scene: &str, time: f64, index: usize, rated: &[Rated], is_full: impl Fn(&Rated) -> bool) {
    let Some(full) = rated.iter().find(|rated| is_full(rated)) else { return };
    let by_efficiency =
        |a: &&Rated, b: &&Rated| a.efficiency[index].total_cmp(&b.efficiency[index]);
    let Some(best) = rated.iter().max_by(by_efficiency) else { return };
    let quotient = best.efficiency[index] / full.efficiency[index];
    let error = full.error.hypot(best.error);
    println!(
        "| {scene:<16} | {time:>4} s | {:>9.3e} | {:>9.3e} | {:<24} | {quotient:>5.2} ± {error:.2} |",
        full.efficiency[index], best.efficiency[index], best.name,
    );
}

/// Prints the head of the table.
pub fn head() {
    println!(
        "Efficiency is 1 / (variance of the mean x CPU seconds) at so many CPU seconds from nothing, \
         {SIDE} x {SIDE} pixels, one thread. Letters: d decoupling, r ratio tracking, b boost, n fire \
         as a light, p probes; * by the other program.\n"
    );
    println!("| scene | time | full | best | the best one | best over full |");
    println!("|---|--:|--:|--:|---|--:|");
}

/// The combinations of the toggles that differ in the scene; those of another build all.
fn combinations(scene: &Scene, merge: bool) -> Vec<Strategy> {
    let mut all: Vec<Strategy> = Vec::new();
    for bits in (0..32_u32).rev() {
        let set = |strategy, (index, toggle): (usize, Toggle)| {
            toggle.set(&strategy, bits >> index & 1 == 1)
        };
        let strategy = Toggle::all().enumerate().fold(Strategy::default(), set);
        let strategy = if merge { effective(scene, strategy) } else { strategy };
        if !all.contains(&strategy) {
            all.push(strategy);
        }
    }
    all
}

fn effective(scene: &Scene, strategy: Strategy) -> Strategy {
    strategy.effective(scene.facts())
}

/// Renders pictures of about so many CPU seconds and rates them; `None`, with a message, where the
/// program fails.
fn rate(
    scene: &BenchScene,
    strategy: Strategy,
    program: &Path,
    seconds: f64,
    seeds: std::ops::Range<u64>,
) -> Option<Rated> {
    // Twice as many samples take twice as long, but for setting up.
    let [few, more] = [2, 16].map(|spp| render(scene, strategy, program, spp, 0));
    let (few, more) = (few?, more?);
    let per_sample = ((more.seconds - few.seconds) / 14.0).max(1e-5);
    let setup = (more.seconds - 16.0 * per_sample).max(0.0);
    // Whole rounds of the independent randomizations.
    let rounds = ((seconds - setup) / per_sample / 8.0).clamp(2.0, 1e5) as u32;
    let pictures: Vec<Picture> = seeds
        .map(|seed| render(scene, strategy, program, 8 * rounds, seed))
        .collect::<Option<_>>()?;
    let at = |picture: &Picture, time: f64| {
        let samples = (time - setup).max(0.0) / per_sample;
        samples / (picture.variance * f64::from(8 * rounds)) / time
    };
    let count = pictures.len() as f64;
    let efficiency = TIMES.map(|time| {
        let inverse = pictures.iter().map(|picture| 1.0 / at(picture, time)).sum::<f64>() / count;
        1.0 / inverse
    });
    let mean = pictures.iter().map(|picture| picture.variance).sum::<f64>() / count;
    let squares = pictures.iter().map(|picture| (picture.variance - mean).powi(2)).sum::<f64>();
    let error = (squares / (count * (count - 1.0).max(1.0))).sqrt() / mean;
    let other = if program == Path::new(env!("CARGO_BIN_EXE_flambeau")) { "" } else { "*" };
    let letters = std::iter::zip("drbnp".chars(), Toggle::all());
    let on = letters.filter(|(_, toggle)| toggle.is_on(&strategy)).map(|(letter, _)| letter);
    let name = format!("{}{other}", on.collect::<String>());
    Some(Rated { name, strategy, program: program.to_owned(), efficiency, error })
}

/// Statistics of a picture, as the program reports them.
struct Picture {
    /// CPU seconds from the start.
    seconds: f64,
    /// Variance of the mean of gray, averaged over the pixels.
    variance: f64,
}

fn render(
    scene: &BenchScene,
    strategy: Strategy,
    program: &Path,
    spp: u32,
    seed: u64,
) -> Option<Picture> {
    let (file, sets) = scene.on_disk()?;
    let out = std::env::temp_dir().join(format!("flambeau-never-worse-{}.npy", std::process::id()));
    let mut command = Command::new(program);
    command.arg("render").arg(file).args(["--stats", "-", "--threads", "1", "-o"]).arg(&out);
    command.args(["--size", &format!("{SIDE}x{SIDE}")]);
    command.args(["--spp", &spp.to_string(), "--seed", &seed.to_string()]);
    let toggles =
        Toggle::all().map(|toggle| format!("{}={}", toggle.key(), toggle.is_on(&strategy)));
    for set in sets.into_iter().chain(toggles) {
        command.args(["--set", &set]);
    }
    let output = command.output().ok()?;
    let stats: serde_json::Value = match serde_json::from_slice(&output.stdout) {
        Ok(stats) => stats,
        Err(_) => {
            println!("{}: {}", scene.name, String::from_utf8_lossy(&output.stderr).trim());
            return None;
        }
    };
    Some(Picture {
        seconds: stats["cpu_seconds_total"].as_f64()?,
        variance: stats["gray_variance_of_mean"].as_f64()?,
    })
}
