//! The file of the scene that is open, written again by another program or by the window itself.

use super::*;

fn density(app: &App) -> Option<f32> {
    app.editor().document.settings.volume[0].density.scale.gray()
}

/// Writes the scene with another density.
fn write(window: &Window, density: f32) {
    let text = BALL.replace("scale = 2.0", &format!("scale = {density:?}"));
    std::fs::write(window.folder.path().join("scene.toml"), text).unwrap();
}

fn edit_density(window: &mut Window, density: f64) {
    let slider = window.harness.get_by_role_and_label(Role::Slider, "Density");
    slider.set_value_accesskit(density);
    window.harness.step();
    window.settle();
}

/// Runs frames for longer than a change takes to be noticed.
fn wait(window: &mut Window) {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(4) {
        std::thread::sleep(Duration::from_millis(50));
        window.settle();
    }
}

#[test]
fn a_scene_that_is_written_again_is_taken_with_the_look_as_it_is() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.press(Modifiers::NONE, Key::E);
    window.press(Modifiers::NONE, Key::C);
    window.press(Modifiers::NONE, Key::Num1);
    let look = |window: &Window| {
        let Document { settings, tone, compared, .. } = window.document();
        (*tone, *compared, settings.strategy)
    };
    let before = look(&window);
    assert!(before.1.is_some() && !window.app().has_unsaved_changes());
    write(&window, 3.0);
    window.until("the file is read", |app| density(app) == Some(3.0));
    assert!(window.has("scene.toml has changed on the disk and was read again."));
    assert!(look(&window) == before && !window.app().has_unsaved_changes());
    window.until("it is rendered", |app| {
        let built = app.live_render().built();
        built.is_some_and(|built| built.settings.volume[0].density.scale.gray() == Some(3.0))
    });
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!((density(window.app()), window.app().has_unsaved_changes()), (Some(2.0), true));
}

#[test]
fn changes_here_are_not_lost_to_a_change_on_the_disk() {
    let Some(mut window) = Window::open(BALL) else { return };
    edit_density(&mut window, 5.0);
    write(&window, 3.0);
    window.until_it_says("has changed on the disk, and has unsaved changes here.");
    assert_eq!(density(window.app()), Some(5.0));
    window.click(Role::Button, "Keep");
    assert!(window.app().has_unsaved_changes() && !window.has("has changed on the disk"));
    write(&window, 4.0);
    window.until_it_says("has changed on the disk, and has unsaved changes here.");
    window.click(Role::Button, "Reload");
    assert_eq!((density(window.app()), window.app().has_unsaved_changes()), (Some(4.0), false));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(density(window.app()), Some(5.0));
}

#[test]
fn a_broken_file_leaves_the_scene_as_it_is() {
    let Some(mut window) = Window::open(BALL) else { return };
    std::fs::write(window.folder.path().join("scene.toml"), "[camera").unwrap();
    window.until_it_says("The scene has changed on the disk.");
    assert!(window.has("scene.toml") && density(window.app()) == Some(2.0));
    write(&window, 3.0);
    window.until("the file is read", |app| density(app) == Some(3.0));
}

#[test]
fn what_the_window_saves_and_what_is_written_unchanged_is_no_change() {
    let Some(mut window) = Window::open(BALL) else { return };
    edit_density(&mut window, 5.0);
    let path = window.folder.path().join("scene.toml");
    window.press(Modifiers::COMMAND.plus(Modifiers::ALT), Key::S);
    window.type_path(path.to_str().unwrap());
    assert!(window.has("This file exists. Save again to replace it."));
    window.press(Modifiers::NONE, Key::Enter);
    window.until_it_says("Saved");
    edit_density(&mut window, 6.0);
    wait(&mut window);
    assert!(!window.has("has changed on the disk") && density(window.app()) == Some(6.0));
    let text = std::fs::read(&path).unwrap();
    std::fs::write(&path, text).unwrap();
    wait(&mut window);
    assert!(!window.has("has changed on the disk") && density(window.app()) == Some(6.0));
}
