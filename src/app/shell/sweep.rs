//! The sweep of all strategies, as the window shows it: its progress below the picture, its results
//! in a window of their own, and the live render that waits for it.

use egui::{Context, Rect, Ui};

use super::app::App;
use crate::app::command::Command;
use crate::app::shell::bars;
use crate::app::sweep::results;
use crate::app::ui::theme;

impl App {
    /// Starts a requested sweep, takes in its results, and lets the live render wait meanwhile.
    pub(super) fn update_sweep(&mut self, ctx: &Context) {
        let Some(size) = self.film_size() else { return };
        let settings = &self.editor.document.settings;
        let wake = ctx.clone();
        let updated =
            self.sweep.update(settings, &self.live_render, size, move || wake.request_repaint());
        let held = self.sweep.holds(settings);
        self.live_render.set_held(held);
        self.compare.second_side.set_held(held);
        if let Err(error) = updated {
            self.notices.failed(error.to_string());
        }
    }

    /// Shows the progress of the sweep.
    pub(super) fn sweep_row(&mut self, ui: &mut Ui) {
        let Some(progress) = self.sweep.progress() else { return };
        let (what, fraction) = results::progress(&progress);
        let help = "End the sweep and show the results so far.";
        let row = egui::Panel::bottom("sweep").frame(theme::panel_frame());
        if row.show(ui, |ui| bars::progress(ui, &what, fraction, help)).inner {
            self.sweep.cancel();
        }
    }

    /// Shows what was found over what the bars leave of the picture, `area`.
    pub(super) fn sweep_window(&mut self, ctx: &Context, area: Rect, commands: &mut Vec<Command>) {
        results::show(ctx, area, &mut self.sweep, &mut self.editor, commands);
    }
}
