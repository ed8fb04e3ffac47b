//! Sequences: one file a frame, holes and frames that lack a grid.

use super::{Place, json};
use flambeau::image::npy;

/// A folder `set` with frames 1, 2 and 4 of a torch, of which frame 2 has no temperature.
fn place() -> Place {
    let place = Place::new();
    std::fs::create_dir(place.path("set")).unwrap();
    let fixtures = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/vdb");
    let torch = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/torch_hd.vdb");
    let tiles = format!("{fixtures}/tiles_leaf_and_internal.vdb");
    for (from, frame) in [(torch, 1), (&tiles, 2), (torch, 4)] {
        std::fs::copy(from, place.path(&format!("set/fire_{frame:04}.vdb"))).unwrap();
    }
    place
}

const SMALL: [&str; 4] = ["--size", "12x8", "--spp", "2"];

#[test]
fn every_frame_has_a_file_of_its_own() {
    let place = place();
    let rest = ["-o", "out.####.npy", "--stats", "stats.%02d.json"];
    let render = |more: &[&str]| {
        place.run(&[&["render", "set/fire_####.vdb"], &SMALL[..], &rest, more].concat())
    };
    let (code, _, stderr) = render(&["--frames", "1-4"]);
    assert_eq!(code, 1, "{stderr}");
    assert!(stderr.contains("fire_0003.vdb: frame 3 is missing; --allow-missing"), "{stderr}");
    assert!(!place.path("out.0001.npy").exists(), "nothing is rendered in vain");

    let still = ["--set", "film.animate_seed=false"];
    let (code, _, stderr) = render(&[&["--frames", "1-4", "--allow-missing"], &still[..]].concat());
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("fire_0002.vdb: this frame has no grid"), "{stderr}");
    assert!(stderr.contains("frame 3 is missing; frame 2 is shown"), "{stderr}");
    let picture = |frame: u32| npy::read(&place.path(&format!("out.000{frame}.npy"))).unwrap().1;
    assert_eq!(picture(1), picture(4));
    assert_eq!(picture(2), picture(3));
    assert_ne!(picture(1), picture(2));
    assert_eq!(json(&place.path("stats.04.json"))["spp"], 2);
}

#[test]
fn a_file_of_a_set_and_its_folder_open_the_set() {
    let place = place();
    let picture = |source: &str, more: &[&str]| {
        let arguments = [&["render", source, "-o", "one.npy"], &SMALL[..], more].concat();
        place.succeed(&arguments);
        npy::read(&place.path("one.npy")).unwrap().1
    };
    let fourth = picture("set/fire_0004.vdb", &[]);
    assert_eq!(picture("set", &["--frame", "4"]), fourth);
    assert_eq!(picture("set/fire_%04d.vdb", &["--set", "time.frame=4"]), fourth);
    let other = "--set film.animate_seed=false".split(' ').collect::<Vec<_>>();
    assert_ne!(picture("set/fire_0004.vdb", &other), fourth, "each frame has its own noise");
    assert_eq!(picture("set", &other), picture("set/fire_0004.vdb", &other), "and the same torch");
}

#[test]
fn mistakes_with_frames_name_what_helps() {
    let place = place();
    let refused = |arguments: &[&str], code: i32, words: &str| {
        let (found, _, stderr) = place.run(&[&["render"], arguments, &SMALL[..]].concat());
        assert_eq!(found, code, "{arguments:?}: {stderr}");
        assert!(stderr.contains(words), "{arguments:?}: {stderr}");
    };
    let one = ["-o", "out.npy"];
    let all = |arguments: &[&'static str]| [arguments, &one[..]].concat();
    refused(&all(&["set", "--frames", "1-2"]), 2, "-o needs a place for the number");
    refused(&all(&["set", "--frames", "2-1"]), 2, "comes after");
    refused(&all(&["set/smoke_####.vdb"]), 1, "there is no file of that pattern");
    refused(&all(&["set", "--set", "time.range=[3, 2]"]), 2, "time.range");
    std::fs::create_dir(place.path("empty")).unwrap();
    refused(&all(&["empty"]), 1, "there are no volumes");
    refused(&all(&["set", "--set", "volume.0.density.grid='smoke'"]), 1, "no grid \"smoke\"");
}

#[test]
fn a_sequence_is_described_by_its_frames_and_its_largest_file() {
    let place = place();
    let text = place.succeed(&["info", "set/fire_####.vdb"]);
    for words in ["fire_####.vdb", "1 to 4, 3 files", "missing       3\n", "fire_0001.vdb"] {
        assert!(text.contains(words), "{words} is not in {text}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&place.succeed(&["info", "--json", "set"])).unwrap();
    assert_eq!(json["sequence"]["frames"], serde_json::json!([1, 2, 4]));
    assert_eq!(json["sequence"]["missing"], serde_json::json!([[3, 3]]));
    assert!(!place.succeed(&["info", "set/fire_0002.vdb"]).contains("Sequence"));
}

#[test]
fn an_empty_frame_is_an_empty_picture() {
    let place = place();
    let empty = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/vdb/empty_grid.vdb");
    std::fs::copy(empty, place.path("set/fire_0005.vdb")).unwrap();
    let arguments = [
        &["render", "set/fire_####.vdb", "--frame", "5", "--setup", "black", "-o", "empty.npy"],
        &SMALL[..],
    ]
    .concat();
    let (code, _, stderr) = place.run(&arguments);
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("fire_0005.vdb: the volume is empty"), "{stderr}");
    let (_, values) = npy::read(&place.path("empty.npy")).unwrap();
    assert!(values.iter().all(|pixel| pixel[0] == 0.0));
}
