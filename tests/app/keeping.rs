//! What must not get lost: changes of the scene, and what the window remembers between runs. And the
//! palette, which finds every command.

use egui::accesskit::Role;
use egui::{Key, Modifiers, ViewportCommand, ViewportEvent, ViewportId};
use egui_kittest::kittest::Queryable;
use flambeau::app::{App, Level};
use flambeau::image::tone::{Channel, Tone, ToneCurve};

use super::{BALL, Window};

const PALETTE: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

impl Window {
    /// Opens the field of view a little, which is a change of the scene.
    fn change(&mut self) {
        let before = self.document().settings.camera.fov_x;
        self.harness.get_by_role_and_label(Role::SpinButton, "Field of view").focus();
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

    fn has_lights_open(&self) -> bool {
        self.has("Add sun")
    }

    fn has_camera_open(&self) -> bool {
        self.harness.query_by_role_and_label(Role::SpinButton, "Field of view").is_some()
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
    assert!(window.has("scene.toml has unsaved changes."));
    window.click(Role::Button, "Cancel");
    assert!(!window.has("unsaved") && window.document().settings.volume[0].name == "ball");
    window.ask_for_other();
    window.click(Role::Button, "Open without saving");
    window.until_volume_is("other");
    assert!(!window.app().has_unsaved_changes());
}

#[test]
fn the_question_takes_the_keyboard_and_escape_is_an_answer() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.change();
    window.press(Modifiers::COMMAND, Key::L);
    window.type_path("/nowhere/nothing.toml");
    window.until("the failure is told", |app| !app.notices().list().is_empty());
    assert!(!window.has("unsaved"), "what is not there cannot take the place of anything");
    window.press(Modifiers::NONE, Key::F1);
    window.ask_for_other();
    assert!(window.has("unsaved"));
    assert!(window.harness.get_by_role_and_label(Role::Button, "Save scene…").is_focused());
    window.press(Modifiers::NONE, Key::Escape);
    assert!(window.has("unsaved") && !window.has("Orbit around the target"), "the front first");
    window.press(Modifiers::NONE, Key::Escape);
    assert!(!window.has("unsaved") && window.document().settings.volume[0].name == "ball");
}

/// Whatever control the keyboard goes to, it is in sight.
#[test]
fn what_the_keyboard_goes_to_is_in_sight() {
    let Some(mut window) = Window::open(BALL) else { return };
    let (mut seen, screen) = (0, window.harness.ctx.content_rect());
    for _ in 0..60 {
        window.press(Modifiers::NONE, Key::Tab);
        let focused = window.harness.ctx.memory(|memory| memory.focused());
        let control = focused.and_then(|id| window.harness.ctx.read_response(id));
        if let Some(control) = control {
            assert!(screen.contains_rect(control.rect), "{:?}", control.rect);
            seen += 1;
        }
    }
    assert!(seen > 40, "{seen}");
    window.press(Modifiers::NONE, Key::F6);
    assert!(window.harness.get_by_role_and_label(Role::Image, "Picture").is_focused());
}

#[test]
fn saving_the_scene_lets_another_one_open() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
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
    assert!(window.has("scene.toml has unsaved changes."));
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(!window.has("unsaved"), "nothing is left to lose");
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
    window.click(Role::DisclosureTriangle, "Lights");
    window.click(Role::DisclosureTriangle, "Camera");
    window.press(Modifiers::COMMAND, Key::Plus);
    let scale = window.harness.ctx.zoom_factor();
    window.press(Modifiers::NONE, Key::N);
    let mut window = window.restart(&scene);
    assert!(scale > 1.0 && window.harness.ctx.zoom_factor() == scale);
    let tone = window.document().tone;
    assert_eq!((tone.curve, tone.exposure), (ToneCurve::Agx, 0.5));
    assert!(window.document().settings.strategy.nee, "strategies are no preferences");
    assert!(window.harness.query_by_role_and_label(Role::Button, "Full").is_none(), "still folded");
    window.press(Modifiers::NONE, Key::N);
    assert!(window.has_lights_open() && !window.has_camera_open());
    window.click(Role::Button, "File");
    window.click(Role::Button, "Open recent");
    window.click(Role::Button, "other.toml");
    window.until_volume_is("other");
    assert!(other.ends_with("other.toml"));
}

#[test]
fn a_reset_brings_window_and_display_back_and_nothing_else() {
    let Some(mut window) = Window::open(BALL) else { return };
    let scale = window.harness.ctx.zoom_factor();
    window.press(Modifiers::COMMAND, Key::Minus);
    window.press(Modifiers::NONE, Key::E);
    window.press(Modifiers::NONE, Key::Num4);
    window.click(Role::DisclosureTriangle, "Lights");
    window.click(Role::DisclosureTriangle, "Camera");
    assert!(window.has_lights_open() && !window.has_camera_open());
    window.press(Modifiers::NONE, Key::N);
    window.press(PALETTE, Key::Num0);
    assert_eq!(window.harness.ctx.zoom_factor(), scale);
    assert_eq!(window.document().tone, Tone::default());
    assert!(!window.document().settings.strategy.nee, "no strategy is touched");
    assert!(!window.has_lights_open() && window.has_camera_open());
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.document().tone.exposure, 0.5, "it can be taken back");
    let scene = window.folder.path().join("scene.toml");
    let window = window.restart(&scene);
    assert!(!window.has_lights_open() && window.has_camera_open(), "nothing of it is kept");
}

#[test]
fn what_went_well_leaves_by_itself_and_failures_stay() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    window.press(Modifiers::COMMAND, Key::L);
    window.type_path("/nowhere/nothing.toml");
    window.until("the failure is told", |app| !app.notices().list().is_empty());
    window.save(Modifiers::COMMAND, "ball.exr");
    let levels = |app: &App| app.notices().list().iter().map(|n| n.level).collect::<Vec<_>>();
    assert_eq!(levels(window.app()), [Level::Failed, Level::Done]);
    window.until("it has left", |app| levels(app) == [Level::Failed]);
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
