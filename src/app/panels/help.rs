//! The page of keys and mouse moves.

use egui::{Context, Grid, RichText, ScrollArea, Ui, Window};

use crate::app::commands::Command;
use crate::app::theme::color;

const MOUSE: [(&str, &str); 12] = [
    ("Drag", "Orbit around the target"),
    ("Drag a handle", "Move or aim the selected light"),
    ("Middle drag, Shift+drag", "Pan"),
    ("Wheel, right drag", "Dolly"),
    ("Ctrl+wheel", "Zoom to pixels"),
    ("Ctrl+drag", "Move the zoomed picture"),
    ("Double-click the picture", "Fit it again"),
    ("M, then drag", "Figures of a rectangle"),
    ("Tab to the picture, arrows", "Orbit"),
    ("The same with Shift", "Pan"),
    ("There, Page Up, Page Down", "Dolly"),
    ("Double-click a setting", "Back to how it was opened"),
];

/// What the page leaves of a small window, its own title included.
const MARGIN: egui::Vec2 = egui::vec2(48.0, 96.0);

/// Shows the page while `open`.
pub fn show(ctx: &Context, open: &mut bool) {
    let room = ctx.content_rect().size() - MARGIN;
    Window::new(Command::Shortcuts.text())
        .open(open)
        .resizable(false)
        .collapsible(false)
        .max_size(room)
        .default_size(room)
        .pivot(egui::Align2::CENTER_CENTER)
        .default_pos(ctx.content_rect().center())
        .show(ctx, |ui| {
            let area = ScrollArea::both().max_width(room.x).max_height(room.y);
            area.show(ui, page);
        });
}

fn page(ui: &mut Ui) {
    ui.horizontal_top(|ui| {
        let (left, right) = Command::ALL.split_at(Command::ALL.len().div_ceil(2));
        for (id, commands) in [("keys", left), ("more keys", right)] {
            let row = |command: &Command| {
                (ui.ctx().format_shortcut(&command.shortcut()), command.text().to_owned())
            };
            let rows = commands.iter().map(row).collect();
            table(ui, id, rows);
            ui.add_space(24.0);
        }
        let row = |(hand, does): (&str, &str)| (hand.to_owned(), does.to_owned());
        table(ui, "mouse", MOUSE.into_iter().map(row).collect());
    });
}

fn table(ui: &mut Ui, id: &str, rows: Vec<(String, String)>) {
    Grid::new(id).num_columns(2).spacing([18.0, 2.0]).show(ui, |ui| {
        for (left, right) in rows {
            ui.label(RichText::new(left).color(color::TEXT_STRONG));
            ui.label(RichText::new(right.trim_end_matches('…')).color(color::TEXT_DIM));
            ui.end_row();
        }
    });
}
