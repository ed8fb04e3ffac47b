//! The film panel: what is typed, and what a double click goes back to.

use super::*;

#[test]
fn bounces_are_typed_and_a_double_click_on_the_name_takes_them_back() {
    let scene = format!("{BALL}\n[path]\nmax_scatters = 7\n");
    let Some(mut window) = Window::open(&scene) else { return };
    let bounces = |window: &Window| window.document().settings.path.max_scatters;
    let field = window.harness.get_by_role_and_label(Role::SpinButton, "Max bounces");
    field.scroll_to_me();
    window.settle();
    window.harness.get_by_role_and_label(Role::SpinButton, "Max bounces").set_value_accesskit(2.0);
    window.harness.step();
    window.settle();
    assert_eq!(bounces(&window), 2);
    window.until("the edit is built", |app| {
        app.live_render().built().is_some_and(|built| built.settings.path.max_scatters == 2)
    });
    let name = window.harness.get_by_role_and_label(Role::Label, "Max bounces").rect().center();
    window.harness.hover_at(name);
    window.harness.step();
    for pressed in [true, false, true, false] {
        // All in one frame: frames of the harness are far apart.
        window.harness.input_mut().events.push(egui::Event::PointerButton {
            pos: name,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }
    window.harness.step();
    window.settle();
    assert_eq!(bounces(&window), 7);
}
