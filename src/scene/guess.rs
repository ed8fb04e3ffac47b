//! Guesses for a bare volume in place of a scene: the roles of its grids, the up axis, density,
//! brightness and camera. Every guess is an ordinary setting, and is reported in a note.

mod candidate;
mod emission;
mod framing;
mod grid_columns;
mod note;
mod roles;
mod velocity;

use std::sync::Arc;

use super::assemble::world_from_file;
use super::cache::VolumeFile;
use super::conventions::{Program, upright};
use super::embedded::short_name;
use super::file_box::FileBox;
use super::fit_camera::fit_camera;
use super::settings::{
    Albedo, Axis, CameraSettings, Color, DensitySettings, PhaseSettings, Settings, VolumeSettings,
};
use super::setup::Setup;
use crate::error::{Error, Progress, Result};
use crate::format::two_digits;
use crate::math::Aabb;
use candidate::{Candidate, LeftOut};
use grid_columns::{FAIRLY, columns, quantile, visible_bounds};
pub use note::{About, Note};

/// A scene made up for a bare volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Guess {
    /// The guesses as settings.
    pub settings: Settings,
    /// The guesses in words.
    pub notes: Vec<Note>,
    /// A box around what is seen of the volume.
    pub bounds: Aabb,
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
const FIRE_SMOKE: Appearance = Appearance { words: &[], depth: 11.0, albedo: 0.45, radiance: 3.0 };
/// The thin soot inside a fire, which must not hide it.
const SOOT: Appearance = Appearance { words: &[], depth: 0.4, albedo: 0.3, radiance: 0.9 };
/// A density that is nowhere above this is soot, if there is fire.
const SOOT_BELOW: f32 = 0.3;
/// Grids whose reasons an error lists; `flambeau info` has the rest.
const MOST_REASONS: usize = 8;

/// Makes up a scene for `file`.
///
/// # Errors
/// No grid of it can be rendered; names them, each with its reason.
pub(super) fn guess(file: &Arc<VolumeFile>, progress: Progress) -> Result<Guess> {
    let (grids, left_out) = candidate::candidates(file, progress)?;
    let density = roles::density(&grids);
    let (emission, role) = roles::emission(&grids);
    let mut notes = Vec::new();
    let seen: Vec<&Candidate> = density.iter().chain(&emission).copied().collect();
    let Some(bounds) = seen.iter().map(|grid| grid.core).reduce(FileBox::union) else {
        return Err(nothing_to_see(file, &grids, &left_out));
    };
    let is_y_up = is_y_up(file, &bounds.to_aabb(), &mut notes);
    let mut first = VolumeSettings {
        file: Some(file.name().to_owned()),
        phase: PhaseSettings { g: 0.3, ..PhaseSettings::default() },
        rotate: upright(if is_y_up { Axis::Y } else { Axis::Z }),
        ..VolumeSettings::default()
    };
    let look = look_of(short_name(file.name()), &density, !emission.is_empty());
    first.albedo = Albedo::Gray(look.albedo);
    let voxel = seen.iter().map(|grid| grid.voxel).fold(f64::INFINITY, f64::min);
    framing::move_near(&mut first, &bounds, voxel, &mut notes);
    // The line of sight of the default camera, in the file's own space.
    let axis = if is_y_up { 2 } else { 1 };
    first.density = density_settings(&density, look.depth, &bounds, axis, &mut notes);
    first.emission =
        emission::emission_settings(&emission, role, look.radiance, &bounds, axis, &mut notes);

    let mut settings = Settings::default();
    let visible = seen.iter().filter_map(|one| visible_bounds(one)).reduce(FileBox::union);
    let visible = visible.unwrap_or(bounds).transformed(&world_from_file(&first));
    settings.camera = default_camera(&settings, &visible.to_aabb());
    framing::notes_of_strays(&seen, &mut notes);
    settings.volume = one_volume_each(&first, &density, &emission, short_name(file.name()));
    let velocities = velocity::velocities(file, &mut notes);
    for (n, volume) in settings.volume.iter_mut().enumerate() {
        volume.velocity = velocities.get(n).or(velocities.first()).cloned().unwrap_or_default();
    }
    let bounds = visible.to_aabb();
    Setup::default().apply(&mut settings, &bounds);
    let text = "a floor and a soft sky were added around it (studio; others are night and black)";
    notes.push(Note::new(About::Light, text));
    for grid in left_out.iter().filter(|grid| grid.is_missed) {
        let text = format!("\"{}\" is left out: {}", grid.name, grid.reason);
        notes.push(Note::new(About::LeftOut, text));
    }
    Ok(Guess { settings, notes, bounds })
}

/// Volumes that add up to all grids of the names of density and emission, the n-th of the one with
/// the n-th of the other.
fn one_volume_each(
    first: &VolumeSettings,
    density: &[&Candidate],
    emission: &[&Candidate],
    name: &str,
) -> Vec<VolumeSettings> {
    let address = |grids: &[&Candidate], n: usize| Some(grids.get(n)?.grid.name.clone());
    let volume = |n: usize| {
        let mut volume = first.clone();
        volume.name = nth_name(name, n);
        match address(density, n) {
            Some(grid) => volume.density.grid = Some(grid),
            None => volume.density = invisible(),
        }
        match address(emission, n) {
            Some(grid) => volume.emission.grid = Some(grid),
            None => volume.emission = Default::default(),
        }
        volume
    };
    (0..density.len().max(emission.len())).map(volume).collect()
}

/// Name of the n-th volume of a file.
pub(super) fn nth_name(name: &str, n: usize) -> String {
    if n == 0 { name.to_owned() } else { format!("{name} {}", n + 1) }
}

fn nothing_to_see(file: &VolumeFile, grids: &[Candidate], left_out: &[LeftOut]) -> Error {
    let unused = grids.iter().map(|grid| (&grid.grid.name, roles::why_unused(grid)));
    let others = left_out.iter().map(|grid| (&grid.name, grid.reason.as_str()));
    let reasons: Vec<String> =
        others.chain(unused).map(|(name, reason)| format!("\"{name}\": {reason}")).collect();
    let reason = match reasons.len() {
        0 => "there are no grids in this file; export it again".to_owned(),
        count => {
            let mut listed = reasons;
            listed.truncate(MOST_REASONS);
            let more = match count.saturating_sub(MOST_REASONS) {
                0 => String::new(),
                more => format!(" (and {more} more, see `flambeau info`)"),
            };
            format!("no grid can be rendered as smoke or fire. {}{more}", listed.join(". "))
        }
    };
    Error::invalid(file.name(), "", reason)
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

fn look_of(name: &str, density: &[&Candidate], is_fire: bool) -> &'static Appearance {
    let name = name.to_ascii_lowercase();
    let is_named = |look: &&Appearance| look.words.iter().any(|word| name.contains(word));
    let largest = density.iter().map(|grid| grid.max).reduce(f32::max);
    match largest {
        Some(largest) if is_fire && largest < SOOT_BELOW => &SOOT,
        _ if is_fire => &FIRE_SMOKE,
        _ => NAMED_APPEARANCES.iter().find(is_named).unwrap_or(&SMOKE),
    }
}

fn density_settings(
    density: &[&Candidate],
    wanted_depth: f32,
    bounds: &FileBox,
    axis: usize,
    notes: &mut Vec<Note>,
) -> DensitySettings {
    let Some(first) = density.first() else {
        notes.push(Note::new(About::Density, "no density grid, only fire"));
        return invisible();
    };
    let depths = columns(density, bounds, axis, |value| value.x.max(0.0));
    let scale = quantile(&depths, FAIRLY).map_or(1.0, |depth| two_digits(wanted_depth / depth));
    let name = &first.grid.name;
    let text = format!("\"{name}\" is the density (density × {scale})");
    notes.push(Note::new(About::Density, text));
    if density.len() > 1 {
        let (count, last) = (density.len(), density.len() - 1);
        let text = format!(
            "{count} grids are called \"{name}\"; all are shown, added together, as \"{name}\" to \
             \"{}\"",
            density[last].grid.name
        );
        notes.push(Note::new(About::Density, text));
    }
    DensitySettings {
        grid: Some(name.clone()),
        scale: Color::Gray(scale),
        ..DensitySettings::default()
    }
}

/// The density of a volume of which only the emission is seen.
fn invisible() -> DensitySettings {
    DensitySettings { scale: Color::Gray(0.0), ..DensitySettings::default() }
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
