//! `flambeau info`: what is in a volume, a snapshot or a scene.

mod json;

use std::fmt::{Debug, Write};

use serde::Serialize;

use super::console::print;
use super::exit::{Exit, Refusal};
use super::values::file_name;
use crate::error::{Error, NO_PROGRESS, Result};
use crate::files::path_of;
use crate::format::{in_steps, mebibytes};
use crate::image::exr::{Info, read_info};
use crate::scene::sequence::NumberedSet;
use crate::scene::settings::{CameraSettings, EnvironmentSettings, PhaseSettings, VolumeSettings};
use crate::scene::{self, GridDescription, Settings, VolumeCache};
use crate::volume::file::GridInfo;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// A volume (.vdb, .nvdb), a folder or pattern (fire_####.vdb) of numbered ones, a snapshot
    /// (.exr), a scene (.toml) or `builtin:NAME`.
    #[arg(value_name = "FILE", value_parser = file_name())]
    file: String,
    /// Tells of a volume as JSON: its grids with type, class, transform, bounds and statistics.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<Exit, Refusal> {
    let file = arguments.file.as_str();
    let path = path_of(file);
    let ending = path.extension().and_then(|ending| ending.to_str());
    let text = match ending.unwrap_or_default().to_ascii_lowercase().as_str() {
        ending if arguments.json => {
            if ending == "exr" || scene::is_scene(file) {
                let reason = "only a volume is told of as JSON; leave out --json";
                return Err(Refusal::usage(Error::invalid(file, "--json", reason)));
            }
            json::volume(file)?
        }
        "exr" => snapshot(&read_info(&path)?),
        _ if scene::is_scene(file) => summary(&scene::load(file)?),
        _ => volume(file)?,
    };
    print(&text)?;
    Ok(Exit::Done)
}

/// Lines of `name value` with the values in one column.
#[derive(Default)]
struct InfoText(String);

impl InfoText {
    fn title(&mut self, title: &str) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.0, "{title}");
    }

    fn row(&mut self, name: &str, value: impl AsRef<str>) {
        let _ = writeln!(self.0, "    {name:<13} {}", value.as_ref());
    }
}

fn volume(file: &str) -> Result<String> {
    let cache = VolumeCache::default();
    let description = scene::describe(file, &cache, NO_PROGRESS)?;
    let opened = cache.file(&description.file, NO_PROGRESS)?;
    let directory = opened.directory();
    let mut report = InfoText::default();
    if let Some(set) = NumberedSet::of_pattern_or_folder(file)? {
        sequence(&mut report, &set);
    }
    let (version, count) = (&directory.version, description.grids.len());
    report.title(&format!("{} file, format {version}, {count} grids", directory.format));
    for (name, value) in &description.metadata {
        report.row(name, value);
    }
    for (grid, info) in std::iter::zip(&description.grids, &directory.grids) {
        describe_grid(&mut report, grid, info);
    }
    Ok(report.0)
}

/// The frames of a sequence, of which the largest file is described.
fn sequence(report: &mut InfoText, set: &NumberedSet) {
    report.title(&format!("Sequence {}", set.pattern.spelling().display()));
    let [first, last] = set.files.range();
    report.row("frames", format!("{first} to {last}, {} files", set.files.files().len()));
    let holes = set.files.holes();
    let in_words = |[from, to]: &[i32; 2]| match from == to {
        true => from.to_string(),
        false => format!("{from} to {to}"),
    };
    if !holes.is_empty() {
        report.row("missing", holes.iter().map(in_words).collect::<Vec<_>>().join(", "));
    }
    report.row("largest file", set.fullest().display().to_string());
}

fn describe_grid(report: &mut InfoText, grid: &GridDescription, info: &GridInfo) {
    report.title(&format!("\"{}\"", grid.name));
    report.row("type", &grid.type_name);
    report.row("class", &grid.class);
    if let Some(reason) = &grid.unsupported {
        report.row("not readable", reason);
        return;
    }
    report.row("voxel size", format!("{:?}", grid.voxel_size));
    if let Some(voxels) = &grid.voxels {
        report.row("range", format!("{} .. {}, mean {}", voxels.min, voxels.max, voxels.mean));
        report.row("active voxels", voxels.active.to_string());
        let finest = grid.voxel_size.into_iter().fold(f64::INFINITY, f64::min);
        let corner = |corner: [f64; 3]| corner.map(|c| in_steps(c, finest)).join(", ");
        let bounds =
            voxels.bounds.map(|[low, high]| format!("[{}] .. [{}]", corner(low), corner(high)));
        report.row("bounds", bounds.unwrap_or_else(|| "empty".to_owned()));
        report.row("memory", mebibytes(voxels.memory_bytes));
    }
    if let Some(taper) = &info.transform.taper {
        let text = format!("slices widen by {} of the nearest a voxel of depth", taper.growth);
        report.row("frustum", text);
    }
    let map = &info.transform.index_to_world;
    for row in 0..3 {
        let axes = map.matrix3.row(row);
        let name = if row == 0 { "transform" } else { "" };
        let row = [axes.x, axes.y, axes.z, map.translation[row]];
        report.row(name, format!("{row:?}"));
    }
}

fn snapshot(info: &Info) -> String {
    let mut report = InfoText::default();
    report.title(&format!("EXR, {} x {} pixels", info.size.x, info.size.y));
    report.row("layers", layers(&info.channels));
    if info.parts != 1 {
        let note = format!("it has {} parts; this is about the first", info.parts);
        report.row("note", note);
    }
    let Some(header) = &info.header else {
        report.row("note", "not written by Flambeau, so it cannot be resumed");
        return report.0;
    };
    report.row("version", &header.version);
    report.row("path version", header.path_version.to_string());
    report.row("samples", format!("{} per pixel", info.samples));
    report.row("seed", header.seed.to_string());
    for file in &header.files {
        report.row("file", format!("{}, {} bytes, FNV-1a {}", file.name, file.bytes, file.hash));
    }
    report.row("paths", info.totals.paths.to_string());
    report.row("steps", info.totals.tracking_steps.to_string());
    report.row("not finite", info.totals.non_finite.to_string());
    report.row("cut by guard", info.totals.guard_hits.to_string());
    report.row("wall time", format!("{:.2} s", header.wall_seconds));
    let (setup, render) = (header.cpu_seconds_setup, header.cpu_seconds_render);
    report.row("CPU time", format!("{setup:.2} s setup, {render:.2} s rendering"));
    report.title("\nStrategy\n");
    report.title(&header.strategy);
    report.title("Scene\n");
    report.title(&header.scene);
    report.0
}

/// Layers with their channels; those that only serve to go on are counted.
fn layers(channels: &[String]) -> String {
    let (state, visible): (Vec<_>, Vec<_>) =
        channels.iter().partition(|channel| channel.starts_with("state."));
    let mut layers: Vec<(&str, Vec<&str>)> = Vec::new();
    for channel in visible {
        let (layer, component) = channel.rsplit_once('.').unwrap_or(("", channel));
        match layers.iter_mut().find(|(name, _)| *name == layer) {
            Some((_, components)) => components.push(component),
            None => layers.push((layer, vec![component])),
        }
    }
    let mut words: Vec<String> = layers
        .iter()
        .map(|(layer, components)| {
            let dot = if layer.is_empty() { "" } else { "." };
            format!("{layer}{dot}({})", components.join(" "))
        })
        .collect();
    if !state.is_empty() {
        words.push(format!("state ({} channels)", state.len()));
    }
    words.join(", ")
}

fn describe_camera(settings: &Settings) -> String {
    let CameraSettings { position, target, fov_x, f_stop, .. } = settings.present_camera();
    let mut text = format!("{position:?} to {target:?}, {fov_x} degrees");
    if f_stop > 0.0 {
        text += &format!(", f/{f_stop}");
    }
    match settings.camera.key.as_slice() {
        [] => text,
        [key] => text + &format!(", one key, of frame {}", key.frame),
        [first, .., last] => {
            let count = settings.camera.key.len();
            text + &format!(", {count} keys, of frames {} to {}", first.frame, last.frame)
        }
    }
}

fn describe_environment(environment: &EnvironmentSettings) -> String {
    if let Some(sky) = &environment.sky {
        let turbidity = sky.turbidity;
        return format!("clear sky of turbidity {turbidity}, sun {} degrees up", sky.sun_elevation);
    }
    match (&environment.file, &environment.gradient) {
        (Some(file), _) => format!("picture {file}"),
        (None, Some([bottom, horizon, top])) => {
            let [bottom, horizon, top] = [bottom, horizon, top].map(plain);
            format!("gradient from {bottom} below to {horizon} at the horizon and {top} above")
        }
        (None, None) => format!("radiance {}", plain(&environment.radiance)),
    }
}

fn summary(settings: &Settings) -> String {
    let mut report = InfoText::default();
    let [width, height] = settings.film.size;
    report.title("Scene");
    let spp = match settings.film.spp {
        0 => "until stopped".to_owned(),
        spp => format!("{spp} samples per pixel"),
    };
    report.row("film", format!("{width} x {height} pixels, {spp}, seed {}", settings.film.seed));
    report.row("camera", describe_camera(settings));
    report.row("environment", describe_environment(&settings.environment));
    for volume in &settings.volume {
        report.row("volume", describe_volume(volume));
    }
    for light in &settings.light {
        report.row("light", format!("{}, {}", plain(&light.kind), plain(&light.intensity)));
    }
    for surface in &settings.surface {
        let material = surface.material.map_or("no material".to_owned(), |m| plain(&m.kind));
        report.row("surface", format!("{}, {material}", plain(&surface.shape)));
    }
    let strategy = &settings.strategy;
    let preset = strategy.preset().map_or("mixed", |preset| preset.name());
    report.row("strategy", preset);
    if strategy.is_biased() {
        report.row("", "integrator = march (biased)");
    }
    for (name, on) in [
        ("emission_decoupling", strategy.emission_decoupling),
        ("emission_ratio_tracking", strategy.emission_ratio_tracking),
        ("majorant_boost", strategy.majorant_boost),
        ("nee", strategy.nee),
    ] {
        report.row("", format!("{name} = {on}"));
    }
    report.0
}

fn describe_volume(volume: &VolumeSettings) -> String {
    let what = match (&volume.file, &volume.shape) {
        (Some(file), _) => file.clone(),
        (None, Some(shape)) => plain(shape),
        (None, None) => "empty".to_owned(),
    };
    let name = if volume.name.is_empty() { String::new() } else { format!("\"{}\" ", volume.name) };
    let PhaseSettings { g, g2, mix } = volume.phase;
    let lobes = if mix > 0.0 { format!("{g} and {g2} (mix {mix})") } else { g.to_string() };
    format!(
        "{name}{what}, density {} x {}, albedo {}, g {}, emission {}",
        plain(&volume.density.scale),
        volume.density_grid(),
        plain(&volume.albedo),
        lobes,
        plain(&volume.emission.mode)
    )
}

/// A value as a scene file has it, without quotes.
fn plain(value: &(impl Serialize + Debug)) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(text)) => text,
        Ok(serde_json::Value::Number(number)) => {
            number.as_f64().map_or(number.to_string(), |value| (value as f32).to_string())
        }
        Ok(serde_json::Value::Array(values)) => {
            format!("[{}]", values.iter().map(plain).collect::<Vec<_>>().join(", "))
        }
        _ => format!("{value:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_gathered_into_layers() {
        let names = ["A", "B", "emission.G", "emission.R", "state.alpha.A", "state.x.R"];
        let names: Vec<String> = names.map(str::to_owned).to_vec();
        assert_eq!(layers(&names), "(A B), emission.(G R), state (2 channels)");
    }

    #[test]
    fn values_are_as_a_scene_file_has_them() {
        use crate::scene::settings::{Color, LightKind};
        assert_eq!(plain(&LightKind::Sphere), "sphere");
        assert_eq!(plain(&Color::Gray(0.1)), "0.1");
        assert_eq!(plain(&Color::Rgb([0.1, 0.25, 3.0])), "[0.1, 0.25, 3]");
    }
}
