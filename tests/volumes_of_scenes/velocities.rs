//! Velocities of volumes: which grids they are guessed to be, what is read of them when, and what
//! is refused.

use std::sync::Arc;

use flambeau::error::NO_PROGRESS;
use flambeau::scene::sequence::Gap;
use flambeau::scene::settings::{Settings, VelocitySettings, VelocityUnit, VolumeSettings};
use flambeau::scene::{self, Overrides, VolumeCache};
use glam::{IVec3, Vec3A};

use crate::grids::{Grid, ball, file};

fn smoke() -> Grid {
    Grid::fog("density", ball(IVec3::ZERO, 4, 1.0))
}

fn number(name: &'static str) -> Grid {
    Grid { class: "unknown", ..Grid::fog(name, ball(IVec3::ZERO, 5, 1.0)) }
}

fn vector(name: &'static str) -> Grid {
    Grid { kind: "vec3s", ..number(name) }
}

/// Writes files of grids under their names into a folder.
fn folder(files: &[(&str, Vec<Grid>)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, grids) in files {
        std::fs::write(folder.path().join(name), file(grids)).unwrap();
    }
    folder
}

fn opened(grids: Vec<Grid>) -> scene::Opened {
    let folder = folder(&[("a.vdb", grids)]);
    let name = folder.path().join("a.vdb");
    let cache = VolumeCache::default();
    scene::open(name.to_str().unwrap(), &Overrides::default(), &cache, NO_PROGRESS).unwrap()
}

fn one(grid: &str) -> VelocitySettings {
    VelocitySettings { grid: Some(grid.into()), ..VelocitySettings::default() }
}

fn three(grids: [&str; 3]) -> VelocitySettings {
    let grids = Some(grids.map(str::to_owned));
    VelocitySettings { grids, ..VelocitySettings::default() }
}

#[test]
fn velocities_of_bare_files_are_guessed_by_name_and_type() {
    let guessed = |others: Vec<Grid>| {
        let opened = opened([vec![smoke()], others].concat());
        let about = opened.notes.iter().filter(|note| note.text.contains("the velocity"));
        let listed = about.map(|note| note.to_string()).collect::<Vec<_>>();
        (opened.settings.volume[0].velocity.clone(), listed)
    };
    let (velocity, notes) = guessed(vec![number("vel"), vector("Velocity"), vector("N")]);
    assert_eq!(velocity, one("Velocity"), "one of numbers is none");
    assert_eq!(notes.len(), 1);
    for part in ["guessed: ", "\"Velocity\" is the velocity, per second", "time.shutter"] {
        assert!(notes[0].contains(part), "{notes:?}");
    }
    assert_eq!(guessed(vec![vector("v"), vector("vel")]).0, one("vel"), "the best name");
    let components = vec![number("vel_z"), number("vel_x"), number("vel_y"), number("v.x")];
    let (velocity, notes) = guessed(components);
    assert_eq!(velocity, three(["vel_x", "vel_y", "vel_z"]));
    assert!(notes[0].contains("\"vel_x\", \"vel_y\" and \"vel_z\""), "{notes:?}");
    for others in [
        vec![],
        vec![number("vel.x"), number("vel.y")],
        vec![vector("wind")],
        vec![Grid { kind: "vec3i", voxels: Vec::new(), ..vector("vel") }],
    ] {
        assert_eq!(guessed(others), (VelocitySettings::default(), vec![]));
    }

    let twice = opened(vec![smoke(), smoke(), vector("v"), vector("v")]).settings;
    assert_eq!(twice.volume[0].velocity, one("v"));
    assert_eq!(twice.volume[1].velocity, one("v[1]"), "the n-th goes with the n-th");
}

fn settings(file: &str, velocity: VelocitySettings) -> Settings {
    let file = Some(file.to_owned());
    let volume = VolumeSettings { file, velocity, ..VolumeSettings::default() };
    let mut settings = Settings { volume: vec![volume], ..Settings::default() };
    settings.time.shutter = 0.5;
    settings
}

#[test]
fn wrong_grids_are_refused_where_they_are_needed() {
    let folder = folder(&[("a.vdb", vec![smoke(), number("n"), vector("vel")])]);
    let name = folder.path().join("a.vdb").to_str().unwrap().to_owned();
    for (velocity, parts) in [
        (one("speed"), &["volume.0.velocity.grid", "no grid \"speed\"", "\"vel\""][..]),
        (one("n"), &["volume.0.velocity.grid", "single numbers", "velocity.grids"]),
        (three(["n", "n", "vel"]), &["volume.0.velocity.grids", "\"vel\" holds vectors"]),
        (three(["n", "m", "n"]), &["volume.0.velocity.grids", "no grid \"m\""]),
    ] {
        let mut settings = settings(&name, velocity);
        let error = scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap_err();
        for part in [&["a.vdb"], parts].concat() {
            assert!(error.to_string().contains(part), "{error} lacks {part}");
        }
        settings.time.shutter = 0.0;
        scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
    }
}

/// A volume is built anew for another shutter, velocity or fraction of a frame, and for nothing
/// else; without a shutter the velocity has no part in it.
#[test]
fn volumes_are_built_for_their_motion() {
    let folder = folder(&[("a.vdb", vec![smoke(), vector("vel")])]);
    let name = folder.path().join("a.vdb").to_str().unwrap().to_owned();
    let cache = VolumeCache::default();
    let volume = |settings: &Settings| {
        let scene = scene::assemble(settings, &cache, NO_PROGRESS).unwrap();
        scene.world.instances()[0].volume().clone()
    };
    let moving = settings(&name, one("vel"));
    let first = volume(&moving);
    let changed = |change: &dyn Fn(&mut Settings)| {
        let mut settings = moving.clone();
        change(&mut settings);
        let other = volume(&settings);
        let is_same = Arc::ptr_eq(&other, &volume(&moving));
        (!is_same, other.motion().is_some())
    };
    assert!(first.motion().is_some());
    let kept = volume(&moving);
    let mut later = moving.clone();
    (later.time.frame, later.camera.fov_x) = (7.0, 20.0);
    assert!(Arc::ptr_eq(&kept, &volume(&later)), "a whole frame later it is the same");
    for change in [
        &(|s: &mut Settings| s.time.shutter = 0.25) as &dyn Fn(&mut Settings),
        &|s| s.time.fps = 25.0,
        &|s| s.time.frame = 1.25,
        &|s| s.volume[0].velocity.unit = VelocityUnit::Frame,
        &|s| s.volume[0].velocity.scale = 2.0,
    ] {
        assert_eq!(changed(change), (true, true));
    }
    assert_eq!(changed(&|s| s.time.shutter = 0.0), (true, false));
    let still = |velocity: VelocitySettings| {
        let mut settings = settings(&name, velocity);
        settings.time.shutter = 0.0;
        settings
    };
    let resting = volume(&still(VelocitySettings::default()));
    assert!(Arc::ptr_eq(&resting, &volume(&still(one("vel")))));
}

/// Velocities that a frame lacks are zero, and are listed; the others move it all the same.
#[test]
fn frames_may_lack_velocities() {
    let components = ["v.x", "v.y", "v.z"];
    let all = || [vec![smoke()], components.map(number).into(), vec![vector("vel")]].concat();
    let folder = folder(&[
        ("a_1.vdb", all()),
        ("a_2.vdb", vec![smoke()]),
        ("a_3.vdb", vec![smoke(), number("v.x"), number("v.z")]),
    ]);
    let name = folder.path().join("a_#.vdb").to_str().unwrap().to_owned();
    let lacking = |frame: f64, velocity: VelocitySettings| {
        let mut settings = settings(&name, velocity);
        settings.time.frame = frame;
        let assembled =
            scene::assemble_frame(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
        let grids = assembled.gaps.iter().map(|gap| match gap {
            Gap::Grid { grid, .. } => grid.clone(),
            Gap::Frame { .. } | Gap::Empty { .. } | Gap::Pixels { .. } => panic!("{gap}"),
        });
        let volume = assembled.scene.world.instances()[0].volume().clone();
        let from = volume.source(Vec3A::ONE, 0.01);
        (grids.collect::<Vec<_>>(), from.unwrap() - volume.source(Vec3A::ONE, 0.0).unwrap())
    };
    // One length a second, in voxels of a tenth.
    let way = -0.01 * 10.0;
    let near = |found: Vec3A, expected: Vec3A| {
        assert!(found.abs_diff_eq(expected, 1e-4), "{found} for {expected}");
    };
    let (gaps, moved) = lacking(1.0, three(components));
    assert_eq!(gaps, [""; 0]);
    near(moved, Vec3A::splat(way));
    let (gaps, moved) = lacking(3.0, three(components));
    assert_eq!(gaps, ["v.y"]);
    near(moved, Vec3A::new(way, 0.0, way));
    let (gaps, moved) = lacking(2.0, one("vel"));
    assert_eq!(gaps, ["vel"]);
    near(moved, Vec3A::ZERO);
}
