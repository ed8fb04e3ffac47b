//! Two strategies side by side: begun, edited, swapped, looked at and ended by keys and names.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use flambeau::app::{CompareLayout, Side};
use flambeau::render::Layer;
use flambeau::render::compare::Verdict;
use flambeau::transport::strategy::Preset;

use super::{BALL, Window};

impl Window {
    /// Runs frames until both sides have finished their few samples and are compared.
    pub(super) fn until_compared(&mut self) {
        self.until("both sides are compared", |app| {
            let finished = |live_render: &flambeau::app::LiveRender| {
                let latest = live_render.is_current() && !live_render.is_building();
                latest && live_render.picture().is_some_and(|picture| picture.stats.finished)
            };
            let both = finished(app.live_render())
                && app.second_side().second_render().is_some_and(finished);
            let spp = app.editor().document.settings.film.spp;
            let all = |comparison: &flambeau::render::compare::Comparison| {
                comparison.sides.iter().all(|side| side.fewest_samples == spp)
            };
            both && app.second_side().comparison().is_some_and(all)
        });
    }
}

fn open() -> Option<Window> {
    let text = BALL.replace("size = [64, 48]", "size = [32, 24]").replace("spp = 4", "spp = 16");
    let mut window = Window::open(&text)?;
    window.click(Role::Button, "Fixed");
    Some(window)
}

#[test]
fn a_key_sets_the_strategy_against_the_baseline_and_tells_how_much_it_brings() {
    let Some(mut window) = open() else { return };
    window.until_finished();
    let picture = window.app().live_render().picture().unwrap().generation;
    window.press(Modifiers::NONE, Key::C);
    assert!(window.has("A  Baseline") && window.has("B  Full"));
    window.until_compared();
    assert_eq!(
        window.app().live_render().picture().unwrap().generation,
        picture,
        "what was rendered before goes on"
    );
    let comparison = window.app().second_side().comparison().unwrap().clone();
    assert_ne!(comparison.agreement.verdict, Verdict::Differ, "{comparison:?}");
    assert!(window.has(&comparison.sentence()), "{}", comparison.sentence());
    assert!(window.has("Noise over time: A"));
    assert!(
        window.app().second_side().histories().iter().all(|history| !history.points().is_empty())
    );

    window.press(Modifiers::NONE, Key::C);
    assert!(window.app().second_side().second_render().is_none() && !window.has("A  Baseline"));
    assert_eq!(window.document().settings.strategy, Preset::Full.strategy());
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.document().compared.is_some(), "undo brings the comparison back");
}

#[test]
fn toggles_act_on_the_edited_side() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::NONE, Key::C);
    // The panel is at rest once the figures are in it.
    window.until_compared();
    let strategy = |window: &Window, side| window.document().strategy_of(side);
    window.press(Modifiers::NONE, Key::Num4);
    assert!(!strategy(&window, Side::B).nee && window.has("B  Custom"));
    assert_eq!(strategy(&window, Side::A), Preset::Baseline.strategy());
    window.press(Modifiers::NONE, Key::B);
    window.press(Modifiers::NONE, Key::Num4);
    assert!(strategy(&window, Side::A).nee && !strategy(&window, Side::B).nee);
    // Both sides have begun anew, and their figures move the buttons when they are back.
    window.until_compared();
    window.click(Role::Button, "Swap");
    assert!(!strategy(&window, Side::A).nee && strategy(&window, Side::B).nee);
    window.click(Role::Button, "Copy to other side");
    assert_eq!(strategy(&window, Side::A), strategy(&window, Side::B));
    window.until_compared();
}

#[test]
fn each_way_to_look_at_both_sides_has_its_picture() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::NONE, Key::C);
    window.until_compared();
    assert_eq!(window.app().second_side().layout, CompareLayout::Wipe);
    for (name, kinds) in [
        ("Side by side", &[][..]),
        ("Difference", &["Signed", "Absolute", "Relative"]),
        ("Noise", &["A", "B", "B / A"]),
    ] {
        window.click(Role::Button, name);
        for kind in kinds {
            window.click(Role::Button, kind);
            window.until("the map is there", |app| app.second_side().map().is_some());
            assert!(window.has("(luminance)") || window.has("Noise of B / noise of A"), "{kind}");
        }
    }
    window.press(Modifiers::NONE, Key::V);
    assert_eq!(window.app().second_side().layout, CompareLayout::Wipe);
}

/// A layer is looked at on both sides as the picture is, and a map of both goes before it.
#[test]
fn layers_are_compared_and_maps_go_before_them() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::NONE, Key::C);
    window.until_compared();
    window.click(Role::ComboBox, "Layer");
    window.click(Role::Button, Layer::Steps.name());
    window.until("both sides bring the layer", |app| {
        let pictures = app.second_side().pictures(app.live_render()).unwrap();
        pictures.iter().all(|picture| picture.layer.layer == Some(Layer::Steps))
    });
    assert!(window.has("Tracking steps per sample") && window.has("Layer: "));
    assert!(window.has("A  Baseline"), "the wipe is there still");
    window.click(Role::Button, "Difference");
    window.until("the map is there", |app| app.second_side().map().is_some());
    assert!(window.has("B − A (luminance)") && !window.has("Tracking steps per sample"));
}

/// What comes and goes above it pushes nothing from under the pointer.
#[test]
fn the_panel_stays_where_the_hand_is() {
    for (role, name) in [(Role::SpinButton, "Field of view"), (Role::CheckBox, "Majorant boost")] {
        let Some(mut window) = open() else { return };
        let at = |window: &Window| window.harness.get_by_role_and_label(role, name).rect().center();
        window.harness.get_by_role_and_label(role, name).scroll_to_me();
        window.settle();
        let before = at(&window);
        window.harness.hover_at(before);
        window.press(Modifiers::NONE, Key::C);
        window.until_compared();
        assert!(at(&window).distance(before) < 1.0, "{name}: {before} to {}", at(&window));
        window.press(Modifiers::NONE, Key::C);
        assert!(at(&window).distance(before) < 1.0, "{name}: {before} to {}", at(&window));
    }
}

/// Camera edits go to both sides, which take turns until both have the samples.
#[test]
fn edits_of_the_scene_go_to_both_sides() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::NONE, Key::C);
    window.until_compared();
    let before = window.app().second_side().pictures(window.app().live_render()).unwrap();
    window.press(Modifiers::NONE, Key::F);
    window.until_compared();
    let after = window.app().second_side().pictures(window.app().live_render()).unwrap();
    for side in 0..2 {
        assert_ne!(before[side].pixels, after[side].pixels);
    }
}

/// A snapshot that is opened meanwhile goes on from its samples, whichever side is edited.
#[test]
fn what_is_opened_ends_the_comparison() {
    let Some(mut window) = open() else { return };
    window.until_finished();
    let path = window.save(Modifiers::COMMAND, "kept.exr");
    window.press(Modifiers::NONE, Key::C);
    window.until_compared();
    window.press(Modifiers::NONE, Key::B);
    window.press(Modifiers::COMMAND, Key::L);
    window.type_path(path.to_str().unwrap());
    window.until("the snapshot is open", |app| app.editor().document.compared.is_none());
    window.until("it has a picture", |app| app.live_render().is_current());
    let live_render = window.app().live_render();
    assert!(window.app().second_side().second_render().is_none());
    assert!(live_render.picture().unwrap().stats.samples_per_pixel >= 16.0, "all are still there");
}
