//! `flambeau sweep`: every strategy tried on a scene for a few seconds, and ranked.

mod chart;
mod table;

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use glam::UVec2;
use indicatif::ProgressBar;

use super::clashes::files_of_scene;
use super::console::{print, progress_bar, warn, warn_of_lost_samples};
use super::cpu_time::process_seconds;
use super::exit::{Exit, Refusal};
use super::failed_path;
use super::interrupt::listen_for_interrupt;
use super::outputs::make_folder;
use super::rescue;
use super::scene_source::SceneArguments;
use super::values::parse_seconds;
use crate::error::{Error, Result};
use crate::render::pool::{Pool, Priority};
use crate::render::sweep::{
    DEFAULT_SECONDS, Ranking, SweepJob, SweepProgress, Swept, Trial, plan, quick_size, sweep,
};
use crate::render::time_slice::Amount;
use crate::scene::effect::no_effect_with;
use crate::scene::{Settings, VolumeCache};
use crate::transport::Scene;
use table::SweepTable;

/// Files written to the folder of the results.
const FILES: [&str; 3] = ["table.txt", "table.json", "chart.png"];

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Seconds of CPU time that the sampling threads spend on each strategy; 3 if neither this nor
    /// --spp is given.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    time: Option<f64>,
    /// Samples per pixel of each strategy.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    spp: Option<u32>,
    /// Number of threads; one a core if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Folder for the table and the bar chart; made if it is not there.
    #[arg(short, long = "output", value_name = "DIR")]
    output: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> Result<Exit, Refusal> {
    let interrupt = listen_for_interrupt()?;
    let go_on = |_: f32| !interrupt.load(Ordering::Relaxed);
    let cache = VolumeCache::default();
    let mut settings = arguments.scene.settings(&cache, &go_on)?;
    if settings.strategy.is_biased() {
        warn("ray marching is on (strategy.integrator): all pictures are biased");
    }
    if arguments.scene.size().is_none() {
        settings.film.size = quick_size(settings.film.size.into()).into();
    }
    if let Some(folder) = &arguments.output {
        make_folder(folder, &FILES, &files_of_scene(arguments.scene.name(), &settings)?)?;
    }
    let scene = arguments.scene.assemble(&settings, &cache, &go_on)?;
    let trials =
        plan(&settings.strategy, &|toggle, strategy| no_effect_with(toggle, &settings, strategy));
    let pool = Pool::new(arguments.threads.map(usize::from), Priority::Normal)?;
    let cpu_before = process_seconds();
    let swept = show_progress(arguments, &settings, (&scene, &trials), &pool, &interrupt)?;
    let paths: u64 = swept.tried.iter().flatten().map(|tried| tried.totals.paths).sum();
    if swept.interrupted && paths == 0 {
        return Err(Error::Cancelled.into());
    }
    let cpu_seconds = process_seconds() - cpu_before;
    let ranking = swept.ranking(&trials);
    let table = SweepTable::new(
        (arguments.scene.name(), &settings.film),
        (&swept, &ranking),
        (pool.threads(), cpu_seconds),
    );
    print(&table.text())?;
    if let Some(folder) = &arguments.output {
        rescue::write_folder(folder, &|folder| {
            table.write(folder).and(chart::write(&folder.join("chart.png"), &ranking))
        })?;
    }
    conclude(arguments, &settings, (&trials, &swept, &ranking))
}

/// Renders with a progress bar on standard error, if that is a terminal.
fn show_progress(
    arguments: &Arguments,
    settings: &Settings,
    (scene, trials): (&Scene, &[Trial]),
    pool: &Pool,
    interrupt: &AtomicBool,
) -> Result<Swept> {
    const STEPS: u64 = 1000;
    let cpu_seconds = match (arguments.time, arguments.spp) {
        (None, None) => Some(DEFAULT_SECONDS),
        (time, _) => time,
    };
    let amount = Amount { spp: arguments.spp.unwrap_or(0), cpu_seconds, evenly: true };
    let size = UVec2::from(settings.film.size);
    let job = SweepJob { scene, trials, size, seed: settings.picture_seed(), amount };
    let bar: ProgressBar = progress_bar(STEPS);
    let result = sweep(&job, pool, interrupt, &mut |progress| match progress {
        SweepProgress::Preparing(done, all) => {
            bar.set_message(format!("preparing {done} of {all}"))
        }
        SweepProgress::Rendering(part) => {
            bar.set_position((part * STEPS as f64) as u64);
            bar.set_message("rendering");
        }
    });
    bar.finish_and_clear();
    result
}

/// Says what went wrong while rendering, and how it ended.
fn conclude(
    arguments: &Arguments,
    settings: &Settings,
    (trials, swept, ranking): (&[Trial], &Swept, &Ranking),
) -> Result<Exit, Refusal> {
    for (trial, tried) in std::iter::zip(trials, &swept.tried) {
        let Some(totals) = tried.map(|tried| tried.totals) else { continue };
        warn_of_lost_samples(&totals, &format!("{}: ", trial.kind.name()));
    }
    if let Some((number, failure)) = &swept.failure {
        let Trial { kind, strategy, .. } = &trials[*number];
        let scene = arguments.scene.in_words(settings);
        let toggles = table::toggles_in_words(strategy);
        let what = failed_path::in_words(failure, &format!("{scene}{toggles}"));
        return Err(Error::invalid("", "", format!("{}: {what}", kind.name())).into());
    }
    if ranking.leave_on.is_none() {
        warn("no pixel has two samples; --time or --spp gives each strategy more");
    }
    Ok(if swept.interrupted { Exit::Interrupted } else { Exit::Done })
}
