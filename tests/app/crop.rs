//! The rectangle that gets all samples.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use flambeau::render::{Area, Film};
use glam::UVec2;

use crate::{BALL, Window};

const SIZE: UVec2 = UVec2::new(32, 24);

fn open() -> Option<Window> {
    let text = BALL.replace("size = [64, 48]", "size = [32, 24]").replace("spp = 4", "spp = 0");
    let mut window = Window::open(&text)?;
    window.click(Role::Button, "Fixed");
    Some(window)
}

fn film(window: &Window) -> Film {
    window.app().live_render().session().snapshot().recv().unwrap()
}

fn until_fewest(window: &mut Window, area: Area, samples: u32) {
    let start = std::time::Instant::now();
    while film(window).fewest_samples(area) < samples {
        assert!(start.elapsed() < crate::PATIENCE, "still waiting for {samples} samples");
        window.settle();
    }
}

/// Fewest and most samples outside of an area.
fn outside(film: &Film, area: Area) -> (u32, u32) {
    let pixels = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| UVec2::new(x, y)));
    let counts = pixels.filter(|pixel| !area.contains(*pixel)).map(|pixel| film.samples(pixel));
    counts.fold((u32::MAX, 0), |(low, high), count| (low.min(count), high.max(count)))
}

#[test]
fn all_samples_go_to_the_rectangle_and_back_to_all() {
    let Some(mut window) = open() else { return };
    window.until("there is a picture", |app| app.live_render().picture().is_some());
    window.press(Modifiers::SHIFT, Key::M);
    assert!(window.has("Drag a region over the picture."), "there has to be one first");
    window.click(Role::Button, "Place it");
    let area = window.app().region().area(SIZE).unwrap();
    assert_eq!(window.app().region().alone(SIZE), Some(area));
    until_fewest(&mut window, area, 1);
    window.settle();
    let before = outside(&film(&window), area);
    until_fewest(&mut window, area, 2 * before.1 + 40);
    let after = outside(&film(&window), area);
    assert_eq!(after, before, "the others get none");

    window.press(Modifiers::SHIFT, Key::M);
    assert_eq!(window.app().region().alone(SIZE), None);
    until_fewest(&mut window, Area::of(SIZE), before.1 + 8);
    window.click(Role::Button, "Render region only");
    assert_eq!(window.app().region().alone(SIZE), Some(area));
    window.press(Modifiers::NONE, Key::Escape);
    assert!(window.app().region().alone(SIZE).is_none(), "without it all pixels get samples");
    window.press(Modifiers::NONE, Key::R);
    until_fewest(&mut window, Area::of(SIZE), 3);
}
