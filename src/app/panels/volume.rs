//! The volumes: their grids with ranges, and how they look.

use egui::{CollapsingHeader, ComboBox, Grid, RichText, Ui};

use super::{Panel, explain, section};
use crate::app::theme::color;
use crate::app::up_axis;
use crate::app::widgets::{Number, count, key_help, row, segments, significant};
use crate::scene::settings::{
    Albedo, Axis, Color, EmissionMode, EmissionSettings, Normalize, VolumeSettings,
};
use crate::scene::{GridDescription, Settings, VoxelDescription};

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    section(ui, "Volume", |ui| {
        let volumes = panel.editor.document.settings.volume.len();
        if volumes == 0 {
            ui.weak("There is no volume in this scene.");
        }
        for note in panel.notes {
            explain(ui, note);
        }
        for index in 0..volumes {
            let title = title(&panel.editor.document.settings.volume[index], index);
            if volumes == 1 {
                ui.label(RichText::new(title).color(color::TEXT_STRONG));
                one(ui, panel, index);
            } else {
                CollapsingHeader::new(title)
                    .id_salt(("volume", index))
                    .default_open(volumes < 4)
                    .show(ui, |ui| one(ui, panel, index));
            }
        }
    });
}

/// What a volume is called: its name, or its file, or its shape.
fn title(volume: &VolumeSettings, index: usize) -> String {
    if !volume.name.is_empty() {
        return volume.name.clone();
    }
    match &volume.file {
        Some(file) => {
            let path = std::path::Path::new(file);
            path.file_name().map_or_else(|| file.clone(), |name| name.to_string_lossy().into())
        }
        None => format!("Volume {}", index + 1),
    }
}

fn up_axis_row(ui: &mut Ui, settings: &mut Settings, index: usize) -> Option<&'static str> {
    let axes = [Axis::Y, Axis::Z];
    let present = settings.volume.get(index).and_then(up_axis::of);
    let chosen = axes.iter().position(|axis| Some(*axis) == present);
    let help = "Which way is up in the file: Houdini's files have y up, Blender's z.";
    let clicked =
        row(ui, "Up axis", help, |ui| segments(ui, &[("Y up", help), ("Z up", help)], chosen));
    let axis = clicked.inner.and_then(|clicked| axes.get(clicked))?;
    up_axis::set(settings, index, *axis);
    Some("up axis")
}

fn one(ui: &mut Ui, panel: &mut Panel<'_>, index: usize) {
    let file = panel.editor.document.settings.volume[index].file.as_ref();
    let grids = file.and_then(|file| panel.grids.get(file)).map_or(&[][..], Vec::as_slice);
    let opened = panel.editor.opened().settings.volume.get(index).cloned().unwrap_or_default();
    let settings = &mut panel.editor.document.settings;
    let volume = &settings.volume[index];
    let mut edit = None;
    if volume.file.is_some() && volume.matrix.is_none() {
        edit = up_axis_row(ui, settings, index);
    }
    let volume = &mut settings.volume[index];
    if !grids.is_empty() {
        grid_table(ui, index, grids);
        let present = volume.density_grid().to_owned();
        let choice = (&mut volume.density.grid, present);
        let key = "volume.N.density.grid";
        edit = edit.or(grid_choice(ui, "Density from", key, index, grids, choice));
    }
    edit = edit.or(medium(ui, volume, &opened));
    edit = edit.or(emission(ui, volume, &opened, index, grids));
    if let Some(name) = edit {
        panel.editor.name_edit(name);
    }
}

fn grid_table(ui: &mut Ui, index: usize, grids: &[GridDescription]) {
    Grid::new(("grids", index)).num_columns(3).striped(true).spacing([14.0, 2.0]).show(ui, |ui| {
        for grid in grids {
            ui.label(RichText::new(&grid.name).color(color::TEXT));
            match &grid.voxels {
                Some(voxels) => voxel_cells(ui, voxels),
                None => {
                    let reason = grid.unsupported.as_deref().unwrap_or_default();
                    ui.label(RichText::new("not rendered").small().color(color::WARNING))
                        .on_hover_text(reason);
                    ui.label("");
                }
            }
            ui.end_row();
        }
    });
}

fn voxel_cells(ui: &mut Ui, voxels: &VoxelDescription) {
    let [low, high] = [voxels.min, voxels.max].map(|value| significant(f64::from(value)));
    ui.label(RichText::new(format!("{low} … {high}")).color(color::TEXT))
        .on_hover_text("The lowest and the highest value in the grid.");
    let voxels = format!("{} voxels", count(voxels.active as f64));
    ui.label(RichText::new(voxels).small().color(color::TEXT_DIM))
        .on_hover_text("How many voxels hold a value.");
}

/// A choice among the file's grids; the name of the edit if it changed.
fn grid_choice(
    ui: &mut Ui,
    name: &'static str,
    key: &str,
    index: usize,
    grids: &[GridDescription],
    (chosen, present): (&mut Option<String>, String),
) -> Option<&'static str> {
    let help = key_help(key);
    row(ui, name, &help, |ui| {
        let mut changed = false;
        let combo = ComboBox::from_id_salt((name, index)).selected_text(&present).width(120.0);
        let response = combo.show_ui(ui, |ui| {
            for grid in grids {
                if ui.selectable_label(grid.name == present, &grid.name).clicked() {
                    *chosen = Some(grid.name.clone());
                    changed = true;
                }
            }
        });
        response.response.accessible_name(name).on_hover_text(&help);
        changed.then_some(name)
    })
    .inner
}

fn medium(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    opened: &VolumeSettings,
) -> Option<&'static str> {
    let mut edit = None;
    let mut density = strength(volume.density.scale);
    let reset = strength(opened.density.scale);
    let around = if reset > 0.0 { reset } else { 1.0 };
    let row = Number {
        name: "Density",
        key: "volume.N.density.scale",
        soft: 0.0..=around * 20.0,
        hard: 0.0..=f32::MAX,
        logarithmic: true,
        unit: "",
        reset,
    };
    if row.show(ui, &mut density) {
        volume.density.scale = scaled(volume.density.scale, density);
        edit = Some("density");
    }
    edit = edit.or(albedo(ui, volume, opened));
    let row = Number {
        name: "Phase g",
        key: "volume.N.phase.g",
        soft: -0.95..=0.95,
        hard: -0.999..=0.999,
        logarithmic: false,
        unit: "",
        reset: opened.phase.g,
    };
    if row.show(ui, &mut volume.phase.g) {
        edit = Some("phase");
    }
    edit
}

fn albedo(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    opened: &VolumeSettings,
) -> Option<&'static str> {
    let as_color = |albedo: &Albedo| match albedo {
        Albedo::Gray(value) => Some(Color::Gray(*value)),
        Albedo::Rgb(rgb) => Some(Color::Rgb(*rgb)),
        Albedo::Grid(_) => None,
    };
    let help = key_help("volume.N.albedo");
    let Some(present) = as_color(&volume.albedo) else {
        if let Albedo::Grid(key) = &volume.albedo {
            row(ui, "Albedo", &help, |ui| ui.weak(format!("from the grid {}", key.grid)));
        }
        return None;
    };
    let mut value = strength(present);
    let number = Number {
        name: "Albedo",
        key: "volume.N.albedo",
        soft: 0.0..=1.0,
        hard: 0.0..=1.0,
        logarithmic: false,
        unit: "",
        reset: as_color(&opened.albedo).map_or(0.0, strength),
    };
    let mut edited = None;
    if number.show(ui, &mut value) {
        edited = Some(scaled(present, value));
    }
    let mut rgb = present.rgb().to_array();
    let tint = row(ui, "Albedo tint", &help, |ui| {
        ui.color_edit_button_rgb(&mut rgb).accessible_name("Albedo tint")
    });
    if tint.inner.changed() {
        edited = Some(from_rgb(rgb));
    }
    volume.albedo = match edited? {
        Color::Gray(value) => Albedo::Gray(value),
        Color::Rgb(rgb) => Albedo::Rgb(rgb),
    };
    Some("albedo")
}

fn emission(
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
        EmissionMode::Grid => {
            factor(ui, "Emission", "scale", &mut emission.scale, emission_or(opened.scale, 1.0))
        }
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
        hard: 0.0..=f32::MAX,
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
        hard: -f32::MAX..=f32::MAX,
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
        hard: 0.0..=f32::MAX,
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
    crate::app::widgets::vector(ui, name, &key, &mut rgb, 0.01).then(|| {
        *value = Some(from_rgb(rgb.map(|channel| channel.max(0.0))));
        name
    })
}

fn emission_or(value: Option<f32>, default: f32) -> f32 {
    value.unwrap_or(default)
}

/// The one number that a slider shows for a color: its largest channel.
fn strength(color: Color) -> f32 {
    color.rgb().max_element()
}

/// `color` made as strong as `strength`, keeping its hue.
fn scaled(color: Color, strength: f32) -> Color {
    let present = color.rgb().max_element();
    match color {
        Color::Rgb(rgb) if present > 0.0 => Color::Rgb(rgb.map(|c| c * strength / present)),
        _ => Color::Gray(strength),
    }
}

/// Gray where the channels agree.
fn from_rgb(rgb: [f32; 3]) -> Color {
    let color = Color::Rgb(rgb);
    color.gray().map_or(color, Color::Gray)
}
