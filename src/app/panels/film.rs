//! Render size, seed, and the limits on samples and bounces.

use egui::{DragValue, Ui, vec2};
use glam::UVec2;

use super::{Panel, section};
use crate::app::document::Document;
use crate::app::ui::theme::space;
use crate::app::ui::widgets::{Number, finite, is_reset, key_help, row, row_label, segments};
use crate::scene::keys;
use crate::scene::settings::{FilmSettings, MAX_FRAME, MAX_SHUTTER, TimeSettings};

/// Shows the section. `window` is the size that the film takes from the window, `largest` the
/// most that the graphics card can show a side.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>, window: Option<UVec2>, largest: u32) {
    section(ui, "Render", |ui| {
        let opened = &panel.editor.opened().settings;
        let reset = (opened.film.seed, opened.film.spp, opened.path.max_scatters);
        let (reset_size, reset_shutter) = (opened.film.size, opened.time.shutter as f32);
        let document = &mut panel.editor.document;
        let mut edit = size_rows(ui, document, reset_size, (window, largest));
        let moves = document.settings.volume.iter().any(|volume| volume.velocity.is_some())
            || document.settings.camera.key.len() > 1;
        let time = &mut document.settings.time;
        let film = &mut document.settings.film;
        let path = &mut document.settings.path;
        let seed = Whole { name: "Seed", key: "film.seed", none: None, unit: "", reset: reset.0 };
        if seed.show(ui, &mut film.seed) {
            edit = Some("seed");
        }
        let stop = Whole {
            name: "Max samples",
            key: "film.spp",
            none: Some("off"),
            unit: " spp",
            reset: reset.1.into(),
        };
        let mut spp = u64::from(film.spp);
        if stop.show(ui, &mut spp) {
            film.spp = u32::try_from(spp).unwrap_or(u32::MAX);
            edit = Some("max samples");
        }
        if range_row(ui, time, panel.frames) {
            edit = Some("frames of the time line");
        }
        let shown = [panel.frames.is_some(), moves];
        edit = edit.or(frame_rows(ui, shown, film, time, reset_shutter));
        let bounces = Whole {
            name: "Max bounces",
            key: "path.max_scatters",
            none: Some("no limit"),
            unit: "",
            reset: reset.2.into(),
        };
        let mut scatters = u64::from(path.max_scatters);
        if bounces.show(ui, &mut scatters) {
            path.max_scatters = u32::try_from(scatters).unwrap_or(u32::MAX);
            edit = Some("max bounces");
        }
        if let Some(name) = edit {
            panel.editor.name_edit(name);
        }
    });
}

/// Shows whether the film has a size of its own, and that size. The name of the edit, if one was
/// made.
fn size_rows(
    ui: &mut Ui,
    document: &mut Document,
    reset: [u32; 2],
    (window, largest): (Option<UVec2>, u32),
) -> Option<&'static str> {
    let choices = [
        ("Window size", "Render at the size of the window."),
        ("Fixed", "Render at the size given here, as on a render farm."),
    ];
    let mut edit = None;
    let chosen = usize::from(document.keep_size);
    let clicked =
        row(ui, "Render size", &key_help("film.size"), |ui| segments(ui, &choices, Some(chosen)));
    if let Some(choice) = clicked.inner {
        document.keep_size = choice == 1;
        edit = Some("render size");
    }
    if document.keep_size {
        if fixed_size(ui, &mut document.settings.film, reset, largest) {
            edit = Some("render size");
        }
    } else if let Some(size) = window {
        row(ui, "", "", |ui| ui.weak(format!("{} × {} pixels", size.x, size.y)));
    }
    edit
}

/// Shows the first and the last frame of the time line; whether they changed. `frames` are those
/// that it has, if there is one.
fn range_row(ui: &mut Ui, time: &mut TimeSettings, frames: Option<[i32; 2]>) -> bool {
    let before = time.range;
    let help = format!("{}\n\nDouble-click the name to reset.", key_help("time.range"));
    ui.horizontal(|ui| {
        let label = row_label(ui, "Frames", &help);
        let own = [time.whole_frame(); 2];
        let mut range = time.range.or(frames).unwrap_or(own);
        let shown = range;
        for (number, name) in range.iter_mut().zip(["First frame", "Last frame"]) {
            let field = DragValue::new(number).range(-MAX_FRAME..=MAX_FRAME).speed(1.0);
            let field = field.update_while_editing(false);
            let response = ui.add_sized([space::NUMBER, space::ROW_HEIGHT], field);
            response.accessible_name(name).on_hover_text(&help);
        }
        if range != shown {
            let pulled = usize::from(range[0] == shown[0]);
            range[1 - pulled] = match pulled {
                0 => range[1].max(range[0]),
                _ => range[0].min(range[1]),
            };
            time.range = Some(range);
        }
        if is_reset(ui, &[&label]) {
            time.range = None;
        }
    });
    time.range != before
}

/// Shows the noise of frames and the shutter, where the scene has frames and where it moves. The
/// name of the edit, if one was made.
fn frame_rows(
    ui: &mut Ui,
    [has_frames, moves]: [bool; 2],
    film: &mut FilmSettings,
    time: &mut TimeSettings,
    reset: f32,
) -> Option<&'static str> {
    let mut edit = None;
    if has_frames {
        let help = key_help("film.animate_seed");
        let noise = ui.checkbox(&mut film.animate_seed, "Noise changes with the frame");
        if noise.on_hover_text(help).changed() {
            edit = Some("noise of frames");
        }
    }
    if moves {
        let number = Number {
            name: "Shutter",
            key: "time.shutter",
            soft: 0.0..=2.0,
            logarithmic: false,
            unit: " frames",
            reset,
        };
        let mut shutter = time.shutter as f32;
        if number.show(ui, &mut shutter) {
            time.shutter = f64::from(shutter).clamp(0.0, MAX_SHUTTER);
            edit = Some("shutter");
        }
    }
    edit
}

fn fixed_size(ui: &mut Ui, film: &mut FilmSettings, reset: [u32; 2], largest: u32) -> bool {
    let before = film.size;
    let [width, height] = reset;
    let help = format!("{}\n\nDouble-click to reset to {width} × {height}.", key_help("film.size"));
    ui.horizontal(|ui| {
        let label = row_label(ui, "Pixels", &help);
        for (side, name) in film.size.iter_mut().zip(["Render width", "Render height"]) {
            let field = DragValue::new(side)
                .range(1..=largest)
                .custom_parser(finite)
                .update_while_editing(false);
            let response = ui.add_sized([space::NUMBER, space::ROW_HEIGHT], field);
            response.accessible_name(name).on_hover_text(&help);
        }
        if is_reset(ui, &[&label]) {
            film.size = reset;
        }
    });
    film.size != before
}

/// A whole number.
struct Whole<'a> {
    name: &'a str,
    key: &'a str,
    /// The meaning of 0 in words.
    none: Option<&'a str>,
    unit: &'a str,
    /// The value that a double click goes back to.
    reset: u64,
}

impl Whole<'_> {
    /// Shows the row; whether the number changed.
    fn show(self, ui: &mut Ui, value: &mut u64) -> bool {
        let before = *value;
        let Self { name, key, none, unit, reset } = self;
        let words = |value: f64| match none {
            Some(none) if value == 0.0 => none.to_owned(),
            _ => format!("{value:.0}{unit}"),
        };
        let number = |text: &str| match none {
            Some(none) if text.trim() == none => Some(0.0),
            _ => finite(text.trim().trim_end_matches(unit)),
        };
        let [low, high] = keys::find(key).map_or([0.0, f64::MAX], |key| key.limits);
        let help =
            format!("{}\n\nDouble-click to reset to {}.", key_help(key), words(reset as f64));
        ui.horizontal(|ui| {
            let label = row_label(ui, name, &help);
            let field = DragValue::new(value)
                .speed(0.1)
                .range(low..=high)
                .custom_formatter(|value, _| words(value))
                .custom_parser(number)
                .update_while_editing(false);
            let field = ui.add_sized(vec2(space::NUMBER + 20.0, space::ROW_HEIGHT), field);
            field.accessible_name(name).on_hover_text(&help);
            if is_reset(ui, &[&label]) {
                *value = reset;
            }
        });
        *value != before
    }
}
