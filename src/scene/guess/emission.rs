//! The emission of a bare volume: its mode, and how bright it is.

use glam::Vec3A;

use super::candidate::Candidate;
use super::grid_columns::{FAIRLY, columns, quantile};
use super::note::{About, Note};
use crate::format::two_digits;
use crate::math::luminance;
use crate::scene::file_box::FileBox;
use crate::scene::grid_names::kelvin_scale;
use crate::scene::role::{Role, flame_stops};
use crate::scene::settings::{EmissionMode, EmissionSettings, Normalize};
use crate::volume::blackbody;

/// The settings of the emission of grids of one name, as it is read from the first of them; so
/// bright that a fairly bright line along `axis` shows the radiance that is wanted.
pub(super) fn emission_settings(
    grids: &[&Candidate],
    role: Role,
    wanted_radiance: f32,
    bounds: &FileBox,
    axis: usize,
    notes: &mut Vec<Note>,
) -> EmissionSettings {
    let Some(first) = grids.first() else { return EmissionSettings::default() };
    let name = &first.grid.name;
    let max = grids.iter().map(|grid| grid.max).fold(0.0, f32::max);
    let mut emission = EmissionSettings { grid: Some(name.clone()), ..EmissionSettings::default() };
    let what = match role {
        Role::Temperature => {
            emission.mode = EmissionMode::Blackbody;
            emission.normalize = Some(Normalize::T4);
            let scale = kelvin_scale(max);
            emission.kelvin_scale = Some(scale);
            format!("a temperature (temperature × {scale} K)")
        }
        Role::Flame => {
            emission.mode = EmissionMode::Ramp;
            emission.stops = Some(flame_stops(max));
            "the flame, through a color ramp".to_owned()
        }
        Role::Emission | Role::Density => {
            emission.mode = EmissionMode::Grid;
            "the emission".to_owned()
        }
    };
    notes.push(Note::new(About::Emission, format!("\"{name}\" is {what}")));
    let brightness = brightness_of(&emission);
    let sums = columns(grids, bounds, axis, brightness);
    let scale = quantile(&sums, FAIRLY).map_or(1.0, |sum| two_digits(wanted_radiance / sum));
    match emission.mode {
        EmissionMode::Grid => emission.scale = Some(scale),
        _ => emission.intensity = Some(scale),
    }
    emission
}

/// The luminance of the emission at a value of its grid, at intensity 1.
fn brightness_of(emission: &EmissionSettings) -> impl Fn(Vec3A) -> f32 {
    let (mode, scale) = (emission.mode, emission.kelvin_scale());
    let (reference, largest) = (emission.reference_kelvin(), emission.stops().last().copied());
    move |value| match mode {
        EmissionMode::Blackbody => {
            let kelvin = (value.x * scale).max(0.0);
            luminance(blackbody::peak_normalized(kelvin)) * (kelvin / reference).powi(4)
        }
        EmissionMode::Ramp => largest.map_or(0.0, |[top, r, g, b]| {
            // The ramp rises about with the square of the value.
            luminance(Vec3A::new(r, g, b)) * (value.x.max(0.0) / top).powi(2)
        }),
        _ => luminance(value.max(Vec3A::ZERO)),
    }
}
