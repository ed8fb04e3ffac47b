//! The strip of snapshots under the picture: small pictures to flip through, with the live one at
//! the end; name and note of the one shown.

use std::sync::Arc;

use egui::accesskit::Role;
use egui::{
    Align, Button, Color32, Layout, Rect, Response, RichText, ScrollArea, Sense, Stroke,
    StrokeKind, TextEdit, TextureOptions, Ui, Vec2, WidgetInfo, vec2,
};

use crate::app::command::Command;
use crate::app::snapshots::{
    LARGEST_THUMBNAIL, SmallPicture, Snapshots, StripItem, now, size_in_words,
};
use crate::app::ui::theme::{color, size, space};
use crate::app::ui::words::{percent, samples};
use crate::render::Picture;

/// Room for a small picture, in points.
const PICTURE: Vec2 = vec2(0.5 * LARGEST_THUMBNAIL.x as f32, 0.5 * LARGEST_THUMBNAIL.y as f32);
/// Height of a line of text under a picture.
const LINE: f32 = 15.0;
/// Least and largest width of the field for a name, and of that for a note.
const NAME_WIDTHS: [f32; 2] = [70.0, 150.0];
const NOTE_WIDTHS: [f32; 2] = [40.0, 400.0];
/// Room that the buttons behind name and note take.
const BUTTONS_WIDTH: f32 = 440.0;
/// Room that the button takes which hides the strip.
const HIDE_WIDTH: f32 = 60.0;
/// Room that the button takes which undoes a deletion.
const UNDO_WIDTH: f32 = 100.0;

/// Shows the strip; returns what its buttons ask for. `live` is the live picture.
pub fn show(ui: &mut Ui, snapshots: &mut Snapshots, live: Option<&Arc<Picture>>) -> Vec<Command> {
    let mut commands = Vec::new();
    head(ui, snapshots, &mut commands);
    ui.add_space(space::TIGHT);
    let height = PICTURE.y + 2.0 * LINE + space::TIGHT;
    ScrollArea::horizontal().auto_shrink([false, true]).stick_to_right(true).show(ui, |ui| {
        ui.set_min_height(height);
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 10.0;
            // Room for the outline.
            ui.add_space(2.0);
            let mut chosen = None;
            let shown = snapshots.strip.shown();
            let moved = snapshots.strip.take_moved();
            for (index, item) in snapshots.strip.items_mut().iter_mut().enumerate() {
                let response = card(ui, item, shown == Some(index));
                if moved && shown == Some(index) {
                    response.scroll_to_me(None);
                }
                if response.clicked() || response.secondary_clicked() {
                    chosen = Some(Some(index));
                }
                response.context_menu(|ui| context_menu(ui, &mut commands));
            }
            for _ in 0..snapshots.keeping() {
                plain_card(ui, "Keeping…", "", false);
            }
            let figures = live.map_or_else(String::new, |live| {
                figures(live.stats.samples_per_pixel, live.stats.noise)
            });
            if plain_card(ui, "Live", &figures, shown.is_none()).clicked() {
                chosen = Some(None);
            }
            if let Some(chosen) = chosen {
                snapshots.strip.show(chosen);
            }
        });
    });
    commands
}

/// The line above the pictures: what is shown, to be named and used, or what the strip is for.
fn head(ui: &mut Ui, snapshots: &mut Snapshots, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let undo = snapshots.strip.last_deleted().map_or(0.0, |_| UNDO_WIDTH);
        let (buttons, hide) = (BUTTONS_WIDTH + undo, HIDE_WIDTH + undo);
        let count = snapshots.strip.items().len();
        let bytes = snapshots.strip.bytes();
        if let Some(item) = snapshots.strip.shown_item_mut() {
            details(ui, item, buttons, commands);
        } else {
            let text = match count {
                0 => "Snapshots".to_owned(),
                1 => format!("1 snapshot, {}", size_in_words(bytes)),
                _ => format!("{count} snapshots, {}", size_in_words(bytes)),
            };
            ui.label(RichText::new(text).color(color::TEXT_STRONG));
            let help = "K keeps the picture, the left and right arrows flip through the snapshots.";
            ui.scope(|ui| {
                ui.set_max_width((ui.available_width() - hide).max(0.0));
                ui.add(egui::Label::new(RichText::new(help).color(color::TEXT_DIM)).truncate());
            });
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            button(ui, Command::FoldStrip, "Hide", commands);
            if snapshots.strip.last_deleted().is_some() {
                button(ui, Command::UndoDelete, Command::UndoDelete.text(), commands);
            }
        });
    });
}

/// Name and note of the snapshot shown, and what can be done with it; `buttons` is the room that
/// the buttons take.
fn details(ui: &mut Ui, item: &mut StripItem, buttons: f32, commands: &mut Vec<Command>) {
    let [least, most] = NAME_WIDTHS;
    let width = (ui.available_width() - buttons - NOTE_WIDTHS[0]).clamp(least, most);
    let name = TextEdit::singleline(&mut item.record.name).desired_width(width);
    ui.add(name).accessible_name("Snapshot name").on_hover_text("The name of this snapshot.");
    let [least, most] = NOTE_WIDTHS;
    let width = (ui.available_width() - buttons).clamp(least, most);
    let note = TextEdit::singleline(&mut item.record.note).hint_text("note").desired_width(width);
    let help = "A note about this snapshot. When snapshots need too much disk space, those without \
                a note are deleted first.";
    ui.add(note).accessible_name("Snapshot note").on_hover_text(help);
    button(ui, Command::CompareAsA, "Compare as A", commands);
    button(ui, Command::CompareAsB, "as B", commands);
    button(ui, Command::ContinueSnapshot, "Resume from this", commands);
    button(ui, Command::DeleteSnapshot, "Delete", commands);
}

fn button(ui: &mut Ui, command: Command, text: &str, commands: &mut Vec<Command>) {
    let key = ui.ctx().format_shortcut(&command.shortcut());
    let help = format!("{}  [{key}]", command.tooltip());
    if ui.button(text).on_hover_text(help).clicked() {
        commands.push(command);
    }
}

fn context_menu(ui: &mut Ui, commands: &mut Vec<Command>) {
    for (command, text) in [
        (Command::ContinueSnapshot, "Resume from this"),
        (Command::CompareAsA, Command::CompareAsA.text()),
        (Command::CompareAsB, Command::CompareAsB.text()),
        (Command::SaveExr, Command::SaveExr.text()),
        (Command::SavePng, Command::SavePng.text()),
        (Command::DeleteSnapshot, "Delete"),
    ] {
        let key = ui.ctx().format_shortcut(&command.shortcut());
        let key = RichText::new(key).color(color::TEXT_DIM);
        if ui.add(Button::new(text).shortcut_text(key).min_size(vec2(150.0, 0.0))).clicked() {
            commands.push(command);
            ui.close();
        }
    }
}

/// A snapshot with its small picture.
fn card(ui: &mut Ui, item: &mut StripItem, shown: bool) -> Response {
    let figures = figures(item.record.spp, item.record.noise);
    let response = frame(ui, &item.record.name, [&item.record.name, &figures], shown);
    if let Some(texture) = texture(ui, item) {
        let area = picture_area(&response);
        let [width, height] = texture.size();
        let size = 0.5 * vec2(width as f32, height as f32);
        let size = size * (area.size() / size).min_elem().min(1.0);
        // On whole pixels, so that it stays sharp.
        let factor = ui.pixels_per_point();
        let min = ((area.center() - 0.5 * size) * factor).round() / factor;
        let place = Rect::from_min_size(min, size);
        let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        ui.painter().image(texture.id(), place, whole, Color32::WHITE);
    }
    outline(ui, &response, shown);
    let record = &item.record;
    response.on_hover_ui(|ui| {
        ui.label(RichText::new(&record.name).color(color::TEXT_STRONG));
        if !record.note.is_empty() {
            ui.label(&record.note);
        }
        let [width, height] = record.size;
        ui.weak(format!("{figures} · {:.1} s · {}", record.seconds, record.strategy));
        ui.weak(format!("{width} × {height} pixels, kept {}", ago(record.kept)));
    })
}

/// A card without a picture, with its name in place of one.
fn plain_card(ui: &mut Ui, name: &str, figures: &str, shown: bool) -> Response {
    let response = frame(ui, name, [figures, ""], shown);
    let font = egui::FontId::proportional(size::BODY);
    let middle = picture_area(&response).center();
    ui.painter().text(middle, egui::Align2::CENTER_CENTER, name, font, tint(shown));
    outline(ui, &response, shown);
    response
}

/// The well for a picture and the lines under it.
fn frame(ui: &mut Ui, name: &str, lines: [&str; 2], shown: bool) -> Response {
    let size = PICTURE + vec2(0.0, 2.0 * LINE + space::TIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let label = format!("Snapshot {name}");
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, shown, &label));
    ui.painter().rect_filled(picture_area(&response), space::RADIUS, color::WELL);
    line(ui, rect, PICTURE.y + space::TIGHT, lines[0], tint(shown));
    line(ui, rect, PICTURE.y + space::TIGHT + LINE, lines[1], color::TEXT_DIM);
    response
}

fn tint(shown: bool) -> Color32 {
    if shown { color::TEXT_STRONG } else { color::TEXT }
}

fn picture_area(response: &Response) -> Rect {
    Rect::from_min_size(response.rect.min, PICTURE)
}

fn outline(ui: &Ui, response: &Response, shown: bool) {
    let tint = match (shown, response.hovered() || response.has_focus()) {
        (true, _) => color::ACCENT,
        (false, true) => color::RAISED_ACTIVE,
        (false, false) => return,
    };
    let stroke = Stroke::new(2.0, tint);
    let area = picture_area(response);
    ui.painter().rect_stroke(area, space::RADIUS, stroke, StrokeKind::Outside);
}

/// A line of text that is cut off where the card ends, `down` from its top.
fn line(ui: &Ui, card: Rect, down: f32, text: &str, tint: Color32) {
    let font = egui::FontId::proportional(size::SMALL);
    let mut job = egui::text::LayoutJob::simple_singleline(text.to_owned(), font, tint);
    job.wrap = egui::text::TextWrapping::truncate_at_width(card.width());
    let galley = ui.painter().layout_job(job);
    ui.painter().galley(card.min + vec2(0.0, down), galley, tint);
}

/// The small picture on the graphics card.
fn texture<'a>(ui: &Ui, item: &'a mut StripItem) -> Option<&'a egui::TextureHandle> {
    let name = || format!("snapshot {}", item.entry.id);
    item.thumbnail = match item.thumbnail.take() {
        Some(SmallPicture::Waiting(image)) => {
            let texture = ui.ctx().load_texture(name(), image, TextureOptions::LINEAR);
            Some(SmallPicture::Ready(texture))
        }
        other => other,
    };
    match &item.thumbnail {
        Some(SmallPicture::Ready(texture)) => Some(texture),
        _ => None,
    }
}

fn figures(spp: f64, noise: Option<f64>) -> String {
    let spp = samples(spp);
    match noise {
        Some(noise) => format!("{spp} spp · {} %", percent(noise)),
        None => format!("{spp} spp"),
    }
}

/// Age of a snapshot in words.
fn ago(kept: u64) -> String {
    let minutes = now().saturating_sub(kept) / 60_000;
    match minutes {
        0 => "just now".to_owned(),
        1..60 => format!("{minutes} min ago"),
        60..2880 => format!("{} h ago", minutes / 60),
        _ => format!("{} days ago", minutes / 1440),
    }
}
