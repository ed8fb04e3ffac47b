//! What must not get lost: changes of the scene, and what the window remembers between runs. And the
//! palette, which finds every command.

use egui::accesskit::Role;
use egui::{Key, Modifiers, ViewportCommand, ViewportEvent, ViewportId};
use egui_kittest::kittest::Queryable;
use flambeau::image::tone::{Channel, ToneCurve};

use super::{BALL, Window};

const PALETTE: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

impl Window {
    /// Opens the field of view a little, which is a change of the scene.
    fn change(&mut self) {
        let before = self.document().settings.camera.fov_x;
        self.harness.get_by_role_and_label(Role::SpinButton, "Angle of view").focus();
        self.settle();
        self.press(Modifiers::NONE, Key::ArrowUp);
        assert_ne!(self.document().settings.camera.fov_x, before);
        self.harness.get_by_role_and_label(Role::Button, "Full").focus();
        self.settle();
        self.press(Modifiers::NONE, Key::Escape);
        assert!(self.app().has_unsaved_changes());
    }

    /// Asks to open another scene by a typed path.
    fn ask_for_other(&mut self) -> String {
        let other = self.folder.path().join("other.toml");
        std::fs::write(&other, BALL.replace("\"ball\"", "\"other\"")).unwrap();
        self.press(Modifiers::COMMAND, Key::L);
        self.type_path(other.to_str().unwrap());
        self.settle();
        other.to_string_lossy().into_owned()
    }

    fn until_volume_is(&mut self, name: &str) {
        self.until("the scene is open", |app| {
            app.editor().document.settings.volume[0].name == name
        });
    }

    /// Whether the window asked to close, or not to, in a frame in which its button was pressed.
    fn close_button(&mut self) -> Vec<ViewportCommand> {
        let viewports = &mut self.harness.input_mut().viewports;
        viewports.entry(ViewportId::ROOT).or_default().events.push(ViewportEvent::Close);
        self.harness.step();
        let commands = self.harness.output().viewport_output[&ViewportId::ROOT].commands.clone();
        let viewports = &mut self.harness.input_mut().viewports;
        viewports.entry(ViewportId::ROOT).or_default().events.clear();
        self.settle();
        commands
    }
}

#[test]
fn changes_are_asked_about_before_another_scene_opens() {
    let Some(mut window) = Window::open(BALL) else { return };
    assert!(!window.app().has_unsaved_changes());
    window.press(Modifiers::NONE, Key::Num4);
    assert!(!window.app().has_unsaved_changes(), "strategies are tried all the time");
    window.change();
    window.ask_for_other();
    assert!(window.has("scene.toml has changes that are not saved."));
    window.click(Role::Button, "Cancel");
    assert!(!window.has("not saved") && window.document().settings.volume[0].name == "ball");
    window.ask_for_other();
    window.click(Role::Button, "Open without saving");
    window.until_volume_is("other");
    assert!(!window.app().has_unsaved_changes());
}

#[test]
fn saving_the_scene_lets_another_one_open() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.until_finished();
    window.change();
    window.ask_for_other();
    window.click(Role::Button, "Save scene…");
    let path = window.folder.path().join("saved.toml");
    window.type_path(path.to_str().unwrap());
    window.until_volume_is("other");
    assert!(std::fs::read_to_string(path).unwrap().contains("ball"));
}

#[test]
fn a_window_with_changes_asks_before_it_closes() {
    let Some(mut window) = Window::open(BALL) else { return };
    assert!(!window.close_button().contains(&ViewportCommand::CancelClose));
    window.change();
    assert!(window.close_button().contains(&ViewportCommand::CancelClose));
    assert!(window.has("scene.toml has changes that are not saved."));
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(!window.has("not saved"), "nothing is left to lose");
    window.change();
    window.close_button();
    window.harness.get_by_role_and_label(Role::Button, "Close without saving").click();
    window.harness.step();
    window.harness.step();
    assert!(!window.close_button().contains(&ViewportCommand::CancelClose));
}

#[test]
fn display_layout_and_files_are_there_again_after_a_restart() {
    let Some(mut window) = Window::open(BALL) else { return };
    let scene = window.folder.path().join("scene.toml");
    let other = window.ask_for_other();
    window.until_volume_is("other");
    window.press(Modifiers::NONE, Key::T);
    window.press(Modifiers::NONE, Key::E);
    window.press(Modifiers::NONE, Key::Num4);
    window.press(Modifiers::NONE, Key::N);
    let mut window = window.restart(&scene);
    let tone = window.document().tone;
    assert_eq!((tone.curve, tone.exposure), (ToneCurve::Agx, 0.5));
    assert!(window.document().settings.strategy.nee, "strategies are never remembered");
    assert!(window.harness.query_by_role_and_label(Role::Button, "Full").is_none(), "still folded");
    window.click(Role::Button, "File");
    window.click(Role::Button, "Open recent");
    window.click(Role::Button, "other.toml");
    window.until_volume_is("other");
    assert!(other.ends_with("other.toml"));
}

#[test]
fn the_palette_carries_out_what_is_typed() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.press(PALETTE, Key::P);
    window.harness.get_by_role_and_label(Role::TextInput, "Command").type_text("false col");
    window.settle();
    window.press(Modifiers::NONE, Key::Enter);
    assert_eq!(window.document().tone.channel, Channel::FalseColor);
    assert!(window.harness.query_by_role_and_label(Role::TextInput, "Command").is_none());
    window.press(PALETTE, Key::P);
    window.press(Modifiers::NONE, Key::Escape);
    assert!(window.harness.query_by_role_and_label(Role::TextInput, "Command").is_none());
    window.press(PALETTE, Key::P);
    window.harness.get_by_role_and_label(Role::TextInput, "Command").type_text("exposure");
    window.settle();
    window.press(Modifiers::NONE, Key::ArrowDown);
    window.press(Modifiers::NONE, Key::Enter);
    assert_ne!(window.document().tone.exposure, 0.0, "the second of those it finds");
}
