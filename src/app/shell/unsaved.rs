//! What must not get lost: changes of the scene, and what the window remembers between runs.

use std::path::{Path, PathBuf};

use egui::{Context, Ui, ViewportCommand};

use super::App;
use crate::app::jobs::dialogs::Purpose;
use crate::app::jobs::live_render::same_matter;
use crate::app::shell::unsaved_bar;
use crate::app::shell::unsaved_bar::{LosingAction, UnsavedAnswer};
use crate::app::ui::theme;
use crate::scene::Settings;

/// The scene as it is on the disk, or on its way there.
#[derive(Debug, Default)]
pub(super) struct UnsavedChanges {
    /// As it was opened or saved last.
    saved: Settings,
    /// Scenes that are being written.
    writing: Vec<(PathBuf, Settings)>,
    /// What would lose changes, while it is asked about.
    pub(super) losing: Option<LosingAction>,
    /// Whether the keyboard is still to go to that.
    is_fresh: bool,
    /// Whether it goes on as soon as they are saved.
    saves_first: bool,
    /// Whether the changes may be lost, or the window close.
    allowed: bool,
    /// The title of the window.
    title: String,
    /// Whether the scene is a file of the user's, whose camera is part of the work.
    is_own: bool,
}

impl UnsavedChanges {
    /// A scene was opened from `source`.
    pub(super) fn opened(&mut self, source: &str, settings: &Settings) {
        self.saved = settings.clone();
        (self.losing, self.saves_first, self.allowed) = (None, false, false);
        let ending = Path::new(source).extension();
        self.is_own = ending.is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    }

    fn ask(&mut self, losing: LosingAction) {
        (self.losing, self.is_fresh) = (Some(losing), true);
    }

    /// A scene is being written to `path`.
    pub(super) fn writes(&mut self, path: &Path, settings: Settings) {
        self.writing.push((path.to_owned(), settings));
    }

    /// `path` was written, or could not be.
    pub(super) fn written(&mut self, path: &Path, is_there: bool) {
        if let Some(index) = self.writing.iter().position(|(writing, _)| writing == path) {
            let (_, settings) = self.writing.remove(index);
            if is_there {
                (self.saved, self.is_own) = (settings, true);
            }
        }
    }

    /// Whether `settings` have changes that a file has not. Strategies are tried on and off all the
    /// time and change no picture, and a film that follows the window has no size of its own. Who
    /// looks around in a scene that Flambeau brings along, or in a bare volume, has made nothing yet.
    fn differs_from(&self, settings: &Settings, keep_size: bool) -> bool {
        let mut film = self.saved.film;
        if !keep_size {
            film.size = settings.film.size;
        }
        let is_moved = self.is_own && self.saved.camera != settings.camera;
        film != settings.film || is_moved || !same_matter(&self.saved, settings)
    }
}

impl App {
    /// Whether the scene has changes that no file has.
    pub fn has_unsaved_changes(&self) -> bool {
        let document = &self.editor.document;
        self.unsaved.differs_from(&document.settings, document.keep_size)
    }

    /// Says in the title of the window what is open and whether it was changed, and asks before a
    /// window with changes closes.
    pub(super) fn watch_over_changes(&mut self, ctx: &Context) {
        let mark = if self.has_unsaved_changes() { "* " } else { "" };
        let title = format!("{mark}{} – Flambeau", self.title());
        if title != self.unsaved.title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.unsaved.title = title;
        }
        let closes = ctx.input(|input| input.viewport().close_requested());
        if closes && !self.unsaved.allowed && self.has_unsaved_changes() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.unsaved.ask(LosingAction::Close);
        }
    }

    /// Opens `source`, or asks first where that would lose changes.
    pub(super) fn open_unless_lost(&mut self, source: &str) {
        // What is not there is not opened, so that nothing would be lost.
        let is_there = source.starts_with("builtin:") || Path::new(source).exists();
        if is_there && self.has_unsaved_changes() {
            self.path_bar = None;
            self.unsaved.ask(LosingAction::Open(source.to_owned()));
        } else {
            self.open(source);
        }
    }

    /// The bar that asks.
    pub(super) fn unsaved_row(&mut self, ui: &mut Ui) {
        let Some(losing) = self.unsaved.losing.clone() else { return };
        if !self.has_unsaved_changes() {
            // Saved as was asked for, or else taken back.
            match std::mem::take(&mut self.unsaved.saves_first) {
                true => self.go_on(ui.ctx(), losing),
                false => self.unsaved.losing = None,
            }
            return;
        }
        let title = self.title();
        let row = egui::Panel::bottom("unsaved").frame(theme::panel_frame());
        let fresh = &mut self.unsaved.is_fresh;
        match row.show(ui, |ui| unsaved_bar::ask(ui, &title, &losing, fresh)).inner {
            Some(UnsavedAnswer::Save) => {
                self.unsaved.saves_first = true;
                self.ask(&ui.ctx().clone(), Purpose::SaveScene);
            }
            Some(UnsavedAnswer::Discard) => self.go_on(ui.ctx(), losing),
            Some(UnsavedAnswer::Stay) => self.stay(),
            None => {}
        }
    }

    /// Goes on working on what is open.
    pub(super) fn stay(&mut self) {
        (self.unsaved.losing, self.unsaved.saves_first) = (None, false);
    }

    fn go_on(&mut self, ctx: &Context, losing: LosingAction) {
        (self.unsaved.losing, self.unsaved.saves_first) = (None, false);
        match losing {
            LosingAction::Open(source) => self.open(&source),
            LosingAction::Close => {
                self.unsaved.allowed = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    /// Notes the file that was opened, for the next run too. Snapshots have their strip.
    pub(super) fn remember_file(&mut self, source: &str) {
        if self.snapshots.name_of(Path::new(source)).is_some() {
            return;
        }
        self.preferences.note(source);
        if let Err(error) = self.write_remembered() {
            self.notices.failed(error.to_string());
        }
    }

    /// Writes what the window remembers.
    pub(super) fn write_remembered(&mut self) -> crate::error::Result<()> {
        self.preferences.folded = self.folded;
        self.preferences.sections = self.sections.chosen();
        self.preferences.note_tone(self.editor.document.tone);
        self.preferences.note_references(self.reference.preferences());
        match &self.data {
            Some(data) => self.preferences.write(data),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::strategy::Preset;

    #[test]
    fn changes_are_what_no_file_has() {
        let mut settings = Settings::default();
        let mut unsaved = UnsavedChanges::default();
        unsaved.opened("torch.toml", &settings);
        settings.strategy = Preset::Baseline.strategy();
        settings.film.size = [7, 7];
        assert!(
            !unsaved.differs_from(&settings, false),
            "strategies and the window's size are none"
        );
        assert!(unsaved.differs_from(&settings, true));
        settings.camera.fov_x += 1.0;
        assert!(unsaved.differs_from(&settings, false));
        let path = Path::new("torch.toml");
        unsaved.writes(path, settings.clone());
        assert!(unsaved.differs_from(&settings, false), "not there yet");
        unsaved.written(path, false);
        assert!(unsaved.differs_from(&settings, false), "it failed");
        unsaved.writes(path, settings.clone());
        unsaved.written(path, true);
        assert!(!unsaved.differs_from(&settings, false));
    }

    #[test]
    fn looking_around_in_what_is_nobodys_own_is_no_change() {
        let mut settings = Settings::default();
        let mut unsaved = UnsavedChanges::default();
        for (source, is_own) in [("builtin:torch", false), ("smoke.vdb", false), ("a.toml", true)] {
            unsaved.opened(source, &settings);
            settings.camera.fov_x += 1.0;
            assert_eq!(unsaved.differs_from(&settings, false), is_own, "{source}");
            settings.path.max_scatters += 1;
            assert!(unsaved.differs_from(&settings, false), "{source}");
        }
        unsaved.opened("builtin:torch", &settings);
        unsaved.writes(Path::new("a.toml"), settings.clone());
        unsaved.written(Path::new("a.toml"), true);
        settings.camera.fov_x += 1.0;
        assert!(unsaved.differs_from(&settings, false), "a file of one's own by now");
    }
}
