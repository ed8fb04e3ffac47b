//! `flambeau sweep`: the table, its files, and what ends it early.

use super::{Place, files_of, json};

/// The files of `sweep -o`.
const SWEPT: [&str; 3] = ["chart.png", "table.json", "table.txt"];

#[test]
fn sweep_ranks_every_strategy_and_writes_table_and_chart() {
    let place = Place::new();
    let text = place.succeed(&["sweep", "scene.toml", "--spp", "16", "-o", "out"]);
    let folder = place.path("out");
    assert_eq!(files_of(&folder), SWEPT);
    assert_eq!(std::fs::read_to_string(folder.join("table.txt")).unwrap(), text);
    let chart = image::open(folder.join("chart.png")).unwrap();
    assert!(chart.width() >= 900 && chart.height() >= 12 * 30);

    let table = json(&folder.join("table.json"));
    assert!(text.contains(table["sentence"].as_str().unwrap()), "{text}");
    assert_eq!((&table["width"], &table["interrupted"]), (&40.into(), &false.into()));
    let rows = table["ranking"].as_array().unwrap();
    let names: Vec<&str> = rows.iter().map(|row| row["name"].as_str().unwrap()).collect();
    assert_eq!(names.len(), 12);
    for name in ["baseline", "full", "light probes alone", "full without fire as a light"] {
        assert!(names.contains(&name) && text.contains(name), "{name} in {names:?}");
    }
    let find = |name: &str| &rows[names.iter().position(|other| *other == name).unwrap()];
    let twin = find("full without emission decoupling")["note"].as_str().unwrap();
    assert!(twin.starts_with("same as full: ratio tracking"), "{twin}");

    // The figures fit together: the ranking is by variance × time, and so are the ratios.
    let product = |row: &serde_json::Value| {
        let factors = ["gray_variance_of_mean", "cpu_seconds_render"];
        factors.iter().map(|key| row[key].as_f64().unwrap()).product::<f64>()
    };
    let baseline = find("baseline");
    let products: Vec<f64> = rows.iter().filter(|row| row["note"].is_null()).map(product).collect();
    assert!(products.is_sorted(), "{products:?}");
    for row in rows.iter().filter(|row| row["note"].is_null()) {
        assert_eq!((&row["spp"], &row["fewest_samples"]), (&16.0.into(), &16.into()));
        let ratio = row["over_baseline"]["ratio"].as_f64().unwrap();
        assert!((ratio * product(row) / product(baseline) - 1.0).abs() < 1e-9, "{row}");
    }
    assert_eq!(rows.iter().filter(|row| row["leave_on"] == true).count(), 1);
    let alone = &table["toggles"][3];
    assert_eq!(alone["toggle"], "strategy.nee");
    assert_eq!(alone["alone"], find("fire as a light alone")["over_baseline"]);
}

/// The film is a quick one unless a size is asked for, the finer choices hold for all, and nothing is
/// written that nobody asked for.
#[test]
fn sweep_takes_a_quick_film_and_the_strategy_as_it_is_set() {
    let place = Place::new();
    let large = ["sweep", "scene.toml", "--set", "film.size=[640, 480]", "--time", "0.05"];
    let set = ["--set", "strategy.nee=false", "--set", "strategy.majorant_boost=false"];
    let text = place.succeed(&[&large[..], &set].concat());
    assert!(text.contains("105 x 78 pixels"), "{text}");
    assert!(text.contains("the toggles as set"), "{text}");
    assert_eq!(files_of(place.0.path()), ["scene.toml"]);
    let small = ["sweep", "scene.toml", "--size", "12x8", "--spp", "2", "--threads", "1"];
    assert!(place.succeed(&small).contains("12 x 8 pixels"));
    let (code, _, stderr) = place.run(&["sweep", "scene.toml", "--time", "0"]);
    assert!(code == 2 && stderr.contains("--time"), "{stderr}");
    let (code, _, _) = place.run(&["sweep", "scene.toml", "-o", "no/such/folder"]);
    assert_eq!(code, 1);
}

/// Ctrl-C gives what there is.
#[cfg(unix)]
#[test]
fn an_interrupted_sweep_writes_what_there_is() {
    use rustix::process::{Pid, Signal, kill_process};
    use std::process::{Command, Stdio};
    use std::time::Duration;

    let place = Place::new();
    for patience in [2000, 8000, 32_000] {
        let child = Command::new(env!("CARGO_BIN_EXE_flambeau"))
            .current_dir(place.0.path())
            .args(["sweep", "scene.toml", "--spp", "1000000", "-o", "out"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(patience));
        kill_process(Pid::from_child(&child), Signal::INT).unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130));
        if place.path("out/table.json").exists() {
            assert!(String::from_utf8_lossy(&output.stdout).contains("interrupted"));
            assert_eq!(files_of(&place.path("out")), SWEPT);
            assert_eq!(json(&place.path("out/table.json"))["interrupted"], true);
            return;
        }
    }
    panic!("nothing was rendered");
}
