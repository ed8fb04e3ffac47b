//! Guesses for a bare volume in place of a scene: the roles of its grids, the up axis, density,
//! brightness and camera. Every guess is an ordinary setting, and is reported in a note.

mod emission;
mod grid_columns;
mod note;
mod roles;

use std::sync::Arc;

use super::cache::VolumeFile;
use super::conventions::{Program, upright};
use super::describe::grid_bounds;
use super::embedded::short_name;
use super::fit_camera::fit_camera;
use super::settings::{
    Albedo, Axis, CameraSettings, Color, DensitySettings, LightKind, LightSettings, PhaseSettings,
    Settings, VolumeSettings,
};
use crate::error::{Error, Progress, Result};
use crate::format::two_digits;
use crate::math::Aabb;
use grid_columns::{FAIRLY, columns, quantile, visible_bounds};
pub use note::{About, Note};
use roles::Candidate;

/// A scene made up for a bare volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Guess {
    /// The guesses as settings.
    pub settings: Settings,
    /// The guesses in words.
    pub notes: Vec<Note>,
}

/// Appearance of a volume: how thick and how bright it is made.
struct Appearance {
    /// Words in the file's name that select the appearance.
    words: &'static [&'static str],
    /// The optical depth of a fairly thick line of sight.
    depth: f32,
    /// Albedo: the share of light that is scattered.
    albedo: f32,
    /// Radiance of a fairly bright line of sight through the fire, if nothing hid it.
    radiance: f32,
}

/// Appearances that the name of a file asks for.
const NAMED_APPEARANCES: &[Appearance] = &[
    Appearance { words: &["cloud", "cumulus", "wdas"], depth: 25.0, albedo: 0.99, radiance: 1.0 },
    Appearance { words: &["fog", "mist", "haze"], depth: 1.5, albedo: 0.95, radiance: 1.0 },
];
/// Smoke without fire.
const SMOKE: Appearance = Appearance { words: &[], depth: 6.0, albedo: 0.9, radiance: 1.0 };
/// Smoke that is wrapped around a fire.
const FIRE_SMOKE: Appearance = Appearance { words: &[], depth: 4.0, albedo: 0.5, radiance: 2.5 };
/// The thin soot inside a fire, which must not hide it.
const SOOT: Appearance = Appearance { words: &[], depth: 0.4, albedo: 0.3, radiance: 0.9 };
/// A density that is nowhere above this is soot, if there is fire.
const SOOT_BELOW: f32 = 0.3;
/// Makes up a scene for `file`.
///
/// # Errors
/// No grid of it can be rendered; names them and what to do.
pub(super) fn guess(file: &Arc<VolumeFile>, progress: Progress) -> Result<Guess> {
    let grids = load(file, progress)?;
    let density = roles::density(&grids);
    let emission = roles::emission(&grids);
    let mut notes = Vec::new();
    let seen: Vec<&Candidate> = density.into_iter().chain(emission.map(|e| e.0)).collect();
    let Some(bounds) = bounds_of(&seen) else { return Err(nothing_to_see(file)) };
    let is_y_up = is_y_up(file, &bounds, &mut notes);
    // The line of sight of the default camera, in the file's own space.
    let axis = if is_y_up { 2 } else { 1 };

    let name = short_name(file.name());
    let look = look_of(name, density, emission.is_some());
    let mut volume = VolumeSettings {
        name: name.to_owned(),
        file: Some(file.name().to_owned()),
        albedo: Albedo::Gray(look.albedo),
        phase: PhaseSettings { g: 0.3 },
        ..VolumeSettings::default()
    };
    volume.rotate = upright(if is_y_up { Axis::Y } else { Axis::Z });
    volume.density = density_settings(density, look.depth, &bounds, axis, &mut notes);
    if let Some((grid, role)) = emission {
        volume.emission =
            emission::emission_settings(grid, role, look.radiance, &bounds, axis, &mut notes);
    }

    let mut settings = Settings::default();
    let visible = seen.iter().filter_map(|one| visible_bounds(&one.grid, one.mean));
    let visible = visible.reduce(|a, b| a.union(&b)).unwrap_or(bounds);
    let world_bounds = visible.transformed(&super::assemble::world_from_file(&volume));
    settings.camera = default_camera(&settings, &world_bounds);
    if emission.is_none() {
        daylight(&mut settings);
        notes.push(Note::new(About::Light, "nothing emits light, so a sun and a sky were added"));
    }
    settings.volume.push(volume);
    Ok(Guess { settings, notes })
}

fn load(file: &Arc<VolumeFile>, progress: Progress) -> Result<Vec<Candidate>> {
    let infos = &file.directory().grids;
    let count = infos.len().max(1) as f32;
    roles::candidates(infos.len(), |index| {
        let Some(info) = infos.get(index) else { return Ok(None) };
        if info.unsupported.is_some() || !roles::is_worth_loading(&info.name) {
            return Ok(None);
        }
        let part = |fraction: f32| progress((index as f32 + fraction) / count);
        file.grid_at(index, &info.name, &part).map(Some)
    })
}

fn nothing_to_see(file: &VolumeFile) -> Error {
    let grids: Vec<String> = file
        .directory()
        .grids
        .iter()
        .map(|grid| format!("\"{}\" ({}, {})", grid.name, grid.value_type, grid.class))
        .collect();
    let reason = if grids.is_empty() {
        "there are no grids in this file; export it again".to_owned()
    } else {
        format!(
            "no grid can be rendered as smoke or fire: {}; export a fog volume with values above \
             zero",
            grids.join(", ")
        )
    };
    Error::invalid(file.name(), "", reason)
}

/// The box around the active voxels of the grids, in the file's space.
fn bounds_of(grids: &[&Candidate]) -> Option<Aabb> {
    let boxes = grids.iter().filter_map(|candidate| grid_bounds(&candidate.grid));
    boxes.reduce(|a, b| a.union(&b))
}

/// Programs have habits; files of none of them stand on the ground of one of the axes.
fn is_y_up(file: &VolumeFile, bounds: &Aabb, notes: &mut Vec<Note>) -> bool {
    let (is_y_up, why) = match Program::of(file.directory()) {
        Some(program) => (program.up() == Axis::Y, format!("exported by {}", program.name())),
        None => (stands_on_y(bounds), "from its position".to_owned()),
    };
    let axis = if is_y_up { "y" } else { "z" };
    notes.push(Note::new(About::UpAxis, format!("{axis} is up ({why})")));
    is_y_up
}

/// Whether the box stands on y = 0 and is centered about z = 0, and does not stand on z = 0.
fn stands_on_y(bounds: &Aabb) -> bool {
    let size = bounds.size().max_element();
    let stands_on = |axis: usize, tolerance: f32| bounds.min[axis].abs() < tolerance * size;
    stands_on(1, 0.08) && !stands_on(2, 0.2) && bounds.center().z.abs() < 0.1 * size
}

fn look_of(name: &str, density: Option<&Candidate>, is_fire: bool) -> &'static Appearance {
    let name = name.to_ascii_lowercase();
    let is_named = |look: &&Appearance| look.words.iter().any(|word| name.contains(word));
    match density {
        Some(density) if is_fire && density.max < SOOT_BELOW => &SOOT,
        _ if is_fire => &FIRE_SMOKE,
        _ => NAMED_APPEARANCES.iter().find(is_named).unwrap_or(&SMOKE),
    }
}

fn density_settings(
    density: Option<&Candidate>,
    wanted_depth: f32,
    bounds: &Aabb,
    axis: usize,
    notes: &mut Vec<Note>,
) -> DensitySettings {
    let Some(density) = density else {
        notes.push(Note::new(About::Density, "no density grid, only fire"));
        return DensitySettings { grid: None, scale: Color::Gray(0.0) };
    };
    let depths = columns(&density.grid, bounds, axis, |value| value.x.max(0.0));
    let scale = quantile(&depths, FAIRLY).map_or(1.0, |depth| two_digits(wanted_depth / depth));
    let name = &density.grid.name;
    let text = format!("\"{name}\" is the density (density × {scale})");
    notes.push(Note::new(About::Density, text));
    DensitySettings { grid: Some(name.clone()), scale: Color::Gray(scale) }
}

/// A little from above and from one side.
fn default_camera(settings: &Settings, bounds: &Aabb) -> CameraSettings {
    let view = CameraSettings {
        position: [0.25, -1.0, 0.18],
        target: [0.0; 3],
        ..CameraSettings::default()
    };
    let [width, height] = settings.film.size;
    fit_camera(&view, bounds, width as f32 / height as f32)
}

fn daylight(settings: &mut Settings) {
    settings.environment.radiance = Color::Rgb([0.18, 0.24, 0.35]);
    settings.light.push(LightSettings {
        kind: LightKind::Sun,
        direction: Some([0.7, 0.45, -0.55]),
        intensity: Color::Rgb([5.0, 4.6, 4.0]),
        ..LightSettings::default()
    });
}
