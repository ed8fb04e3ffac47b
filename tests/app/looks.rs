//! The main states of the window at three sizes, pixel by pixel: a small screen, the usual one, and
//! a large one of fine pixels.

use egui::{Rect, pos2};

use super::*;

/// Width and height in points, and pixels per point.
const SIZES: [([f32; 2], f32); 3] =
    [([900.0, 600.0], 1.0), ([1280.0, 720.0], 1.0), ([1600.0, 900.0], 2.0)];

/// A window of that size with a finished picture.
fn open(size: ([f32; 2], f32)) -> Option<Window> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, BALL).unwrap();
    let mut window = Window::begin(folder, Some(&path), size)?;
    window.click(Role::Button, "Fixed");
    window.until_finished();
    Some(window)
}

/// The window as it is, without what differs from run to run: seconds and what follows from them.
fn look(window: &mut Window, size: [f32; 2], name: &str) -> egui_kittest::SnapshotResult {
    window.harness.remove_cursor();
    window.settle();
    let status = Rect::from_min_max(pos2(70.0, size[1] - 30.0), pos2(560.0, size[1]));
    window.harness.mask(status);
    let options = SnapshotOptions::new().max_failed_pixels(20);
    window.harness.try_snapshot_options(name, &options)
}

#[test]
fn the_window_looks_as_it_did() {
    let mut results = egui_kittest::SnapshotResults::new();
    for ([width, height], factor) in SIZES {
        let size = [width, height];
        let Some(mut window) = open((size, factor)) else { return };
        let name = |state: &str| format!("{state}_{width}x{height}");
        results.add(look(&mut window, size, &name("window")));
        window.press(Modifiers::SHIFT, Key::F1);
        results.add(look(&mut window, size, &name("start")));
        window.press(Modifiers::SHIFT, Key::F1);
        window.press(Modifiers::NONE, Key::F1);
        results.add(look(&mut window, size, &name("keys")));
        window.press(Modifiers::NONE, Key::F1);
        window.press(Modifiers::NONE, Key::F11);
        results.add(look(&mut window, size, &name("full")));
    }
}
