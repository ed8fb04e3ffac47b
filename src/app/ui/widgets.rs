//! Rows of settings: a label, a slider, an exact number, with the help of the scene file's keys.

use std::ops::RangeInclusive;

use egui::{
    Align, Button, ComboBox, DragValue, Label, Layout, Response, RichText, Sense, Slider,
    SliderClamping, Ui, vec2,
};

use super::theme::{color, space};
use crate::app::command::Command;
use crate::scene::keys;
use crate::scene::settings::Color;

/// Room beside a label for the names of choices, in letters.
const ROOM_BESIDE_LABEL: usize = 24;
/// Letters that the frame of a button takes the room of.
const LETTERS_OF_FRAME: usize = 2;

/// Width of a list that drops down, in points.
const LIST: f32 = 120.0;

/// The help of a key of the scene file, ready for a tooltip.
pub fn key_help(path: &str) -> String {
    let Some(key) = keys::find(path) else { return path.to_owned() };
    let unit = key.unit.as_ref().map_or_else(String::new, |unit| format!(" [{unit}]"));
    format!("{}\n\n{}{unit}", key.help.trim(), key.path.replace(".N.", "."))
}

/// The help of a key that has half of what is shown.
pub fn doubled_help(path: &str) -> String {
    format!("The full size; the scene file has half of it. {}", key_help(path))
}

/// The key of a command, as menus write it.
pub fn key_of(ui: &Ui, command: Command) -> String {
    ui.ctx().format_shortcut(&command.shortcut())
}

/// Steps to the right and down that the arrow keys ask of a control that has the focus. It keeps
/// the keys for itself, which otherwise move the focus.
pub fn arrow_steps(ui: &Ui, control: egui::Id) -> egui::Vec2 {
    let filter = egui::EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..egui::EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(control, filter));
    let pressed = |key| ui.input(|input| input.num_presses(key)) as f32;
    egui::vec2(
        pressed(egui::Key::ArrowRight) - pressed(egui::Key::ArrowLeft),
        pressed(egui::Key::ArrowDown) - pressed(egui::Key::ArrowUp),
    )
}

/// First sentence of a key's help.
pub fn key_summary(path: &str) -> String {
    let help = keys::find(path).map(|key| key.help.clone()).unwrap_or_default();
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    match help.find(". ") {
        Some(end) => help[..=end].to_owned(),
        None => help,
    }
}

/// Small dim text that explains.
pub fn explain(ui: &mut Ui, text: &str) {
    ui.add(Label::new(RichText::new(text).small().color(color::TEXT_DIM)).wrap());
}

/// A label of fixed width that starts a row; hovering shows the help, `name` is what it says.
pub fn row_label(ui: &mut Ui, name: &str, help: &str) -> Response {
    let size = vec2(space::LABEL, space::ROW_HEIGHT);
    let layout = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_size(size);
        let text = RichText::new(name).color(color::TEXT_DIM);
        ui.add(Label::new(text).truncate().sense(Sense::hover()))
    })
    .inner
    .on_hover_text(help)
}

/// A row with a label and any contents right of it.
pub fn row<R>(
    ui: &mut Ui,
    name: &str,
    help: &str,
    contents: impl FnOnce(&mut Ui) -> R,
) -> egui::InnerResponse<R> {
    ui.horizontal(|ui| {
        row_label(ui, name, help);
        ui.name_inputs(name, contents)
    })
}

/// A row for one number: a slider over a sensible range and a field for exact values beyond it.
pub struct Number<'a> {
    /// Name of the number, also for screen readers and undo.
    pub name: &'a str,
    /// Key of the number in the scene file, which gives its help and bounds; empty where it has
    /// none.
    pub key: &'a str,
    /// The range of the slider.
    pub soft: RangeInclusive<f32>,
    /// Whether the slider goes by factors.
    pub logarithmic: bool,
    /// The unit behind the number, with a space before it.
    pub unit: &'a str,
    /// The value that a double click goes back to.
    pub reset: f32,
}

impl Number<'_> {
    /// Shows the row; whether the value changed.
    pub fn show(self, ui: &mut Ui, value: &mut f32) -> bool {
        let limits = keys::find(self.key).map_or([f64::MIN, f64::MAX], |key| key.limits);
        let help = key_help(self.key);
        self.show_as(ui, value, &help, limits)
    }

    /// Shows the row with a help of its own and the limits between which the number may be typed.
    pub fn show_as(self, ui: &mut Ui, value: &mut f32, help: &str, limits: [f64; 2]) -> bool {
        self.show_beside(ui, value, (help, limits), (0.0, |_: &mut Ui, _: &mut f32| {}))
    }

    /// Shows the row with something more behind the number, which takes that width.
    pub fn show_beside(
        self,
        ui: &mut Ui,
        value: &mut f32,
        (help, limits): (&str, [f64; 2]),
        (width, beside): (f32, impl FnOnce(&mut Ui, &mut f32)),
    ) -> bool {
        let before = *value;
        let help = format!("{help}\n\nDouble-click to reset to {}.", self.reset);
        ui.horizontal(|ui| {
            let label = row_label(ui, self.name, &help);
            let slider = self.slider(ui, value, width).on_hover_text(&help).labelled_by(label.id);
            let field = self.field(ui, value, limits).labelled_by(label.id);
            field.on_hover_text("Click to type, or drag to change; hold Shift for fine steps.");
            beside(ui, value);
            if is_reset(ui, &[&label, &slider]) {
                *value = self.reset;
            }
        });
        *value != before
    }

    /// The slider, which leaves room for the number and for `beside`.
    fn slider(&self, ui: &mut Ui, value: &mut f32, beside: f32) -> Response {
        let gaps = if beside > 0.0 { 3.0 } else { 2.0 } * ui.spacing().item_spacing.x;
        ui.spacing_mut().slider_width =
            (ui.available_width() - space::NUMBER - beside - gaps).clamp(30.0, 400.0);
        let smallest = f64::from(self.soft.end() / 1e4).max(1e-6);
        ui.add(
            Slider::new(value, self.soft.clone())
                .show_value(false)
                .clamping(SliderClamping::Never)
                .logarithmic(self.logarithmic)
                .smallest_positive(smallest),
        )
    }

    fn field(&self, ui: &mut Ui, value: &mut f32, [low, high]: [f64; 2]) -> Response {
        let span = f64::from(self.soft.end() - self.soft.start());
        let speed = if self.logarithmic {
            f64::from(value.abs()).max(span * 1e-4) * 0.01
        } else {
            span / 300.0
        };
        let field = DragValue::new(value)
            .speed(speed)
            .range(low..=high)
            .max_decimals(4)
            .suffix(self.unit)
            .custom_formatter(|value, _| significant(value))
            .custom_parser(finite);
        ui.add_sized([space::NUMBER, space::ROW_HEIGHT], field)
    }
}

/// A typed number; nothing where it is none, or none to calculate with.
pub fn finite(text: &str) -> Option<f64> {
    let digits = text.split_whitespace().collect::<String>().replace('\u{2212}', "-");
    digits.parse().ok().filter(|value: &f64| value.abs() <= f64::from(f32::MAX))
}

/// A number in four significant digits, without trailing zeros, and never longer than a field.
pub fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    if !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.1e}");
    }
    let digits = 3 - value.abs().log10().floor() as i32;
    let decimals = usize::try_from(digits.clamp(0, 7)).unwrap_or(0);
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A large count with a prefix: 24.1 M.
pub fn count(value: f64) -> String {
    let scales = [(1e12, " T"), (1e9, " G"), (1e6, " M"), (1e3, " k")];
    match scales.into_iter().find(|(scale, _)| value >= *scale) {
        Some((scale, prefix)) => format!("{:.1}{prefix}", value / scale),
        None => format!("{value:.0}"),
    }
}

/// Three numbers in a row, such as a point in space.
pub struct Vector<'a> {
    /// Name of the vector, also for screen readers and undo.
    pub name: &'a str,
    /// Key of the vector in the scene file, which gives its help and bounds.
    pub key: &'a str,
    /// Change per point of a drag.
    pub speed: f32,
    /// The unit behind the numbers.
    pub unit: &'a str,
    /// The value that a double click on the name goes back to.
    pub reset: [f32; 3],
}

impl Vector<'_> {
    /// Shows the row; whether any number changed. Where the key has half an edge, the row has the
    /// whole of it.
    pub fn show(self, ui: &mut Ui, value: &mut [f32; 3]) -> bool {
        if !self.key.contains(".half_") {
            let help = key_help(self.key);
            return self.show_as(ui, value, &help);
        }
        let mut whole = value.map(|half| 2.0 * half);
        let reset = self.reset.map(|half| 2.0 * half);
        let help = doubled_help(self.key);
        let changed = Self { reset, ..self }.show_as(ui, &mut whole, &help);
        if changed {
            *value = whole.map(|edge| 0.5 * edge);
        }
        changed
    }

    /// Shows the row with a help of its own.
    pub fn show_as(self, ui: &mut Ui, value: &mut [f32; 3], help: &str) -> bool {
        let before = *value;
        let key = keys::find(self.key);
        let [low, high] = key.map_or([f64::MIN, f64::MAX], |key| key.limits);
        let [x, y, z] = self.reset.map(|value| significant(f64::from(value)));
        let help = format!("{}\n\nDouble-click the name to reset to {x}, {y}, {z}.", help);
        ui.horizontal(|ui| {
            let label = row_label(ui, self.name, &help);
            if is_reset(ui, &[&label]) {
                *value = self.reset;
            }
            let gaps = 2.0 * ui.spacing().item_spacing.x;
            let width = ((ui.available_width() - gaps) / 3.0).max(30.0);
            ui.spacing_mut().button_padding.x = 2.0;
            for (component, axis) in value.iter_mut().zip(["x", "y", "z"]) {
                let field = DragValue::new(component)
                    .speed(self.speed)
                    .range(low..=high)
                    .max_decimals(4)
                    .suffix(self.unit)
                    .custom_formatter(|value, _| significant(value))
                    .custom_parser(finite);
                ui.add_sized([width, space::ROW_HEIGHT], field)
                    .accessible_name(format!("{} {axis}", self.name))
                    .on_hover_text(format!("{axis}: {help}"));
            }
        });
        *value != before
    }
}

/// A list that drops down, `choices` with their names and help; whether another one was chosen.
pub fn list<T: Copy + PartialEq>(
    ui: &mut Ui,
    (name, help): (&str, &str),
    value: &mut T,
    choices: &[(T, &str, &str)],
) -> bool {
    let before = *value;
    let shown = choices.iter().find(|(choice, ..)| *choice == before).map_or("", |choice| choice.1);
    let list = ComboBox::from_id_salt(name).selected_text(shown).width(LIST).height(f32::INFINITY);
    let list = list.show_ui(ui, |ui| {
        for (choice, text, help) in choices {
            let response = ui.selectable_label(*choice == before, *text);
            let response = if help.is_empty() { response } else { response.on_hover_text(*help) };
            if response.clicked() {
                *value = *choice;
                // By a key too, which clicks beside nothing.
                ui.close();
            }
        }
    });
    list.response.accessible_name(name).on_hover_text(help);
    *value != before
}

/// Whether something was double-clicked, which takes it back to what it was.
pub fn is_reset(ui: &Ui, parts: &[&Response]) -> bool {
    let button = egui::PointerButton::Primary;
    let double = ui.input(|input| input.pointer.button_double_clicked(button));
    double && parts.iter().any(|part| part.contains_pointer())
}

/// Rows for the strength of a color and for its hue; whether either changed. `name` is that of the
/// second row.
pub fn color_rows(ui: &mut Ui, number: Number<'_>, name: &str, value: &mut Color) -> bool {
    let before = *value;
    let help = key_help(number.key);
    let mut strong = strength(*value);
    if number.show(ui, &mut strong) {
        *value = scaled(*value, strong);
    }
    if tint(ui, name, &help, value) {
        *value = scaled(*value, strong);
    }
    *value != before
}

/// The hue of a color, which comes out with a largest channel of 1; whether it was picked.
pub fn tint(ui: &mut Ui, name: &str, help: &str, value: &mut Color) -> bool {
    let mut rgb = scaled(*value, 1.0).rgb().to_array();
    let picked = row(ui, name, help, |ui| {
        ui.color_edit_button_rgb(&mut rgb).accessible_name(name).on_hover_text(help).changed()
    });
    if picked.inner {
        *value = scaled(from_rgb(rgb), 1.0);
    }
    picked.inner
}

/// A row of buttons of which at most one is on; the index of the one that was clicked.
pub fn segments(ui: &mut Ui, choices: &[(&str, &str)], chosen: Option<usize>) -> Option<usize> {
    segments_but(ui, choices, chosen, None)
}

/// [`segments`] of which one may not be clicked.
fn segments_but(
    ui: &mut Ui,
    choices: &[(&str, &str)],
    chosen: Option<usize>,
    refused: Option<usize>,
) -> Option<usize> {
    let mut clicked = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (index, (text, help)) in choices.iter().enumerate() {
            let button = Button::selectable(chosen == Some(index), *text).frame_when_inactive(true);
            let button = ui.add_enabled(refused != Some(index), button);
            if button.on_hover_text(*help).on_disabled_hover_text(*help).clicked() {
                clicked = Some(index);
            }
        }
    });
    clicked
}

/// Row for one of the names that a key of the scene file chooses among; whether it changed. More
/// names than a row has room for stand below the label.
pub fn choice<T>(ui: &mut Ui, name: &str, key: &str, value: &mut T) -> bool
where
    T: serde::Serialize + serde::de::DeserializeOwned,
{
    choice_but(ui, name, key, value, None)
}

/// [`choice`] without what may not be chosen beside the other settings, if there is such a name.
pub fn choice_but<T>(ui: &mut Ui, name: &str, key: &str, value: &mut T, refused: Option<T>) -> bool
where
    T: serde::Serialize + serde::de::DeserializeOwned,
{
    let explained = keys::explained_choices(key);
    let index_of = |value: &T| {
        let value = serde_json::to_value(value).ok();
        explained.iter().position(|(name, _)| value == Some((*name).into()))
    };
    let (chosen, refused) = (index_of(value), refused.as_ref().and_then(index_of));
    let names: Vec<String> = explained.iter().map(|(name, _)| choice_name(name)).collect();
    let choices: Vec<(&str, &str)> = std::iter::zip(&names, &explained)
        .map(|(name, (_, help))| (name.as_str(), *help))
        .collect();
    let help = key_help(key);
    let room: usize = names.iter().map(|name| name.len() + LETTERS_OF_FRAME).sum();
    let clicked = if room > ROOM_BESIDE_LABEL {
        row_label(ui, name, &help);
        ui.name_inputs(name, |ui| segments_but(ui, &choices, chosen, refused))
    } else {
        row(ui, name, &help, |ui| segments_but(ui, &choices, chosen, refused)).inner
    };
    let parsed = clicked
        .and_then(|index| explained.get(index))
        .and_then(|(name, _)| serde_json::from_value((*name).into()).ok());
    parsed.is_some_and(|parsed| {
        *value = parsed;
        true
    })
}

/// A choice of the scene file as buttons name it.
fn choice_name(name: &str) -> String {
    match name {
        "path" => "Path tracing".to_owned(),
        "march" => "Ray marching".to_owned(),
        "mis" => "MIS".to_owned(),
        "null" => "Null-collision".to_owned(),
        name => capitalized(name),
    }
}

/// A name that begins with a capital.
pub fn capitalized(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The one number that a slider shows for a color: its largest channel.
pub fn strength(color: Color) -> f32 {
    color.rgb().max_element()
}

/// `color` made as strong as `strength`, keeping its hue.
pub fn scaled(color: Color, strength: f32) -> Color {
    let present = color.rgb().max_element();
    match color {
        Color::Rgb(rgb) if present > 0.0 => Color::Rgb(rgb.map(|c| c * strength / present)),
        _ => Color::Gray(strength),
    }
}

/// Gray where the channels agree.
pub fn from_rgb(rgb: [f32; 3]) -> Color {
    let color = Color::Rgb(rgb);
    color.gray().map_or(color, Color::Gray)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        let texts = [0.0, 1.0, 12.5, 1500.0, 0.012_345, -0.5, 123_456.0].map(significant);
        assert_eq!(texts, ["0", "1", "12.5", "1500", "0.01235", "-0.5", "123456"]);
        assert_eq!([-1.19e-7, 3.2e9].map(significant), ["-1.2e-7", "3.2e9"]);
        for exponent in -12..12 {
            assert!(significant(-1.234_567 * 10.0_f64.powi(exponent)).len() <= 9);
        }
        assert_eq!(count(24_100_000.0), "24.1 M");
        assert_eq!(count(12.0), "12");
        assert_eq!(["1 500", "nan", "inf", "x"].map(finite), [Some(1500.0), None, None, None]);
    }
}
