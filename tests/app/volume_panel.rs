//! The volume panel: grids, guesses, the conventions of programs, and the ramp editor.

use flambeau::scene::settings::{EmissionMode, VolumeSettings};

use super::*;

/// A window on a bare volume of the project, of which everything is guessed.
fn bare_torch() -> Option<Window> {
    let mut window = Window::start(tempfile::tempdir().unwrap(), Path::new("builtin:torch_hd"))?;
    // The picture does not matter here.
    window.press(Modifiers::NONE, Key::Space);
    window.until_it_says("density as density");
    Some(window)
}

fn volume(window: &Window) -> &VolumeSettings {
    &window.document().settings.volume[0]
}

/// Runs frames until what was edited is what is rendered.
fn until_accepted(window: &mut Window) {
    window.until("the edit is built", |app| {
        let built = app.live_render().built().map(|built| &built.settings.volume);
        built == Some(&app.editor().document.settings.volume)
    });
    assert!(window.app().notices().list().is_empty(), "{:?}", window.app().notices().list());
}

#[test]
fn a_wrong_guess_is_one_click_to_mend() {
    let Some(mut window) = bare_torch() else { return };
    for grid in ["density", "flame", "temperature"] {
        let name = format!("Histogram of {grid}");
        assert!(window.harness.query_by_role_and_label(Role::Image, &name).is_some());
    }
    assert_eq!(volume(&window).emission.mode, EmissionMode::Blackbody);
    assert!(window.has("Guessed: \"temperature\" is a temperature"));
    assert_eq!(window.harness.query_all_by_label("guess").count(), 3, "two grids and the up axis");
    assert_eq!(window.harness.query_all_by_label("not used").count(), 1, "one of three grids");

    window.click(Role::Button, "flame as flame");
    assert_eq!(volume(&window).emission.mode, EmissionMode::Ramp);
    assert_eq!(volume(&window).emission_grid(), Some("flame"));
    assert!(!window.has("Guessed: \"temperature\""), "it is no guess any more");
    assert!(window.has("Changed since: guessed: \"temperature\""));
    assert_eq!(window.harness.query_all_by_label("guess").count(), 2);
    until_accepted(&mut window);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(volume(&window).emission.mode, EmissionMode::Blackbody);
    assert_eq!(window.harness.query_all_by_label("guess").count(), 3);

    window.click(Role::Button, "flame as density");
    assert_eq!(volume(&window).density_grid(), "flame");
    until_accepted(&mut window);
}

#[test]
fn a_program_is_one_click_for_all_that_its_files_have_in_common() {
    let Some(mut window) = bare_torch() else { return };
    window.click(Role::Button, "Houdini");
    assert_eq!(volume(&window).rotate, [90.0, 0.0, 0.0], "y is up");
    assert_eq!(volume(&window).emission.kelvin_scale(), 840.0);
    until_accepted(&mut window);
    window.click(Role::Button, "EmberGen");
    assert_eq!(volume(&window).rotate, [0.0; 3]);
    assert_eq!(volume(&window).emission_grid(), Some("flame"));
    until_accepted(&mut window);
    window.click(Role::Button, "Blender");
    assert_eq!(volume(&window).emission.kelvin_scale(), 1000.0);
    until_accepted(&mut window);
}

/// Keys of the mode before would be refused.
#[test]
fn a_new_emission_mode_leaves_nothing_of_the_old_one() {
    let Some(mut window) = bare_torch() else { return };
    window.click(Role::Button, "flame as flame");
    for (name, mode) in [
        ("grid", EmissionMode::Grid),
        ("source", EmissionMode::Source),
        ("color ramp", EmissionMode::Ramp),
        ("none", EmissionMode::None),
        ("blackbody", EmissionMode::Blackbody),
    ] {
        window.click(Role::ComboBox, "Emission mode");
        window.click(Role::Button, name);
        assert_eq!(volume(&window).emission.mode, mode);
        until_accepted(&mut window);
    }
    assert_eq!(volume(&window).emission_grid(), Some("temperature"), "by its name");
    assert!(window.has("The grid covers 1 to 2961 K."));
}

#[test]
fn stops_of_a_ramp_are_added_moved_and_deleted_by_hand_and_by_keys() {
    let Some(mut window) = bare_torch() else { return };
    window.click(Role::Button, "flame as flame");
    let stops = |window: &Window| volume(window).emission.stops().to_vec();
    let before = stops(&window);
    window.click(Role::Button, "Add stop");
    assert_eq!(stops(&window).len(), before.len() + 1);
    until_accepted(&mut window);
    window.click(Role::Button, "Delete stop");
    assert_eq!(stops(&window), before, "what was added was chosen");

    window.harness.get_by_role_and_label(Role::Slider, "Ramp stop 2").scroll_to_me();
    window.settle();
    let handle = |window: &Window| {
        window.harness.get_by_role_and_label(Role::Slider, "Ramp stop 2").rect().center()
    };
    let from = handle(&window);
    window.harness.hover_at(from);
    window.harness.step();
    window.harness.drag_at(from);
    window.harness.hover_at(from + egui::vec2(10.0, 0.0));
    window.harness.hover_at(from + egui::vec2(20.0, 0.0));
    window.harness.drop_at(from + egui::vec2(20.0, 0.0));
    window.harness.step();
    window.settle();
    let dragged = stops(&window);
    assert!(dragged[1][0] > before[1][0] && dragged[1][1..] == before[1][1..]);
    assert!((handle(&window).x - from.x - 20.0).abs() < 1.5);

    // The stop has the focus now: keys move it, and none of them is a command.
    window.press(Modifiers::NONE, Key::ArrowLeft);
    assert!(stops(&window)[1][0] < dragged[1][0]);
    window.press(Modifiers::NONE, Key::Delete);
    assert_eq!(stops(&window).len(), before.len() - 1);
    until_accepted(&mut window);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(stops(&window).len(), before.len());
}

#[test]
fn a_volume_is_placed_and_a_shape_measured() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::DisclosureTriangle, "Placement");
    for (name, value) in [("Translate x", 2.0), ("Rotate z", 30.0), ("Scale", 0.5), ("Radius", 1.5)]
    {
        let field = window.harness.get_by_role_and_label(Role::SpinButton, name);
        field.set_value_accesskit(value);
        window.harness.step();
        window.settle();
    }
    let placed = volume(&window);
    assert_eq!((placed.translate, placed.rotate), ([2.0, 0.0, 0.0], [0.0, 0.0, 30.0]));
    assert_eq!((placed.scale.axes(), placed.radius()), ([0.5; 3], 1.5));
    until_accepted(&mut window);
}

#[test]
fn one_of_two_hundred_volumes_is_found_by_its_name() {
    let street = Path::new("builtin:street");
    let Some(mut window) = Window::start(tempfile::tempdir().unwrap(), street) else { return };
    window.press(Modifiers::NONE, Key::Space);
    window.until_it_says("left 1");
    assert!(!window.has("right 77"), "the list is short");
    find(&mut window, "RIGHT 77");
    window.click(Role::Button, "right 77");
    let density = |window: &Window| {
        let volumes = &window.document().settings.volume;
        let named = volumes.iter().find(|volume| volume.name == "right 77").unwrap();
        named.density.scale
    };
    let before = density(&window);
    window.harness.get_by_role_and_label(Role::Slider, "Density").set_value_accesskit(3.0);
    window.settle();
    assert_ne!(density(&window), before);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(density(&window), before);
    find(&mut window, "nobody");
    assert!(window.has("No name contains these letters."));
}

/// Types into the field over the list of volumes.
fn find(window: &mut Window, text: &str) {
    // Which brings it and the list into sight.
    window.harness.get_by_role_and_label(Role::TextInput, "Find a volume").focus();
    window.harness.step();
    window.settle();
    let field = window.harness.get_by_role_and_label(Role::TextInput, "Find a volume");
    field.set_text_value_accesskit(text);
    window.harness.step();
    window.settle();
}

/// A level set is not used unless that is asked for, by a click here.
#[test]
fn a_level_set_becomes_fog_by_a_click() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("body.vdb");
    let voxels = |value| grids::ball(glam::IVec3::ZERO, 4, value);
    let surface = grids::Grid {
        class: "level set",
        background: 0.2,
        ..grids::Grid::fog("surface", voxels(-0.1))
    };
    std::fs::write(&path, grids::file(&[surface, grids::Grid::fog("density", voxels(1.0))]))
        .unwrap();
    let Some(mut window) = Window::start(folder, &path) else { return };
    window.until_it_says("surface as density");
    assert_eq!(volume(&window).density_grid(), "density");
    assert!(!window.has("surface as emission"));
    window.click(Role::Button, "surface as density");
    assert!(volume(&window).density.level_set && volume(&window).density_grid() == "surface");
    until_accepted(&mut window);
    let built = window.app().live_render().built().unwrap().scene.clone();
    let properties = built.world.instances()[0].volume().properties();
    assert_eq!(properties.mu_t(glam::Vec3A::ZERO).x, 0.5 * properties.density_scale.x);
    window.click(Role::Button, "density as density");
    assert!(!volume(&window).density.level_set);
    until_accepted(&mut window);
}
