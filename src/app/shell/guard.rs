//! Asks before unsaved changes of the scene are lost.

use egui::{Context, Ui, ViewportCommand};

use super::app::App;
use super::unsaved_bar;
use super::unsaved_bar::{PendingAction, UnsavedAnswer};
use crate::app::jobs::dialogs::Purpose;
use crate::app::ui::theme;

impl App {
    /// Whether the scene has changes that no file has.
    pub fn has_unsaved_changes(&self) -> bool {
        let document = &self.editor.document;
        self.unsaved.differs_from(&document.settings, document.keep_size)
    }

    /// A short name of what is open, with a star where it has unsaved changes, and its frame.
    pub(super) fn marked_title(&self) -> String {
        let mark = if self.has_unsaved_changes() { "* " } else { "" };
        let frame = match self.time_line.range() {
            Some(_) => {
                let frame = self.editor.document.settings.time.whole_frame();
                format!(", frame {}", self.time_line.shown(frame))
            }
            None => String::new(),
        };
        format!("{mark}{}{frame}", self.opened.title())
    }

    /// Says in the title of the window what is open and whether it was changed, and asks before a
    /// window with changes closes.
    pub(super) fn watch_over_changes(&mut self, ctx: &Context) {
        let title = format!("{} – Flambeau", self.marked_title());
        if title != self.unsaved.title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.unsaved.title = title;
        }
        let closes = ctx.input(|input| input.viewport().close_requested());
        if closes && !self.unsaved.allowed && self.has_unsaved_changes() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.unsaved.ask(PendingAction::Close);
        }
    }

    /// Opens `source`, or asks first where that would lose changes.
    pub(super) fn open_or_ask(&mut self, source: &str) {
        // What is not there is not opened, so that nothing would be lost.
        let is_there = source.starts_with("builtin:") || crate::files::path_of(source).exists();
        if is_there && self.has_unsaved_changes() {
            self.files.path_bar = None;
            self.unsaved.ask(PendingAction::Open(source.to_owned()));
        } else {
            self.open(source);
        }
    }

    /// The bar that asks.
    pub(super) fn unsaved_row(&mut self, ui: &mut Ui) {
        let Some(action) = self.unsaved.pending.clone() else { return };
        if !self.has_unsaved_changes() {
            // Saved as was asked for, or else taken back.
            match std::mem::take(&mut self.unsaved.saves_first) {
                true => self.go_on(ui.ctx(), action),
                false => self.unsaved.pending = None,
            }
            return;
        }
        let title = self.opened.title();
        let row = egui::Panel::bottom("unsaved").frame(theme::panel_frame());
        let fresh = &mut self.unsaved.is_fresh;
        match row.show(ui, |ui| unsaved_bar::ask(ui, &title, &action, fresh)).inner {
            Some(UnsavedAnswer::Save) => {
                self.unsaved.saves_first = true;
                self.ask(&ui.ctx().clone(), Purpose::SaveScene);
            }
            Some(UnsavedAnswer::Discard) => self.go_on(ui.ctx(), action),
            Some(UnsavedAnswer::Stay) => self.stay(),
            None => {}
        }
    }

    /// Goes on working on what is open.
    pub(super) fn stay(&mut self) {
        (self.unsaved.pending, self.unsaved.saves_first) = (None, false);
    }

    fn go_on(&mut self, ctx: &Context, action: PendingAction) {
        (self.unsaved.pending, self.unsaved.saves_first) = (None, false);
        match action {
            PendingAction::Open(source) => self.open(&source),
            PendingAction::Close => {
                self.unsaved.allowed = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }
}
