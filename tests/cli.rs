//! The program from end to end: what it writes, prints and returns.

#[path = "cli/file_names.rs"]
mod file_names;
#[path = "cli/frames.rs"]
mod frames;
#[path = "cli/interrupts.rs"]
mod interrupts;
#[path = "cli/losses.rs"]
mod losses;
#[path = "cli/path_versions.rs"]
mod path_versions;
#[path = "cli/sweep.rs"]
mod sweep;

use std::path::{Path, PathBuf};
use std::process::Command;

use flambeau::image::exr::{read_info, read_snapshot};
use flambeau::image::npy;
use serde_json::Value;

const SCENE: &str = r#"
[camera]
position = [0.0, -4.0, 0.5]
target = [0.0, 0.0, 0.0]

[film]
size = [40, 30]
seed = 3
spp = 4

[environment]
radiance = [0.1, 0.2, 0.4]

[[volume]]
name = "ball of fire"
shape = "sphere"
radius = 1.0
density = { scale = 1.5 }
albedo = 0.6
emission = { mode = "source", le = [2.0, 1.0, 0.2] }

[[light]]
type = "sphere"
center = [2.0, -1.0, 2.0]
radius = 0.3
intensity = 20.0

[[surface]]
shape = "plane"
point = [0.0, 0.0, -1.0]
"#;

/// A folder with the scene in it.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_flambeau"));
        command.current_dir(self.0.path()).args(arguments);
        command
    }

    /// Runs it; returns the exit code, what it printed and what it complained about.
    fn run(&self, arguments: &[&str]) -> (i32, String, String) {
        let output = self.command(arguments).output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr))
    }

    fn succeed(&self, arguments: &[&str]) -> String {
        let (code, stdout, stderr) = self.run(arguments);
        assert_eq!(code, 0, "{arguments:?}: {stderr}");
        stdout
    }
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// The keys of `--stats`, which scripts read.
const STATS: [&str; 18] = [
    "cpu_seconds_render",
    "cpu_seconds_setup",
    "cpu_seconds_total",
    "gray_variance_of_mean",
    "guard_hits",
    "height",
    "mean_relative_variance",
    "mean_rgb",
    "non_finite_samples",
    "paths",
    "seed",
    "spp",
    "strategy",
    "threads",
    "tracking_steps",
    "version",
    "wall_seconds",
    "width",
];

#[test]
fn render_writes_every_format_and_the_figures() {
    let place = Place::new();
    place.succeed(&[
        "render",
        "scene.toml",
        "-o",
        "out.exr",
        "-o",
        "out.png",
        "-o",
        "out.npy",
        "--stats",
        "stats.json",
        "--threads",
        "2",
    ]);
    let (size, values) = npy::read(&place.path("out.npy")).unwrap();
    assert_eq!(size.to_array(), [40, 30]);
    assert_eq!(image::open(place.path("out.png")).unwrap().width(), 40);
    let film = read_snapshot(&place.path("out.exr")).unwrap().film;
    assert_eq!(film.sample_range(), (4, 4));

    let stats = json(&place.path("stats.json"));
    let mut keys: Vec<&str> = stats.as_object().unwrap().keys().map(String::as_str).collect();
    keys.sort_unstable();
    assert_eq!(keys, STATS);
    assert_eq!((&stats["spp"], &stats["seed"]), (&4.into(), &3.into()));
    assert_eq!((&stats["width"], &stats["threads"]), (&40.into(), &2.into()));
    assert_eq!(stats["paths"], 40 * 30 * 4);
    assert_eq!(stats["non_finite_samples"], 0);
    assert_eq!(stats["guard_hits"], 0);
    assert_eq!(stats["strategy"]["majorant_boost"], true);
    for channel in 0..3 {
        let mean = values.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>();
        let mean = mean / (30.0 * 40.0);
        assert!((stats["mean_rgb"][channel].as_f64().unwrap() - mean).abs() < 1e-6 * mean);
        assert!(mean > 0.01);
    }
    for positive in ["gray_variance_of_mean", "mean_relative_variance", "wall_seconds"] {
        assert!(stats[positive].as_f64().unwrap() > 0.0, "{positive}");
    }
    let seconds = |key: &str| stats[key].as_f64().unwrap();
    let parts = seconds("cpu_seconds_setup") + seconds("cpu_seconds_render");
    assert!((seconds("cpu_seconds_total") - parts).abs() < 1e-9);
}

#[test]
fn the_command_line_overrides_the_scene() {
    let place = Place::new();
    place.succeed(&[
        "render",
        "scene.toml",
        "-o",
        "out.exr",
        "--size",
        "17x9",
        "--seed",
        "5",
        "--spp",
        "2",
        "--preset",
        "baseline",
        "--set",
        "strategy.majorant_boost=true",
        "--set",
        "volume.0.density.scale=0.5",
        "--stats",
        "stats.json",
    ]);
    let stats = json(&place.path("stats.json"));
    assert_eq!((&stats["width"], &stats["height"]), (&17.into(), &9.into()));
    assert_eq!((&stats["spp"], &stats["seed"]), (&2.into(), &5.into()));
    assert_eq!(stats["strategy"]["emission_ratio_tracking"], false);
    assert_eq!(stats["strategy"]["majorant_boost"], true);
    let header = read_info(&place.path("out.exr")).unwrap().header.unwrap();
    assert_eq!(header.seed, 5);
    assert!(header.strategy.contains("emission_decoupling = false"), "{}", header.strategy);

    // The scene in the header renders to the same picture.
    std::fs::write(place.path("again.toml"), &header.scene).unwrap();
    place.succeed(&["render", "again.toml", "-o", "again.exr"]);
    let film = |name: &str| read_snapshot(&place.path(name)).unwrap().film;
    assert_eq!(film("out.exr"), film("again.exr"));
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let place = Place::new();
    let render = |threads: &str| {
        place.succeed(&[
            "render",
            "scene.toml",
            "-o",
            "out.exr",
            "--spp",
            "5",
            "--threads",
            threads,
        ]);
        read_snapshot(&place.path("out.exr")).unwrap().film
    };
    let one = render("1");
    assert_eq!(render("2"), one);
    assert_eq!(render("4"), one);
}

#[test]
fn a_resumed_render_is_the_uninterrupted_one() {
    let place = Place::new();
    place.succeed(&["render", "scene.toml", "-o", "half.exr", "--spp", "5"]);
    place.succeed(&["render", "scene.toml", "-o", "all.exr", "--spp", "13"]);
    place.succeed(&[
        "render",
        "scene.toml",
        "--resume",
        "half.exr",
        "-o",
        "resumed.exr",
        "-o",
        "resumed.npy",
        "--spp",
        "13",
        "--stats",
        "stats.json",
    ]);
    let snapshot = |name: &str| read_snapshot(&place.path(name)).unwrap();
    assert_eq!(snapshot("resumed.exr").film, snapshot("all.exr").film);
    assert_eq!(json(&place.path("stats.json"))["paths"], 40 * 30 * 13);
    let (half, resumed) = (snapshot("half.exr").header, snapshot("resumed.exr").header);
    assert!(resumed.cpu_seconds_render > half.cpu_seconds_render);

    let (code, _, stderr) = place.run(&[
        "render",
        "scene.toml",
        "--resume",
        "half.exr",
        "-o",
        "x.exr",
        "--set",
        "volume.0.albedo=0.7",
    ]);
    assert_eq!(code, 1);
    assert!(stderr.contains("albedo = 0.6") && stderr.contains("albedo = 0.7"), "{stderr}");
    let (code, _, stderr) = place.run(&[
        "render",
        "scene.toml",
        "--resume",
        "half.exr",
        "-o",
        "x.exr",
        "--size",
        "8x8",
    ]);
    assert_eq!(code, 1);
    assert!(stderr.contains("size"), "{stderr}");
    assert!(!place.path("x.exr").exists());
}

#[test]
fn a_biased_picture_is_called_one() {
    let place = Place::new();
    let render = ["render", "scene.toml", "-o", "out.npy", "--spp", "1"];
    let marching = [&render[..], &["--set", "strategy.integrator=march"]].concat();
    assert!(!place.run(&render).2.contains("biased"));
    let (code, _, stderr) = place.run(&marching);
    assert_eq!((code, stderr.matches("biased").count()), (0, 1), "{stderr}");
}

/// A snapshot knows the files it was rendered from, not only their names.
#[test]
fn a_changed_volume_is_not_resumed() {
    let place = Place::new();
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/torch_hd.vdb");
    let bytes = std::fs::read(assets).unwrap();
    std::fs::write(place.path("fire.vdb"), &bytes).unwrap();
    let scene = "[film]\nsize = [8, 6]\n[[volume]]\nfile = \"fire.vdb\"\n";
    std::fs::write(place.path("fire.toml"), scene).unwrap();
    place.succeed(&["render", "fire.toml", "-o", "fire.exr", "--spp", "1"]);
    let header = read_info(&place.path("fire.exr")).unwrap().header.unwrap();
    assert_eq!(header.files.len(), 1);
    assert_eq!(header.files[0].bytes, bytes.len() as u64);
    let resume = ["render", "fire.toml", "-o", "more.exr", "--spp", "2", "--resume", "fire.exr"];

    let mut other = bytes.clone();
    *other.last_mut().unwrap() ^= 1;
    std::fs::write(place.path("fire.vdb"), &other).unwrap();
    let (code, _, stderr) = place.run(&resume);
    assert_eq!(code, 1, "{stderr}");
    assert!(stderr.contains("fire.vdb has other content"), "{stderr}");
    std::fs::write(place.path("fire.vdb"), &bytes[1..]).unwrap();
    let (code, _, stderr) = place.run(&resume);
    assert_eq!(code, 1, "{stderr}");
    assert!(stderr.contains(&format!("had {} bytes", bytes.len())), "{stderr}");
    assert!(!place.path("more.exr").exists());

    std::fs::write(place.path("fire.vdb"), &bytes).unwrap();
    place.succeed(&resume);
}

/// Messages that nobody can read do not keep the picture from being written.
#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_error_stops_nothing() {
    let place = Place::new();
    let status = |arguments: &[&str]| {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_flambeau"));
        command.current_dir(place.0.path()).args(arguments).stderr(full).status().unwrap().code()
    };
    // A bare volume has its guesses told, and without --spp there is one more message.
    let volume = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/plume.vdb");
    assert_eq!(status(&["render", volume, "-o", "out.npy", "--size", "4x3"]), Some(0));
    assert_eq!(npy::read(&place.path("out.npy")).unwrap().0.to_array(), [4, 3]);
    assert_eq!(status(&["render", "absent.toml", "-o", "out.npy"]), Some(1));
}

/// The files of `compare -o`.
const COMPARED: [&str; 8] = [
    "a.exr",
    "b.exr",
    "difference.png",
    "noise_a.png",
    "noise_b.png",
    "noise_over_time.png",
    "table.json",
    "table.txt",
];

fn files_of(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort_unstable();
    names
}

#[test]
fn compare_writes_the_table_the_snapshots_and_the_pictures() {
    let place = Place::new();
    let text = place.succeed(&["compare", "scene.toml", "--spp", "16", "-o", "out"]);
    let folder = place.path("out");
    assert_eq!(files_of(&folder), COMPARED);
    assert_eq!(std::fs::read_to_string(folder.join("table.txt")).unwrap(), text);
    for name in COMPARED.iter().filter(|name| name.ends_with(".png")) {
        assert!(image::open(folder.join(name)).unwrap().width() >= 600, "{name}");
    }

    let table = json(&folder.join("table.json"));
    let sentence = table["sentence"].as_str().unwrap();
    assert!(text.contains(sentence), "{sentence}");
    assert_eq!((&table["width"], &table["seed"]), (&40.into(), &3.into()));
    assert_eq!(table["agreement"]["verdict"], "agree", "{text}");
    assert_eq!(table["interrupted"], false);
    let mut products = Vec::new();
    for (side, choice) in [("a", "baseline"), ("b", "full")] {
        let row = &table[side];
        assert_eq!((&row["choice"], &row["spp"]), (&choice.into(), &16.0.into()));
        assert_eq!(row["paths"], 40 * 30 * 16);
        let number = |key: &str| row[key].as_f64().unwrap();
        products.push(number("gray_variance_of_mean") * number("cpu_seconds_render"));
        let mean = row["mean_rgb"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap());
        let noise = number("gray_variance_of_mean").sqrt() / (mean.sum::<f64>() / 3.0);
        assert!((noise / number("noise") - 1.0).abs() < 1e-6);
        let last = row["noise_over_time"].as_array().unwrap().last().unwrap();
        assert_eq!(last[0], row["cpu_seconds_render"]);
        assert!((last[1].as_f64().unwrap() / number("noise") - 1.0).abs() < 1e-9);
    }
    let ratio = table["speed_up"]["ratio"].as_f64().unwrap();
    assert!((ratio * products[1] / products[0] - 1.0).abs() < 1e-9);
    let header = read_info(&folder.join("a.exr")).unwrap().header.unwrap();
    assert!(header.strategy.contains("majorant_boost = false"), "{}", header.strategy);
}

/// The snapshots are those that `render` writes, can be continued, and don't depend on the number
/// of threads.
#[test]
fn compared_pictures_are_those_that_render_makes() {
    let place = Place::new();
    let film = |name: &str| read_snapshot(&place.path(name)).unwrap().film;
    for threads in ["1", "3"] {
        place.succeed(&[
            "compare",
            "scene.toml",
            "--a",
            "nee=false,advanced.boost_mode=clamped",
            "--spp",
            "5",
            "--threads",
            threads,
            "-o",
            threads,
        ]);
    }
    let render = ["render", "scene.toml", "--spp", "5"];
    place.succeed(&[&render[..], &["-o", "full.exr"]].concat());
    let set = ["--set", "strategy.nee=false", "--set", "strategy.advanced.boost_mode=clamped"];
    place.succeed(&[&render[..], &set, &["-o", "other.exr"]].concat());
    for threads in ["1", "3"] {
        assert_eq!(film(&format!("{threads}/a.exr")), film("other.exr"));
        assert_eq!(film(&format!("{threads}/b.exr")), film("full.exr"));
    }
    let more = ["render", "scene.toml", "--spp", "7", "--resume", "1/b.exr", "-o", "more.exr"];
    place.succeed(&more);
    assert_eq!(film("more.exr").sample_range(), (7, 7));
}

/// The better strategy is nearer to a reference, and one of another size is refused before anything
/// is rendered.
#[test]
fn compare_measures_both_sides_against_a_reference() {
    let place = Place::new();
    place.succeed(&["render", "scene.toml", "--spp", "256", "--seed", "9", "-o", "reference.exr"]);
    let compare = ["compare", "scene.toml", "--spp", "8", "--reference", "reference.exr"];
    let text = place.succeed(&[&compare[..], &["-o", "out"]].concat());
    assert!(text.contains("relMSE") && text.contains("FLIP"), "{text}");
    let table = json(&place.path("out").join("table.json"));
    for measure in ["rel_mse", "flip"] {
        let [a, b] = ["a", "b"].map(|side| table[side]["errors"][measure].as_f64().unwrap());
        assert!(0.0 < b && b < a, "{measure}: {a} and {b}");
    }
    let (code, _, stderr) = place.run(&[&compare[..], &["--size", "8x8"]].concat());
    assert!(code == 1 && stderr.contains("8 x 8") && stderr.contains("40 x 30"), "{stderr}");
    let plain = place.succeed(&["compare", "scene.toml", "--spp", "2"]);
    assert!(!plain.contains("relMSE"), "{plain}");
}

#[test]
fn without_a_folder_compare_prints_and_writes_nothing() {
    let place = Place::new();
    let (code, text, stderr) =
        place.run(&["compare", "scene.toml", "--time", "0.2", "--b", "integrator=march"]);
    assert_eq!(code, 0, "{stderr}");
    assert!(text.contains("CPU seconds") && text.contains("integrator=march"), "{text}");
    assert!(stderr.contains("--b") && stderr.contains("biased"), "{stderr}");
    assert_eq!(files_of(place.0.path()), ["scene.toml"]);
    let (_, _, stderr) = place.run(&["compare", "scene.toml", "--b", "volume.0.albedo=0.3"]);
    assert!(stderr.contains("--set volume.0.albedo=0.3"), "{stderr}");
    let (_, _, stderr) = place.run(&["compare", "scene.toml", "--b", "baseline,nea=true"]);
    assert!(stderr.contains("--b: strategy.nea") && stderr.contains("nee"), "{stderr}");
}

/// No side gets less CPU time than it was promised.
#[test]
fn compare_gives_each_side_its_time() {
    let place = Place::new();
    place.succeed(&["compare", "scene.toml", "--time", "0.5", "-o", "out"]);
    let table = json(&place.path("out/table.json"));
    let seconds = |side: &str| table[side]["cpu_seconds_render"].as_f64().unwrap();
    assert!(seconds("a") >= 0.5 && seconds("b") >= 0.5);
}

/// Ctrl-C while both sides are rendered. A machine with much else to do is given more time to get
/// there.
#[cfg(unix)]
#[test]
fn an_interrupted_comparison_writes_what_there_is() {
    use rustix::process::{Pid, Signal, kill_process};
    use std::process::{Command, Stdio};
    use std::time::Duration;

    let place = Place::new();
    let film = || read_snapshot(&place.path("out/a.exr")).ok().map(|snapshot| snapshot.film);
    for patience in [700, 3000, 12_000, 48_000] {
        let child = Command::new(env!("CARGO_BIN_EXE_flambeau"))
            .current_dir(place.0.path())
            .args(["compare", "scene.toml", "--spp", "1000000", "-o", "out"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(patience));
        kill_process(Pid::from_child(&child), Signal::INT).unwrap();
        let output = child.wait_with_output().unwrap();
        if film().is_some_and(|film| film.totals.paths > 0) {
            assert_eq!(output.status.code(), Some(130));
            assert!(String::from_utf8_lossy(&output.stdout).contains("interrupted"));
            assert_eq!(files_of(&place.path("out")), COMPARED);
            assert_eq!(json(&place.path("out/table.json"))["interrupted"], true);
            return;
        }
    }
    panic!("nothing was rendered");
}

/// Ctrl-C in the middle: what there is is written, and going on from it misses nothing.
#[cfg(unix)]
#[test]
fn an_interrupt_writes_what_there_is() {
    stop_with(rustix::process::Signal::INT);
}

/// Render farms end programs with another signal.
#[cfg(unix)]
#[test]
fn a_request_to_end_writes_what_there_is() {
    stop_with(rustix::process::Signal::TERM);
}

#[cfg(unix)]
fn stop_with(signal: rustix::process::Signal) {
    use rustix::process::{Pid, kill_process};
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let place = Place::new();
    let film = |name: &str| read_snapshot(&place.path(name)).ok().map(|snapshot| snapshot.film);
    // A machine with much else to do is given more time to get to the first sample.
    for patience in [700, 3000, 12_000, 48_000] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_flambeau"))
            .current_dir(place.0.path())
            .args(["render", "scene.toml", "-o", "cut.exr", "--spp", "1000000"])
            .args(["--size", "200x150"])
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(patience));
        kill_process(Pid::from_child(&child), signal).unwrap();
        // As `timeout` does, a second one at once; the program may be done by then.
        let _ = kill_process(Pid::from_child(&child), signal);
        let start = Instant::now();
        let status = child.wait().unwrap();
        assert!(start.elapsed() < Duration::from_secs(20), "it went on for {:?}", start.elapsed());
        if film("cut.exr").is_some() {
            assert_eq!(status.code(), Some(130));
            break;
        }
    }
    let (_, most) = film("cut.exr").expect("nothing was rendered").sample_range();
    assert!(most > 0);

    let spp = (most + 1).to_string();
    let common = ["render", "scene.toml", "--size", "200x150", "--spp", &spp];
    place.succeed(&[&common[..], &["-o", "resumed.exr", "--resume", "cut.exr"]].concat());
    place.succeed(&[&common[..], &["-o", "all.exr"]].concat());
    assert!(film("resumed.exr").is_some() && film("resumed.exr") == film("all.exr"));
}

#[test]
fn a_time_limit_ends_the_render() {
    let place = Place::new();
    let render = ["render", "scene.toml", "-o", "out.npy", "--preset", "baseline"];
    place.succeed(&[&render[..], &["--time", "1", "--stats", "s.json"]].concat());
    let stats = json(&place.path("s.json"));
    assert!(stats["spp"].as_f64().unwrap() > 4.0, "the scene's spp was taken for a limit");
    assert!((1.0..10.0).contains(&stats["wall_seconds"].as_f64().unwrap()));
}

#[test]
fn exit_codes_tell_failure_from_wrong_usage() {
    let place = Place::new();
    std::fs::write(place.path("broken.toml"), "[camera]\nfov = 3").unwrap();
    let failures: &[&[&str]] = &[
        &["render", "absent.toml", "-o", "x.exr"],
        &["render", "broken.toml", "-o", "x.exr"],
        &["render", "scene.toml", "-o", "no/such/folder/x.exr"],
        &["render", "scene.toml", "-o", "x.exr", "--resume", "scene.toml"],
        &["compare", "absent.toml", "--spp", "1"],
        &["compare", "scene.toml", "--spp", "1", "-o", "no/such/folder"],
        &["compare", "scene.toml", "--spp", "1", "-o", "scene.toml"],
        &["info", "absent.vdb"],
        &["info", "broken.toml"],
    ];
    for arguments in failures {
        let (code, _, stderr) = place.run(arguments);
        assert_eq!(code, 1, "{arguments:?}: {stderr}");
        assert!(stderr.starts_with("flambeau: "), "{arguments:?}: {stderr}");
    }
    let usage: &[&[&str]] = &[
        &["render", "scene.toml", "-o", "x.exr", "--seed", "9007199254740992"],
        &["render", "scene.toml", "-o", "x.exr", "--set", "film.seed=9007199254740992"],
        &["render", "scene.toml"],
        &["render", "scene.toml", "-o", "x.jpg"],
        &["render", "scene.toml", "-o", "x.exr", "--size", "12"],
        &["render", "scene.toml", "-o", "x.exr", "--spp", "0"],
        &["render", "scene.toml", "-o", "x.exr", "--time", "-1"],
        &["render", "scene.toml", "-o", "x.exr", "--preset", "ful"],
        &["render", "scene.toml", "-o", "x.exr", "--set", "film.sise=[3, 3]"],
        &["render", "scene.toml", "-o", "x.exr", "--set", "nonsense"],
        &["replay", "scene.toml", "--pixel", "40,0", "--sample", "0"],
        &["replay", "scene.toml", "--pixel", "1", "--sample", "0"],
        &["compare", "scene.toml", "--a", "ful"],
        &["compare", "scene.toml", "--a", "nea=true"],
        &["compare", "scene.toml", "--b", "nee=maybe"],
        &["compare", "scene.toml", "--b", "film.seed=3"],
        &["compare", "scene.toml", "--time", "0"],
        &["keys", "--xml"],
        &["--nonsense"],
    ];
    for arguments in usage {
        let (code, _, stderr) = place.run(arguments);
        assert_eq!(code, 2, "{arguments:?}: {stderr}");
        assert!(!stderr.is_empty());
    }
    let (_, _, stderr) = place.run(usage[0]);
    assert!(stderr.contains("9007199254740991"), "{stderr}");
    for arguments in [&["--help"][..], &["--version"], &["render", "--help"]] {
        place.succeed(arguments);
    }
    assert!(!place.path("x.exr").exists());
}

#[cfg(not(feature = "gui"))]
#[test]
fn without_a_window_there_is_a_hint() {
    let (code, _, stderr) = Place::new().run(&["scene.toml"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("flambeau render"), "{stderr}");
}

#[test]
fn keys_are_listed_for_people_and_for_programs() {
    let place = Place::new();
    let text = place.succeed(&["keys"]);
    assert!(text.contains("volume.N.density.scale") && text.contains("default"), "{text}");
    let keys: Value = serde_json::from_str(&place.succeed(&["keys", "--json"])).unwrap();
    let fov = keys.as_array().unwrap().iter().find(|key| key["path"] == "camera.fov_x").unwrap();
    assert_eq!((&fov["unit"], &fov["default"]), (&"degrees".into(), &"36.0".into()));
}

#[test]
fn info_tells_what_is_in_a_file() {
    let place = Place::new();
    let scene = place.succeed(&["info", "scene.toml"]);
    for part in ["40 x 30", "ball of fire", "sphere", "emission source", "strategy"] {
        assert!(scene.contains(part), "{part} in {scene}");
    }
    place.succeed(&["render", "scene.toml", "-o", "out.exr"]);
    let snapshot = place.succeed(&["info", "out.exr"]);
    for part in ["40 x 30", "4 per pixel", "emission.(", "state (", "[[volume]]", "seed"] {
        assert!(snapshot.contains(part), "{part} in {snapshot}");
    }
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/torch_hd.vdb");
    let volume = place.succeed(&["info", assets]);
    for part in ["density", "voxel size", "range", "active voxels", "bounds", "transform"] {
        assert!(volume.contains(part), "{part} in {volume}");
    }
    assert!(place.succeed(&["info", "builtin:torch"]).starts_with("Scene"));
    assert!(place.succeed(&["info", "builtin:torch_hd"]).starts_with("OpenVDB"));
    let json: Value = serde_json::from_str(&place.succeed(&["info", "--json", assets])).unwrap();
    assert_eq!((&json["format"], &json["version"]), (&"OpenVDB".into(), &"224".into()));
    let density =
        &json["grids"].as_array().unwrap().iter().find(|g| g["name"] == "density").unwrap();
    assert_eq!((&density["type"], &density["class"]), (&"half float".into(), &"fog volume".into()));
    assert_eq!(density["active_voxels"], 89_411);
    assert!(density["max"].as_f64().unwrap() > density["mean"].as_f64().unwrap());
    assert_eq!(density["transform"][2].as_array().unwrap().len(), 4);
    assert!(density["index_bounds"][0][0].is_i64() && density.get("unsupported").is_none());
    let (code, _, stderr) = place.run(&["info", "--json", "scene.toml"]);
    assert!(code == 2 && stderr.contains("--json"), "{stderr}");
    let (code, _, stderr) = place.run(&["info", "builtin:nothing"]);
    assert_eq!(code, 1);
    assert!(stderr.contains("builtin:torch_hd"), "{stderr}");
}

/// The replayed path is the one that was rendered: at one sample per pixel the picture is made of
/// single paths.
#[test]
fn replay_prints_the_path_that_was_rendered() {
    let place = Place::new();
    place.succeed(&["render", "scene.toml", "-o", "out.npy", "--spp", "1"]);
    let (_, values) = npy::read(&place.path("out.npy")).unwrap();
    for (x, y) in [(20, 14), (3, 27), (33, 8)] {
        let pixel = format!("{x},{y}");
        let text = place.succeed(&["replay", "scene.toml", "--pixel", &pixel, "--sample", "0"]);
        assert!(text.starts_with("ray 1 from (0, -4, 0.5)"), "{text}");
        let beauty = text.lines().find_map(|line| line.trim().strip_prefix("beauty (")).unwrap();
        let beauty: Vec<f32> =
            beauty.trim_end_matches(')').split(", ").map(|v| v.parse().unwrap()).collect();
        assert_eq!(beauty, values[y * 40 + x][..3], "pixel {pixel}: {text}");
    }
}

#[test]
fn who_looks_past_the_volume_is_told() {
    let place = Place::new();
    let text = "[film]\nsize = [8, 6]\n[[volume]]\nshape = 'sphere'\n";
    std::fs::write(place.path("ball.toml"), text).unwrap();
    let told = |more: &[&str]| {
        let arguments = [&["render", "ball.toml", "--spp", "2", "-o", "a.npy"], more].concat();
        let (code, _, stderr) = place.run(&arguments);
        assert_eq!(code, 0, "{stderr}");
        stderr.contains("no path met any volume")
    };
    assert!(!told(&[]));
    assert!(told(&["--set", "camera.target=[0, -9, 0]"]));
}
