//! How a volume glows.

use egui::{ComboBox, Ui};

use super::volume::grid_choice;
use crate::app::widgets::{Number, from_rgb, key_help, row, segments, vector};
use crate::scene::GridDescription;
use crate::scene::settings::{Color, EmissionMode, EmissionSettings, Normalize, VolumeSettings};

/// Shows the rows; the name of the edit if anything changed.
pub fn show(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    opened: &VolumeSettings,
    index: usize,
    grids: &[GridDescription],
) -> Option<&'static str> {
    let mut edit = emission_mode(ui, volume, index);
    if let (Some(present), false) = (volume.emission_grid().map(str::to_owned), grids.is_empty()) {
        let choice = (&mut volume.emission.grid, present);
        edit = edit.or(grid_choice(
            ui,
            "Emission from",
            "volume.N.emission.grid",
            index,
            grids,
            choice,
        ));
    }
    let (emission, opened) = (&mut volume.emission, &opened.emission);
    let change = match emission.mode {
        EmissionMode::None => None,
        EmissionMode::Grid => factor(ui, "Emission", "scale", &mut emission.scale, opened.scale()),
        EmissionMode::Constant => color_row(ui, "Emission", "value", &mut emission.value),
        EmissionMode::Source => color_row(ui, "Source", "le", &mut emission.le),
        EmissionMode::Blackbody => blackbody(ui, emission, opened),
        EmissionMode::Ramp => intensity(ui, emission, opened),
    };
    edit.or(change)
}

const MODES: [(EmissionMode, &str, &str); 6] = [
    (EmissionMode::None, "none", "It does not glow."),
    (EmissionMode::Blackbody, "blackbody", "From a temperature, as a black body."),
    (EmissionMode::Ramp, "color ramp", "From a grid through a color ramp."),
    (EmissionMode::Grid, "grid", "Read from a grid, untouched by density and albedo."),
    (EmissionMode::Constant, "constant", "The same all over the volume."),
    (EmissionMode::Source, "source", "In proportion to the absorption."),
];

fn emission_mode(ui: &mut Ui, volume: &mut VolumeSettings, index: usize) -> Option<&'static str> {
    let help = key_help("volume.N.emission.mode");
    let mode = volume.emission.mode;
    let present = MODES.iter().find(|(other, ..)| *other == mode).map_or("", |(_, name, _)| name);
    row(ui, "Emission", &help, |ui| {
        let mut changed = None;
        let combo = ComboBox::from_id_salt(("emission mode", index)).width(120.0);
        let response = combo.selected_text(present).show_ui(ui, |ui| {
            for (other, name, help) in MODES {
                if ui.selectable_label(other == mode, name).on_hover_text(help).clicked() {
                    volume.emission.mode = other;
                    changed = Some("emission mode");
                }
            }
        });
        response.response.accessible_name("Emission mode").on_hover_text(&help);
        changed
    })
    .inner
}

fn blackbody(
    ui: &mut Ui,
    emission: &mut EmissionSettings,
    opened: &EmissionSettings,
) -> Option<&'static str> {
    let mut edit = intensity(ui, emission, opened);
    let mut scale = emission.kelvin_scale();
    let row_scale = Number {
        name: "Kelvin scale",
        key: "volume.N.emission.kelvin_scale",
        soft: 0.0..=(opened.kelvin_scale() * 4.0).max(1.0),
        logarithmic: false,
        unit: " K",
        reset: opened.kelvin_scale(),
    };
    if row_scale.show(ui, &mut scale) {
        emission.kelvin_scale = Some(scale);
        edit = Some("kelvin scale");
    }
    let mut offset = emission.kelvin_offset();
    let reach = (2000.0 / emission.kelvin_scale().max(1e-3)).max(1e-3);
    let row_offset = Number {
        name: "Kelvin offset",
        key: "volume.N.emission.kelvin_offset",
        soft: -reach..=reach,
        logarithmic: false,
        unit: "",
        reset: opened.kelvin_offset(),
    };
    if row_offset.show(ui, &mut offset) {
        emission.kelvin_offset = Some(offset);
        edit = Some("kelvin offset");
    }
    let laws = [
        ("Peak", "Every temperature equally bright; only its color changes."),
        ("T⁴", "Brightness grows with the fourth power of the temperature, as in nature."),
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
) -> Option<&'static str> {
    let mut rgb = value.unwrap_or(Color::Gray(1.0)).rgb().to_array();
    let key = format!("volume.N.emission.{key}");
    vector(ui, name, &key, &mut rgb, 0.01).then(|| {
        *value = Some(from_rgb(rgb.map(|channel| channel.max(0.0))));
        name
    })
}
