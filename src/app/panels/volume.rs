//! The volumes: their grids with ranges, and how they look.

use egui::{CollapsingHeader, ComboBox, Grid, RichText, Ui};

use super::{Panel, emission, explain, section};
use crate::app::theme::color;
use crate::app::up_axis;
use crate::app::widgets::{
    Number, count, from_rgb, key_help, row, scaled, segments, significant, strength,
};
use crate::scene::settings::{Albedo, Axis, Color, VolumeSettings};
use crate::scene::{GridDescription, Settings, VoxelDescription};

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    section(ui, "Volume", |ui| {
        let volumes = panel.editor.document.settings.volume.len();
        if volumes == 0 {
            ui.weak("There is no volume in this scene.");
        }
        for note in panel.notes {
            explain(ui, &note.to_string());
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
    edit = edit.or(emission::show(ui, volume, &opened, index, grids));
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
pub fn grid_choice(
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
