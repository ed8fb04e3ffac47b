//! How what glows is rendered: the emission model of a bare volume, and how bright it is.

use glam::Vec3A;

use super::FAIRLY;
use super::probe::{columns, quantile, two_digits};
use super::roles::{Candidate, Glow};
use crate::math::{Aabb, luminance};
use crate::scene::settings::{EmissionMode, EmissionSettings, Normalize};
use crate::volume::blackbody;

/// Kelvin of the hottest place of a temperature without a unit, where its range tells nothing.
const HOTTEST_KELVIN: f32 = 2500.0;
/// Kelvin per unit of temperature in files that follow Blender.
const BLENDER_KELVIN: f32 = 1000.0;

/// The emission of the grid that glows, so bright that a fairly bright line along `axis` shows the
/// radiance that is wanted.
pub(super) fn emission_settings(
    candidate: &Candidate,
    kind: &Glow,
    wanted_radiance: f32,
    bounds: &Aabb,
    axis: usize,
    notes: &mut Vec<String>,
) -> EmissionSettings {
    let name = &candidate.grid.name;
    let mut emission = EmissionSettings { grid: Some(name.clone()), ..EmissionSettings::default() };
    match kind {
        Glow::Emission => {
            emission.mode = EmissionMode::Grid;
            notes.push(format!("guessed: \"{name}\" is the emission itself"));
        }
        Glow::Kelvin | Glow::Unitless => {
            emission.mode = EmissionMode::Blackbody;
            emission.normalize = Some(Normalize::T4);
            let scale = kelvin_scale(kind, candidate.max);
            emission.kelvin_scale = Some(scale);
            notes.push(format!("guessed: \"{name}\" is a temperature, {scale} kelvin a unit"));
        }
        Glow::Flame => {
            emission.mode = EmissionMode::Ramp;
            emission.stops = Some(flame_stops(candidate.max));
            notes.push(format!("guessed: \"{name}\" is flame, through a ramp of colors"));
        }
    }
    let brightness = brightness_of(&emission);
    let sums = columns(&candidate.grid, bounds, axis, brightness);
    let scale = quantile(&sums, FAIRLY).map_or(1.0, |sum| two_digits(wanted_radiance / sum));
    match kind {
        Glow::Emission => emission.scale = Some(scale),
        _ => emission.intensity = Some(scale),
    }
    emission
}

fn kelvin_scale(kind: &Glow, max: f32) -> f32 {
    match kind {
        Glow::Kelvin => 1.0,
        _ if (1.2..=5.0).contains(&max) => BLENDER_KELVIN,
        _ => two_digits(HOTTEST_KELVIN / max),
    }
}

/// From nothing through red and orange to yellow at the grid's largest value.
fn flame_stops(max: f32) -> Vec<[f32; 4]> {
    [[0.0, 0.0, 0.0, 0.0], [0.35, 0.5, 0.05, 0.003], [0.7, 2.0, 0.6, 0.08], [1.0, 3.0, 1.6, 0.5]]
        .map(|[value, r, g, b]| [two_digits(value * max), r, g, b])
        .to_vec()
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
