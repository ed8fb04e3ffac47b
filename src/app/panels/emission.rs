//! The emission of a volume.

use egui::Ui;

use super::explain;
use crate::app::ui::widgets::{Number, color_rows, key_help, list, row, segments, strength, tint};
use crate::scene::settings::{Color, EmissionMode, EmissionSettings, Normalize, VolumeSettings};
use crate::scene::{GridDescription, Role, VoxelDescription};

/// The highest temperature that the slider of the temperature scale reaches, in kelvin.
const HOTTEST: f32 = 6000.0;

/// Shows the rows; the name of the edit if anything changed.
pub fn show(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    opened: &VolumeSettings,
    grids: &[GridDescription],
) -> Option<&'static str> {
    let edit = emission_mode(ui, volume, grids);
    let grid = volume.emission_grid().map(str::to_owned);
    if let Some(grid) = grid.as_ref().filter(|_| !grids.is_empty()) {
        let help = key_help("volume.N.emission.grid");
        row(ui, "Emission grid", &help, |ui| ui.label(grid));
    }
    let described = grid.as_ref().and_then(|name| grids.iter().find(|grid| grid.is_called(name)));
    let voxels = described.and_then(|grid| grid.voxels);
    let (emission, opened) = (&mut volume.emission, &opened.emission);
    let change = match emission.mode {
        EmissionMode::None => None,
        EmissionMode::Grid => factor(ui, "Emission", "scale", &mut emission.scale, opened.scale()),
        EmissionMode::Constant => {
            color_row(ui, "Emission", "value", &mut emission.value, opened.value())
        }
        EmissionMode::Source => {
            color_row(ui, "Source radiance", "le", &mut emission.le, opened.le())
        }
        EmissionMode::Blackbody => blackbody(ui, emission, opened, voxels.as_ref()),
        EmissionMode::Ramp => ramp(ui, emission, opened, voxels.as_ref()),
    };
    let is_colored = voxels.is_some_and(|voxels| voxels.is_vector);
    let change = match emission.mode {
        EmissionMode::Grid | EmissionMode::Blackbody | EmissionMode::Ramp if !is_colored => {
            change.or(color(ui, emission))
        }
        _ => change,
    };
    edit.or(change).or(intensity_grid(ui, emission, grids))
}

const MODES: [(EmissionMode, &str, &str); 6] = [
    (EmissionMode::None, "none", "No emission."),
    (EmissionMode::Blackbody, "blackbody", "Blackbody emission from a temperature grid."),
    (EmissionMode::Ramp, "color ramp", "A grid mapped through a color ramp."),
    (EmissionMode::Grid, "grid", "Read from a grid, independent of density and albedo."),
    (EmissionMode::Constant, "constant", "The same everywhere in the volume."),
    (EmissionMode::Source, "source", "Proportional to the absorption."),
];

fn emission_mode(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    grids: &[GridDescription],
) -> Option<&'static str> {
    let help = key_help("volume.N.emission.mode");
    let mode = volume.emission.mode;
    row(ui, "Emission", &help, |ui| {
        let mut chosen = mode;
        list(ui, ("Emission mode", &help), &mut chosen, &MODES).then(|| {
            set_mode(volume, chosen, grids);
            "emission mode"
        })
    })
    .inner
}

/// Sets the mode; one that reads a grid gets the one that is named like it, else the present one.
fn set_mode(volume: &mut VolumeSettings, mode: EmissionMode, grids: &[GridDescription]) {
    let present = volume.emission.grid.clone();
    volume.emission.mode = mode;
    let Some(role) = Role::of_mode(mode) else { return };
    let same = |grid: &&GridDescription| {
        present.as_ref().is_some_and(|name| grid.is_called(name)) && role.suits(grid)
    };
    let grid = role.best_of(grids).or_else(|| grids.iter().find(same));
    if let Some(grid) = grid.or_else(|| grids.iter().find(|grid| role.suits(grid))) {
        role.give(volume, grid);
    }
}

/// A color that the emission is multiplied by; the name of the edit if it changed.
fn color(ui: &mut Ui, emission: &mut EmissionSettings) -> Option<&'static str> {
    let mut color = emission.color();
    let tinted = tint(ui, "Emission color", &key_help("volume.N.emission.color"), &mut color);
    tinted.then(|| {
        emission.color = Some(color);
        "emission color"
    })
}

/// The grid that multiplies the emission, if there is one; the name of the edit if it changed.
fn intensity_grid(
    ui: &mut Ui,
    emission: &mut EmissionSettings,
    grids: &[GridDescription],
) -> Option<&'static str> {
    let fits = |grid: &&GridDescription| {
        grid.voxels.is_some_and(|voxels| !voxels.is_vector) && !grid.is_level_set()
    };
    let fitting: Vec<&GridDescription> = grids.iter().filter(fits).collect();
    if emission.mode == EmissionMode::None || fitting.len() < 2 {
        return None;
    }
    let help = key_help("volume.N.emission.intensity_grid");
    let none = (None, "none", "The emission alone.");
    let named = fitting.iter().enumerate();
    let named = named.map(|(n, grid)| (Some(n), grid.name.as_str(), "Multiplies the emission."));
    let choices: Vec<(Option<usize>, &str, &str)> = std::iter::once(none).chain(named).collect();
    let name = emission.intensity_grid.clone();
    let present = name.and_then(|name| fitting.iter().position(|grid| grid.is_called(&name)));
    let mut chosen = present;
    row(ui, "Intensity grid", &help, |ui| {
        list(ui, ("Intensity grid", &help), &mut chosen, &choices)
    });
    (chosen != present).then(|| {
        emission.intensity_grid = chosen.map(|n| fitting[n].name.clone());
        if chosen.is_none() {
            emission.intensity_curve.clear();
        }
        "intensity grid"
    })
}

fn ramp(
    ui: &mut Ui,
    emission: &mut EmissionSettings,
    opened: &EmissionSettings,
    voxels: Option<&VoxelDescription>,
) -> Option<&'static str> {
    let mut stops = emission.stops().to_vec();
    let reset = opened.stops.clone().unwrap_or_else(|| stops.clone());
    let edit = super::ramp::show(ui, &mut stops, &reset, voxels);
    if edit.is_some() {
        emission.stops = Some(stops);
    }
    edit.or(intensity(ui, emission, opened)).or(times_density(ui, emission))
}

fn times_density(ui: &mut Ui, emission: &mut EmissionSettings) -> Option<&'static str> {
    let mut on = emission.times_density();
    let help = key_help("volume.N.emission.times_density");
    ui.checkbox(&mut on, "Multiply emission by density").on_hover_text(help).changed().then(|| {
        emission.times_density = Some(on);
        "emission times density"
    })
}

/// Says what the range of the grid is in kelvin.
fn kelvin_note(ui: &mut Ui, emission: &EmissionSettings, voxels: &VoxelDescription) {
    let kelvin = |value: f32| {
        let kelvin = (value - emission.kelvin_offset()) * emission.kelvin_scale();
        format!("{:.0}", kelvin.max(0.0))
    };
    let (low, high) = (kelvin(voxels.min), kelvin(voxels.max));
    explain(ui, &format!("The grid covers {low} to {high} K."));
}

fn blackbody(
    ui: &mut Ui,
    emission: &mut EmissionSettings,
    opened: &EmissionSettings,
    voxels: Option<&VoxelDescription>,
) -> Option<&'static str> {
    let mut edit = intensity(ui, emission, opened);
    let highest = voxels.map_or(0.0, |voxels| voxels.max);
    let most = if highest > 0.0 { HOTTEST / highest } else { opened.kelvin_scale() * 4.0 };
    let mut scale = emission.kelvin_scale();
    let row_scale = Number {
        name: "Temperature scale (K)",
        key: "volume.N.emission.kelvin_scale",
        soft: 0.0..=most.max(1.0),
        logarithmic: false,
        unit: " K",
        reset: opened.kelvin_scale.unwrap_or(scale),
    };
    if row_scale.show(ui, &mut scale) {
        emission.kelvin_scale = Some(scale);
        edit = Some("temperature scale");
    }
    let mut offset = emission.kelvin_offset();
    let reach = (2000.0 / emission.kelvin_scale().max(1e-3)).max(1e-3);
    let row_offset = Number {
        name: "Temperature offset",
        key: "volume.N.emission.kelvin_offset",
        soft: -reach..=reach,
        logarithmic: false,
        unit: "",
        reset: opened.kelvin_offset(),
    };
    if row_offset.show(ui, &mut offset) {
        emission.kelvin_offset = Some(offset);
        edit = Some("temperature offset");
    }
    if let Some(voxels) = voxels {
        kelvin_note(ui, emission, voxels);
    }
    edit = edit.or(brightness(ui, emission, opened));
    edit.or(times_density(ui, emission))
}

/// Rows for the dependence of brightness on temperature.
fn brightness(
    ui: &mut Ui,
    emission: &mut EmissionSettings,
    opened: &EmissionSettings,
) -> Option<&'static str> {
    let mut edit = None;
    let laws = [
        ("Constant", "Every temperature is equally bright; only its color changes."),
        (
            "Physical (T⁴)",
            "Brightness grows with the fourth power of the temperature, as a black body's does.",
        ),
    ];
    let all = [Normalize::Peak, Normalize::T4];
    let chosen = all.iter().position(|law| *law == emission.normalize());
    let clicked = row(ui, "Brightness", &key_help("volume.N.emission.normalize"), |ui| {
        segments(ui, &laws, chosen)
    });
    if let Some(law) = clicked.inner.and_then(|index| all.get(index)) {
        emission.normalize = Some(*law);
        edit = Some("brightness");
    }
    if emission.normalize() == Normalize::T4 {
        let mut reference = emission.reference_kelvin();
        let number = Number {
            name: "Reference temperature",
            key: "volume.N.emission.reference_kelvin",
            soft: 500.0..=4000.0,
            logarithmic: false,
            unit: " K",
            reset: opened.reference_kelvin(),
        };
        if number.show(ui, &mut reference) {
            emission.reference_kelvin = Some(reference);
            edit = Some("reference temperature");
        }
    }
    edit
}

fn intensity(
    ui: &mut Ui,
    emission: &mut EmissionSettings,
    opened: &EmissionSettings,
) -> Option<&'static str> {
    factor(ui, "Intensity", "intensity", &mut emission.intensity, opened.intensity())
}

/// A factor of the emission over two decades around what it was when opened.
fn factor(
    ui: &mut Ui,
    name: &'static str,
    key: &str,
    value: &mut Option<f32>,
    reset: f32,
) -> Option<&'static str> {
    let mut present = value.unwrap_or(1.0);
    let around = if reset > 0.0 { reset } else { 1.0 };
    let number = Number {
        name,
        key: &format!("volume.N.emission.{key}"),
        soft: 0.0..=around * 20.0,
        logarithmic: true,
        unit: "",
        reset,
    };
    number.show(ui, &mut present).then(|| {
        *value = Some(present);
        name
    })
}

fn color_row(
    ui: &mut Ui,
    name: &'static str,
    key: &str,
    value: &mut Option<Color>,
    reset: Color,
) -> Option<&'static str> {
    let mut present = value.unwrap_or(Color::Gray(1.0));
    let around = if reset.is_black() { 1.0 } else { strength(reset) };
    let number = Number {
        name,
        key: &format!("volume.N.emission.{key}"),
        soft: 0.0..=around * 20.0,
        logarithmic: true,
        unit: "",
        reset: strength(reset),
    };
    color_rows(ui, number, "Emission color", &mut present).then(|| {
        *value = Some(present);
        name
    })
}
