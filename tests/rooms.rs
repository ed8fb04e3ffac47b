//! The core knows nothing of windows: no room but `app` names the window's packages.

use std::path::{Path, PathBuf};

/// The packages of the window, as code names them.
const WINDOW: [&str; 6] = ["eframe", "egui", "egui_wgpu", "wgpu", "rfd", "winit"];

fn sources(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// The names in a line of code, comments left out.
fn names(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or_default();
    code.split(|letter: char| !(letter.is_alphanumeric() || letter == '_'))
}

#[test]
fn only_the_app_names_the_packages_of_the_window() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&source, &mut files);
    let app = source.join("app");
    let (inside, outside): (Vec<_>, Vec<_>) = files.iter().partition(|file| file.starts_with(&app));
    let uses_window = |file: &Path| {
        let text = std::fs::read_to_string(file).unwrap();
        text.lines().flat_map(names).any(|name| WINDOW.contains(&name))
    };
    assert!(inside.iter().any(|file| uses_window(file)), "the test looks in the wrong place");
    let guilty: Vec<_> = outside.into_iter().filter(|file| uses_window(file)).collect();
    assert!(guilty.is_empty(), "these files name the window's packages: {guilty:?}");
}
