//! Requests to end a render before it has begun to sample.
#![cfg(unix)]

use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

use super::{Place, json};

/// Longer than anything that is asked to end may take, on a machine with much else to do.
const PATIENCE: Duration = Duration::from_secs(20);

/// Placing so many probes takes minutes.
const PROBES: [&str; 2] = ["--set", "strategy.advanced.probe_count=1000000"];

fn start(place: &Place, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_flambeau"))
        .current_dir(place.0.path())
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn send(child: &Child, signal: Signal) {
    kill_process(Pid::from_child(child), signal).unwrap();
}

/// Waits for it to end, but not for ever.
fn ended(mut child: Child) -> Output {
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > PATIENCE {
            child.kill().unwrap();
            let output = child.wait_with_output().unwrap();
            panic!("it went on: {}", String::from_utf8_lossy(&output.stderr));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child.wait_with_output().unwrap()
}

/// Runs it and sends `signal` once it listens for signals; a machine with much else to do is given
/// more time to get there.
fn interrupted(place: &Place, arguments: &[&str], signal: Signal) -> Output {
    for patience in [300, 1500, 6000] {
        let child = start(place, arguments);
        std::thread::sleep(Duration::from_millis(patience));
        send(&child, signal);
        let output = ended(child);
        if output.status.code().is_some() {
            return output;
        }
    }
    panic!("it never listened");
}

/// A render that is ended before its first sample leaves the picture of before.
#[test]
fn nothing_is_written_before_the_first_sample() {
    let place = Place::new();
    for name in ["out.npy", "out.exr", "stats.json"] {
        std::fs::write(place.path(name), "old").unwrap();
    }
    let render =
        ["render", "scene.toml", "-o", "out.npy", "-o", "out.exr", "--stats", "stats.json"];
    for signal in [Signal::TERM, Signal::INT] {
        let output = interrupted(&place, &[&render[..], &PROBES].concat(), signal);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(130), "{stderr}");
        assert!(stderr.contains("nothing was written"), "{stderr}");
        for name in ["out.npy", "out.exr", "stats.json"] {
            assert_eq!(std::fs::read_to_string(place.path(name)).unwrap(), "old", "{name}");
        }
    }
}

#[test]
fn a_comparison_without_samples_writes_nothing() {
    let place = Place::new();
    for command in ["compare", "sweep"] {
        std::fs::create_dir(place.path(command)).unwrap();
        std::fs::write(place.path(command).join("table.json"), "old").unwrap();
        let arguments = [&[command, "scene.toml", "-o", command], &PROBES[..]].concat();
        let output = interrupted(&place, &arguments, Signal::INT);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(130), "{stderr}");
        assert!(stderr.contains("nothing was written") && output.stdout.is_empty(), "{stderr}");
        assert_eq!(super::files_of(&place.path(command)), ["table.json"]);
        let kept = std::fs::read_to_string(place.path(command).join("table.json")).unwrap();
        assert_eq!(kept, "old");
    }
}

/// Whoever asks twice does not wait for files: here for somebody who reads the figures.
#[test]
fn a_second_request_ends_the_program_at_once() {
    let place = Place::new();
    assert!(Command::new("mkfifo").arg(place.path("pipe")).status().unwrap().success());
    let render = ["render", "scene.toml", "-o", "out.npy", "--spp", "1", "--stats", "pipe"];
    for patience in [700, 3000, 12_000] {
        let mut child = start(&place, &render);
        std::thread::sleep(Duration::from_millis(patience));
        send(&child, Signal::INT);
        // Less than a second, and more than `timeout` takes for its two signals.
        std::thread::sleep(Duration::from_millis(900));
        let waits = child.try_wait().unwrap().is_none();
        if waits {
            send(&child, Signal::INT);
        }
        let output = ended(child);
        if waits && place.path("out.npy").exists() {
            assert_eq!(output.status.code(), Some(130));
            return;
        }
    }
    panic!("it never got as far as to write");
}

/// A time that setting up eats leaves a picture with one sample in every pixel, and says so.
#[test]
fn the_time_counts_from_the_start() {
    let place = Place::new();
    let render = ["render", "scene.toml", "-o", "out.npy", "--time", "0.001", "--stats", "s.json"];
    let (code, _, stderr) = place.run(&render);
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("setting up took") && stderr.contains("--time 0.001"), "{stderr}");
    assert_eq!(json(&place.path("s.json"))["spp"], 1);
}
