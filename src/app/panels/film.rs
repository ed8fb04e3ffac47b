//! The size of the picture, its seed and where it ends.

use egui::{DragValue, Ui, vec2};
use glam::UVec2;

use super::{Panel, section};
use crate::app::theme::space;
use crate::app::widgets::{finite, key_help, row, segments};
use crate::scene::settings::FilmSettings;

/// Shows the section. `window` is the size that the film takes from the window, `largest` the
/// most that the graphics card can show a side.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>, window: Option<UVec2>, largest: u32) {
    section(ui, "Film", |ui| {
        let document = &mut panel.editor.document;
        let mut edit = None;
        let choices = [
            ("Window's own", "The film always fills the window."),
            ("Fixed", "The film keeps the size given here, as a render on the farm would."),
        ];
        let chosen = usize::from(document.keep_size);
        let clicked =
            row(ui, "Size", &key_help("film.size"), |ui| segments(ui, &choices, Some(chosen)));
        if let Some(choice) = clicked.inner {
            document.keep_size = choice == 1;
            edit = Some("film size");
        }
        let film = &mut document.settings.film;
        if document.keep_size {
            if fixed_size(ui, film, largest) {
                edit = Some("film size");
            }
        } else if let Some(size) = window {
            row(ui, "", "", |ui| ui.weak(format!("{} × {} pixels", size.x, size.y)));
        }
        if whole(ui, "Seed", "film.seed", &mut film.seed, None) {
            edit = Some("seed");
        }
        let mut spp = u64::from(film.spp);
        if whole(ui, "Stop at", "film.spp", &mut spp, Some("never")) {
            film.spp = u32::try_from(spp).unwrap_or(u32::MAX);
            edit = Some("samples per pixel");
        }
        if let Some(name) = edit {
            panel.editor.name_edit(name);
        }
    });
}

fn fixed_size(ui: &mut Ui, film: &mut FilmSettings, largest: u32) -> bool {
    let help = key_help("film.size");
    row(ui, "Pixels", &help, |ui| {
        let mut changed = false;
        for (side, name) in film.size.iter_mut().zip(["Film width", "Film height"]) {
            let field = DragValue::new(side)
                .range(1..=largest)
                .custom_parser(finite)
                .update_while_editing(false);
            let response = ui.add_sized([space::NUMBER, space::ROW_HEIGHT], field);
            changed |= response.accessible_name(name).on_hover_text(&help).changed();
        }
        changed
    })
    .inner
}

/// A whole number; `none` is what 0 means in words.
fn whole(ui: &mut Ui, name: &str, key: &str, value: &mut u64, none: Option<&str>) -> bool {
    let help = key_help(key);
    row(ui, name, &help, |ui| {
        let words = |value: f64| match none {
            Some(none) if value == 0.0 => none.to_owned(),
            Some(_) => format!("{value:.0} spp"),
            None => format!("{value:.0}"),
        };
        let number = |text: &str| match none {
            Some(none) if text.trim() == none => Some(0.0),
            _ => finite(text.trim().trim_end_matches("spp")),
        };
        let field = DragValue::new(value)
            .speed(0.1)
            .custom_formatter(|value, _| words(value))
            .custom_parser(number)
            .update_while_editing(false);
        let field = ui.add_sized(vec2(space::NUMBER + 20.0, space::ROW_HEIGHT), field);
        field.accessible_name(name).on_hover_text(&help).changed()
    })
    .inner
}
