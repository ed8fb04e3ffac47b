//! The frames of a volume that is a sequence.

use egui::{DragValue, Ui};

use crate::app::ui::theme::space;
use crate::app::ui::widgets::{key_help, row, segments};
use crate::scene::keys;
use crate::scene::sequence::Pattern;
use crate::scene::settings::{MAX_FRAME, Outside, VolumeSettings};

/// Choices of `outside`, in the order of the buttons.
const OUTSIDE: [(Outside, &str); 3] =
    [(Outside::Hold, "Hold"), (Outside::Loop, "Loop"), (Outside::None, "None")];

/// Shows the rows of a sequence; the name of the edit, if one was made.
pub fn show(ui: &mut Ui, volume: &mut VolumeSettings) -> Option<&'static str> {
    volume.file.as_deref().and_then(Pattern::spelled)?;
    let mut edit = None;
    let meanings = keys::explained_choices("volume.0.outside");
    let meaning = |index: usize| meanings.get(index).map_or("", |(_, meaning)| *meaning);
    let choices: Vec<(&str, &str)> =
        OUTSIDE.iter().enumerate().map(|(index, (_, name))| (*name, meaning(index))).collect();
    let chosen = OUTSIDE.iter().position(|(outside, _)| *outside == volume.outside);
    let help = key_help("volume.0.outside");
    let clicked = row(ui, "Outside", &help, |ui| segments(ui, &choices, chosen));
    if let Some((outside, _)) = clicked.inner.and_then(|clicked| OUTSIDE.get(clicked)) {
        volume.outside = *outside;
        edit = Some("frames outside");
    }
    row(ui, "Frame offset", &key_help("volume.0.frame_offset"), |ui| {
        let field = DragValue::new(&mut volume.frame_offset).range(-MAX_FRAME..=MAX_FRAME);
        if ui.add_sized([space::NUMBER, space::ROW_HEIGHT], field.speed(0.1)).changed() {
            edit = Some("frame offset");
        }
    });
    edit
}
