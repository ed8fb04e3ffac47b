//! The time line: sequences opened, scrubbed, stepped through and played from the flipbook.

use egui_kittest::kittest::Queryable;
use flambeau::image::reference::Reference;

use super::*;

/// A window on a set of four numbered volumes, of which the third is missing; on a small film.
fn window() -> Option<Window> {
    let folder = tempfile::tempdir().unwrap();
    let torch = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/torch_hd.vdb");
    for frame in [1, 2, 4] {
        std::fs::copy(torch, folder.path().join(format!("fire_{frame:04}.vdb"))).unwrap();
    }
    let scene = folder.path().join("scene.toml");
    let text = "[film]\nsize = [48, 32]\nspp = 2\n[[volume]]\nfile = 'fire_####.vdb'\n\
                emission = { mode = 'blackbody', kelvin_scale = 1000 }\n";
    std::fs::write(&scene, text).unwrap();
    let mut window = Window::start(folder, &scene)?;
    window.click(Role::Button, "Fixed");
    Some(window)
}

fn frame(window: &Window) -> f64 {
    window.document().settings.time.frame
}

#[test]
fn frames_are_stepped_through_by_keys_and_by_the_track() {
    let Some(mut window) = window() else { return };
    assert!(window.has("of 1–4"));
    window.press(Modifiers::NONE, Key::Period);
    assert_eq!(frame(&window), 2.0);
    window.press(Modifiers::NONE, Key::Period);
    window.until_it_says("frame 3 is missing; frame 2 is shown in its place");
    window.press(Modifiers::NONE, Key::Comma);
    window.press(Modifiers::NONE, Key::Comma);
    window.press(Modifiers::NONE, Key::Comma);
    assert_eq!(frame(&window), 4.0, "around the end");
    assert!(!window.has("is missing"));
    let track = window.harness.get_by_role_and_label(Role::Slider, "Time line");
    track.focus();
    window.harness.step();
    window.press(Modifiers::NONE, Key::ArrowLeft);
    assert_eq!(frame(&window), 3.0);
}

/// Going to another frame is no edit: there is nothing to undo and nothing to save, and what is
/// undone leaves the frame alone.
#[test]
fn another_frame_is_no_edit() {
    let Some(mut window) = window() else { return };
    let (edit, unsaved) =
        (window.app().editor().undo_name().map(str::to_owned), window.app().has_unsaved_changes());
    window.press(Modifiers::NONE, Key::Period);
    assert_eq!(window.app().editor().undo_name().map(str::to_owned), edit);
    assert_eq!(window.app().has_unsaved_changes(), unsaved);
    window.press(Modifiers::NONE, Key::Num1);
    window.press(Modifiers::NONE, Key::Comma);
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.document().settings.strategy.emission_decoupling, "undone");
    assert_eq!(frame(&window), 1.0, "the frame that the edit was made at is 2");
}

fn until_saved_as_exr(window: &mut Window) {
    window.until("the flipbook is saved", |app| {
        let is_told = |notice: &Notice| notice.text.contains(".exr");
        let told = app.notices().list().iter().find(|notice| is_told(notice));
        told.is_some_and(|notice| notice.level == Level::Done)
    });
}

#[test]
fn frames_are_rendered_once_and_played_from_the_flipbook() {
    let Some(mut window) = window() else { return };
    window.press(Modifiers::NONE, Key::P);
    window.until("all frames are in the flipbook", |app| app.time_line().flipbook.len() == 4);
    assert!(window.app().time_line().is_playing());
    window.until("the flipbook plays", |app| app.time_line().is_passing());
    let stands = frame(&window);
    let start = Instant::now();
    let mut seen = std::collections::BTreeSet::new();
    while seen.len() < 4 {
        window.harness.step();
        seen.insert(window.app().time_line().shown(0));
        assert!(start.elapsed() < PATIENCE, "it stands at {seen:?}");
    }
    assert_eq!(frame(&window), stands, "the scene need not be built for that");
    window.click(Role::Button, "Stop");
    assert!(!window.app().time_line().is_playing());

    window.press(Modifiers { alt: true, ..Modifiers::COMMAND }, Key::P);
    let name = window.folder.path().join("torch");
    window.type_path(name.to_str().unwrap());
    window.until_it_says("Saved");
    for frame in 1..=4 {
        let file = window.folder.path().join(format!("torch.{frame:04}.png"));
        assert_eq!(image::open(&file).unwrap().width() % 48, 0, "{}", file.display());
    }

    window.press(Modifiers { alt: true, ..Modifiers::COMMAND }, Key::P);
    let name = window.folder.path().join("torch.%04d.exr");
    window.type_path(name.to_str().unwrap());
    until_saved_as_exr(&mut window);
    for frame in 1..=4 {
        let file = window.folder.path().join(format!("torch.{frame:04}.exr"));
        let read = Reference::load(&file).unwrap();
        let kept = &window.app().time_line().flipbook.get(frame).unwrap()[0];
        assert_eq!(read.size(), kept.size);
        let is_same = |(read, kept): (&[f32; 4], &[f32; 4])| read[..3] == kept[..3];
        assert!(std::iter::zip(read.pixels(), &kept.pixels).all(is_same), "frame {frame}");
    }

    // An edit makes the pictures worthless; another exposure does not.
    window.press(Modifiers::NONE, Key::E);
    assert_eq!(window.app().time_line().flipbook.len(), 4);
    window.press(Modifiers::NONE, Key::Num1);
    assert!(window.app().time_line().flipbook.len() <= 1);
}

#[test]
fn the_panel_says_what_is_shown_outside_of_the_frames() {
    let Some(mut window) = window() else { return };
    window.click(Role::Button, "Loop");
    assert_eq!(window.document().settings.volume[0].outside, scene::settings::Outside::Loop);
    assert_eq!(window.app().editor().undo_name(), Some("frames outside"));
    window.click(Role::CheckBox, "Noise changes with the frame");
    assert!(!window.document().settings.film.animate_seed);
}

#[test]
fn both_sides_of_a_comparison_are_played() {
    let Some(mut window) = window() else { return };
    window.press(Modifiers::NONE, Key::C);
    window.press(Modifiers::NONE, Key::P);
    window.until("all frames are in the flipbook", |app| app.time_line().flipbook.len() == 4);
    let pictures = |app: &App| app.time_line().flipbook.get(2).map(<[_]>::len);
    assert_eq!(pictures(window.app()), Some(2));

    window.press(Modifiers { alt: true, ..Modifiers::COMMAND }, Key::P);
    let name = window.folder.path().join("both.exr");
    window.type_path(name.to_str().unwrap());
    until_saved_as_exr(&mut window);
    let read = Reference::load(&window.folder.path().join("both.0002.exr")).unwrap();
    let sides = window.app().time_line().flipbook.get(2).unwrap();
    let (width, middle) = (read.size().x as usize, read.size().x as usize / 2);
    for (at, pixel) in read.pixels().iter().enumerate() {
        let side = usize::from(at % width >= middle);
        assert_eq!(pixel[..3], sides[side].pixels[at][..3], "of A on the left, of B on the right");
    }
}

/// A file that is written again is read again, and a frame that is added joins the time line.
#[test]
fn files_that_change_on_the_disk_are_read_again() {
    let Some(mut window) = window() else { return };
    window.until_finished();
    let torch = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/campfire_hd.vdb");
    let first = window.folder.path().join("fire_0001.vdb");
    let voxels = |window: &Window| window.app().live_render().built().unwrap().scene.clone();
    let before = voxels(&window);
    std::fs::copy(torch, &first).unwrap();
    window.until_it_says("have changed on the disk");
    window.until("the file is read", |app| {
        !std::sync::Arc::ptr_eq(&app.live_render().built().unwrap().scene, &before)
    });
    std::fs::copy(torch, window.folder.path().join("fire_0006.vdb")).unwrap();
    window.until("there are six frames", |app| app.time_line().range() == Some([1, 6]));
}
