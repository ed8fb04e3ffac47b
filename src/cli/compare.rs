//! `flambeau compare`: two sampling strategies on one scene, at equal cost.

mod errors;
mod pictures;
mod sides;
mod table;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use clap::Args;
use glam::UVec2;

use super::clashes::{Named, files_of_scene};
use super::console::{print, progress_bar, warn, warn_of_lost_samples};
use super::cpu_time::process_seconds;
use super::exit::{Exit, Refusal};
use super::failed_path;
use super::interrupt::listen_for_interrupt;
use super::outputs::make_folder;
use super::rescue;
use super::scene_source::SceneArguments;
use super::snapshot_header::header;
use super::stats::Spent;
use super::values::parse_seconds;
use crate::error::{Error, Progress, Result};
use crate::format;
use crate::image::exr::SnapshotHeader;
use crate::render::compare::Comparison;
use crate::render::side_by_side::{PairJob, RenderedPair, render_side_by_side};
use crate::render::turns::Usage;
use crate::scene::{self, Settings, VolumeCache};
use crate::transport::{PixelSampler, PreparedFrame, Scene};
use errors::Errors;
use sides::StrategyChoice;
use table::{CompareTable, SideRow};

/// Files written to the folder of the results.
const FILES: [&str; 8] = [
    "table.txt",
    "table.json",
    "a.exr",
    "b.exr",
    "difference.png",
    "noise_a.png",
    "noise_b.png",
    "noise_over_time.png",
];
/// CPU seconds of each side where the command line says nothing.
const DEFAULT_SECONDS: f64 = 10.0;

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Strategy of side A: a preset, keys of the strategy such as nee=false, or both, separated by
    /// commas. It is laid over the scene and over --preset and --set, which both sides share.
    #[arg(long, value_name = "PRESET|KEY=VALUE,..", default_value = "baseline")]
    a: StrategyChoice,
    /// Strategy of side B.
    #[arg(long, value_name = "PRESET|KEY=VALUE,..", default_value = "full")]
    b: StrategyChoice,
    /// Seconds of CPU time that the sampling threads spend on each side; 10 if neither this nor
    /// --spp is given.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    time: Option<f64>,
    /// Samples per pixel of each side.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    spp: Option<u32>,
    /// Number of threads; one a core if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// A picture without noise to measure both sides against: an EXR, or a numpy array, of their
    /// size.
    #[arg(long, value_name = "FILE")]
    reference: Option<PathBuf>,
    /// Folder for the table, both snapshots, the maps and the plot; made if it is not there.
    #[arg(short, long = "output", value_name = "DIR")]
    output: Option<PathBuf>,
}

/// A side before it is rendered.
struct Prepared {
    settings: Settings,
    sampler: Arc<dyn PixelSampler>,
    /// CPU seconds of preparing the side, of placing probes above all.
    setup: f64,
}

pub fn run(arguments: &Arguments) -> Result<Exit, Refusal> {
    let start = Instant::now();
    let interrupt = listen_for_interrupt()?;
    let go_on = |_: f32| !interrupt.load(Ordering::Relaxed);
    let cache = VolumeCache::default();
    let shared = arguments.scene.settings(&cache, &go_on)?;
    let settings = settings_of_sides(arguments, &shared)?;
    let size = UVec2::from_array(settings[0].film.size);
    let reference = arguments.reference.as_deref();
    let reference = reference.map(|path| errors::load(path, size)).transpose()?;
    if let Some(folder) = &arguments.output {
        let mut reads = files_of_scene(arguments.scene.name(), &shared)?;
        let given = arguments.reference.as_deref();
        reads.extend(given.map(|path| Named::new("the reference", path)));
        make_folder(folder, &FILES, &reads)?;
    }
    let files = match arguments.output.is_some() {
        true => scene::fingerprints(&shared, &go_on)?,
        false => Vec::new(),
    };
    let scene = arguments.scene.assemble(&shared, &cache, &go_on)?;
    let cpu_setup = process_seconds();
    let [a, b] = settings;
    let sides = [prepare(&scene, a, &go_on)?, prepare(&scene, b, &go_on)?];
    let wall_setup = start.elapsed().as_secs_f64();

    let pair = show_progress(job(arguments, &sides), &interrupt)?;
    if pair.interrupted && pair.sides.iter().any(|side| side.film.totals.paths == 0) {
        return Err(Error::Cancelled.into());
    }
    let comparison = compared(&pair);
    let spent = [0, 1].map(|side| Spent {
        wall: wall_setup + pair.sides[side].seconds,
        cpu_setup: cpu_setup + sides[side].setup,
        cpu_render: pair.sides[side].cpu_seconds,
    });
    let errors = reference.map(|reference| errors::of(&reference, &pair)).transpose()?;
    let table = table(arguments, &sides, &pair, &comparison, (spent, errors));
    print(&table.text())?;
    if let Some(folder) = &arguments.output {
        let headers = [
            header(&sides[0].settings, files.clone(), spent[0])?,
            header(&sides[1].settings, files, spent[1])?,
        ];
        write(folder, arguments, &pair, &headers, &table)?;
    }
    conclude(arguments, &sides, &pair)
}

/// Writes the table and the pictures, to another folder where this one does not take all of them.
fn write(
    folder: &Path,
    arguments: &Arguments,
    pair: &RenderedPair,
    headers: &[SnapshotHeader; 2],
    table: &CompareTable,
) -> Result<()> {
    let names = [format!("A {}", arguments.a.text()), format!("B {}", arguments.b.text())];
    let words = (&names, table.sentence.as_str());
    rescue::write_folder(folder, &|folder| {
        let written = table.write(folder);
        pair.pool.install(|| pictures::write_all(folder, pair, headers, words)).and(written)
    })
}

/// The settings of A and of B: those they share, each with its own strategy.
fn settings_of_sides(arguments: &Arguments, shared: &Settings) -> Result<[Settings; 2], Refusal> {
    let settings = |choice: &StrategyChoice, option: &str| {
        let mut settings = choice.over(shared, option).map_err(Refusal::usage)?;
        settings.film.spp = arguments.spp.unwrap_or(0);
        if settings.strategy.is_biased() {
            warn(&format!(
                "{option}: ray marching is on (strategy.integrator): its picture is biased"
            ));
        }
        Ok::<_, Refusal>(settings)
    };
    Ok([settings(&arguments.a, "--a")?, settings(&arguments.b, "--b")?])
}

/// Frames the scene with the strategy of one side. Its pilot, if it has one, runs here, so that it
/// counts as preparation.
fn prepare(scene: &Scene, settings: Settings, progress: Progress) -> Result<Prepared> {
    let before = process_seconds();
    let scene = scene.clone().with_strategy(settings.strategy);
    let size = UVec2::from_array(settings.film.size);
    let frame = PreparedFrame::new(Arc::new(scene), size, settings.picture_seed(), progress)?;
    let setup = process_seconds() - before;
    Ok(Prepared { settings, sampler: Arc::new(frame), setup })
}

fn job(arguments: &Arguments, sides: &[Prepared; 2]) -> PairJob {
    let cpu_seconds = match (arguments.time, arguments.spp) {
        (None, None) => Some(DEFAULT_SECONDS),
        (time, _) => time,
    };
    PairJob {
        samplers: [sides[0].sampler.clone(), sides[1].sampler.clone()],
        size: UVec2::from_array(sides[0].settings.film.size),
        spp: arguments.spp.unwrap_or(0),
        cpu_seconds,
        threads: arguments.threads.map(usize::from),
    }
}

/// Renders both with a progress bar on standard error, if that is a terminal.
fn show_progress(job: PairJob, interrupt: &AtomicBool) -> Result<RenderedPair> {
    const STEPS: u64 = 1000;
    let (spp, cpu_seconds) = (job.spp, job.cpu_seconds);
    let bar = progress_bar(STEPS);
    let part = |usage: &Usage| {
        let by_samples = if spp > 0 { usage.samples / f64::from(spp) } else { 0.0 };
        let by_time = cpu_seconds.map_or(0.0, |end| usage.cpu_seconds / end);
        by_samples.max(by_time).min(1.0)
    };
    let result = render_side_by_side(job, interrupt, &mut |[a, b]| {
        bar.set_position((0.5 * (part(a) + part(b)) * STEPS as f64) as u64);
        let [a, b] = [a, b].map(|usage| format::samples_per_pixel(usage.samples));
        bar.set_message(format!("A {a} · B {b}"));
    });
    bar.finish_and_clear();
    result
}

fn compared(pair: &RenderedPair) -> Comparison {
    let films = [&pair.sides[0].film, &pair.sides[1].film];
    let cpu_seconds = [pair.sides[0].cpu_seconds, pair.sides[1].cpu_seconds];
    pair.pool.install(|| Comparison::of(films, cpu_seconds, None))
}

fn table(
    arguments: &Arguments,
    sides: &[Prepared; 2],
    pair: &RenderedPair,
    comparison: &Comparison,
    (spent, errors): ([Spent; 2], Option<[Errors; 2]>),
) -> CompareTable {
    let choices = [&arguments.a, &arguments.b];
    let row = |side: usize| {
        SideRow::new(
            (["A", "B"][side], choices[side].text()),
            sides[side].settings.strategy,
            &comparison.sides[side],
            &pair.sides[side],
            (spent[side], errors.map(|errors| errors[side])),
        )
    };
    let film = &sides[0].settings.film;
    CompareTable {
        scene: arguments.scene.name().to_owned(),
        width: film.size[0],
        height: film.size[1],
        seed: film.seed,
        threads: pair.pool.threads(),
        version: env!("CARGO_PKG_VERSION"),
        interrupted: pair.interrupted,
        a: row(0),
        b: row(1),
        speed_up: comparison.speed_up.as_ref().map(Into::into),
        sentence: comparison.sentence(),
        agreement: (&comparison.agreement).into(),
    }
}

/// Says what went wrong while rendering, and how it ended.
fn conclude(
    arguments: &Arguments,
    sides: &[Prepared; 2],
    pair: &RenderedPair,
) -> Result<Exit, Refusal> {
    let choices = [&arguments.a, &arguments.b];
    for (side, name) in ["A", "B"].into_iter().enumerate() {
        warn_of_lost_samples(&pair.sides[side].film.totals, &format!("{name}: "));
        if let Some(failure) = &pair.sides[side].failure {
            let scene = arguments.scene.in_words(&sides[side].settings);
            let scene = format!("{scene}{}", choices[side].in_words());
            let what = failed_path::in_words(failure, &scene);
            return Err(Error::invalid("", "", format!("{name}: {what}")).into());
        }
    }
    Ok(if pair.interrupted { Exit::Interrupted } else { Exit::Done })
}
