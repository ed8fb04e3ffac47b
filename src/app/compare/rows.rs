//! Rows under the picture: the region and the reference, with their figures.

use std::sync::Arc;

use egui::{DragValue, RichText, Ui};
use glam::UVec2;

use super::figures::{Column, names, of_errors, of_region};
use super::panel;
use super::state::CompareState;
use crate::app::command::Command;
use crate::app::compare::reference::MeasuredReference;
use crate::app::compare::region_figures::RegionFigures;
use crate::app::document::Document;
use crate::app::picture::region::PictureRegion;
use crate::app::ui::theme::{self, color, space};
use crate::app::ui::widgets::key_of;
use crate::image::metrics::Errors;
use crate::render::{Area, Picture};
use crate::scene::Settings;

/// Width of a field for pixels.
const FIELD: f32 = 48.0;

/// The request of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Asked {
    /// A command.
    Command(Command),
    /// The film to take the size of the reference.
    Size(UVec2),
}

/// Shows the view of A and B, the region and the reference with their figures; nothing where there
/// is none of them. `pictures` are those that the figures are of, `live` the live one.
pub fn show(
    ui: &mut Ui,
    compare: &mut CompareState,
    document: &Document,
    pictures: &[Arc<Picture>],
    live: Option<&Arc<Picture>>,
) -> Option<Asked> {
    let has_region = compare.region.is_armed() || compare.region.is_set();
    let has_reference = compare.reference.loaded().is_some() || compare.reference.is_loading();
    if !(compare.second_side.is_on() || has_region || has_reference) {
        return None;
    }
    let panel = egui::Panel::bottom("compare").frame(theme::panel_frame());
    let asked = panel.show(ui, |ui| {
        let view = view_row(ui, compare, document, live);
        let Some(picture) = pictures.first() else { return view };
        if has_region {
            let biased = compare.biased(document);
            let CompareState { second_side, reference, region, .. } = compare;
            let told = (second_side.region_figures(), reference.errors(), biased);
            ui.horizontal_wrapped(|ui| self::region(ui, region, picture.size, told));
        }
        if !has_reference {
            return view;
        }
        let looked_at = (picture.size, &document.settings);
        let row = |ui: &mut Ui| reference(ui, &compare.reference, looked_at);
        ui.horizontal_wrapped(row).inner.or(view)
    });
    asked.inner
}

/// Shows how the pictures are looked at where there is a choice, and the verdict on A and B.
fn view_row(
    ui: &mut Ui,
    compare: &mut CompareState,
    document: &Document,
    live: Option<&Arc<Picture>>,
) -> Option<Asked> {
    let kinds = compare.layouts();
    if kinds.len() < 2 {
        return None;
    }
    let of_two = compare.second_side.is_on();
    let row = |ui: &mut Ui| {
        panel::layouts(ui, &mut compare.second_side.layout, (&kinds, of_two));
        if !of_two {
            return None;
        }
        ui.separator();
        match compare.other_size(live) {
            Some(size) => other_size(ui, size),
            None => {
                let biased = compare.biased(document);
                panel::verdict(ui, compare.second_side.comparison(), biased);
                None
            }
        }
    };
    ui.horizontal_wrapped(row).inner
}

/// Shows the region on pictures of `size` and its figures; `biased` says which sides are.
fn region(
    ui: &mut Ui,
    region: &mut PictureRegion,
    size: UVec2,
    (figures, errors, biased): (Option<&RegionFigures>, Option<&[Errors]>, [bool; 2]),
) {
    let Some(area) = region.area(size) else {
        ui.label(RichText::new("Drag a region over the picture.").color(color::ACCENT));
        let help = "Place it in the middle; numbers then move and size it.";
        if ui.button("Place it").on_hover_text(help).clicked() {
            region.set(Area { first: size / 3, size: size / 3 }, size);
        }
        if ui.button("Cancel").on_hover_text("Measure no region.  [Esc]").clicked() {
            region.remove();
        }
        return;
    };
    ui.label(RichText::new("Region").color(color::TEXT_STRONG));
    if let Some(area) = fields(ui, area, size) {
        region.set(area, size);
    }
    if ui.button("Remove").on_hover_text("Remove the region.  [Esc]").clicked() {
        region.remove();
    }
    let alone = Command::RenderRegionOnly;
    let help = format!("{}  [{}]", alone.tooltip(), key_of(ui, alone));
    ui.toggle_value(&mut region.is_alone, "Render region only").on_hover_text(help);
    let Some(figures) = figures else { return };
    match &figures.comparison {
        Some(comparison) => panel::verdict(ui, Some(comparison), biased),
        None => told(ui, &of_region(figures, errors)),
    }
}

/// Fields for the position and size of the region; the edited region, where one was changed.
fn fields(ui: &mut Ui, area: Area, size: UVec2) -> Option<Area> {
    let mut numbers = [area.first.x, area.first.y, area.size.x, area.size.y];
    let room = size.saturating_sub(area.first);
    let most = [size.x.saturating_sub(1), size.y.saturating_sub(1), room.x, room.y];
    let least = [0, 0, 1, 1];
    let words = [
        ("Region x", "The first column of the region."),
        ("Region y", "The first row of the region, 0 at the top."),
        ("Region width", "The width of the region in pixels."),
        ("Region height", "The height of the region in pixels."),
    ];
    let mut changed = false;
    for (index, (name, help)) in words.into_iter().enumerate() {
        if index == 2 {
            ui.label(RichText::new("size").color(color::TEXT_DIM));
        }
        let field = DragValue::new(&mut numbers[index]).range(least[index]..=most[index].max(1));
        let field = ui.add_sized([FIELD, space::ROW_HEIGHT], field).accessible_name(name);
        changed |= field.on_hover_text(help).changed();
    }
    ui.label(RichText::new("pixels").color(color::TEXT_DIM));
    let [x, y, width, height] = numbers;
    let area = Area { first: UVec2::new(x, y), size: UVec2::new(width, height) };
    changed.then_some(area)
}

/// Figures of one picture or two in a line.
fn told(ui: &mut Ui, columns: &[Column]) {
    let count = columns.first().map_or(0, Column::count);
    for (index, name) in names(count).iter().enumerate() {
        if !name.is_empty() {
            ui.label(RichText::new(*name).color(color::TEXT_DIM));
        }
        for column in columns {
            ui.label(RichText::new(column.in_words(index)).color(color::TEXT_STRONG))
                .on_hover_text(column.help());
        }
    }
}

/// Says that a snapshot of `size` and the live picture have different sizes.
fn other_size(ui: &mut Ui, size: UVec2) -> Option<Asked> {
    let text =
        format!("The snapshot has {} × {} pixels, the live picture another size.", size.x, size.y);
    ui.label(RichText::new(text).color(color::WARNING));
    take_size(ui, size)
}

fn take_size(ui: &mut Ui, size: UVec2) -> Option<Asked> {
    let help = "Set the render size to that size.";
    let clicked = ui.button("Use its size").on_hover_text(help).clicked();
    clicked.then_some(Asked::Size(size))
}

/// Shows the reference for pictures of `size`, rendered with `settings`, and how far off they are.
fn reference(
    ui: &mut Ui,
    reference: &MeasuredReference,
    (size, settings): (UVec2, &Settings),
) -> Option<Asked> {
    let mut asked = None;
    ui.label(RichText::new("Reference").color(color::TEXT_STRONG));
    let Some(loaded) = reference.loaded() else {
        ui.label(RichText::new("Loading…").color(color::ACCENT));
        return None;
    };
    let of = loaded.reference.size();
    ui.add(egui::Label::new(RichText::new(&loaded.name).color(color::TEXT)).truncate());
    let remove = Command::RemoveReference;
    let help = format!("{}  [{}]", remove.tooltip(), key_of(ui, remove));
    if ui.button("Remove").on_hover_text(help).clicked() {
        asked = Some(Asked::Command(remove));
    }
    if reference.is_of_another_size(size) {
        let text =
            format!("It has {} × {} pixels, the picture {} × {}.", of.x, of.y, size.x, size.y);
        ui.label(RichText::new(text).color(color::WARNING));
        return take_size(ui, of).or(asked);
    }
    if let Some(warning) = loaded.warning(settings) {
        let text = format!("Errors mean little: {warning}.");
        ui.label(RichText::new(text).color(color::WARNING))
            .on_hover_text("The reference does not show what this picture shows.");
    }
    match reference.errors() {
        Some(errors) => told(ui, &of_errors(errors, None)),
        None => {
            ui.label(RichText::new("Measuring…").color(color::TEXT_DIM));
        }
    }
    asked
}
