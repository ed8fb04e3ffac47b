//! The volumes: the grids of their files, the guesses made of them, and their medium and emission.

use egui::accesskit::Role;
use egui::{CollapsingHeader, RichText, Ui, WidgetInfo};

use super::{Panel, emission, grids, placement, section, sequence};
use crate::app::document::Document;
use crate::app::document::up_axis;
use crate::app::ui::chooser;
use crate::app::ui::theme::color;
use crate::app::ui::widgets::{Number, capitalized, color_rows, key_help, row, segments, strength};
use crate::scene::settings::{Albedo, Axis, Color, VolumeSettings};
use crate::scene::{About, GridDescription, Note, Program, Settings};

/// The most volumes that are listed with all that can be said of them, unfolded or not.
const MOST_UNFOLDED: usize = 12;

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    section(ui, "Volume", |ui| {
        let volumes = panel.editor.document.settings.volume.iter().enumerate();
        let titles: Vec<String> = volumes.map(|(index, volume)| title(volume, index)).collect();
        notes(ui, panel);
        match &titles[..] {
            [] => drop(ui.weak("No volumes yet.")),
            [title] => {
                ui.label(RichText::new(title).color(color::TEXT_STRONG));
                one(ui, panel, 0);
            }
            many if many.len() > MOST_UNFOLDED => {
                let index = chooser::choose(ui, "volume", many);
                ui.label(RichText::new(&many[index]).color(color::TEXT_STRONG));
                // What is folded or typed in one is not that of the next.
                ui.push_id(("volume", index), |ui| one(ui, panel, index));
            }
            several => {
                for (index, title) in several.iter().enumerate() {
                    CollapsingHeader::new(title)
                        .id_salt(("volume", index))
                        .default_open(several.len() < 4)
                        .show(ui, |ui| one(ui, panel, index));
                }
            }
        }
    });
}

/// Shows the guesses, struck out where they stand no more, so that the rows below stay in place.
fn notes(ui: &mut Ui, panel: &Panel<'_>) {
    let volumes = |document: &Document| document.settings.volume.first().cloned();
    let present = volumes(&panel.editor.document).zip(volumes(panel.editor.opened()));
    let Some((volume, opened)) = present else { return };
    for note in panel.notes {
        let text = RichText::new(capitalized(&note.to_string())).small().color(color::TEXT_DIM);
        let is_so = stands(note, &volume, &opened);
        let text = if is_so { text } else { text.strikethrough() };
        let label = ui.add(egui::Label::new(text).wrap());
        if !is_so {
            let told = format!("Changed since: {note}");
            label.widget_info(|| WidgetInfo::labeled(Role::Label, true, &told));
            label.on_hover_text("Changed since.");
        }
    }
}

/// The title of a volume: its name, or its file, or its shape.
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

fn up_axis_row(
    ui: &mut Ui,
    settings: &mut Settings,
    index: usize,
    guess: Option<&Note>,
) -> Option<&'static str> {
    let axes = [Axis::Y, Axis::Z];
    let present = settings.volume.get(index).and_then(up_axis::of);
    let chosen = axes.iter().position(|axis| Some(*axis) == present);
    let help = "The axis that points up in the file: y in Houdini's files, z in Blender's.";
    let clicked = row(ui, "Up axis", help, |ui| {
        let clicked = segments(ui, &[("Y up", help), ("Z up", help)], chosen);
        if let Some(note) = guess {
            let text = RichText::new("guess").small().italics().color(color::WARNING);
            let help = format!("Guessed: {}. Click the other button to change it.", note.text);
            ui.label(text).on_hover_text(help);
        }
        clicked
    });
    let axis = clicked.inner.and_then(|clicked| axes.get(clicked))?;
    up_axis::set(settings, index, *axis);
    Some("up axis")
}

/// Buttons that set everything that a program's files have in common.
fn programs(
    ui: &mut Ui,
    settings: &mut Settings,
    index: usize,
    grids: &[GridDescription],
) -> Option<&'static str> {
    let helps = Program::ALL.map(|program| {
        let up = if program.up() == Axis::Y { "y" } else { "z" };
        format!(
            "Read density, fire and temperature as {} exports them, with {up} up.",
            program.name()
        )
    });
    let choices: Vec<(&str, &str)> =
        Program::ALL.iter().zip(&helps).map(|(program, help)| (program.name(), &**help)).collect();
    let help = "Sets the grids, the temperature scale and the up axis to the conventions of the \
                program that exported the file.";
    let clicked = ui.horizontal(|ui| {
        // A label of its own width: the names need the room.
        ui.label(RichText::new("Treat as").color(color::TEXT_DIM)).on_hover_text(help);
        let clicked = segments(ui, &choices, None);
        ui.label(RichText::new("export").color(color::TEXT_DIM)).on_hover_text(help);
        clicked
    });
    let program = clicked.inner.and_then(|clicked| Program::ALL.get(clicked))?;
    let volume = settings.volume.get_mut(index)?;
    program.dress(volume, grids);
    if volume.matrix.is_none() {
        up_axis::set(settings, index, program.up());
    }
    Some("export conventions")
}

/// Whether a guess still holds.
fn stands(note: &Note, volume: &VolumeSettings, opened: &VolumeSettings) -> bool {
    match note.about {
        About::UpAxis => volume.rotate == opened.rotate,
        About::Density => volume.density == opened.density,
        About::Emission => {
            let of = |volume: &VolumeSettings| {
                (volume.emission.mode, volume.emission.grid.clone(), volume.emission.kelvin_scale)
            };
            of(volume) == of(opened)
        }
        About::Placement => volume.translate == opened.translate,
        About::Velocity => volume.velocity == opened.velocity,
        About::Light | About::Sequence | About::Framing | About::LeftOut => true,
    }
}

fn one(ui: &mut Ui, panel: &mut Panel<'_>, index: usize) {
    let file = panel.editor.document.settings.volume[index].file.as_ref();
    let grids = file.and_then(|file| panel.grids.get(file)).map_or(&[][..], Vec::as_slice);
    let opened = panel.editor.opened().settings.volume.get(index).cloned().unwrap_or_default();
    let size = panel.bounds.size().max_element();
    let settings = &mut panel.editor.document.settings;
    let volume = &settings.volume[index];
    let (mode, shape) = (volume.emission.mode, volume.kind);
    let mut edit = None;
    if volume.file.is_some() && volume.matrix.is_none() {
        let guess = panel.notes.iter().find(|note| note.about == About::UpAxis);
        let guess = guess.filter(|note| stands(note, volume, &opened));
        edit = up_axis_row(ui, settings, index, guess);
    }
    if !grids.is_empty() {
        edit = edit.or(programs(ui, settings, index, grids));
    }
    let volume = &mut settings.volume[index];
    edit = edit.or(sequence::show(ui, volume));
    edit = edit.or(grids::show(ui, volume, &opened, grids, panel.notes));
    edit = edit.or(medium(ui, volume, &opened));
    edit = edit.or(emission::show(ui, volume, &opened, grids));
    edit = edit.or(placement::shape(ui, volume, &opened));
    let place = CollapsingHeader::new("Placement").id_salt(("placement", index));
    let moved = place.show(ui, |ui| placement::show(ui, volume, &opened, size)).body_returned;
    edit = edit.or(moved.flatten());
    let chose = (volume.emission.mode, volume.kind) != (mode, shape);
    if let Some(name) = edit {
        panel.editor.name_edit(name);
    }
    if chose {
        panel.editor.choose();
    }
}

fn medium(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    opened: &VolumeSettings,
) -> Option<&'static str> {
    let mut edit = None;
    let reset = strength(opened.density.scale);
    let around = if reset > 0.0 { reset } else { 1.0 };
    let number = Number {
        name: "Density",
        key: "volume.N.density.scale",
        soft: 0.0..=around * 20.0,
        logarithmic: true,
        unit: "",
        reset,
    };
    if color_rows(ui, number, "Extinction color", &mut volume.density.scale) {
        edit = Some("density");
    }
    edit = edit.or(albedo(ui, volume, opened));
    let row = Number {
        name: "Anisotropy (g)",
        key: "volume.N.phase.g",
        soft: -0.95..=0.95,
        logarithmic: false,
        unit: "",
        reset: opened.phase.g,
    };
    if row.show(ui, &mut volume.phase.g) {
        edit = Some("anisotropy");
    }
    edit.or(second_lobe(ui, volume, opened))
}

/// Shows the share of a second lobe, and where it has one its anisotropy; the name of the edit, if
/// one was made.
fn second_lobe(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    opened: &VolumeSettings,
) -> Option<&'static str> {
    let mut edit = None;
    let number =
        |name, key, soft, reset| Number { name, key, soft, logarithmic: false, unit: "", reset };
    let mix = number("Second lobe", "volume.N.phase.mix", 0.0..=1.0, opened.phase.mix);
    if mix.show(ui, &mut volume.phase.mix) {
        edit = Some("second lobe");
    }
    if volume.phase.mix > 0.0 {
        let g2 = number("Its anisotropy", "volume.N.phase.g2", -0.95..=0.95, opened.phase.g2);
        if g2.show(ui, &mut volume.phase.g2) {
            edit = Some("anisotropy of the second lobe");
        }
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
    let Some(mut value) = as_color(&volume.albedo) else {
        if let Albedo::Grid(key) = &volume.albedo {
            let help = key_help("volume.N.albedo");
            row(ui, "Albedo", &help, |ui| ui.weak(format!("from the grid {}", key.grid)));
        }
        return None;
    };
    let number = Number {
        name: "Albedo",
        key: "volume.N.albedo",
        soft: 0.0..=1.0,
        logarithmic: false,
        unit: "",
        reset: as_color(&opened.albedo).map_or(0.0, strength),
    };
    color_rows(ui, number, "Scattering color", &mut value).then(|| {
        volume.albedo = match value {
            Color::Gray(value) => Albedo::Gray(value),
            Color::Rgb(rgb) => Albedo::Rgb(rgb),
        };
        "albedo"
    })
}
