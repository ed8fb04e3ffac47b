//! The surroundings of a volume that stands alone.

use egui::Ui;

use super::Panel;
use crate::app::command::Command;
use crate::app::ui::widgets::{row, segments};
use crate::scene::Setup;

const SETUPS: [(Setup, &str, &str); 3] = [
    (Setup::Studio, "Studio", "A neutral floor under a soft sky, dim where something glows."),
    (Setup::Night, "Night", "The same by moonlight."),
    (Setup::Black, "Black", "Nothing around it; smoke keeps a key light."),
];

/// Shows the row; the name of the edit, if one was made.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) -> Option<&'static str> {
    let settings = &mut panel.editor.document.settings;
    let chosen = Setup::of(settings);
    let chosen = SETUPS.iter().position(|(setup, ..)| Some(*setup) == chosen);
    let choices = SETUPS.map(|(_, name, help)| (name, help));
    let help = Command::NextSetup.tooltip();
    let clicked = row(ui, "Surroundings", help, |ui| segments(ui, &choices, chosen)).inner;
    let (setup, ..) = SETUPS.get(clicked?)?;
    setup.apply(settings, &panel.bounds);
    Some("surroundings")
}
