//! The strip of snapshots, and snapshot files that are opened to go on from them.

use std::sync::atomic::AtomicBool;

use flambeau::error::NO_PROGRESS;
use flambeau::image::exr::{self, SnapshotHeader, read_snapshot};
use flambeau::render::schedule::Limits;
use flambeau::render::{Film, RenderJob, render_headless};
use flambeau::scene::{Settings, VolumeCache};
use flambeau::transport::{Frame, PATH_VERSION};
use glam::UVec2;

use super::*;

impl Window {
    /// Keeps the picture and waits until it is in the strip under this name.
    pub(super) fn keep(&mut self, name: &str) {
        self.press(Modifiers::NONE, Key::K);
        self.until_there_is(&format!("Snapshot {name}"));
    }

    fn until_there_is(&mut self, name: &str) {
        let start = Instant::now();
        while self.harness.query_by_role_and_label(Role::Button, name).is_none() {
            assert!(start.elapsed() < PATIENCE, "still waiting for {name:?}");
            std::thread::sleep(Duration::from_millis(5));
            self.settle();
        }
    }

    fn has_snapshot(&self, name: &str) -> bool {
        let name = format!("Snapshot {name}");
        self.harness.query_by_role_and_label(Role::Button, &name).is_some()
    }

    /// Moves the slider of the ball's density and waits for the new picture.
    fn set_density(&mut self, density: f64) {
        let slider = self.harness.get_by_role_and_label(Role::Slider, "Density");
        slider.set_value_accesskit(density);
        self.harness.step();
        self.until_finished();
    }

    fn type_into(&mut self, field: &str, text: &str) {
        let field = self.harness.get_by_role_and_label(Role::TextInput, field);
        field.set_text_value_accesskit(text);
        self.harness.step();
        self.settle();
    }

    /// Ends the program and starts it again.
    pub(super) fn restart(mut self, scene: &Path) -> Self {
        self.harness.state_mut().as_mut().unwrap().close();
        let Self { harness, folder } = self;
        drop(harness);
        Self::start(folder, scene).unwrap()
    }

    fn shown_without_cursor(&mut self) -> image::RgbaImage {
        self.harness.remove_cursor();
        self.settle();
        shown_picture(self)
    }
}

fn same(a: &image::RgbaImage, b: &image::RgbaImage) -> bool {
    a.dimensions() == b.dimensions() && differing(a, b, 0..a.height()) == 0
}

/// The film of a scene after `spp` samples, rendered without a window.
fn headless(settings: &Settings, spp: u32) -> Film {
    let scene = scene::assemble(settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
    let size = UVec2::from(settings.film.size);
    let job = RenderJob {
        sampler: Arc::new(
            Frame::new(Arc::new(scene), size, settings.film.seed, NO_PROGRESS).unwrap(),
        ),
        size,
        limits: Limits { spp, seconds: None },
        resume: None,
        threads: Some(2),
    };
    render_headless(job, &AtomicBool::new(false), &mut |_, _| {}).unwrap().film
}

/// A snapshot of a scene after `spp` samples, as the command line writes it.
fn write_snapshot(path: &Path, settings: &Settings, spp: u32) {
    let header = SnapshotHeader {
        scene: scene::to_toml(settings, None).unwrap(),
        strategy: toml::to_string(&settings.strategy).unwrap(),
        seed: settings.film.seed,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        path_version: PATH_VERSION,
        wall_seconds: 1000.0,
        files: scene::fingerprints(settings, NO_PROGRESS).unwrap(),
        ..SnapshotHeader::default()
    };
    exr::write(path, &headless(settings, spp), &header).unwrap();
}

#[test]
fn a_kept_picture_is_flipped_to_against_the_live_one() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    assert!(!window.has("Snapshot "), "there is no strip before there is a snapshot");
    window.keep("scene full");
    let kept = window.shown_without_cursor();
    window.set_density(5.0);
    let live = window.shown_without_cursor();
    assert!(!same(&kept, &live));

    let generation = window.app().live_render().picture().unwrap().generation;
    window.press(Modifiers::NONE, Key::ArrowLeft);
    assert!(window.has("Snapshot: scene full, 4.0 spp"));
    assert!(same(&kept, &window.shown_without_cursor()));
    window.press(Modifiers::NONE, Key::ArrowLeft);
    assert!(same(&kept, &window.shown_without_cursor()), "there is none before the first");
    window.press(Modifiers::NONE, Key::E);
    assert!(!same(&kept, &window.shown_without_cursor()), "exposure is that of the window");
    window.press(Modifiers::SHIFT, Key::E);
    window.press(Modifiers::NONE, Key::ArrowRight);
    assert!(!window.has("Snapshot: ") && same(&live, &window.shown_without_cursor()));
    window.press(Modifiers::NONE, Key::ArrowLeft);
    window.press(Modifiers::NONE, Key::Escape);
    assert!(!window.has("Snapshot: ") && same(&live, &window.shown_without_cursor()));
    assert_eq!(window.app().live_render().picture().unwrap().generation, generation);

    // What is shown is what is saved, until an edit asks for the live picture again.
    window.press(Modifiers::NONE, Key::ArrowLeft);
    let exr = window.save(Modifiers::COMMAND, "stored.exr");
    let stored = scene::settings_of(&read_snapshot(&exr).unwrap().header, "").unwrap();
    assert_eq!(stored.volume[0].density.scale.gray(), Some(2.0));
    assert!(window.has("Snapshot: "));
    window.set_density(3.0);
    assert!(!window.has("Snapshot: "));
}

#[test]
fn the_strip_comes_and_goes_without_a_new_render() {
    let endless = BALL.replace("spp = 4", "spp = 0");
    let Some(mut window) = Window::open(&endless) else { return };
    window.until("there is a picture", |app| app.live_render().is_current());
    let generation = |window: &Window| window.app().live_render().picture().unwrap().generation;
    let height = |window: &Window| {
        window.harness.get_by_role_and_label(Role::Image, "Picture").rect().height()
    };
    let (before, high) = (generation(&window), height(&window));
    window.keep("scene full");
    window.keep("scene full 2");
    assert!(height(&window) < high - 80.0);
    std::thread::sleep(Duration::from_millis(200));
    window.settle();
    window.press(Modifiers::SHIFT, Key::N);
    assert!(!window.has("Snapshot ") && height(&window) == high);
    std::thread::sleep(Duration::from_millis(200));
    window.settle();
    assert_eq!(generation(&window), before);
    window.press(Modifiers::SHIFT, Key::N);
    assert!(window.has_snapshot("scene full 2"));
}

#[test]
fn snapshots_are_named_deleted_brought_back_and_there_again_after_a_restart() {
    let Some(mut window) = Window::open(BALL) else { return };
    let scene = window.folder.path().join("scene.toml");
    window.click(Role::Button, "Fixed");
    window.until_finished();
    window.keep("scene full");
    window.set_density(5.0);
    window.keep("scene full 2");
    window.keep("scene full 3");

    window.click(Role::Button, "Snapshot scene full");
    window.type_into("Snapshot name", "thin smoke");
    window.type_into("Snapshot note", "for the second shot");
    assert!(window.has_snapshot("thin smoke") && window.has("Snapshot: thin smoke"));
    window.press(Modifiers::NONE, Key::Escape);

    window.press(Modifiers::NONE, Key::ArrowLeft);
    window.press(Modifiers::NONE, Key::Delete);
    assert!(!window.has_snapshot("scene full 3"));
    window.click(Role::Button, "Undo delete");
    assert!(window.has("Snapshot: scene full 3"));
    window.press(Modifiers::NONE, Key::ArrowLeft);
    window.press(Modifiers::NONE, Key::Delete);
    assert!(!window.has_snapshot("scene full 2"));
    window.click(Role::Button, "Snapshot thin smoke");
    window.until_it_says("Snapshot: thin smoke");
    let kept = window.shown_without_cursor();

    let mut window = window.restart(&scene);
    window.until_there_is("Snapshot thin smoke");
    assert!(window.has_snapshot("scene full 3") && !window.has_snapshot("scene full 2"));
    window.click(Role::Button, "Fixed");
    window.until_finished();
    window.click(Role::Button, "Snapshot thin smoke");
    window.until_it_says("Snapshot: thin smoke");
    assert!(same(&kept, &window.shown_without_cursor()));
    let note = window.harness.get_by_role_and_label(Role::TextInput, "Snapshot note");
    assert_eq!(note.value().as_deref(), Some("for the second shot"));
}

#[test]
fn a_snapshot_of_the_strip_is_gone_on_from() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    window.keep("scene full");
    window.set_density(5.0);
    window.press(Modifiers::NONE, Key::ArrowLeft);
    window.click(Role::Button, "Resume from this");
    // The density of before would be lost.
    window.click(Role::Button, "Open without saving");
    window.until_it_says(
        "scene full: resumed from 4 spp. It had reached its max samples; the limit is now off.",
    );
    window.settle();
    assert!(!window.has("Snapshot: "));
    let preferences = window.folder.path().join("data").join("window.json");
    let preferences: serde_json::Value =
        serde_json::from_slice(&std::fs::read(preferences).unwrap()).unwrap();
    let recent = preferences["recent"].as_array().unwrap();
    assert!(
        recent.len() == 1,
        "the snapshot is in the strip, and no file that was open: {recent:?}"
    );
    assert_eq!(window.document().settings.volume[0].density.scale.gray(), Some(2.0));
    window.until("samples are added", |app| {
        let picture = app.live_render().picture();
        app.live_render().is_current()
            && picture.is_some_and(|picture| picture.stats.samples_per_pixel > 5.0)
    });
}

#[test]
fn a_reopened_snapshot_goes_on_to_the_uninterrupted_film() {
    let Some(mut window) = Window::open(BALL) else { return };
    let mut settings = window.document().settings.clone();
    settings.film.size = [40, 30];
    settings.film.spp = 8;
    let path = window.folder.path().join("half.exr");
    write_snapshot(&path, &settings, 3);
    window.press(Modifiers::COMMAND, Key::O);
    window.type_path(path.to_str().unwrap());
    window.until_it_says("half.exr: resumed from 3 spp.");
    window.until_finished();
    let stats = window.app().live_render().picture().unwrap().stats;
    assert!(stats.samples_per_pixel == 8.0 && stats.seconds > 1000.0, "{stats:?}");
    assert_eq!(window.document().settings, settings);
    let whole = window.save(Modifiers::COMMAND, "whole.exr");
    assert_eq!(read_snapshot(&whole).unwrap().film, headless(&settings, 8));
}

#[test]
fn a_snapshot_that_cannot_go_on_says_why() {
    let Some(mut window) = Window::open(BALL) else { return };
    let volume = window.folder.path().join("fire.vdb");
    let bytes = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/torch_hd.vdb")).unwrap();
    std::fs::write(&volume, &bytes).unwrap();
    let mut settings = Settings::default();
    settings.film.size = [8, 6];
    settings.film.spp = 1;
    let file = Some(volume.to_str().unwrap().to_owned());
    settings.volume =
        vec![flambeau::scene::settings::VolumeSettings { file, ..Default::default() }];
    let path = window.folder.path().join("old.exr");
    write_snapshot(&path, &settings, 1);
    let mut other = bytes;
    *other.last_mut().unwrap() ^= 1;
    std::fs::write(&volume, &other).unwrap();
    window.drop_file(path);
    window.click(Role::Button, "Open");
    window.until_it_says("old.exr: cannot be resumed and is rendered from the start");
    assert!(window.has("fire.vdb has other content"));
    assert_eq!(window.document().settings.film.size, [8, 6]);

    let foreign = window.folder.path().join("foreign.exr");
    ::exr::prelude::write_rgb_file(&foreign, 4, 4, |_, _| (0.5f32, 0.5f32, 0.5f32)).unwrap();
    window.drop_file(foreign);
    window.click(Role::Button, "Open");
    window.until_it_says("not written by Flambeau");
    assert_eq!(window.document().settings.film.size, [8, 6], "what was open stays open");
}

#[test]
fn what_is_no_snapshot_is_skipped_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, BALL).unwrap();
    let odd = folder.path().join("data/snapshots/odd");
    std::fs::create_dir_all(&odd).unwrap();
    std::fs::write(odd.join("snapshot.toml"), "name = 3").unwrap();
    let Some(mut window) = Window::start(folder, &scene) else { return };
    window.until_it_says("Some snapshots cannot be shown");
    assert!(window.has("odd"));
    window.click(Role::Button, "Fixed");
    window.until_finished();
    window.keep("scene full");
}
