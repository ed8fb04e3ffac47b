//! Names of files that are no Unicode text, on the command line.
#![cfg(unix)]

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;

use super::Place;

#[test]
fn a_volume_is_opened_and_gone_on_from_by_any_name() {
    let place = Place::new();
    let name = OsStr::from_bytes(b"it's br\xfbl\xe9.vdb");
    let asset = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/plume.vdb");
    if std::fs::copy(asset, place.0.path().join(name)).is_err() {
        eprintln!("skipped: this file system takes no such names");
        return;
    }
    let run = |command: &mut std::process::Command| {
        let output = command.output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let info = run(place.command(&["info"]).arg(name));
    assert!(info.contains("\"density\""), "{info}");
    let few = ["--size", "16x9"];
    run(place.command(&["render"]).arg(name).args(few).args(["--spp", "1", "-o", "a.exr"]));
    let scene = place.succeed(&["info", "a.exr"]);
    assert!(scene.contains("[[volume]]"), "{scene}");
    run(place
        .command(&["render"])
        .arg(name)
        .args(few)
        .args(["--spp", "2", "--resume", "a.exr", "-o", "b.exr"]));
    let absent = OsStr::from_bytes(b"\xff.vdb");
    let output = place.command(&["info"]).arg(absent).output().unwrap();
    assert!(String::from_utf8_lossy(&output.stderr).contains("no such file"));
}
