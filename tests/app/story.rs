//! A morning with the window, from the first picture to the one that is gone on from the next day.

use flambeau::app::CompareLayout;
use flambeau::image::exr::read_snapshot;
use flambeau::render::compare::Comparison;

use super::*;

const TORCH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/torch_hd.vdb");

impl Window {
    /// The factor between both sides' times for the same noise, once it is known.
    fn until_compared_anew(&mut self, told: &str) -> Comparison {
        self.until("both sides are compared", |app| {
            let is_current = |live_render: &flambeau::app::LiveRender| {
                live_render.is_current() && !live_render.is_building()
            };
            let both = is_current(app.live_render())
                && app.second_side().second_render().is_some_and(is_current);
            let sides = app.second_side().comparison().map(|comparison| &comparison.sides);
            both && sides.is_some_and(|sides| sides.iter().all(|side| side.fewest_samples >= 4))
        });
        let comparison = self.app().second_side().comparison().unwrap().clone();
        assert!(comparison.speed_up.is_some(), "{told}: {comparison:?}");
        assert!(self.has(&comparison.sentence()), "{told}: {}", comparison.sentence());
        comparison
    }
}

#[test]
#[allow(clippy::too_many_lines, reason = "one story, told in order")]
fn a_morning_with_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let Some(mut window) = Window::begin(folder, None, ([720.0, 420.0], 1.0)) else { return };

    // A torch behind smoke, that refines.
    assert!(window.has("torch") && window.has("Start with a scene"));
    window.until("there is a picture", |app| app.live_render().picture().is_some());
    window.press(Modifiers::NONE, Key::Escape);
    let first = window.app().live_render().picture().unwrap().stats.paths;
    window.until("it refines", |app| app.live_render().picture().unwrap().stats.paths > first);

    // A volume dropped on the window, guessed and changed.
    window.drop_file(TORCH.into());
    window.until_it_says("Guessed: \"temperature\" is a temperature");
    window.until_it_says("density as density");
    let built = window.app().live_render().built().unwrap().settings.clone();
    let slider = window.harness.get_by_role_and_label(Role::Slider, "Density");
    slider.set_value_accesskit(4.0);
    window.harness.step();
    window.until("the slider shows", |app| {
        let built_now = &app.live_render().built().unwrap().settings;
        built_now.volume != built.volume && app.live_render().is_current()
    });

    // Everything off against everything on, and one toggle at a time.
    window.press(Modifiers::NONE, Key::C);
    assert!(window.has("A  Baseline") && window.has("B  Full"));
    let full = window.until_compared_anew("full against baseline");
    window.press(Modifiers::NONE, Key::Num1);
    window.press(Modifiers::NONE, Key::Num2);
    assert!(window.has("B  Custom"));
    let without = window.until_compared_anew("without emission on the way");
    let factor = |comparison: &Comparison| comparison.speed_up.unwrap().ratio;
    assert!(factor(&full) > 2.0 * factor(&without), "it is what matters for a flame alone");

    // The wipe across the fire, the noise map, pixels.
    let area = window.harness.get_by_role_and_label(Role::Image, "Picture").rect();
    window.harness.drag_at(area.center());
    window.harness.hover_at(area.center() - egui::vec2(60.0, 0.0));
    window.harness.drop_at(area.center() - egui::vec2(60.0, 0.0));
    window.harness.step();
    window.settle();
    assert!(window.app().second_side().divider < 0.45, "{}", window.app().second_side().divider);
    for _ in 0..3 {
        window.press(Modifiers::NONE, Key::V);
    }
    assert!(matches!(window.app().second_side().layout, CompareLayout::Noise(_)));
    window.until("the map is there", |app| app.second_side().map().is_some());
    window.press(Modifiers::NONE, Key::V);
    window.harness.hover_at(area.center());
    window.press(Modifiers::NONE, Key::Z);
    window.press(Modifiers::NONE, Key::Home);

    // Snapshots to flip through, and one of them as a file.
    window.press(Modifiers::NONE, Key::C);
    window.press(Modifiers::NONE, Key::K);
    window.until_it_says("1 snapshot");
    window.press(Modifiers::NONE, Key::Num1);
    window.until("it is rendered", |app| {
        app.live_render().is_current() && !app.live_render().is_building()
    });
    window.press(Modifiers::NONE, Key::K);
    window.until_it_says("2 snapshots");
    window.press(Modifiers::NONE, Key::ArrowLeft);
    window.press(Modifiers::NONE, Key::ArrowLeft);
    assert!(window.has("Snapshot name"));
    window.press(Modifiers::NONE, Key::Escape);
    window.press(Modifiers::NONE, Key::Space);
    let exr = window.save(Modifiers::COMMAND, "evening.exr");
    let kept = read_snapshot(&exr).unwrap().film;

    // The next day.
    let mut window = window.restart(&exr);
    assert!(window.has("resumed from"), "{:?}", window.app().notices().list());
    window.until("there is a picture", |app| app.live_render().is_current());
    let paths = |app: &App| app.live_render().picture().unwrap().stats.paths;
    assert!(paths(window.app()) >= kept.totals.paths, "it begins where it ended");
    window.until("samples are added", |app| paths(app) > kept.totals.paths);
    assert_eq!(window.document().settings.volume[0].density.scale.gray(), Some(4.0));
}
