//! The page of keys and mouse moves.

use egui::{Context, Grid, RichText, Ui, Window};

use crate::app::commands::Command;
use crate::app::theme::color;

const MOUSE: [(&str, &str); 7] = [
    ("Drag", "Orbit around the target"),
    ("Middle drag, Shift+drag", "Pan"),
    ("Wheel, right drag", "Dolly"),
    ("Ctrl+wheel", "Zoom to pixels"),
    ("Ctrl+drag", "Move the zoomed picture"),
    ("Double-click the picture", "Fit it again"),
    ("Double-click a setting", "Back to how it was opened"),
];

/// Shows the page while `open`.
pub fn show(ctx: &Context, open: &mut bool) {
    Window::new(Command::Shortcuts.text())
        .open(open)
        .resizable(false)
        .collapsible(false)
        .pivot(egui::Align2::CENTER_CENTER)
        .default_pos(ctx.content_rect().center())
        .show(ctx, |ui| {
            ui.horizontal_top(|ui| {
                table(
                    ui,
                    "keys",
                    Command::ALL.map(|command| {
                        (ui.ctx().format_shortcut(&command.shortcut()), command.text().to_owned())
                    }),
                );
                ui.add_space(24.0);
                table(ui, "mouse", MOUSE.map(|(hand, does)| (hand.to_owned(), does.to_owned())));
            });
        });
}

fn table<const N: usize>(ui: &mut Ui, id: &str, rows: [(String, String); N]) {
    Grid::new(id).num_columns(2).spacing([18.0, 4.0]).show(ui, |ui| {
        for (left, right) in rows {
            ui.label(RichText::new(left).color(color::TEXT_STRONG));
            ui.label(RichText::new(right.trim_end_matches('…')).color(color::TEXT_DIM));
            ui.end_row();
        }
    });
}
