//! Snapshots of other versions: they open and compare, and are gone on from where the paths are
//! the same.

use flambeau::image::exr::{Snapshot, read_info, read_snapshot, write};
use flambeau::transport::PATH_VERSION;

use super::Place;

/// Flambeau 0.1.0 wrote the pictures in this folder, of the scene beside them, with
/// `--preset full --spp 2` and `--spp 4`.
const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/snapshots");

/// Its paths are of version 1, which these are not.
#[test]
fn a_snapshot_of_0_1_0_opens_and_is_not_gone_on_from() {
    let place = Place::new();
    for name in ["0.1.0_2spp.exr", "0.1.0_4spp.exr", "scene.toml"] {
        std::fs::copy(format!("{FIXTURES}/{name}"), place.path(name)).unwrap();
    }
    let info = place.succeed(&["info", "0.1.0_2spp.exr"]);
    assert!(info.contains("path version  1\n"), "{info}");
    let read = |name: &str| read_snapshot(&place.path(name)).unwrap();
    let (two, four) = (read("0.1.0_2spp.exr"), read("0.1.0_4spp.exr"));
    assert_eq!((two.header.path_version, four.header.path_version), (1, 1));
    assert_eq!(four.film.totals.paths, 2 * two.film.totals.paths);
    let more = ["--spp", "4", "--resume", "0.1.0_2spp.exr", "-o", "more.exr"];
    let full = ["render", "scene.toml", "--preset", "full"];
    let (code, _, stderr) = place.run(&[&full[..], &more[..]].concat());
    assert_eq!(code, 1, "{stderr}");
    assert!(stderr.contains("the snapshot has path version 1, of Flambeau 0.1.0"), "{stderr}");
}

#[test]
fn a_snapshot_of_other_paths_opens_and_compares_and_is_not_gone_on_from() {
    let place = Place::new();
    let render = ["render", "scene.toml", "--spp", "2"];
    place.succeed(&[&render[..], &["-o", "ours.exr"]].concat());
    let Snapshot { film, mut header } = read_snapshot(&place.path("ours.exr")).unwrap();
    assert_eq!(header.path_version, PATH_VERSION);
    header.path_version = PATH_VERSION + 1;
    header.version = "9.8.7".to_owned();
    // A later version has keys that this one does not know.
    header.scene.push_str("\n[later]\nkey = 1\n");
    write(&place.path("other.exr"), &film, &header).unwrap();

    let theirs = (PATH_VERSION + 1).to_string();
    let info = place.succeed(&["info", "other.exr"]);
    assert!(info.contains(&format!("path version  {theirs}\n")), "{info}");
    assert_eq!(read_info(&place.path("other.exr")).unwrap().header.as_ref(), Some(&header));
    let compared =
        place.succeed(&["compare", "scene.toml", "--spp", "2", "--reference", "other.exr"]);
    assert!(compared.contains("relMSE"), "{compared}");

    let more = [&render[..], &["--resume", "other.exr", "-o", "more.exr"]].concat();
    let (code, _, stderr) = place.run(&more);
    assert_eq!(code, 1, "{stderr}");
    for words in [
        &format!("other.exr: the snapshot has path version {theirs}, of Flambeau 9.8.7"),
        &format!("with path version {PATH_VERSION}"),
        "Render anew",
    ] {
        assert!(stderr.contains(words), "{words:?} in {stderr}");
    }
    assert!(!place.path("more.exr").exists());
}
