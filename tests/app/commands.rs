//! Every command of the window, by the palette and by its key, in whatever state it comes.

use egui_kittest::kittest::Queryable;
use flambeau::app::Command;
use flambeau::image::tone::Channel;

use super::*;

const PALETTE: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

/// What is compared, or looked at, while a command comes.
#[derive(Clone, Copy, Debug)]
enum State {
    Strategies,
    Snapshot,
    Rectangle,
}

impl Window {
    fn is_in(&self, state: State) -> bool {
        match state {
            State::Strategies => self.document().compared.is_some(),
            State::Snapshot => self.app().second_side().stored.is_some(),
            State::Rectangle => self.app().region().is_set(),
        }
    }

    /// Brings it about, where the last command ended it.
    fn bring_about(&mut self, state: State) {
        if self.is_in(state) {
            return;
        }
        self.close_what_is_open();
        match state {
            State::Strategies => self.press(Modifiers::NONE, Key::C),
            State::Snapshot => {
                self.press(Modifiers::NONE, Key::ArrowLeft);
                self.press(Modifiers::SHIFT, Key::A);
            }
            State::Rectangle => {
                self.press(Modifiers::NONE, Key::M);
                self.click(Role::Button, "Place it");
            }
        }
        assert!(self.is_in(state), "{state:?}");
    }

    /// Closes what a command may have opened in front.
    fn close_what_is_open(&mut self) {
        for _ in 0..3 {
            self.press(Modifiers::NONE, Key::Escape);
        }
    }
}

#[test]
fn the_palette_finds_and_carries_out_every_command() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.until_finished();
    for command in Command::ALL {
        window.press(PALETTE, Key::P);
        let field = window.harness.get_by_role_and_label(Role::TextInput, "Command");
        field.type_text(command.text());
        window.settle();
        window.press(Modifiers::NONE, Key::Enter);
        let field = window.harness.query_by_role_and_label(Role::TextInput, "Command");
        let opens_itself = command == Command::Palette;
        assert_eq!(field.is_some(), opens_itself, "{}", command.text());
        match command {
            Command::FalseColor => {
                assert_eq!(window.document().tone.channel, Channel::FalseColor);
            }
            Command::Shortcuts => assert!(window.has("Orbit around the target")),
            Command::Compare => assert!(window.document().compared.is_some()),
            Command::OpenPath | Command::SaveExr | Command::LoadReference => {
                assert!(window.harness.query_by_role_and_label(Role::TextInput, "Path").is_some());
            }
            _ => {}
        }
        window.close_what_is_open();
    }
}

#[test]
fn every_key_is_taken_while_strategies_and_snapshots_are_compared() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.until_finished();
    window.keep("scene full");
    for state in [State::Strategies, State::Snapshot, State::Rectangle] {
        for command in Command::ALL {
            // Right behind the command that deletes it.
            if command != Command::UndoDelete {
                window.bring_about(state);
            }
            let shortcut = command.shortcut();
            window.press(shortcut.modifiers, shortcut.logical_key);
            if window.harness.query_by_role_and_label(Role::TextInput, "Path").is_some() {
                window.close_what_is_open();
            }
            assert!(window.app().engine().picture().is_some(), "{state:?}, {}", command.text());
        }
    }
}
