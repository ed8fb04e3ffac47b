//! The surfaces panel.

use flambeau::scene::settings::{MaterialKind, SurfaceSettings, SurfaceShape};

use super::*;

fn surfaces(window: &Window) -> &[SurfaceSettings] {
    &window.document().settings.surface
}

fn until_accepted(window: &mut Window) {
    window.until("the edit is built", |app| {
        let built = app.live_render().built().map(|built| &built.settings.surface);
        built == Some(&app.editor().document.settings.surface)
    });
    assert!(window.app().notices().list().is_empty(), "{:?}", window.app().notices().list());
}

#[test]
fn one_click_places_a_floor_under_the_volume() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::DisclosureTriangle, "Surfaces");
    window.click(Role::Button, "Add floor");
    let floor = &surfaces(&window)[0];
    let ([x, y, z], [_, _, up]) = (floor.point(), floor.normal());
    assert!((x, y, up) == (0.0, 0.0, 1.0) && z < -1.0 && z > -1.01, "{floor:?}");
    until_accepted(&mut window);
    assert_eq!(window.app().editor().undo_name(), Some("add a floor"));

    window.click(Role::Button, "Metal");
    assert_eq!(surfaces(&window)[0].material.unwrap().kind, MaterialKind::Conductor);
    until_accepted(&mut window);
    window.click(Role::Button, "Black");
    until_accepted(&mut window);
    for _ in 0..3 {
        window.press(Modifiers::COMMAND, Key::Z);
    }
    assert!(surfaces(&window).is_empty());
}

#[test]
fn every_shape_can_be_added_changed_and_deleted() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::DisclosureTriangle, "Surfaces");
    window.click(Role::Button, "Add sphere surface");
    assert_eq!(surfaces(&window)[0].shape, SurfaceShape::Sphere);
    let center = surfaces(&window)[0].center;
    until_accepted(&mut window);
    for (name, shape) in [
        ("Box", SurfaceShape::Box),
        ("Quad", SurfaceShape::Quad),
        ("Plane", SurfaceShape::Plane),
        ("Sphere", SurfaceShape::Sphere),
    ] {
        window.click(Role::Button, name);
        assert_eq!(surfaces(&window)[0].shape, shape);
        until_accepted(&mut window);
    }
    assert_eq!(surfaces(&window)[0].center, center, "it stays where it was");
    window.click(Role::Button, "Delete surface");
    assert!(surfaces(&window).is_empty());
    until_accepted(&mut window);
}
