//! The page of keys and mouse moves.

use egui::{Align2, Context, Grid, RichText, ScrollArea, Ui, Vec2, Window};

use crate::app::command::Command;
use crate::app::ui::theme::color;

const MOUSE: [(&str, &str); 12] = [
    ("Drag", "Orbit around the target"),
    ("Drag a handle", "Move or aim the selected light"),
    ("Middle drag, Shift+drag", "Pan"),
    ("Wheel, right drag", "Dolly"),
    ("Ctrl+wheel", "Zoom to pixels"),
    ("Ctrl+drag", "Move the zoomed picture"),
    ("Double-click the picture", "Fit the picture"),
    ("M, then drag", "Measure a region"),
    ("F6, then arrows", "Orbit"),
    ("F6, then Shift+arrows", "Pan"),
    ("F6, then Page Up, Page Down", "Dolly"),
    ("Double-click a setting", "Reset it to the opened value"),
];

/// Room that the page leaves around itself in a small window, its own title included.
const MARGIN: Vec2 = egui::vec2(48.0, 96.0);
/// Room that a column takes.
const COLUMN: f32 = 330.0;

/// Shows the page while `open`.
pub fn show(ctx: &Context, open: &mut bool) {
    let room = ctx.content_rect().size() - MARGIN;
    Window::new(Command::Shortcuts.text())
        .open(open)
        .auto_sized()
        .collapsible(false)
        .anchor(Align2::CENTER_CENTER, Vec2::ZERO)
        .show(ctx, |ui| {
            let columns = ((room.x / COLUMN) as usize).clamp(1, 3);
            ScrollArea::vertical().max_height(room.y).show(ui, |ui| page(ui, columns));
        });
}

/// Page of all keys and then all moves, in so many columns.
fn page(ui: &mut Ui, columns: usize) {
    let of_command = |command: Command| {
        (ui.ctx().format_shortcut(&command.shortcut()), command.text().to_owned())
    };
    let of_mouse = |(hand, does): (&str, &str)| (hand.to_owned(), does.to_owned());
    let keys = Command::all().map(of_command);
    let rows: Vec<(String, String)> = keys.chain(MOUSE.into_iter().map(of_mouse)).collect();
    ui.horizontal_top(|ui| {
        for (index, rows) in rows.chunks(rows.len().div_ceil(columns)).enumerate() {
            if index > 0 {
                ui.add_space(24.0);
            }
            table(ui, index, rows);
        }
    });
}

fn table(ui: &mut Ui, index: usize, rows: &[(String, String)]) {
    Grid::new(("keys", index)).num_columns(2).spacing([18.0, 2.0]).show(ui, |ui| {
        for (left, right) in rows {
            ui.label(RichText::new(left).color(color::TEXT_STRONG));
            ui.label(RichText::new(right.trim_end_matches('…')).color(color::TEXT_DIM));
            ui.end_row();
        }
    });
}
