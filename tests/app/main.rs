//! The window, driven through its accessible names, on a real render state but without a display.
//!
//! Without a graphics adapter the tests are skipped with a message, unless
//! `FLAMBEAU_REQUIRE_WINDOW_TESTS=1` says that there has to be one.

mod cameras;
mod commands;
mod compare;
mod crop;
mod diagnostics;
mod display;
mod environment;
mod film;
#[path = "../vdb/grids.rs"]
mod grids;
mod keeping;
mod lights;
mod looks;
mod reference;
mod scene_file;
mod snapshots;
mod start;
mod story;
mod surfaces;
mod sweep;
mod time_line;
mod volume_panel;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state, default_wgpu_setup};
use egui_kittest::{Harness, SnapshotOptions};
use flambeau::app::{App, Dialogs, Document, Level, Notice, Options, Scale, ramp_color};
use flambeau::scene;
use flambeau::transport::strategy::{
    Advanced, BoostMode, Integrator, LightSelection, NeeEvaluation, Tracker, TransmittanceEstimator,
};

/// A ball of glowing smoke on a small fixed film that ends after a few samples.
const BALL: &str = r#"
[camera]
position = [0.0, -5.0, 0.0]

[film]
size = [64, 48]
seed = 7
spp = 4

[[volume]]
name = "ball"
shape = "sphere"
density = { scale = 2.0 }
albedo = 0.4
emission = { mode = "source", le = [2.0, 0.7, 0.2] }
"#;

/// How long anything is waited for, on a busy machine without a graphics card.
const PATIENCE: Duration = Duration::from_secs(180);

struct Window {
    harness: Harness<'static, Option<App>>,
    folder: tempfile::TempDir,
}

impl Window {
    /// A window on the text of a scene; `None` without an adapter.
    fn open(scene: &str) -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, scene).unwrap();
        Self::start(folder, &path)
    }

    /// A window on a scene, with its data in `folder`; `None` without an adapter.
    fn start(folder: tempfile::TempDir, scene: &Path) -> Option<Self> {
        Self::begin(folder, Some(scene), ([900.0, 600.0], 1.0))
    }

    /// A window of `size` points, `factor` pixels each, on a scene or on the default one.
    fn begin(
        folder: tempfile::TempDir,
        scene: Option<&Path>,
        (size, factor): ([f32; 2], f32),
    ) -> Option<Self> {
        let state = render_state()?;
        let options = Options {
            source: scene.map(|scene| scene.to_str().unwrap().to_owned()),
            threads: Some(1),
            dialogs: Dialogs::Typed,
            cleared: false,
            pace: None,
            data: Some(folder.path().join("data")),
        };
        let renderer = WgpuTestRenderer::from_render_state(state.clone());
        let harness = Harness::builder().with_size(size).with_pixels_per_point(factor);
        let harness = harness.renderer(renderer);
        let frame = move |ui: &mut egui::Ui, app: &mut Option<App>| {
            let ctx = ui.ctx().clone();
            let app = app.get_or_insert_with(|| App::new(&ctx, &state, options.clone()).unwrap());
            app.frame(ui);
        };
        let mut window = Self { harness: harness.build_ui_state(frame, None), folder };
        window.until("the scene is open", |app| !app.editor().document.settings.volume.is_empty());
        Some(window)
    }

    fn app(&self) -> &App {
        self.harness.state().as_ref().unwrap()
    }

    fn document(&self) -> &Document {
        &self.app().editor().document
    }

    /// Runs frames until `condition` holds.
    fn until(&mut self, what: &str, condition: impl Fn(&App) -> bool) {
        let start = Instant::now();
        loop {
            self.harness.step();
            if condition(self.app()) {
                break;
            }
            assert!(start.elapsed() < PATIENCE, "still waiting until {what}");
            std::thread::sleep(Duration::from_millis(5));
        }
        self.settle();
    }

    /// Runs the few frames that layouts take to come to rest: until none is asked for, as on a
    /// screen, and six at most, since a render in progress asks for ever more.
    fn settle(&mut self) {
        for frame in 0..6 {
            self.harness.step();
            let root = &self.harness.output().viewport_output[&egui::ViewportId::ROOT];
            if frame > 0 && root.repaint_delay > Duration::ZERO {
                break;
            }
        }
    }

    fn until_finished(&mut self) {
        self.until("the picture is finished", |app| {
            let live_render = app.live_render();
            // Until a change is built, the picture of before is the latest.
            let latest = live_render.is_current() && !live_render.is_building();
            latest && live_render.picture().is_some_and(|picture| picture.stats.finished)
        });
    }

    fn click(&mut self, role: Role, name: &str) {
        // What is scrolled out of sight cannot be clicked.
        self.harness.get_by_role_and_label(role, name).scroll_to_me();
        self.settle();
        self.harness.get_by_role_and_label(role, name).click();
        self.harness.step();
        self.settle();
    }

    fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.harness.step();
        self.settle();
    }

    /// Types into the path bar, which has to be open, and confirms.
    fn type_path(&mut self, path: &str) {
        let field = self.harness.get_by_role_and_label(Role::TextInput, "Path");
        field.set_text_value_accesskit(path);
        self.harness.step();
        self.settle();
        self.press(Modifiers::NONE, Key::Enter);
    }

    /// Saves by a shortcut and a typed path.
    fn save(&mut self, modifiers: Modifiers, name: &str) -> PathBuf {
        let path = self.folder.path().join(name);
        self.press(modifiers, Key::S);
        self.type_path(path.to_str().unwrap());
        let of_it = |notice: &&Notice| notice.text.contains(name);
        let told = |app: &App| app.notices().list().iter().find(of_it).map(|notice| notice.level);
        self.until("the file is saved", |app| told(app).is_some());
        assert_eq!(told(self.app()), Some(Level::Done));
        path
    }

    /// Runs frames until a text is there.
    fn until_it_says(&mut self, text: &str) {
        let start = Instant::now();
        while !self.has(text) {
            assert!(start.elapsed() < PATIENCE, "still waiting for {text:?}");
            std::thread::sleep(Duration::from_millis(5));
            self.settle();
        }
    }

    fn has(&self, text: &str) -> bool {
        self.harness.query_all_by_label_contains(text).next().is_some()
    }
}

/// A render state without a window; `None` with a message where there is no adapter.
fn render_state() -> Option<egui_wgpu::RenderState> {
    let create =
        || create_render_state(default_wgpu_setup(), egui_wgpu::RendererOptions::PREDICTABLE);
    match std::panic::catch_unwind(create) {
        Ok(state) => Some(state),
        Err(_) if std::env::var_os("FLAMBEAU_REQUIRE_WINDOW_TESTS").is_some_and(|v| v == "1") => {
            panic!("there has to be a graphics adapter, such as Mesa's lavapipe")
        }
        Err(_) => {
            eprintln!("skipped: there is no graphics adapter for the window's tests");
            None
        }
    }
}

#[test]
fn toggles_answer_to_clicks_keys_presets_and_undo() {
    let Some(mut window) = Window::open(BALL) else { return };
    let decoupling = |window: &Window| window.document().settings.strategy.emission_decoupling;
    let tracking = |window: &Window| window.document().settings.strategy.emission_ratio_tracking;
    let nee = |window: &Window| window.document().settings.strategy.nee;
    assert!(decoupling(&window) && tracking(&window) && nee(&window));
    assert!(window.has("No effect here: ratio tracking already collects"));

    window.press(Modifiers::NONE, Key::Num2);
    assert!(!tracking(&window));
    assert!(!window.has("No effect here"), "with tracking off, decoupling does something");
    window.click(Role::CheckBox, "Emission decoupling");
    assert!(!decoupling(&window));
    assert!(!window.has("No effect here"), "fire as a light still has steps to boost");
    window.press(Modifiers::NONE, Key::Num4);
    assert!(!nee(&window));
    assert!(window.has("No effect here: it needs decoupling, ratio tracking or fire as a light"));
    window.click(Role::Button, "Full");
    assert!(decoupling(&window) && tracking(&window) && nee(&window));

    window.press(Modifiers::COMMAND, Key::Z);
    assert!(!decoupling(&window) && !tracking(&window) && !nee(&window));
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(!decoupling(&window) && nee(&window));
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(decoupling(&window) && !tracking(&window));
    window.press(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert!(!decoupling(&window));
}

#[test]
fn where_nothing_glows_the_toggles_say_so() {
    let smoke = BALL.replace("\"source\", le = [2.0, 0.7, 0.2]", "\"none\"");
    let Some(window) = Window::open(&smoke) else { return };
    let idle = "No effect here: no volume in this scene emits light.";
    assert_eq!(window.harness.query_all_by_label_contains(idle).count(), 4);
}

#[test]
fn fire_that_lights_nothing_says_so() {
    let soot = BALL.replace("albedo = 0.4", "albedo = 0.0");
    let Some(window) = Window::open(&soot) else { return };
    assert!(window.has("No effect here: nothing in this scene scatters or reflects light"));
}

#[test]
fn probes_that_do_not_pay_say_so() {
    let cloud = r#"
        [film]
        size = [48, 32]
        spp = 2
        [strategy.advanced]
        probe_count = 64
        [camera]
        position = [0, -4, 0]
        target = [0, 0, 0]
        [environment]
        radiance = 1.0
        [[volume]]
        shape = "noise"
        half_size = 1.0
        frequency = 2.0
        density = { scale = 6.0 }
        albedo = 0.999
        phase = { g = 0.8 }
    "#;
    let Some(mut window) = Window::open(cloud) else { return };
    window.click(Role::Button, "Fixed");
    window.until_it_says("Switched off automatically: no gain in this shot.");
}

#[test]
fn ray_marching_is_labeled_biased_wherever_it_is_on() {
    let Some(mut window) = Window::open(BALL) else { return };
    assert!(!window.has("biased") && !window.has("Biased"));
    window.click(Role::DisclosureTriangle, "Advanced");
    window.click(Role::Button, "Ray marching");
    assert_eq!(window.document().settings.strategy.integrator, Integrator::March);
    assert!(window.has("Biased: ray marching is on"), "in the panel");
    assert!(window.harness.query_by_label("biased").is_some(), "in the status line");
    let idle = "No effect here: ray marching";
    assert_eq!(window.harness.query_all_by_label_contains(idle).count(), 4);
    window.click(Role::Button, "Baseline");
    assert!(window.has("Biased: ray marching is on"), "a preset leaves the integrator alone");
    window.click(Role::Button, "Path tracing");
    assert!(!window.has("biased") && !window.has("Biased"));
}

#[test]
fn every_finer_choice_can_be_made() {
    let Some(mut window) = Window::open(BALL) else { return };
    let advanced = |window: &Window| window.document().settings.strategy.advanced;
    assert_eq!(advanced(&window), Advanced::default());
    window.click(Role::DisclosureTriangle, "Advanced");
    let modes = [
        ("Optimal", BoostMode::Optimal),
        ("Clamped", BoostMode::Clamped),
        ("Literal", BoostMode::Literal),
        ("Stratified", BoostMode::Stratified),
    ];
    for (name, mode) in modes {
        window.click(Role::Button, name);
        assert_eq!(advanced(&window).boost_mode, mode);
    }
    window.click(Role::Button, "Point");
    assert_eq!(advanced(&window).nee_evaluation, NeeEvaluation::Point);
    window.click(Role::Button, "Uniform");
    assert_eq!(advanced(&window).light_selection, LightSelection::Uniform);
    window.click(Role::Button, "Residual");
    assert_eq!(advanced(&window).transmittance, TransmittanceEstimator::Residual);
    window.click(Role::CheckBox, "Low-discrepancy samples");
    assert!(!advanced(&window).low_discrepancy);
    assert_eq!(window.app().editor().undo_name(), Some("low-discrepancy samples"));

    // What an idle toggle would use is dimmed.
    window.press(Modifiers::NONE, Key::Num4);
    let line = window.harness.get_by_role_and_label(Role::Button, "Line");
    assert!(line.accesskit_node().is_disabled());
}

#[test]
fn a_tracker_is_offered_where_it_may_be_used_and_gives_way() {
    let Some(mut window) = Window::open(BALL) else { return };
    let tracker = |window: &Window| window.document().settings.strategy.advanced.tracker;
    window.click(Role::DisclosureTriangle, "Advanced");
    let offered = |window: &Window| {
        let button = window.harness.get_by_role_and_label(Role::Button, "Decomposition");
        !button.accesskit_node().is_disabled()
    };
    assert!(!offered(&window));
    assert!(window.has("probes cannot weight its distances"));
    window.click(Role::Button, "Spectral");
    assert_eq!(tracker(&window), Tracker::Spectral);

    window.press(Modifiers::NONE, Key::Num5);
    assert!(offered(&window) && !window.has("Not available with these settings"));
    window.click(Role::Button, "Decomposition");
    assert_eq!(tracker(&window), Tracker::Decomposition);
    window.press(Modifiers::NONE, Key::Num2);
    assert_eq!(tracker(&window), Tracker::Delta, "ratio tracking went off");
    assert!(window.has("cannot collect emission "));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(tracker(&window), Tracker::Decomposition);
    window.click(Role::Button, "Full");
    assert_eq!(tracker(&window), Tracker::Delta, "the probes went on");
    assert!(!window.has("strategy.advanced.tracker:"), "no error is shown");
}

#[test]
fn a_slider_restarts_the_render_and_undo_brings_the_value_back() {
    // The film takes the window's size, which has nothing to do with it.
    let text = BALL.replace("spp = 4", "spp = 1");
    let Some(mut window) = Window::open(&text) else { return };
    window.until_finished();
    let before = window.app().live_render().picture().unwrap().generation;
    let density = |window: &Window| window.document().settings.volume[0].density.scale.gray();
    assert_eq!(density(&window), Some(2.0));

    let slider = window.harness.get_by_role_and_label(Role::Slider, "Density");
    slider.set_value_accesskit(5.0);
    window.harness.step();
    window.settle();
    assert_eq!(density(&window), Some(5.0));
    window.until("a new render is shown", |app| {
        app.live_render().picture().is_some_and(|picture| picture.generation > before)
    });
    assert_eq!(window.app().editor().undo_name(), Some("density"));

    let field = window.harness.get_by_role_and_label(Role::SpinButton, "Density");
    field.set_value_accesskit(7.5);
    window.harness.step();
    window.settle();
    assert_eq!(density(&window), Some(7.5));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(density(&window), Some(5.0));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(density(&window), Some(2.0));
    assert_eq!(window.app().editor().undo_name(), None);
}

#[test]
fn a_drag_on_the_picture_orbits_as_one_edit() {
    let Some(mut window) = Window::open(BALL) else { return };
    let before = window.document().settings.camera.clone();
    let start = window.harness.get_by_role_and_label(Role::Image, "Picture").rect().center();
    window.harness.drag_at(start);
    for step in 1..6 {
        window.harness.hover_at(start + egui::vec2(12.0 * step as f32, 4.0));
    }
    window.harness.drop_at(start + egui::vec2(80.0, 4.0));
    window.harness.step();
    window.settle();
    let after = window.document().settings.camera.clone();
    assert_ne!(after.position, before.position);
    assert_eq!(after.target, before.target);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.document().settings.camera, before);
}

#[test]
fn typed_paths_open_and_broken_ones_say_why_and_change_nothing() {
    let Some(mut window) = Window::open(BALL) else { return };
    let other = window.folder.path().join("other.toml");
    std::fs::write(&other, BALL.replace("\"ball\"", "\"other\"")).unwrap();
    let broken = window.folder.path().join("broken.toml");
    std::fs::write(&broken, "[camera]\nfov = 3\n").unwrap();

    window.press(Modifiers::COMMAND, Key::L);
    window.type_path(other.to_str().unwrap());
    window.until("the other scene is open", |app| {
        app.editor().document.settings.volume[0].name == "other"
    });

    window.press(Modifiers::COMMAND, Key::O);
    window.type_path(broken.to_str().unwrap());
    window.until("the failure is told", |app| !app.notices().list().is_empty());
    assert!(window.has("broken.toml") && window.has("fov_x"), "the key and the nearest known one");
    assert_eq!(window.document().settings.volume[0].name, "other");
    window.click(Role::Button, "Dismiss");
    assert!(window.app().notices().list().is_empty());

    window.press(Modifiers::COMMAND, Key::O);
    window.press(Modifiers::NONE, Key::Escape);
    assert!(window.harness.query_by_role_and_label(Role::TextInput, "Path").is_none());
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

#[test]
fn a_dropped_file_opens() {
    let Some(mut window) = Window::open(BALL) else { return };
    let path = window.folder.path().join("dropped.toml");
    std::fs::write(&path, BALL.replace("\"ball\"", "\"dropped\"")).unwrap();
    window.harness.input_mut().dropped_files.push(Arc::new(Dropped(path)));
    window.until("the dropped scene is open", |app| {
        app.editor().document.settings.volume[0].name == "dropped"
    });
}

#[test]
fn pause_holds_the_samples_and_restart_throws_them_away() {
    let endless = BALL.replace("spp = 4", "spp = 0");
    let Some(mut window) = Window::open(&endless) else { return };
    window.until("there are samples", |app| {
        app.live_render().picture().is_some_and(|picture| picture.stats.samples_per_pixel > 2.0)
    });
    window.press(Modifiers::NONE, Key::Space);
    assert!(window.app().live_render().paused());
    std::thread::sleep(Duration::from_millis(200));
    window.settle();
    let held = window.app().live_render().picture().unwrap().clone();
    std::thread::sleep(Duration::from_millis(200));
    window.settle();
    assert!(Arc::ptr_eq(&held, window.app().live_render().picture().unwrap()));

    window.click(Role::Button, "Resume");
    assert!(!window.app().live_render().paused());
    window.press(Modifiers::NONE, Key::R);
    window.until("a new render is shown", |app| {
        app.live_render().picture().is_some_and(|picture| picture.generation > held.generation)
    });
}

#[test]
fn the_panels_fold_and_the_menus_know_the_commands() {
    let Some(mut window) = Window::open(BALL) else { return };
    let wide = |window: &Window| {
        window.harness.get_by_role_and_label(Role::Image, "Picture").rect().width()
    };
    let before = wide(&window);
    window.press(Modifiers::NONE, Key::N);
    assert!(wide(&window) > before + 200.0);
    assert!(window.harness.query_by_role_and_label(Role::CheckBox, "Majorant boost").is_none());
    window.click(Role::Button, "View");
    let item = window.harness.get_by_label_contains("Show or hide the panels");
    item.click();
    window.harness.step();
    window.settle();
    assert_eq!(wide(&window), before);
}

#[test]
fn saved_files_hold_what_is_shown() {
    let Some(mut window) = Window::open(BALL) else { return };
    window.click(Role::Button, "Fixed");
    window.until_finished();
    let size = window.app().live_render().picture().unwrap().size;
    assert_eq!(size.to_array(), [64, 48]);

    let exr = window.save(Modifiers::COMMAND, "picture.exr");
    let snapshot = flambeau::image::exr::read_snapshot(&exr).unwrap();
    assert_eq!(snapshot.film.size(), size);
    assert_eq!(snapshot.film.sample_range(), (4, 4));

    let toml = window.save(Modifiers::COMMAND.plus(Modifiers::ALT), "scene copy");
    let toml = toml.with_extension("toml");
    assert_eq!(scene::load(toml.to_str().unwrap()).unwrap(), window.document().settings);

    // A file that exists is replaced only after a second confirmation.
    window.press(Modifiers::COMMAND, Key::S);
    window.type_path(exr.to_str().unwrap());
    assert!(window.has("This file exists"));
    let written = std::fs::metadata(&exr).unwrap().modified().unwrap();
    window.press(Modifiers::NONE, Key::Enter);
    window.until("the file is replaced", |_| {
        std::fs::metadata(&exr).unwrap().modified().unwrap() > written
    });
    assert!(!window.has("This file exists"));

    // The PNG is what the shader shows: the middle of each block of the enlarged picture.
    let png = window.save(Modifiers::COMMAND.plus(Modifiers::SHIFT), "picture.png");
    let png = image::open(png).unwrap().into_rgb8();
    window.click(Role::Button, "Dismiss");
    let area = window.harness.get_by_role_and_label(Role::Image, "Picture").rect();
    let shown = window.harness.render().unwrap();
    let scale = (area.width() / 64.0).min(area.height() / 48.0).floor();
    let corner = area.center() - scale * egui::vec2(32.0, 24.0);
    let mut bright = 0;
    for (x, y, code) in png.enumerate_pixels() {
        let at = corner.round() + scale * egui::vec2(x as f32 + 0.5, y as f32 + 0.5);
        let pixel = shown.get_pixel(at.x as u32, at.y as u32);
        for channel in 0..3 {
            let (a, b) = (i32::from(code[channel]), i32::from(pixel[channel]));
            assert!((a - b).abs() <= 1, "pixel {x},{y}: {code:?} saved, {pixel:?} shown");
            bright += i32::from(a > 60);
        }
    }
    assert!(bright > 100, "the ball is not in the picture");
}

/// The picture's part of the window, pixel by pixel.
fn shown_picture(window: &mut Window) -> image::RgbaImage {
    let area = window.harness.get_by_role_and_label(Role::Image, "Picture").rect();
    let shown = window.harness.render().unwrap();
    let [x, y, width, height] =
        [area.left(), area.top(), area.width(), area.height()].map(|side| side.round() as u32);
    image::imageops::crop_imm(&shown, x, y, width, height).to_image()
}

/// How many pixels of two pictures differ, between these rows.
fn differing(a: &image::RgbaImage, b: &image::RgbaImage, rows: std::ops::Range<u32>) -> usize {
    let pixels = std::iter::zip(a.enumerate_pixels(), b.pixels());
    pixels.filter(|((_, y, a), b)| rows.contains(y) && a != b).count()
}
