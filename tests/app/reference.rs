//! What is measured of a picture beside comparing two strategies: rectangles, references, snapshots
//! as one side, and all that in a file.

use flambeau::app::Measure;
use flambeau::image::metrics::{Errors, Viewing};
use flambeau::image::{Reference, npy};
use flambeau::render::Area;
use flambeau::render::Picture;
use flambeau::render::compare::{Comparison, Verdict};
use glam::UVec2;

use super::*;

impl Window {
    fn picture(&self) -> Arc<Picture> {
        self.app().live_render().picture().unwrap().clone()
    }

    /// The place in the window of a picture position, of a picture that is fitted alone.
    fn place(&self, at: [f32; 2]) -> egui::Pos2 {
        let area = self.harness.get_by_role_and_label(Role::Image, "Picture").rect();
        let size = self.picture().size.as_vec2();
        let scale = (area.width() / size.x).min(area.height() / size.y).floor();
        let corner = (area.center() - area.min - 0.5 * scale * egui::vec2(size.x, size.y)).round();
        area.min + corner + scale * egui::vec2(at[0], at[1])
    }

    fn drag(&mut self, from: egui::Pos2, to: egui::Pos2) {
        self.harness.drag_at(from);
        self.harness.hover_at(from.lerp(to, 0.5));
        self.harness.hover_at(to);
        self.harness.drop_at(to);
        self.harness.step();
        self.settle();
    }

    fn draw_rectangle(&mut self, from: [f32; 2], to: [f32; 2]) {
        self.press(Modifiers::NONE, Key::M);
        let (from, to) = (self.place(from), self.place(to));
        self.drag(from, to);
    }

    fn area(&self) -> Option<Area> {
        self.app().region().area(self.picture().size)
    }

    /// Runs frames until the errors are those of the present pictures.
    fn until_measured(&mut self) {
        self.until("the errors are there", |app| app.reference().errors().is_some());
    }

    fn load_reference(&mut self, path: &Path) {
        self.press(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::O);
        self.type_path(path.to_str().unwrap());
    }

    pub(super) fn drop_file(&mut self, path: PathBuf) {
        self.harness.input_mut().dropped_files.push(Arc::new(Dropped(path)));
        self.harness.step();
        self.settle();
    }

    /// Writes a reference of constant gray.
    fn gray(&self, name: &str, size: [u32; 2], value: f32) -> PathBuf {
        let path = self.folder.path().join(name);
        let pixels = vec![[value, value, value, 1.0]; (size[0] * size[1]) as usize];
        npy::write(&path, size.into(), &pixels).unwrap();
        path
    }
}

fn open() -> Option<Window> {
    let text = BALL.replace("size = [64, 48]", "size = [32, 24]").replace("spp = 4", "spp = 16");
    let mut window = Window::open(&text)?;
    window.click(Role::Button, "Fixed");
    window.until_finished();
    Some(window)
}

fn area(x: u32, y: u32, width: u32, height: u32) -> Area {
    Area { first: UVec2::new(x, y), size: UVec2::new(width, height) }
}

#[test]
fn a_rectangle_is_drawn_moved_by_numbers_and_taken_away() {
    let Some(mut window) = open() else { return };
    let opened = window.document().clone();
    window.press(Modifiers::NONE, Key::M);
    assert!(window.has("Drag a region over the picture."));
    window.press(Modifiers::NONE, Key::Escape);
    assert!(!window.has("Drag a region over the picture."));

    window.draw_rectangle([20.5, 15.5], [8.5, 9.5]);
    assert_eq!(window.area(), Some(area(8, 9, 13, 7)), "from any corner, whole pixels");
    assert_eq!(window.document(), &opened, "the camera stays, and nothing is to be undone");
    window.until("its noise is known", |app| {
        app.second_side().region_figures().is_some_and(|part| part.sides[0].noise.is_some())
    });
    let whole = window.picture().stats.noise.unwrap();
    let part = window.app().second_side().region_figures().unwrap();
    assert_eq!((part.area, part.sides.len()), (area(8, 9, 13, 7), 1));
    assert!(part.sides[0].noise.unwrap() < 0.9 * whole, "the ball is bright there");
    assert!(window.has("noise ") && window.has(" ± "), "the row says so");

    let field = window.harness.get_by_role_and_label(Role::SpinButton, "Region width");
    field.set_value_accesskit(99.0);
    window.harness.step();
    window.settle();
    assert_eq!(window.area(), Some(area(8, 9, 24, 7)), "it ends at the picture");

    let at = window.place([4.0, 4.0]);
    window.harness.drag_at(at);
    window.harness.drop_at(at);
    window.harness.step();
    window.settle();
    assert_eq!(window.area(), None, "a click takes it away");
    window.press(Modifiers::NONE, Key::M);
    window.click(Role::Button, "Place it");
    assert_eq!(window.area(), Some(area(10, 8, 10, 8)));
    window.press(Modifiers::NONE, Key::Escape);
    assert_eq!(window.area(), None);
}

#[test]
fn both_sides_are_compared_in_the_rectangle_too() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::NONE, Key::C);
    window.until_compared();
    window.draw_rectangle([10.0, 6.0], [21.0, 17.0]);
    let area = window.area().unwrap();
    window.until("the rectangle is compared", |app| {
        let part = app.second_side().region_figures();
        part.is_some_and(|part| part.area == area && part.comparison.is_some())
    });
    let app = window.app();
    let [a, b] = app.second_side().pictures(app.live_render()).unwrap();
    let expected = Comparison::of_pictures([&a, &b], Some(area));
    let part = app.second_side().region_figures().unwrap();
    assert_eq!(part.comparison.as_ref(), Some(&expected));
    assert!(window.has(&expected.sentence()), "{}", expected.sentence());

    // The same in every view; zoomed, it stays on its pixels.
    for key in [Key::V, Key::V, Key::V] {
        window.press(Modifiers::NONE, key);
        assert_eq!(window.area(), Some(area));
    }
    window.press(Modifiers::NONE, Key::V);
    window.press(Modifiers::NONE, Key::V);
    let right = window.harness.get_by_role_and_label(Role::Image, "Picture").rect();
    window.press(Modifiers::NONE, Key::M);
    window.drag(
        right.right_center() - egui::vec2(150.0, 60.0),
        right.right_center() - egui::vec2(90.0, 0.0),
    );
    let drawn = window.area().unwrap();
    assert!(drawn != area && drawn.first.x > 10, "drawn in the picture of B: {drawn:?}");
}

#[test]
fn errors_against_a_file_are_those_of_the_metrics() {
    let Some(mut window) = open() else { return };
    let path = window.gray("gray.npy", [32, 24], 0.25);
    window.load_reference(&path);
    window.until_measured();
    assert!(window.has("gray.npy"));
    let reference = Reference::load(&path).unwrap();
    let expected = |window: &Window| {
        let viewing = Viewing { tone: window.document().tone, ..Viewing::default() };
        Errors::of(&[&window.picture().pixels], &reference, viewing).unwrap()
    };
    assert_eq!(window.app().reference().errors().unwrap(), expected(&window));
    window.until_it_says("relMSE over time: ");
    let before = window.app().reference().errors().unwrap()[0].flip.mean;

    // FLIP is of what is displayed.
    window.press(Modifiers::NONE, Key::E);
    window.until("FLIP is that of the new exposure", |app| {
        app.reference().errors().is_some_and(|errors| errors[0].flip.mean != before)
    });
    assert_eq!(window.app().reference().errors().unwrap(), expected(&window));

    window.draw_rectangle([10.0, 6.0], [21.0, 17.0]);
    let area = window.area().unwrap();
    let errors = &window.app().reference().errors().unwrap()[0];
    assert_eq!(
        Measure::RelMse.mean(errors, Some(area)),
        errors.rel_mse.mean_of(area.first, area.size)
    );

    // One picture has two views: itself and its error.
    for (kind, title) in [("Squared error", "Relative squared error"), ("FLIP map", "FLIP error")] {
        if kind == "Squared error" {
            window.press(Modifiers::NONE, Key::V);
        }
        window.click(Role::Button, kind);
        window.until_it_says(title);
    }
    window.press(Modifiers::NONE, Key::V);
    assert!(!window.has("FLIP error"));
    window.press(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::K);
    assert!(!window.has("gray.npy") && window.app().reference().errors().is_none());
}

#[test]
fn references_that_do_not_fit_are_told_with_the_mend() {
    let Some(mut window) = open() else { return };
    let broken = window.folder.path().join("broken.npy");
    std::fs::write(&broken, b"no array").unwrap();
    window.load_reference(&broken);
    window.until_it_says("The reference could not be used.");
    assert!(window.has("broken.npy") && window.has(".exr or an .npy"));
    assert!(window.app().reference().loaded().is_none());

    let wide = window.gray("wide.npy", [40, 24], 0.25);
    window.load_reference(&wide);
    window.until_it_says("It has 40 × 24 pixels, the picture 32 × 24.");
    assert!(window.app().reference().errors().is_none());
    window.click(Role::Button, "Use its size");
    window.until_finished();
    assert_eq!(window.picture().size, UVec2::new(40, 24));
    window.until_measured();
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.document().settings.film.size, [32, 24], "the size was an edit");
}

#[test]
fn dropped_pictures_are_opened_or_measured_against_as_one_chooses() {
    let Some(mut window) = open() else { return };
    let exr = window.save(Modifiers::COMMAND, "kept.exr");
    window.drop_file(exr.clone());
    assert!(window.has("kept.exr") && window.app().reference().loaded().is_none());
    window.click(Role::Button, "Use as reference");
    window.until_measured();
    assert_eq!(window.app().reference().errors().unwrap()[0].rel_mse.mean, 0.0);
    assert!(!window.has("Errors mean little"));
    window.press(Modifiers::NONE, Key::F);
    assert!(window.has("Errors mean little: its camera differs."));

    // Another scene has another reference, and this one its own when it is opened again.
    let scene = window.folder.path().join("scene.toml");
    let other = window.folder.path().join("other.toml");
    std::fs::write(&other, BALL.replace("\"ball\"", "\"other\"")).unwrap();
    window.drop_file(other);
    window.click(Role::Button, "Open without saving");
    window.until("the other scene is open", |app| app.reference().loaded().is_none());
    let gray = window.gray("gray.npy", [64, 48], 0.25);
    window.drop_file(gray);
    window.until("an array can only be a reference", |app| app.reference().loaded().is_some());
    let is_first = |app: &App| app.reference().loaded().is_some_and(|held| held.name == "kept.exr");
    window.drop_file(scene.clone());
    window.until("the first reference is there again", is_first);
    let mut window = window.restart(&scene);
    window.until("it is there after a restart too", is_first);
    window.drop_file(exr);
    window.click(Role::Button, "Open");
    window.until_it_says("resumed from 16 spp");
}

#[test]
fn the_picture_itself_becomes_the_reference_of_both_sides() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::COMMAND, Key::K);
    window.until_it_says("the picture at 16 spp");
    window.press(Modifiers::NONE, Key::C);
    window.until_compared();
    window.until("both are measured", |app| {
        app.reference().errors().is_some_and(|errors| errors.len() == 2)
    });
    window.until("both are complete", |app| {
        app.reference().errors().is_some_and(|errors| errors[1].rel_mse.mean == 0.0)
    });
    let errors = window.app().reference().errors().unwrap();
    assert!(errors[0].rel_mse.mean > 0.0 && errors[0].flip.mean > 0.0, "the baseline is noisier");
    assert_eq!(errors[1].flip.mean, 0.0);
    window.click(Role::Button, "Error");
    window.until_it_says("Relative squared error of A");
    let slider = window.harness.get_by_role_and_label(Role::Slider, "Density");
    slider.set_value_accesskit(5.0);
    window.harness.step();
    window.settle();
    assert!(window.has("Errors mean little: the scene has changed since."));
}

#[test]
fn a_snapshot_is_one_side_against_the_live_picture() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::SHIFT, Key::A);
    assert!(window.has("No snapshot is shown to compare with"));
    window.keep("scene full");
    window.click(Role::Button, "Baseline");
    window.until_finished();
    window.keep("scene baseline");
    let live = window.picture();

    window.press(Modifiers::NONE, Key::ArrowLeft);
    window.press(Modifiers::NONE, Key::ArrowLeft);
    window.click(Role::Button, "Compare as A");
    window.until("both are compared", |app| app.second_side().comparison().is_some());
    assert!(window.has("A  Snapshot scene full") && window.has("B  Live: baseline"));
    let [a, b] = window.app().second_side().pictures(window.app().live_render()).unwrap();
    assert_eq!(b.pixels, live.pixels);
    assert_ne!(a.pixels, live.pixels);
    assert!(a.stats.cpu_seconds > 0.0, "its CPU time was kept");
    assert!(
        window.app().second_side().second_render().is_none(),
        "nothing is rendered on its side"
    );
    window.until("the live picture has its variance", |app| {
        let sides = app.second_side().comparison().map(|comparison| comparison.sides);
        sides.is_some_and(|sides| sides.iter().all(|side| side.variance_of_mean.is_some()))
    });
    let comparison = window.app().second_side().comparison().unwrap();
    assert_ne!(comparison.agreement.verdict, Verdict::Differ);
    assert!(comparison.speed_up.is_some() && window.has(&comparison.sentence()));

    // Flipping goes on to the next snapshot, and no further.
    window.press(Modifiers::NONE, Key::ArrowRight);
    window.until_it_says("A  Snapshot scene baseline");
    window.until("it is read", |app| app.second_side().pictures(app.live_render()).is_some());
    let [a, _] = window.app().second_side().pictures(window.app().live_render()).unwrap();
    assert_eq!(a.pixels, live.pixels);
    window.press(Modifiers::NONE, Key::ArrowRight);
    assert!(window.has("A  Snapshot scene baseline"));
    window.press(Modifiers::NONE, Key::X);
    assert!(window.has("A  Live: baseline") && window.has("B  Snapshot scene baseline"));

    // An edit goes to the live side, and both stay in view.
    window.press(Modifiers::NONE, Key::Num4);
    window.until_finished();
    assert!(window.has("A  Live: custom") && window.has("B  Snapshot scene baseline"));
    window.press(Modifiers::NONE, Key::Escape);
    assert!(!window.has("B  Snapshot") && !window.has("Snapshot: "));

    // Two strategies give way to a snapshot, and undo brings them back.
    window.press(Modifiers::NONE, Key::C);
    window.press(Modifiers::NONE, Key::ArrowLeft);
    window.press(Modifiers::SHIFT, Key::B);
    assert!(window.document().compared.is_none() && window.has("B  Snapshot scene baseline"));
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.document().compared.is_some() && !window.has("B  Snapshot"));
}

#[test]
fn a_snapshot_of_another_size_offers_its_size() {
    let Some(mut window) = open() else { return };
    window.keep("scene full");
    window.click(Role::Button, "Window size");
    window.until("the film is that of the window", |app| {
        app.live_render().picture().is_some_and(|picture| picture.size.x > 400)
    });
    window.press(Modifiers::NONE, Key::ArrowLeft);
    window.press(Modifiers::SHIFT, Key::B);
    window.until_it_says("The snapshot has 32 × 24 pixels, the live picture another size.");
    assert!(window.app().second_side().comparison().is_none());
    window.click(Role::Button, "Use its size");
    window.until("they can be compared", |app| app.second_side().comparison().is_some());
    assert!(!window.has("The snapshot has 32 × 24 pixels"));
}

/// Escape closes what is in front alone.
#[test]
fn a_path_that_is_not_wanted_leaves_the_rectangle() {
    let Some(mut window) = open() else { return };
    window.draw_rectangle([8.5, 9.5], [20.5, 15.5]);
    window.press(Modifiers::COMMAND, Key::O);
    window.press(Modifiers::NONE, Key::Escape);
    assert!(window.area().is_some());
    window.press(Modifiers::NONE, Key::Escape);
    assert!(window.area().is_none());
}

#[test]
fn a_biased_side_is_labeled_whichever_is_edited() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::NONE, Key::C);
    // The panel is at rest once the figures are in it.
    window.until_compared();
    // In the panel and in the status line.
    let says = |window: &Window, text: &str| window.harness.query_all_by_label(text).count() == 2;
    window.press(Modifiers::NONE, Key::B);
    window.click(Role::DisclosureTriangle, "Advanced");
    window.click(Role::Button, "Ray marching");
    assert!(window.has("A  Ray marching") && says(&window, "A is biased"));
    window.press(Modifiers::NONE, Key::B);
    assert!(window.has("A  Ray marching") && says(&window, "A is biased"));
    window.press(Modifiers::NONE, Key::X);
    assert!(window.has("B  Ray marching") && says(&window, "B is biased"));
    window.press(Modifiers::NONE, Key::B);
    window.press(Modifiers::SHIFT, Key::X);
    assert!(says(&window, "A and B are biased"));
}

#[test]
fn a_comparison_is_saved_with_names_and_figures() {
    let Some(mut window) = open() else { return };
    window.press(Modifiers::COMMAND, Key::P);
    assert!(window.has("Nothing is compared"));
    window.press(Modifiers::NONE, Key::C);
    window.until_compared();
    let save = |window: &mut Window, name: &str| {
        window.press(Modifiers::COMMAND, Key::P);
        let path = window.folder.path().join(name);
        window.type_path(path.to_str().unwrap());
        window.until_it_says(&format!("Saved {}", path.display()));
        image::open(path).unwrap().into_rgb8()
    };
    let wipe = save(&mut window, "wipe.png");
    let app = window.app();
    let [a, b] = app.second_side().pictures(app.live_render()).unwrap();
    let tone = app.editor().document.tone;
    // Enlarged 20 times to 640 pixels; the divider in the middle.
    assert_eq!(wipe.width(), 640);
    assert!(wipe.height() > 24 * 20 + 60, "words and figures stand below");
    for (picture, x) in [(&a, 5_u32), (&b, 27)] {
        let [r, g, blue, _] = picture.pixels[12 * 32 + x as usize];
        let expected = tone.encoder().encode([r, g, blue].into());
        assert_eq!(wipe.get_pixel(x * 20 + 10, 12 * 20 + 10).0, expected);
    }
    window.press(Modifiers::NONE, Key::V);
    let beside = save(&mut window, "beside.png");
    assert_eq!(beside.width(), 2 * 320 + 2);
    window.press(Modifiers::NONE, Key::V);
    window.until("the map is there", |app| app.second_side().map().is_some());
    let map = save(&mut window, "map.png");
    assert!(map.height() >= wipe.height() + 100, "a map has a legend");
}

/// Both sides end after the same samples, so that their pictures are the same every time; the
/// figures around them are not.
#[test]
fn the_views_of_a_comparison_look_as_they_did() {
    let text = BALL.replace("size = [64, 48]", "size = [88, 24]").replace("spp = 4", "spp = 16");
    let Some(mut window) = Window::open(&text) else { return };
    window.click(Role::Button, "Fixed");
    window.press(Modifiers::NONE, Key::N);
    window.until_finished();
    window.press(Modifiers::COMMAND, Key::K);
    window.until_measured();
    window.press(Modifiers::NONE, Key::C);
    window.until_compared();
    window.draw_rectangle([30.0, 4.0], [57.0, 20.0]);
    let mut results = egui_kittest::SnapshotResults::new();
    for name in ["wipe", "beside", "difference", "noise", "error"] {
        if name != "wipe" {
            window.press(Modifiers::NONE, Key::V);
        }
        if name == "error" {
            window.until("A is measured against B", |app| {
                app.reference().errors().is_some_and(|errors| {
                    errors.len() == 2
                        && errors[1].rel_mse.mean == 0.0
                        && errors[0].rel_mse.mean > 0.0
                })
            });
            window.until_it_says("Relative squared error of A");
        } else if !["wipe", "beside"].contains(&name) {
            window.until("the map is there", |app| app.second_side().map().is_some());
        }
        window.harness.remove_cursor();
        window.settle();
        let shown = shown_picture(&mut window);
        let (left, top) = ((shown.width() - 880) / 2, (shown.height() - 240) / 2);
        let middle = image::imageops::crop_imm(&shown, left, top, 880, 240).to_image();
        let options = SnapshotOptions::new().max_failed_pixels(20);
        let name = format!("compare_{name}");
        results.add(egui_kittest::try_image_snapshot_options(&middle, name, &options));
    }
}
