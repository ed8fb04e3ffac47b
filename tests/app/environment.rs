//! The environment in the lights panel, and pictures dropped for it.

use flambeau::scene::settings::{Color, EnvironmentSettings, WorldUp};

use super::*;

fn open() -> Option<Window> {
    let mut window = Window::open(BALL)?;
    window.click(Role::DisclosureTriangle, "Lights");
    Some(window)
}

fn environment(window: &Window) -> &EnvironmentSettings {
    &window.document().settings.environment
}

/// Runs frames until what was edited is what is rendered.
fn until_accepted(window: &mut Window) {
    window.until("the edit is built", |app| {
        let built = app.live_render().built().map(|built| &built.settings.environment);
        built == Some(&app.editor().document.settings.environment)
    });
    assert!(window.app().notices().list().is_empty(), "{:?}", window.app().notices().list());
}

fn set(window: &mut Window, name: &str, value: f64) {
    let field = window.harness.get_by_role_and_label(Role::SpinButton, name);
    field.set_value_accesskit(value);
    window.harness.step();
    window.settle();
}

/// A picture with one bright texel.
fn picture(window: &Window, name: &str) -> PathBuf {
    let path = window.folder.path().join(name);
    let pixels = [[9, 9, 9, 133], [9, 9, 9, 128]].concat();
    std::fs::write(&path, [b"#?RADIANCE\n\n-Y 1 +X 2\n".to_vec(), pixels].concat()).unwrap();
    path
}

#[test]
fn every_source_of_the_sky_is_chosen_edited_and_undone() {
    let Some(mut window) = open() else { return };
    set(&mut window, "Sky", 0.5);
    assert_eq!(environment(&window).radiance, Color::Gray(0.5));
    until_accepted(&mut window);

    window.click(Role::Button, "Gradient");
    let expected = [0.25, 0.5, 1.0].map(Color::Gray);
    assert_eq!(environment(&window).gradient, Some(expected), "about as bright as before");
    set(&mut window, "Top", 2.0);
    set(&mut window, "Sky exposure", 1.0);
    assert_eq!(environment(&window).gradient.unwrap()[2], Color::Gray(2.0));
    assert_eq!(environment(&window).exposure, 1.0);
    until_accepted(&mut window);

    window.click(Role::Button, "Clear sky");
    assert_eq!(environment(&window).gradient, None);
    set(&mut window, "Sun elevation", 12.0);
    set(&mut window, "Sky rotation", 45.0);
    window.click(Role::CheckBox, "Sun of the sky");
    window.click(Role::CheckBox, "Sky visible");
    window.click(Role::Button, "Y");
    let sky = environment(&window).sky.unwrap();
    assert_eq!((sky.sun_elevation, sky.sun), (12.0, false));
    assert!(!environment(&window).visible && environment(&window).rotation == 45.0);
    assert_eq!(window.document().settings.scene.up, WorldUp::Y);
    until_accepted(&mut window);

    for _ in 0..6 {
        window.press(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(environment(&window).gradient.unwrap()[2], Color::Gray(2.0));
    until_accepted(&mut window);
}

#[test]
fn pictures_become_the_environment_by_the_button_and_by_dropping_them() {
    let Some(mut window) = open() else { return };
    let first = picture(&window, "first.hdr");
    window.click(Role::Button, "Image");
    window.type_path(first.to_str().unwrap());
    assert_eq!(environment(&window).file.as_deref(), first.to_str());
    until_accepted(&mut window);
    assert!(window.has("first.hdr"));

    let second = picture(&window, "second.HDR");
    window.drop_file(second.clone());
    assert_eq!(environment(&window).file.as_deref(), second.to_str());
    until_accepted(&mut window);

    // An EXR may be a snapshot as well, so that it asks.
    let exr = window.save(Modifiers::COMMAND, "third.exr");
    window.drop_file(exr.clone());
    assert_eq!(environment(&window).file.as_deref(), second.to_str());
    window.click(Role::Button, "Use as environment");
    assert_eq!(environment(&window).file.as_deref(), exr.to_str());
    until_accepted(&mut window);
}
