//! Takes over the file of the scene that is open once another program has written it.

use std::path::{Path, PathBuf};

use egui::{Context, Ui};

use super::app::App;
use super::changed_scene::{OfferAnswer, offer};
use super::preferences::full_name;
use crate::app::ui::theme;
use crate::scene::{self, Settings};

impl App {
    /// The file of the scene that is open; `None` for embedded scenes, volumes and snapshots.
    pub(super) fn scene_file(&self) -> Option<PathBuf> {
        let source = full_name(&self.opened.source);
        scene::scene_file(&source).map(|path| path.into_owned())
    }

    /// Reads the file of the scene again.
    pub(super) fn read_scene_again(&mut self, ctx: &Context, path: &Path) {
        let wake = ctx.clone();
        if let Err(error) = self.changed_scene.reader.read(path, move || wake.request_repaint()) {
            self.notices.failed(error.to_string());
        }
    }

    /// Takes over what was read of the scene's file, or offers it where there are changes.
    pub(super) fn take_changed_scene(&mut self) {
        match self.changed_scene.reader.poll() {
            None => {}
            Some(Err(error)) => {
                self.notices.failed(format!("The scene has changed on the disk. {error}"));
            }
            Some(Ok(settings)) => {
                // Only its time may have changed, or it was saved from here.
                let is_new = !self.unsaved.is_saved(&settings);
                self.changed_scene.offered = is_new.then(|| Box::new(settings));
            }
        }
        if !self.has_unsaved_changes()
            && let Some(settings) = self.changed_scene.offered.take()
        {
            self.take_scene(*settings);
        }
    }

    /// Puts the settings of the file in place of those of the document, as an edit.
    fn take_scene(&mut self, of_file: Settings) {
        let settings = self.unsaved.reloaded(&of_file, &self.editor.document.settings);
        self.editor.reload(settings, &of_file);
        self.unsaved.changed_on_disk(of_file);
        let title = self.opened.title();
        self.notices.done(format!("{title} has changed on the disk and was read again."));
    }

    /// The bar that offers the settings of the changed file.
    pub(super) fn changed_scene_row(&mut self, ui: &mut Ui) {
        if self.changed_scene.offered.is_none() {
            return;
        }
        let title = self.opened.title();
        let row = egui::Panel::bottom("changed scene").frame(theme::panel_frame());
        let answer = row.show(ui, |ui| offer(ui, &title)).inner;
        let Some(answer) = answer else { return };
        let Some(settings) = self.changed_scene.offered.take() else { return };
        match answer {
            OfferAnswer::Reload => self.take_scene(*settings),
            OfferAnswer::Keep => self.unsaved.changed_on_disk(*settings),
        }
    }
}
