//! The bar that asks before changes of the scene are lost.

use egui::{Button, RichText, Ui};

use crate::app::ui::theme::color;

/// An action that would lose unsaved changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PendingAction {
    /// The window would close.
    Close,
    /// A scene, a volume or a snapshot would take their place.
    Open(String),
}

/// The user's answer to the question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnsavedAnswer {
    /// Save the scene first.
    Save,
    /// Go on without.
    Discard,
    /// Don't go on.
    Stay,
}

/// Asks about the changes of the scene called `title`. A `fresh` question takes the keyboard, and
/// is fresh until it has.
pub fn ask(
    ui: &mut Ui,
    title: &str,
    action: &PendingAction,
    fresh: &mut bool,
) -> Option<UnsavedAnswer> {
    let discard = match action {
        PendingAction::Close => "Close without saving",
        PendingAction::Open(_) => "Open without saving",
    };
    let buttons = [
        ("Save scene…", UnsavedAnswer::Save, "Save all settings as a scene file first."),
        (discard, UnsavedAnswer::Discard, "Discard the changes."),
        ("Cancel", UnsavedAnswer::Stay, "Keep editing."),
    ];
    ui.horizontal_wrapped(|ui| {
        let text = format!("{title} has unsaved changes.");
        ui.label(RichText::new(text).color(color::WARNING));
        let mut answer = None;
        for (text, says, help) in buttons {
            let button = ui.add(Button::new(text)).on_hover_text(help);
            if button.clicked() {
                answer = Some(says);
            }
            if *fresh && says == UnsavedAnswer::Save {
                *fresh = !button.has_focus();
                button.request_focus();
            }
        }
        answer
    })
    .inner
}
