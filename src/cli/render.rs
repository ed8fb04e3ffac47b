//! `flambeau render`: a picture without a window.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use clap::Args;
use glam::UVec2;

use super::clashes::{Named, files_of_scene, refuse_clashes};
use super::console::{progress_bar, warn, warn_of_lost_samples};
use super::cpu_time::process_seconds;
use super::exit::{Exit, Refusal};
use super::failed_path;
use super::frames::{FrameList, path_of_frame, refuse_one_file_for_all};
use super::interrupt::listen_for_interrupt;
use super::outputs::{Output, write_all};
use super::scene_source::SceneArguments;
use super::snapshot_header::header;
use super::stats::{Spent, Stats, is_standard_output};
use super::values::parse_seconds;
use crate::error::{Error, Progress, Result};
use crate::files::{Fingerprint, check_writable};
use crate::format;
use crate::image::exr::{Snapshot, SnapshotHeader, read_snapshot_unless};
use crate::render::estimate::samples_per_pixel;
use crate::render::schedule::Limits;
use crate::render::{Film, FilmStats, Headless, RenderJob, render_headless};
use crate::scene::{self, Settings, VolumeCache};
use crate::transport::{Frame, PixelSampler};

/// Samples a pixel where neither the command line nor the scene says how many.
const DEFAULT_SPP: u32 = 64;

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Where to write: .exr keeps all layers and can be continued, .png is as seen on screen, .npy
    /// is the linear picture for scripts. Several are allowed. `out.####.exr` has the number of the
    /// frame in place of #.
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    output: Vec<Output>,
    /// Frames of a sequence, each to a file of its own: A-B, or every N-th of them by A-BxN.
    #[arg(long, value_name = "A-B[xN]", allow_hyphen_values = true, conflicts_with = "frame")]
    frames: Option<FrameList>,
    /// Samples per pixel.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    spp: Option<u32>,
    /// Stop this many seconds after the start of a frame, setting up included. Set-up is never cut
    /// short, and every pixel gets one sample: where the time is too short for both, it ends after
    /// them.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    time: Option<f64>,
    /// Number of threads; one a core if absent. The picture does not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Write the figures of the render as JSON; `-` is standard output. `stats.####.json` has the
    /// number of the frame in place of #.
    #[arg(long, value_name = "STATS.json")]
    stats: Option<PathBuf>,
    /// Go on from a snapshot of the same scene.
    #[arg(long, value_name = "OUT.exr", conflicts_with = "frames")]
    resume: Option<PathBuf>,
}

/// A picture to render.
struct FrameJob {
    settings: Settings,
    limits: Limits,
    outputs: Vec<Output>,
    /// File of the figures of the render.
    stats: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> Result<Exit, Refusal> {
    let interrupt = listen_for_interrupt()?;
    let mut start = Start { wall: Instant::now(), cpu: 0.0 };
    let go_on = |_: f32| !interrupt.load(Ordering::Relaxed);
    let cache = VolumeCache::default();
    let mut settings = arguments.scene.settings(&cache, &go_on)?;
    if settings.strategy.is_biased() {
        warn("ray marching is on (strategy.integrator): the picture is biased");
    }
    let limits = limits(arguments, &mut settings);
    let jobs = jobs(arguments, &settings, limits)?;
    for job in &jobs {
        arguments.scene.refuse_missing(&job.settings)?;
        check_places(arguments, job)?;
    }
    for job in jobs {
        match render(arguments, job, start, &cache, &interrupt)? {
            Exit::Done => start = Start { wall: Instant::now(), cpu: process_seconds() },
            exit => return Ok(exit),
        }
    }
    Ok(Exit::Done)
}

/// The pictures to render, frame by frame.
fn jobs(
    arguments: &Arguments,
    settings: &Settings,
    limits: Limits,
) -> Result<Vec<FrameJob>, Refusal> {
    let stats = arguments.stats.as_deref();
    if arguments.frames.is_some_and(FrameList::has_several) {
        let files = stats.filter(|path| !is_standard_output(path));
        arguments
            .output
            .iter()
            .map(|output| ("-o", output.path()))
            .chain(files.map(|path| ("--stats", path)))
            .try_for_each(|(option, path)| refuse_one_file_for_all(option, path))?;
    }
    let frames = match arguments.frames {
        Some(list) => list.iter().map(f64::from).collect(),
        None => vec![settings.time.frame],
    };
    let job = |frame| {
        let mut settings = settings.clone();
        settings.time.frame = frame;
        let number = settings.time.whole_frame();
        let outputs = arguments.output.iter().map(|output| output.of_frame(number)).collect();
        let stats = stats.map(|path| path_of_frame(path, number));
        FrameJob { settings, limits, outputs, stats }
    };
    Ok(frames.into_iter().map(job).collect())
}

/// When the work on a picture began.
#[derive(Clone, Copy)]
struct Start {
    wall: Instant,
    /// CPU time that the program had spent by then, in seconds.
    cpu: f64,
}

/// Renders one picture and writes it.
fn render(
    arguments: &Arguments,
    job: FrameJob,
    start: Start,
    cache: &VolumeCache,
    interrupt: &AtomicBool,
) -> Result<Exit, Refusal> {
    let FrameJob { settings, limits, .. } = &job;
    let go_on = |_: f32| !interrupt.load(Ordering::Relaxed);
    let files = match arguments.resume.is_some() || writes_snapshot(arguments) {
        true => scene::fingerprints(settings, &go_on)?,
        false => Vec::new(),
    };
    let resumed = match &arguments.resume {
        Some(path) => Some(resume(path, settings, &files, &go_on)?),
        None => None,
    };
    let scene = arguments.scene.assemble(settings, cache, &go_on)?;
    let (film, before) = match resumed {
        Some(Snapshot { film, header }) => (Some(film), spent_before(&header)),
        None => (None, Spent::default()),
    };
    let size = UVec2::from_array(settings.film.size);
    let frame = Frame::new(Arc::new(scene), size, settings.picture_seed(), &go_on)?;
    // A single sample needs no pilot pass.
    let sampler: Arc<dyn PixelSampler> = match limits.spp {
        1 => Arc::new(frame),
        _ => Arc::new(frame.prepared(&go_on)?),
    };
    let cpu_setup = process_seconds();
    let paths_before = film.as_ref().map_or(0, |film| film.totals.paths);
    let render_job = RenderJob {
        sampler,
        size,
        limits: limits_left(*limits, start.wall),
        resume: film,
        threads: arguments.threads.map(usize::from),
    };
    let render = show_progress(render_job, interrupt)?;
    refuse_nothing(arguments, settings, &render, paths_before)?;
    let spent = before.plus(Spent {
        wall: start.wall.elapsed().as_secs_f64(),
        cpu_setup: cpu_setup - start.cpu,
        cpu_render: process_seconds() - cpu_setup,
    });
    finish(arguments, &job, files, &render, spent)
}

/// Limits of samples and time, from the command line, the scene and the default, in this order. The
/// number of samples becomes part of the settings, so that the header of a snapshot holds it.
fn limits(arguments: &Arguments, settings: &mut Settings) -> Limits {
    let spp = match (arguments.spp, arguments.time, settings.film.spp) {
        (Some(spp), _, _) => spp,
        (None, Some(_), _) => 0,
        (None, None, 0) => {
            warn(&format!(
                "rendering {DEFAULT_SPP} samples per pixel; --spp or --time says otherwise"
            ));
            DEFAULT_SPP
        }
        (None, None, spp) => spp,
    };
    settings.film.spp = spp;
    Limits { spp, seconds: arguments.time }
}

/// Limits that are left once everything is set up.
fn limits_left(limits: Limits, start: Instant) -> Limits {
    let Some(all) = limits.seconds else { return limits };
    let spent = start.elapsed().as_secs_f64();
    if spent >= all {
        warn(&format!(
            "setting up took {spent:.1} s, all of --time {all}; every pixel gets one sample all the \
             same"
        ));
    }
    Limits { seconds: Some((all - spent).max(0.0)), ..limits }
}

/// Finds out before hours of rendering what would overwrite an input after them, or could not be
/// written.
fn check_places(arguments: &Arguments, job: &FrameJob) -> Result<(), Refusal> {
    let stats = job.stats.as_deref().filter(|path| !is_standard_output(path));
    let mut reads = files_of_scene(arguments.scene.name(), &job.settings)?;
    let snapshot = arguments.resume.as_deref();
    reads.extend(snapshot.map(|path| Named::snapshot("the snapshot to go on from", path)));
    let mut writes: Vec<Named> = job.outputs.iter().map(Output::named).collect();
    writes.extend(stats.map(|path| Named::new("--stats", path)));
    refuse_clashes(&reads, &writes)?;
    job.outputs.iter().map(Output::path).chain(stats).try_for_each(check_writable)?;
    Ok(())
}

/// Refuses to write anything where the render was broken off before its first sample, so that an
/// older picture stays.
fn refuse_nothing(
    arguments: &Arguments,
    settings: &Settings,
    render: &Headless,
    paths_before: u64,
) -> Result<()> {
    match &render.failure {
        _ if render.film.totals.paths > paths_before => Ok(()),
        Some(failure) => {
            let scene = arguments.scene.in_words(settings);
            let reason = failed_path::in_words(failure, &scene);
            Err(Error::invalid("", "", format!("{reason}; nothing was written")))
        }
        None if render.interrupted => Err(Error::Cancelled),
        None => Ok(()),
    }
}

fn writes_snapshot(arguments: &Arguments) -> bool {
    arguments.output.iter().any(Output::is_snapshot)
}

/// The snapshot to go on from, if it is one of this scene with the `files` it has now.
fn resume(
    path: &Path,
    settings: &Settings,
    files: &[Fingerprint],
    go_on: Progress,
) -> Result<Snapshot> {
    let snapshot = read_snapshot_unless(path, go_on)?;
    let name = path.display().to_string();
    let compatibility = scene::compatibility(&snapshot.header, &name, settings, files)?;
    if let Some(scene::Blocker { what, fix }) = compatibility.blocker {
        return Err(Error::invalid(name, "", format!("{what}. {fix}")));
    }
    compatibility.warnings.iter().for_each(|warning| warn(warning));
    Ok(snapshot)
}

fn spent_before(header: &SnapshotHeader) -> Spent {
    Spent {
        wall: header.wall_seconds,
        cpu_setup: header.cpu_seconds_setup,
        cpu_render: header.cpu_seconds_render,
    }
}

/// Renders with a progress bar on standard error, if that is a terminal.
fn show_progress(job: RenderJob, interrupt: &AtomicBool) -> Result<Headless> {
    const STEPS: u64 = 1000;
    let limits = job.limits;
    let before = job.resume.as_ref().map_or(0.0, samples_per_pixel);
    let bar = progress_bar(STEPS);
    let result = render_headless(job, interrupt, &mut |film: &Film, seconds: f64| {
        let samples = samples_per_pixel(film);
        let by_samples = match limits.spp {
            0 => 0.0,
            spp => (samples - before) / (f64::from(spp) - before),
        };
        let by_time = limits.seconds.map_or(0.0, |end| seconds / end);
        bar.set_position((by_samples.max(by_time) * STEPS as f64) as u64);
        bar.set_message(format::samples_per_pixel(samples));
    });
    bar.finish_and_clear();
    result
}

/// Writes what there is and says how it went.
fn finish(
    arguments: &Arguments,
    FrameJob { settings, outputs, stats, .. }: &FrameJob,
    files: Vec<Fingerprint>,
    render: &Headless,
    spent: Spent,
) -> Result<Exit, Refusal> {
    let film = &render.film;
    let header = header(settings, files, spent)?;
    let figures = render.pool.install(|| FilmStats::of(film));
    let written = render.pool.install(|| write_all(outputs, film, &header));
    if let Some(path) = stats {
        let threads = render.pool.threads();
        let stats =
            Stats::new(film, &figures, spent, settings.film.seed, threads, settings.strategy);
        if let Err(refusal) = stats.write(path) {
            written.unwrap_or_else(|error| warn(&error.to_string()));
            return Err(refusal);
        }
    }
    written?;
    report(outputs, render, &figures);
    if !settings.volume.is_empty() && film.totals.met_no_volume() {
        warn("no path met any volume; the camera may look past it");
    }
    if let Some(failure) = &render.failure {
        let what = failed_path::in_words(failure, &arguments.scene.in_words(settings));
        return Err(Error::invalid("", "", what).into());
    }
    Ok(if render.interrupted { Exit::Interrupted } else { Exit::Done })
}

fn report(outputs: &[Output], render: &Headless, figures: &FilmStats) {
    let noise = figures.noise.map_or(String::new(), |n| format!(", noise {:.2} %", n * 100.0));
    let names: Vec<String> =
        outputs.iter().map(|output| output.path().display().to_string()).collect();
    warn(&format!(
        "{}{:.4} samples per pixel in {:.1} s{noise}: {}",
        if render.interrupted { "interrupted after " } else { "" },
        figures.samples_per_pixel,
        render.seconds,
        names.join(", ")
    ));
    warn_of_lost_samples(&render.film.totals, "");
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    /// The time runs from the start of the program, and never below nothing.
    #[test]
    fn setting_up_takes_its_share_of_the_time() {
        let Some(start) = Instant::now().checked_sub(Duration::from_secs(5)) else { return };
        let left = |seconds| limits_left(Limits { spp: 3, seconds }, start);
        assert_eq!(left(None), Limits { spp: 3, seconds: None });
        assert!((994.0..=995.0).contains(&left(Some(1000.0)).seconds.unwrap()));
        assert_eq!(left(Some(4.0)), Limits { spp: 3, seconds: Some(0.0) });
    }
}
