//! The grids of a volume's file: their type, size, range and values, and what each is for.

use egui::{Button, Color32, Grid, Painter, Rect, RichText, Sense, Ui, vec2};

use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::{count, significant};
use crate::scene::settings::{EmissionMode, VolumeSettings};
use crate::scene::{About, GridDescription, Note, Role, VoxelDescription};

/// Shows them; the name of the edit if one was handed another role. `opened` is the volume as it
/// was opened, `notes` what was guessed then.
pub fn show(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    opened: &VolumeSettings,
    grids: &[GridDescription],
    notes: &[Note],
) -> Option<&'static str> {
    let mut edit = None;
    for grid in grids {
        ui.scope(|ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            heading(ui, grid);
            if grid.voxels.is_none() {
                return;
            }
            let guessed = |role: Role, volume: &VolumeSettings| {
                let about = if role == Role::Density { About::Density } else { About::Emission };
                let note = notes.iter().find(|note| note.about == about)?;
                let same = role.is_of(volume, &grid.name) && role.is_of(opened, &grid.name);
                same.then_some(note)
            };
            let clicked = roles(ui, volume, grid, guessed);
            if let Some(role) = clicked {
                take_or_give(role, volume, grid);
                edit = Some("use of a grid");
            }
        });
        ui.add_space(space::TIGHT);
    }
    edit
}

/// Gives the grid a role; a click on the role of emission that it already has ends the emission.
fn take_or_give(role: Role, volume: &mut VolumeSettings, grid: &GridDescription) {
    if !role.is_of(volume, &grid.name) {
        role.give(volume, grid);
    } else if role != Role::Density {
        volume.emission = Default::default();
        volume.emission.mode = EmissionMode::None;
    }
}

/// Name, kind, values and size.
fn heading(ui: &mut Ui, grid: &GridDescription) {
    ui.horizontal(|ui| {
        let size = vec2(ui.available_width(), space::HISTOGRAM[1]);
        let (row, _) = ui.allocate_exact_size(size, Sense::empty());
        let right = row.with_min_x(row.right() - space::HISTOGRAM[0]);
        let left = row.with_max_x(right.left() - space::ROW);
        let mut names = ui.new_child(
            egui::UiBuilder::new()
                .max_rect(left)
                .layout(egui::Layout::left_to_right(egui::Align::Center)),
        );
        names.label(RichText::new(&grid.name).color(color::TEXT_STRONG));
        let kind = RichText::new(format!("{}, {}", grid.type_name, grid.class));
        names.add(egui::Label::new(kind.small().color(color::TEXT_DIM)).truncate());
        if let Some(voxels) = &grid.voxels {
            histogram(ui, right, grid, voxels);
        }
    });
    match &grid.voxels {
        Some(voxels) => figures(ui, voxels),
        None => {
            let reason = grid.unsupported.as_deref().unwrap_or_default();
            let text = RichText::new("not rendered").small().color(color::WARNING);
            ui.label(text).on_hover_text(reason);
        }
    }
}

fn figures(ui: &mut Ui, voxels: &VoxelDescription) {
    let small = |text: String| RichText::new(text).small().color(color::TEXT_DIM);
    let [low, high] = [voxels.min, voxels.max].map(|value| significant(f64::from(value)));
    Grid::new(ui.next_auto_id()).num_columns(3).spacing([14.0, 0.0]).show(ui, |ui| {
        ui.label(RichText::new(format!("{low} … {high}")).small().color(color::TEXT))
            .on_hover_text("The smallest and the largest value of the grid.");
        ui.label(small(format!("{} voxels", count(voxels.active as f64))))
            .on_hover_text("The number of active voxels.");
        ui.label(small(format!("{}B", count(voxels.memory_bytes as f64))))
            .on_hover_text("Their memory use.");
    });
}

fn histogram(ui: &Ui, rect: Rect, grid: &GridDescription, voxels: &VoxelDescription) {
    let response = ui.interact(rect, ui.scope_id().with(("histogram", &grid.name)), Sense::hover());
    let name = format!("Histogram of {}", grid.name);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &name));
    ui.painter().rect_filled(rect, 2.0, color::WELL);
    histogram_bars(ui.painter(), rect.shrink(1.0), voxels, color::CURVE);
    let [low, high] = [voxels.min, voxels.max].map(|value| significant(f64::from(value)));
    response.on_hover_text(format!(
        "Histogram of the values, from {low} on the left to {high} on the right. Heights are the \
         square root of the voxel counts."
    ));
}

/// Draws how often each value occurs, the heights by the root of that.
pub fn histogram_bars(painter: &Painter, rect: Rect, voxels: &VoxelDescription, fill: Color32) {
    let most = voxels.histogram.iter().max().copied().unwrap_or(0);
    let height = |count: u64| (count as f32 / most.max(1) as f32).sqrt();
    let width = rect.width() / voxels.histogram.len() as f32;
    for (index, &count) in voxels.histogram.iter().enumerate().filter(|(_, count)| **count > 0) {
        let left = rect.left() + width * index as f32;
        let top = rect.bottom() - height(count) * rect.height();
        let right = left + (width - 0.5).max(0.5);
        painter.rect_filled(Rect::from_x_y_ranges(left..=right, top..=rect.bottom()), 0.0, fill);
    }
}

/// Shows the roles a grid may have, its own, and whether that is a guess; the one that was clicked.
fn roles<'n>(
    ui: &mut Ui,
    volume: &VolumeSettings,
    grid: &GridDescription,
    guessed: impl Fn(Role, &VolumeSettings) -> Option<&'n Note>,
) -> Option<Role> {
    let mut clicked = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().button_padding = vec2(5.0, 0.0);
        ui.spacing_mut().interact_size.y = space::ROW_HEIGHT - 3.0;
        for role in Role::ALL.into_iter().filter(|role| role.suits(grid)) {
            let (text, mut help) = words(role);
            if grid.is_level_set() {
                help = "Use the inside of this level set as the smoke density: fog that rises from \
                        0 at the surface to 1 inside.";
            }
            let text = RichText::new(text).small();
            let button = Button::selectable(role.is_of(volume, &grid.name), text);
            let response = ui.add(button.frame_when_inactive(true)).on_hover_text(help);
            let name = format!("{} as {}", grid.name, words(role).0.to_lowercase());
            if response.accessible_name(name).clicked() {
                clicked = Some(role);
            }
        }
        let note = Role::ALL.into_iter().find_map(|role| guessed(role, volume));
        if let Some(note) = note {
            ui.add_space(space::TIGHT);
            let help = format!("Guessed: {}. Click another button to change it.", note.text);
            let text = RichText::new("guess").small().italics().color(color::WARNING);
            ui.label(text).on_hover_text(help);
        }
        let intensity = volume.emission.intensity_grid.as_deref();
        if intensity.is_some_and(|name| grid.is_called(name)) {
            ui.add_space(space::TIGHT);
            let help = "This grid multiplies the emission.";
            ui.label(RichText::new("intensity").small().color(color::TEXT_DIM)).on_hover_text(help);
        } else if !Role::ALL.into_iter().any(|role| role.is_of(volume, &grid.name)) {
            ui.add_space(space::TIGHT);
            let help = "This grid is not used. Click a button to use it.";
            ui.label(RichText::new("not used").small().color(color::TEXT_DIM)).on_hover_text(help);
        }
    });
    clicked
}

fn words(role: Role) -> (&'static str, &'static str) {
    match role {
        Role::Density => ("Density", "Use this grid as the smoke density."),
        Role::Temperature => {
            ("Temperature", "Use this grid as the temperature of blackbody emission.")
        }
        Role::Flame => {
            ("Flame", "Use this grid as the flame, mapped to emission through a color ramp.")
        }
        Role::Emission => ("Emission", "Use this grid as the emission."),
    }
}
