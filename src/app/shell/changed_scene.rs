//! The file of the scene that is open, written again by another program, and the bar that offers
//! its settings where they would replace unsaved changes.

use egui::{RichText, Ui};

use crate::app::jobs::scene_reader::SceneReader;
use crate::app::ui::theme::color;
use crate::scene::Settings;

/// The file of the scene that is open, if it was written again.
#[derive(Debug, Default)]
pub(super) struct ChangedScene {
    /// Reads the file.
    pub(super) reader: SceneReader,
    /// Its settings, while the user is asked whether to take them.
    pub(super) offered: Option<Box<Settings>>,
}

/// The user's answer to the offer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OfferAnswer {
    /// Take the settings of the file.
    Reload,
    /// Keep those of the window.
    Keep,
}

impl ChangedScene {
    /// Forgets the file, since another was opened or the scene was saved to it.
    pub(super) fn forget(&mut self) {
        self.reader.forget();
        self.offered = None;
    }
}

/// Offers to read the scene called `title` again.
pub(super) fn offer(ui: &mut Ui, title: &str) -> Option<OfferAnswer> {
    let buttons = [
        (
            "Reload",
            OfferAnswer::Reload,
            "Take the settings of the file. Undo brings the changes back.",
        ),
        ("Keep", OfferAnswer::Keep, "Keep the scene as it is here. Saving replaces the file."),
    ];
    ui.horizontal_wrapped(|ui| {
        let text = format!("{title} has changed on the disk, and has unsaved changes here.");
        ui.label(RichText::new(text).color(color::WARNING));
        let mut answer = None;
        for (text, says, help) in buttons {
            if ui.button(text).on_hover_text(help).clicked() {
                answer = Some(says);
            }
        }
        answer
    })
    .inner
}
