//! The palette: every command by a few letters of its name.

use egui::{Align2, Button, Context, Key, RichText, ScrollArea, TextEdit, Ui, Window, vec2};

use crate::app::command::Command;
use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::key_of;

/// Width of the palette and height of its list, in points.
const SIZE: egui::Vec2 = vec2(380.0, 300.0);

/// The palette with the text typed so far and the command chosen.
#[derive(Debug, Default)]
pub struct Palette {
    text: String,
    chosen: usize,
    shown: bool,
}

/// The outcome of a frame of the palette.
#[derive(Debug, PartialEq, Eq)]
pub enum PaletteChoice {
    /// The palette is still open.
    Pending,
    /// A command was chosen.
    Done(Command),
    /// The palette was left.
    Left,
}

impl Palette {
    /// Shows the palette over the upper part of the picture.
    pub fn show(&mut self, ctx: &Context) -> PaletteChoice {
        let mut open = true;
        let window = Window::new("All commands")
            .open(&mut open)
            .resizable(false)
            .collapsible(false)
            .anchor(Align2::CENTER_TOP, vec2(0.0, 64.0));
        let shown = window.show(ctx, |ui| self.contents(ui));
        let left = !open || ctx.input(|input| input.key_pressed(Key::Escape));
        match shown.and_then(|shown| shown.inner) {
            Some(Some(command)) => PaletteChoice::Done(command),
            _ if left => PaletteChoice::Left,
            _ => PaletteChoice::Pending,
        }
    }

    fn contents(&mut self, ui: &mut Ui) -> Option<Command> {
        ui.set_width(SIZE.x);
        let moved = self.moved(ui);
        let edit = TextEdit::singleline(&mut self.text)
            .hint_text("Type a few letters, then press Enter")
            .desired_width(f32::INFINITY);
        let field = ui.add(edit).accessible_name("Command");
        if !std::mem::replace(&mut self.shown, true) {
            field.request_focus();
        }
        if field.changed() {
            self.chosen = 0;
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let found = found(&self.text);
        self.chosen = self.chosen.saturating_add_signed(moved).min(found.len().saturating_sub(1));
        if found.is_empty() {
            ui.label(RichText::new("No command matches.").color(color::TEXT_DIM));
        }
        let mut clicked = None;
        ScrollArea::vertical().max_height(SIZE.y).auto_shrink([false, true]).show(ui, |ui| {
            for (index, &command) in found.iter().enumerate() {
                let response = item(ui, command, index == self.chosen);
                if index == self.chosen && moved != 0 {
                    response.scroll_to_me(None);
                }
                if response.clicked() {
                    clicked = Some(command);
                }
            }
        });
        clicked.or_else(|| found.get(self.chosen).copied().filter(|_| entered))
    }

    /// Number of rows by which the arrow keys move the choice.
    fn moved(&self, ui: &Ui) -> isize {
        ui.input_mut(|input| {
            let mut count = |key| input.count_and_consume_key(egui::Modifiers::NONE, key) as isize;
            count(Key::ArrowDown) - count(Key::ArrowUp)
        })
    }
}

fn item(ui: &mut Ui, command: Command, chosen: bool) -> egui::Response {
    let key = RichText::new(key_of(ui, command)).color(color::TEXT_DIM);
    let button = Button::selectable(chosen, command.text())
        .shortcut_text(key)
        .min_size(vec2(ui.available_width(), space::ROW_HEIGHT));
    ui.add(button).on_hover_text(command.tooltip())
}

/// The commands that have every word of `text` in their name, those first whose name begins with
/// it; then those that have it in their help.
fn found(text: &str) -> Vec<Command> {
    let text = text.trim().to_lowercase();
    let rank = |command: Command| {
        let (name, help) = (command.text().to_lowercase(), command.tooltip().to_lowercase());
        let has_all = |place: &str| text.split_whitespace().all(|word| place.contains(word));
        match () {
            () if name.starts_with(&text) => Some(0),
            () if has_all(&name) => Some(1),
            () if has_all(&help) => Some(2),
            () => None,
        }
    };
    let mut ranked: Vec<(i32, Command)> = Command::all()
        .filter(|command| *command != Command::Palette)
        .filter_map(|command| rank(command).map(|rank| (rank, command)))
        .collect();
    ranked.sort_by_key(|(rank, _)| *rank);
    ranked.into_iter().map(|(_, command)| command).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_found_by_its_name_and_some_by_a_few_letters() {
        assert_eq!(found("").len(), Command::all().count() - 1, "all but the palette itself");
        for command in Command::all().filter(|command| *command != Command::Palette) {
            assert_eq!(found(command.text()).first(), Some(&command), "{command:?}");
        }
        assert_eq!(found("undo")[0], Command::Undo);
        assert_eq!(found("PNG save")[0], Command::SavePng);
        assert_eq!(found("  next tone")[0], Command::NextToneCurve);
        assert!(found("half a stop").contains(&Command::ExposureUp), "by its help");
        assert!(found("no such thing").is_empty());
    }
}
