//! What to begin with, and the picture alone on the screen.

use egui::ViewportCommand;
use egui_kittest::kittest::Queryable;

use super::*;

/// A window without a file, as at the first run.
fn first_run(folder: tempfile::TempDir) -> Option<Window> {
    Window::begin(folder, None, ([900.0, 600.0], 1.0))
}

#[test]
fn the_first_run_offers_scenes_and_a_click_opens_one() {
    let Some(mut window) = first_run(tempfile::tempdir().unwrap()) else { return };
    assert!(window.has("Start with a scene"));
    for name in scene::embedded_scenes() {
        let card = format!("Scene {name}");
        assert!(window.harness.query_by_role_and_label(Role::Button, &card).is_some(), "{name}");
    }
    window.click(Role::Button, "Scene plume");
    window.until("the plume is open", |app| {
        let volumes = &app.editor().document.settings.volume;
        volumes[0].file.as_deref() == Some("builtin:plume")
    });
    window.click(Role::CheckBox, "Show at start");
    window.press(Modifiers::NONE, Key::Escape);
    assert!(!window.has("Start with a scene"));
    window.press(Modifiers::SHIFT, Key::F1);
    assert!(window.has("Start with a scene"));

    window.harness.state_mut().as_mut().unwrap().close();
    let Window { harness, folder } = window;
    drop(harness);
    let Some(window) = first_run(folder) else { return };
    assert!(!window.has("Start with a scene"), "as it was told");
}

#[test]
fn who_names_a_file_sees_it_and_finds_it_again() {
    let Some(window) = Window::open(BALL) else { return };
    assert!(!window.has("Start with a scene"));
    let scene = window.folder.path().join("scene.toml");
    let mut window = window.restart(&scene);
    window.press(Modifiers::SHIFT, Key::F1);
    assert!(window.harness.query_by_role_and_label(Role::Button, "scene.toml").is_some());
}

#[test]
fn the_picture_takes_the_full_screen_and_gives_it_back() {
    let Some(mut window) = Window::open(BALL) else { return };
    let area = |window: &Window| {
        window.harness.get_by_role_and_label(Role::Image, "Picture").rect().size()
    };
    let before = area(&window);
    window.harness.input_mut().events.push(egui::Event::Key {
        key: Key::F11,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::NONE,
    });
    window.harness.step();
    let asked = window.harness.output().viewport_output[&egui::ViewportId::ROOT].commands.clone();
    assert!(asked.contains(&ViewportCommand::Fullscreen(true)), "{asked:?}");
    window.settle();
    let gained = area(&window) - before;
    assert!(gained.x > 300.0 && gained.y > 40.0, "of the panels and the bars: {gained:?}");
    assert!(window.harness.query_by_role_and_label(Role::Button, "File").is_none());
    window.press(Modifiers::NONE, Key::Escape);
    assert_eq!(area(&window), before);
}

#[test]
fn keys_orbit_pan_and_dolly_while_the_picture_has_the_focus() {
    let Some(mut window) = Window::open(BALL) else { return };
    let camera = |window: &Window| window.document().settings.camera.clone();
    let opened = camera(&window);
    window.press(Modifiers::NONE, Key::PageUp);
    assert_eq!(camera(&window), opened, "not before it has it");
    window.harness.get_by_role_and_label(Role::Image, "Picture").focus();
    window.settle();
    for (modifiers, key, name) in [
        (Modifiers::NONE, Key::ArrowRight, "orbit"),
        (Modifiers::NONE, Key::ArrowUp, "orbit"),
        (Modifiers::SHIFT, Key::ArrowLeft, "pan"),
        (Modifiers::NONE, Key::PageUp, "dolly"),
    ] {
        let before = camera(&window);
        window.press(modifiers, key);
        assert_ne!(camera(&window), before, "{key:?}");
        assert_eq!(window.app().editor().undo_name(), Some(name));
        assert_eq!(camera(&window).target != before.target, name == "pan");
    }
    let distance = |camera: flambeau::scene::settings::CameraSettings| {
        glam::Vec3::from(camera.position).distance(camera.target.into())
    };
    let ratio = distance(camera(&window)) / distance(opened);
    assert!((ratio - 0.9).abs() < 1e-3, "a notch closer: {ratio}");
}
