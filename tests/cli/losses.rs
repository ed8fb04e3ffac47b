//! Nobody's files are lost: outputs never replace what is read or each other, and what was rendered is
//! always written somewhere.

use std::path::Path;

use super::{Place, SCENE, files_of, json};
use flambeau::image::npy;

/// A scene with a volume of its own, in a folder beside its own.
fn place() -> Place {
    let place = Place::new();
    std::fs::create_dir_all(place.path("deep/volumes")).unwrap();
    let volume = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/torch_hd.vdb");
    std::fs::copy(volume, place.path("deep/volumes/fire.vdb")).unwrap();
    let fire = "[film]\nsize = [8, 6]\n[[volume]]\nfile = \"volumes/fire.vdb\"\n";
    std::fs::write(place.path("deep/fire.toml"), fire).unwrap();
    place
}

/// Runs a render of the fire with these arguments, which has to be refused with these `words` and may
/// not change the file `kept`.
fn refused(place: &Place, arguments: &[&str], kept: &str, words: &str) {
    let before = std::fs::read(place.path(kept)).unwrap();
    let (code, _, stderr) = place.run(&[&["render"], arguments, &["--spp", "1"]].concat());
    assert_eq!(code, 2, "{arguments:?}: {stderr}");
    assert!(stderr.contains(words), "{arguments:?}: {stderr}");
    assert!(std::fs::read(place.path(kept)).unwrap() == before, "{arguments:?} replaced {kept}");
}

#[test]
fn outputs_never_replace_what_is_read() {
    let place = place();
    let scene = place.path("deep/fire.toml").display().to_string();
    let mut spellings = vec!["deep/fire.toml", "./deep/../deep/fire.toml", &scene];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("deep", place.path("shallow")).unwrap();
        std::os::unix::fs::symlink("deep/fire.toml", place.path("soft.json")).unwrap();
        std::fs::hard_link(place.path("deep/fire.toml"), place.path("hard.json")).unwrap();
        spellings.extend(["shallow/fire.toml", "soft.json", "hard.json"]);
    }
    let render = ["deep/fire.toml", "-o", "out.npy", "--stats"];
    for stats in spellings {
        let words = "--stats would overwrite the scene, deep/fire.toml";
        refused(&place, &[&render[..], &[stats]].concat(), "deep/fire.toml", words);
    }
    let volume = "deep/volumes/fire.vdb";
    refused(&place, &[&render[..], &[volume]].concat(), volume, "overwrite a file of the scene");
    let bare = [volume, "-o", "out.npy", "--stats", "./deep/volumes/fire.vdb", "--size", "8x6"];
    refused(&place, &bare, volume, "overwrite a file of the scene");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(volume, place.path("fire.exr")).unwrap();
        let picture = ["deep/fire.toml", "-o", "fire.exr"];
        refused(&place, &picture, volume, "-o would overwrite a file of the scene");
    }
    assert!(!place.path("out.npy").exists());
}

#[test]
fn outputs_never_replace_one_another() {
    let place = Place::new();
    std::fs::write(place.path("a.exr"), "old").unwrap();
    for [one, other] in [["a.exr", "a.exr"], ["a.exr", "./a.exr"], ["b.npy", "b.npy"]] {
        let words = format!("what -o {one} writes");
        refused(&place, &["scene.toml", "-o", one, "-o", other], "a.exr", &words);
    }
    let stats = ["scene.toml", "-o", "a.exr", "--stats", "a.exr"];
    refused(&place, &stats, "a.exr", "--stats would overwrite what -o a.exr writes");
}

/// A snapshot gives way to its own continuation, and to nothing else.
#[test]
fn a_snapshot_gives_way_to_its_continuation_alone() {
    let place = Place::new();
    place.succeed(&["render", "scene.toml", "-o", "half.exr", "--spp", "1"]);
    let resume = ["scene.toml", "--resume", "half.exr"];
    let stats = [&resume[..], &["-o", "more.exr", "--stats", "half.exr"]].concat();
    refused(&place, &stats, "half.exr", "overwrite the snapshot to go on from, half.exr");
    #[cfg(unix)]
    {
        std::fs::hard_link(place.path("half.exr"), place.path("half.png")).unwrap();
        let png = [&resume[..], &["-o", "half.png"]].concat();
        refused(&place, &png, "half.exr", "overwrite the snapshot to go on from, half.exr");
    }
    place.succeed(&[&["render"], &resume[..], &["-o", "./half.exr", "--spp", "2"]].concat());
    let film = flambeau::image::exr::read_snapshot(&place.path("half.exr")).unwrap().film;
    assert_eq!(film.sample_range(), (2, 2));
}

/// Files of `compare` and `sweep` have names of their own, which may be taken.
#[test]
fn folders_of_results_replace_nothing_that_is_read() {
    let place = Place::new();
    place.succeed(&["compare", "scene.toml", "--spp", "2", "-o", "out"]);
    let kept = std::fs::read(place.path("out/a.exr")).unwrap();
    let compare =
        ["compare", "scene.toml", "--spp", "2", "--reference", "out/a.exr", "-o", "./out"];
    let (code, _, stderr) = place.run(&compare);
    assert!(code == 2 && stderr.contains("overwrite the reference, out/a.exr"), "{stderr}");
    assert!(std::fs::read(place.path("out/a.exr")).unwrap() == kept);
    place.succeed(&[&compare[..7], &["new"]].concat());

    std::fs::write(place.path("new/table.toml"), SCENE).unwrap();
    #[cfg(unix)]
    {
        std::fs::remove_file(place.path("new/table.txt")).unwrap();
        std::fs::hard_link(place.path("new/table.toml"), place.path("new/table.txt")).unwrap();
        let sweep = ["sweep", "new/table.toml", "--spp", "2", "-o", "new"];
        let (code, _, stderr) = place.run(&sweep);
        assert!(code == 2 && stderr.contains("overwrite the scene, new/table.toml"), "{stderr}");
    }
}

/// Links lead to the same place as before, devices stay what they are, and figures go to standard
/// output where they are sent there.
#[cfg(target_os = "linux")]
#[test]
fn what_is_no_plain_file_is_written_through() {
    let place = Place::new();
    let render = ["render", "scene.toml", "-o", "out.npy", "--spp", "1", "--stats"];
    for stats in ["-", "/dev/stdout", "/proc/self/fd/1"] {
        let text = place.succeed(&[&render[..], &[stats]].concat());
        let figures: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(figures["spp"], 1, "{stats}");
    }
    assert!(Path::new("/dev/stdout").is_symlink());
    // Into a file by way of standard output: behind what is there, in the file itself.
    let log = place.path("log");
    std::fs::write(&log, "before\n").unwrap();
    let open = std::fs::File::options().append(true).open(&log).unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_flambeau"));
    command.current_dir(place.0.path()).args(render).arg("/dev/stdout").stdout(open);
    assert!(command.status().unwrap().success());
    let text = std::fs::read_to_string(&log).unwrap();
    let figures = text.strip_prefix("before\n").unwrap();
    assert_eq!(serde_json::from_str::<serde_json::Value>(figures).unwrap()["spp"], 1);

    std::fs::create_dir(place.path("farm")).unwrap();
    for (link, target) in [("a.exr", "farm/new.exr"), ("b.json", "farm/new.json")] {
        std::os::unix::fs::symlink(target, place.path(link)).unwrap();
    }
    std::os::unix::fs::symlink("/dev/null", place.path("null.png")).unwrap();
    let outputs = ["-o", "a.exr", "-o", "null.png", "--stats", "b.json", "--spp", "1"];
    place.succeed(&[&render[..2], &outputs].concat());
    for link in ["a.exr", "b.json", "null.png"] {
        assert!(place.path(link).is_symlink(), "{link} was replaced");
    }
    assert_eq!(files_of(&place.path("farm")), ["new.exr", "new.json"]);
    assert!(place.run(&["render", "scene.toml", "-o", "-"]).2.contains("standard output"));
}

/// That a folder takes no files is found out before anything is rendered.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_is_known_before_the_first_sample() {
    let place = Place::new();
    std::fs::create_dir(place.path("taken.npy")).unwrap();
    let render = ["render", "scene.toml", "-o", "good.npy", "--spp", "1"];
    for more in [["-o", "/proc/bad.npy"], ["-o", "taken.npy"], ["--stats", "/proc/bad.json"]] {
        let (code, _, stderr) = place.run(&[&render[..], &more].concat());
        assert!(code == 1 && stderr.contains(more[1]), "{more:?}: {stderr}");
        assert!(!place.path("good.npy").exists(), "{more:?}: it was rendered all the same");
    }
    std::fs::create_dir_all(place.path("out/b.exr")).unwrap();
    let (code, text, stderr) = place.run(&["compare", "scene.toml", "--spp", "1", "-o", "out"]);
    assert!(code == 1 && stderr.contains("out/b.exr: it is a folder"), "{stderr}");
    assert!(text.is_empty(), "it was rendered all the same: {text}");
}

/// The files that `name` was saved as instead, in the folder where the program ran.
#[cfg(target_os = "linux")]
fn saved_instead(place: &Place, name: &str, stderr: &str) -> std::path::PathBuf {
    let (stem, ending) = name.split_once('.').unwrap();
    let is_it = |file: &&String| file.starts_with(&format!("{stem}-")) && file.ends_with(ending);
    let files = files_of(place.0.path());
    let found = files.iter().find(is_it).unwrap_or_else(|| panic!("{files:?}: {stderr}"));
    assert!(stderr.contains(&format!("{found} instead")), "{stderr}");
    place.path(found)
}

/// A disk may fill up meanwhile.
#[cfg(target_os = "linux")]
#[test]
fn what_fails_at_the_end_is_saved_elsewhere() {
    let place = Place::new();
    for name in ["full.npy", "full.json"] {
        std::os::unix::fs::symlink("/dev/full", place.path(name)).unwrap();
    }
    let render = ["render", "scene.toml", "--spp", "1", "-o", "good.npy", "-o", "full.npy"];
    let (code, _, stderr) = place.run(&[&render[..], &["--stats", "full.json"]].concat());
    assert_eq!(code, 1, "{stderr}");
    assert!(stderr.contains("full.npy: there is no room left"), "{stderr}");
    let pixels = |path: &Path| npy::read(path).unwrap();
    assert_eq!(
        pixels(&saved_instead(&place, "full.npy", &stderr)),
        pixels(&place.path("good.npy"))
    );
    assert_eq!(json(&saved_instead(&place, "full.json", &stderr))["spp"], 1);
}

/// A folder may go meanwhile. The first picture goes into a pipe, and until somebody reads it there is
/// time for that.
#[cfg(target_os = "linux")]
#[test]
fn what_has_lost_its_folder_is_saved_elsewhere() {
    use std::process::{Command, Stdio};
    use std::time::Duration;

    let place = Place::new();
    std::fs::create_dir(place.path("gone")).unwrap();
    assert!(Command::new("mkfifo").arg(place.path("pipe.npy")).status().unwrap().success());
    let mut child = Command::new(env!("CARGO_BIN_EXE_flambeau"))
        .current_dir(place.0.path())
        .args(["render", "scene.toml", "--spp", "1", "--size", "200x150"])
        .args(["-o", "pipe.npy", "-o", "gone/out.npy"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let (sender, read) = std::sync::mpsc::channel();
    let (pipe, gone) = (place.path("pipe.npy"), place.path("gone"));
    std::thread::spawn(move || {
        // Waits until the picture is written, which is larger than a pipe holds.
        let mut pipe = std::fs::File::open(pipe).unwrap();
        std::fs::remove_dir(gone).unwrap();
        let mut picture = Vec::new();
        std::io::Read::read_to_end(&mut pipe, &mut picture).unwrap();
        sender.send(picture).unwrap();
    });
    let Ok(picture) = read.recv_timeout(Duration::from_secs(60)) else {
        child.kill().unwrap();
        panic!("nothing came through the pipe");
    };
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("gone/out.npy: there is no folder"), "{stderr}");
    let saved = saved_instead(&place, "out.npy", &stderr);
    assert!(std::fs::read(saved).unwrap() == picture);
}
