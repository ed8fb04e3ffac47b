//! The camera's keys over the frames, and its focus.

use egui_kittest::kittest::Queryable;

use super::*;

/// A window on a scene of four frames.
fn window() -> Option<Window> {
    let mut window = Window::open(&format!("{BALL}\n[time]\nrange = [1, 4]\n"))?;
    window.click(Role::Button, "Fixed");
    Some(window)
}

/// Orbits by the keyboard.
fn orbit(window: &mut Window) {
    window.press(Modifiers::NONE, Key::F6);
    window.press(Modifiers::NONE, Key::ArrowLeft);
}

#[test]
fn a_camera_with_keys_gets_one_where_it_is_moved() {
    let Some(mut window) = window() else { return };
    let keys = |window: &Window| window.document().settings.camera.key.clone();
    let place = |window: &Window| window.document().settings.present_camera().position;
    let opened = place(&window);
    assert!(window.has("none: the camera stands still"));
    window.click(Role::Button, "Set key");
    assert_eq!(keys(&window).len(), 1);
    window.press(Modifiers::NONE, Key::Period);
    assert_eq!(place(&window), opened);
    window.press(Modifiers::NONE, Key::Period);
    orbit(&mut window);
    let moved = place(&window);
    assert_ne!(moved, opened);
    assert_eq!(keys(&window).iter().map(|key| key.frame).collect::<Vec<_>>(), [1.0, 3.0]);
    window.press(Modifiers::NONE, Key::Comma);
    let between = place(&window);
    assert!(between != opened && between != moved, "half of the way");
    window.until_finished();
    window.press(Modifiers::NONE, Key::Comma);
    assert_eq!(place(&window), opened);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(keys(&window).len(), 1, "undone");
    window.press(Modifiers::NONE, Key::I);
    assert_eq!(keys(&window).len(), 0);
    assert_eq!(place(&window), opened);
}

/// The ball glows all through, so that its middle is what is seen.
#[test]
fn a_click_focuses_on_what_is_seen_there() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    let focus = |window: &Window| window.document().settings.camera.focus_distance;
    window.press(Modifiers::SHIFT, Key::F);
    window.press(Modifiers::NONE, Key::Escape);
    let area = window.harness.get_by_role_and_label(Role::Image, "Picture").rect();
    click(&mut window, area.center());
    assert_eq!(focus(&window), None, "canceled");
    window.press(Modifiers::SHIFT, Key::F);
    click(&mut window, area.center());
    let distance = focus(&window).unwrap();
    assert!((4.0..5.0).contains(&distance), "{distance}");
    assert!(window.has("A pinhole has everything in focus"));
    window.press(Modifiers::SHIFT, Key::F);
    let enlarged = (area.width() / 64.0).min(area.height() / 48.0).floor();
    click(&mut window, area.center() - egui::vec2(30.0 * enlarged, 0.0));
    assert_eq!(focus(&window), Some(distance));
    window.until_it_says("Nothing is seen there");
}

fn click(window: &mut Window, at: egui::Pos2) {
    window.harness.hover_at(at);
    window.harness.step();
    window.harness.drag_at(at);
    window.harness.step();
    window.harness.drop_at(at);
    window.harness.step();
    window.settle();
}

/// Another last frame makes a time line, by hand as from a file.
#[test]
fn frames_can_be_given_to_a_still_scene() {
    let Some(mut window) = Window::open(BALL) else { return };
    assert!(!window.has("of 1–"));
    let field = window.harness.get_by_role_and_label(Role::SpinButton, "Last frame");
    field.focus();
    window.harness.step();
    window.press(Modifiers::NONE, Key::ArrowUp);
    window.until("there is a time line", |app| app.time_line().range().is_some());
    let range = window.document().settings.time.range.unwrap();
    assert!(range[0] == 1 && range[1] > 1, "{range:?}");
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.document().settings.time.range, None);
}
