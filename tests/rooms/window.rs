//! The core knows nothing of windows: no room but `app` names the window's packages.

use std::path::Path;

use crate::source;

/// The packages of the window, as code names them.
const WINDOW: [&str; 6] = ["eframe", "egui", "egui_wgpu", "wgpu", "rfd", "winit"];

/// The names in a line of code, comments left out.
fn names(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or_default();
    code.split(|letter: char| !(letter.is_alphanumeric() || letter == '_'))
}

fn names_the_window(text: &str) -> bool {
    text.lines().flat_map(names).any(|name| WINDOW.contains(&name))
}

#[test]
fn only_the_app_names_the_packages_of_the_window() {
    let sources = source::read(Path::new(env!("CARGO_MANIFEST_DIR")), &["src"]).unwrap();
    let users = sources.iter().filter(|(_, text)| names_the_window(text));
    let (inside, outside): (Vec<_>, Vec<_>) =
        users.map(|(file, _)| file).partition(|file| file.starts_with("src/app/"));
    assert!(!inside.is_empty(), "the test looks in the wrong place");
    assert!(outside.is_empty(), "these files name the window's packages: {outside:?}");
}
