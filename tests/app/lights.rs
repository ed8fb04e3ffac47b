//! The lights panel and the handles over the picture.

use flambeau::scene::settings::{LightKind, LightSettings};

use super::*;

/// A window with one light of a kind, selected.
fn with_light(kind: &str) -> Option<Window> {
    let mut window = Window::open(BALL)?;
    window.click(Role::DisclosureTriangle, "Lights");
    window.click(Role::Button, kind);
    // There are handles only where there is a picture.
    window.until("there is a picture", |app| app.live_render().picture().is_some());
    Some(window)
}

fn lights(window: &Window) -> &[LightSettings] {
    &window.document().settings.light
}

/// Runs frames until what was edited is what is rendered.
fn until_accepted(window: &mut Window) {
    window.until("the edit is built", |app| {
        let built = app.live_render().built().map(|built| &built.settings.light);
        built == Some(&app.editor().document.settings.light)
    });
    assert!(window.app().notices().list().is_empty(), "{:?}", window.app().notices().list());
}

/// Drags with the primary button.
fn drag(window: &mut Window, from: egui::Pos2, way: egui::Vec2) {
    window.harness.hover_at(from);
    window.harness.step();
    window.harness.drag_at(from);
    for step in 1..5 {
        window.harness.hover_at(from + way * (step as f32 / 4.0));
    }
    window.harness.drop_at(from + way);
    window.harness.step();
    window.settle();
}

#[test]
fn lights_are_added_duplicated_and_deleted_and_undo_takes_it_back() {
    let Some(mut window) = with_light("Add point") else { return };
    assert_eq!(lights(&window).len(), 1);
    until_accepted(&mut window);
    window.click(Role::Button, "Duplicate light");
    assert_eq!(lights(&window).len(), 2);
    assert_eq!(lights(&window)[0], lights(&window)[1]);
    window.click(Role::Button, "Delete light");
    assert_eq!(lights(&window).len(), 1);
    assert!(window.harness.query_by_label("Delete light").is_none(), "nothing is selected");
    for count in [2, 1, 0] {
        window.press(Modifiers::COMMAND, Key::Z);
        assert_eq!(lights(&window).len(), count);
    }
    window.press(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert_eq!(lights(&window)[0].kind, LightKind::Point);
}

#[test]
fn handles_go_away_with_escape_and_with_a_click_beside_them() {
    let Some(mut window) = with_light("Add point") else { return };
    let has_handles = |window: &Window| window.harness.query_by_label("Move light").is_some();
    assert!(has_handles(&window));
    window.press(Modifiers::NONE, Key::F11);
    assert!(!has_handles(&window), "nothing but the picture on the full screen");
    window.press(Modifiers::NONE, Key::Escape);
    assert!(has_handles(&window));
    window.press(Modifiers::NONE, Key::Escape);
    assert!(!has_handles(&window));
    window.click(Role::Button, "Point 1");
    assert!(has_handles(&window));
    let picture = window.harness.get_by_role_and_label(Role::Image, "Picture").rect();
    let beside = picture.left_top() + egui::vec2(8.0, 8.0);
    window.harness.drag_at(beside);
    window.harness.drop_at(beside);
    window.settle();
    assert!(!has_handles(&window));
    assert_eq!(lights(&window).len(), 1);
}

#[test]
fn every_kind_of_light_can_be_built_and_changed_into_every_other() {
    let Some(mut window) = with_light("Add spot") else { return };
    let stood = lights(&window)[0].position;
    for (name, kind) in [
        ("Sphere light", LightKind::Sphere),
        ("Area light", LightKind::Quad),
        ("Sun", LightKind::Sun),
        ("Point", LightKind::Point),
        ("Spot", LightKind::Spot),
    ] {
        window.click(Role::Button, name);
        assert_eq!(lights(&window)[0].kind, kind);
        until_accepted(&mut window);
        if kind == LightKind::Sphere {
            assert_eq!(lights(&window)[0].center, stood, "it stays where it was");
        }
    }
    let slider = window.harness.get_by_role_and_label(Role::SpinButton, "Cone");
    slider.set_value_accesskit(60.0);
    window.harness.step();
    window.settle();
    assert_eq!(lights(&window)[0].cone(), 60.0);
    until_accepted(&mut window);
}

#[test]
fn a_handle_moves_the_light_and_leaves_the_camera_alone() {
    let Some(mut window) = with_light("Add point") else { return };
    let camera = window.document().settings.camera.clone();
    let before = lights(&window)[0].position();
    let handle = |window: &Window, name: &str| {
        window.harness.get_by_role_and_label(Role::Button, name).rect().center()
    };
    let from = handle(&window, "Move light");
    let way = egui::vec2(40.0, 30.0);
    drag(&mut window, from, way);
    let after = lights(&window)[0].position();
    assert!(after[0] > before[0] && after[2] < before[2], "{before:?} to {after:?}");
    assert_eq!(window.document().settings.camera, camera);
    let to = handle(&window, "Move light");
    assert!(to.distance(from + way) < 1.5, "it follows the hand: {from:?} to {to:?}");

    // Along one axis the other two coordinates stay.
    let arm = handle(&window, "Move light along z");
    drag(&mut window, arm, egui::vec2(6.0, -30.0));
    let raised = lights(&window)[0].position();
    assert!(raised[2] > after[2] && raised[..2] == after[..2], "{after:?} to {raised:?}");

    // Each drag is one edit.
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(lights(&window)[0].position(), after);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(lights(&window)[0].position(), before);

    // Keys move the one that has the focus.
    window.harness.get_by_role_and_label(Role::Button, "Move light").focus();
    window.settle();
    window.press(Modifiers::NONE, Key::ArrowRight);
    assert!(lights(&window)[0].position()[0] > before[0]);
    assert_eq!(window.document().settings.camera, camera);
    window.press(Modifiers::COMMAND, Key::Z);

    // Beside the handles the hand orbits as ever.
    let corner = window.harness.get_by_role_and_label(Role::Image, "Picture").rect().right_bottom();
    drag(&mut window, corner - egui::vec2(60.0, 60.0), egui::vec2(-50.0, 0.0));
    assert_eq!(lights(&window)[0].position(), before);
    assert_ne!(window.document().settings.camera, camera);

    // Without a selection there is nothing over the picture.
    window.click(Role::Button, "Point 1");
    assert!(window.harness.query_by_label("Move light").is_none());
}

#[test]
fn spots_are_aimed_and_suns_turned_over_the_picture() {
    let Some(mut window) = with_light("Add spot") else { return };
    let spot = lights(&window)[0].clone();
    let target = window.harness.get_by_role_and_label(Role::Button, "Aim light").rect().center();
    drag(&mut window, target, egui::vec2(30.0, 0.0));
    assert_eq!(lights(&window)[0].position, spot.position);
    assert!(lights(&window)[0].target()[0] > spot.target()[0]);

    window.click(Role::Button, "Sun");
    let sun = lights(&window)[0].direction();
    let tail = window.harness.get_by_role_and_label(Role::Button, "Turn sun").rect().center();
    drag(&mut window, tail, egui::vec2(25.0, 0.0));
    let turned = lights(&window)[0].direction();
    assert!(turned[0] < sun[0], "the sun went to the right: {sun:?} to {turned:?}");
}

/// Where frames are long, a press and the moves after it come in one.
#[test]
fn a_fast_hand_on_a_slow_machine_moves_the_light_and_not_the_camera() {
    let Some(mut window) = with_light("Add point") else { return };
    let camera = window.document().settings.camera.clone();
    let before = lights(&window)[0].position();
    let handle = window.harness.get_by_role_and_label(Role::Button, "Move light");
    let from = handle.rect().center();
    let button = |pos, pressed| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let to = from + egui::vec2(90.0, 60.0);
    window.harness.hover_at(from);
    window.harness.step();
    let events = &mut window.harness.input_mut().events;
    events.extend([button(from, true), egui::Event::PointerMoved(to)]);
    window.harness.step();
    window.harness.hover_at(to + egui::vec2(10.0, 0.0));
    window.harness.step();
    window.harness.input_mut().events.push(button(to + egui::vec2(10.0, 0.0), false));
    window.harness.step();
    window.settle();
    assert_ne!(lights(&window)[0].position(), before);
    assert_eq!(window.document().settings.camera, camera);
}
