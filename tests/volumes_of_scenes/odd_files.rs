//! Bare files as programs and people write them: several grids of one name, velocities beside the
//! smoke, stray voxels, places far from the origin, names that are no text.

use std::path::Path;

use flambeau::error::{NO_PROGRESS, Result};
use flambeau::scene::settings::{EmissionMode, Settings};
use flambeau::scene::{self, Overrides, Role, VolumeCache};
use flambeau::volume::CoefficientBounds;
use glam::{DVec3, IVec3, Vec3A};

use crate::grids::{Grid, ball, file};

/// Writes a file of `grids` and opens it.
fn open(grids: &[Grid]) -> (tempfile::TempDir, String, Result<scene::Opened>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("odd.vdb");
    std::fs::write(&path, file(grids)).unwrap();
    let name = path.to_str().unwrap().to_owned();
    let cache = VolumeCache::default();
    let opened = scene::open(&name, &Overrides::default(), &cache, NO_PROGRESS);
    (folder, name, opened)
}

fn has_note(opened: &scene::Opened, parts: &[&str]) -> bool {
    opened.notes.iter().any(|note| parts.iter().all(|part| note.text.contains(part)))
}

fn build(settings: &Settings) -> flambeau::transport::Scene {
    scene::assemble(settings, &VolumeCache::default(), NO_PROGRESS).unwrap()
}

/// The sum of μ_t at a point of the world over all volumes.
fn mu_t(scene: &flambeau::transport::Scene, at: Vec3A) -> f32 {
    let of = |instance: &flambeau::volume::world::Instance| {
        let local = instance.world_from_local().inverse().transform_point3a(at);
        instance.volume().properties().mu_t(local).x
    };
    scene.world.instances().iter().map(of).sum()
}

fn balls_of_one_name() -> Vec<Grid> {
    let at = |x: i32, value: f32| ball(IVec3::new(x, 0, 0), 4, value);
    [(-20, 0.5), (0, 1.0), (20, 2.0)].map(|(x, value)| Grid::fog("density", at(x, value))).into()
}

#[test]
fn grids_of_one_name_are_all_shown_and_each_has_an_address() {
    let (_folder, name, opened) = open(&balls_of_one_name());
    let opened = opened.unwrap();
    let volumes = &opened.settings.volume;
    let grids: Vec<&str> = volumes.iter().map(|volume| volume.density_grid()).collect();
    assert_eq!(grids, ["density", "density[1]", "density[2]"]);
    assert!(has_note(&opened, &["3 grids", "\"density[2]\""]), "{:?}", opened.notes);
    let built = build(&opened.settings);
    let scale = volumes[0].density.scale.rgb().x;
    for (x, value) in [(-2.0, 0.5), (0.0, 1.0), (2.0, 2.0), (1.0, 0.0)] {
        let found = mu_t(&built, Vec3A::new(x, 0.0, 0.0));
        assert!((found - scale * value).abs() < 1e-4 * scale, "{found} at {x}");
    }

    let cache = VolumeCache::default();
    let described = scene::describe(&name, &cache, NO_PROGRESS).unwrap().grids;
    let mut volume = volumes[1].clone();
    let lit = |volume: &_| -> Vec<bool> {
        described.iter().map(|grid| Role::Density.is_of(volume, &grid.name)).collect()
    };
    assert_eq!(lit(&volume), [false, true, false]);
    volume.density.grid = Some("density[0]".to_owned());
    assert_eq!(lit(&volume), [true, false, false]);
    volume.density.grid = Some("density[3]".to_owned());
    let settings = Settings { volume: vec![volume], ..Settings::default() };
    let error = scene::assemble(&settings, &cache, NO_PROGRESS).unwrap_err().to_string();
    assert!(error.contains("\"density[3]\"") && error.contains("\"density[2]\""), "{error}");
}

#[test]
fn pieces_of_fire_keep_their_own_temperatures() {
    let grid = |name, x| Grid::fog(name, ball(IVec3::new(x, 0, 0), 4, 1.5));
    let grids = [grid("density", 0), grid("temperature", 0), grid("temperature", 20)];
    let (_folder, _, opened) = open(&grids);
    let settings = opened.unwrap().settings;
    let named = |n: usize| {
        let volume = &settings.volume[n];
        (volume.density.scale.is_black(), volume.emission_grid())
    };
    assert_eq!(settings.volume.len(), 2);
    assert_eq!(named(0), (false, Some("temperature")));
    assert_eq!(named(1), (true, Some("temperature[1]")));
    assert_eq!(build(&settings).world.instances().len(), 2);
}

#[test]
fn velocities_and_their_like_are_no_smoke() {
    let voxels = || ball(IVec3::ZERO, 4, 1.5);
    let others = ["vel.x", "v_y", "velz", "rest.x", "uvw", "N", "Cd.r", "id", "mask", "body_sdf"];
    let mut grids: Vec<Grid> = others.map(|name| Grid::fog(name, voxels())).into();
    grids.push(Grid { class: "staggered", ..Grid::fog("flow_field", voxels()) });
    grids.push(Grid { class: "level set", ..Grid::fog("outside", voxels()) });
    let mut signed = voxels();
    signed[0].1 = -1.0;
    grids.push(Grid::fog("signed", signed));
    let error = open(&grids).2.unwrap_err().to_string();
    for part in ["\"vel.x\": by its name", "and 5 more", "odd.vdb"] {
        assert!(error.contains(part), "{error}");
    }
    grids.drain(..8);
    let error = open(&grids).2.unwrap_err().to_string();
    for part in [
        "\"outside\": a level set",
        "\"flow_field\": a component",
        "\"signed\": it goes below zero",
    ] {
        assert!(error.contains(part), "{error}");
    }

    grids.push(Grid::fog("temperature", voxels()));
    let fire = open(&grids).2.unwrap().settings;
    assert!(fire.volume[0].density.scale.is_black(), "a fire without smoke");
    assert_eq!(fire.volume[0].emission.mode, EmissionMode::Blackbody);
    grids.push(Grid::fog("haze", voxels()));
    let smoke = open(&grids).2.unwrap().settings;
    assert_eq!(smoke.volume[0].density_grid(), "haze", "of the rest the first is taken");
}

#[test]
fn every_grid_that_cannot_be_shown_has_its_own_reason() {
    let voxels = || ball(IVec3::ZERO, 2, 1.0);
    let grids = [
        Grid { kind: "int32", ..Grid::fog("density", Vec::new()) },
        Grid::fog("smoke", Vec::new()),
        Grid::fog("soot", ball(IVec3::ZERO, 2, -1.0)),
        Grid { kind: "vec3s", ..Grid::fog("haze", voxels()) },
    ];
    let error = open(&grids).2.unwrap_err().to_string();
    for part in [
        "\"density\": values of type int32",
        "\"smoke\": it is empty",
        "\"soot\": it has no values above zero",
        "\"haze\": it holds vectors",
    ] {
        assert!(error.contains(part), "{part}: {error}");
    }
    let mut grids = Vec::from(grids);
    grids.push(Grid::fog("temperature", voxels()));
    let opened = open(&grids).2.unwrap();
    assert!(has_note(&opened, &["\"density\" is left out", "int32"]), "{:?}", opened.notes);
}

#[test]
fn a_stray_voxel_does_not_decide_what_the_camera_frames() {
    let clean = open(&[Grid::fog("density", ball(IVec3::ZERO, 12, 1.0))]).2.unwrap();
    let mut voxels = ball(IVec3::ZERO, 12, 1.0);
    voxels.push((IVec3::new(60_000, 0, 0), 0.01));
    let (_folder, _, stray) = open(&[Grid::fog("density", voxels)]);
    let stray = stray.unwrap();
    assert!(has_note(&stray, &["\"density\"", "along x", "599"]), "{:?}", stray.notes);
    let [a, b] = [&clean, &stray].map(|opened| &opened.settings);
    let distance = |settings: &Settings| {
        let camera = &settings.camera;
        Vec3A::from(camera.position).distance(camera.target.into())
    };
    let (near, far) = (distance(a), distance(b));
    assert!((far / near - 1.0).abs() < 0.1, "{far} instead of {near}");
    let scale = |settings: &Settings| settings.volume[0].density.scale.rgb().x;
    assert!((scale(b) / scale(a) - 1.0).abs() < 0.3, "{} and {}", scale(a), scale(b));
    assert!(mu_t(&build(b), Vec3A::new(6000.0, 0.0, 0.0)) > 0.0, "it is still there");
}

/// A ball of millimeters far away by its transform, or by its voxels.
fn far_balls() -> [Grid; 2] {
    let by_transform = Grid {
        voxel_size: 0.001,
        translation: DVec3::new(500_000.0, 20.0, 0.0),
        ..Grid::fog("density", ball(IVec3::ZERO, 10, 1.0))
    };
    let center = IVec3::new(500_000_000, 20_000, 0);
    let by_voxels = Grid { voxel_size: 0.001, ..Grid::fog("density", ball(center, 10, 1.0)) };
    [by_transform, by_voxels]
}

#[test]
fn millimeters_far_away_are_moved_near_and_keep_their_shape() {
    for grid in far_balls() {
        let (_folder, name, opened) = open(&[grid]);
        let opened = opened.unwrap();
        assert!(has_note(&opened, &["[500000, 20, 0]", "moved"]), "{:?}", opened.notes);
        let scene = build(&opened.settings);
        let bounds = scene.world.instances()[0].bounds();
        assert!(bounds.size().abs_diff_eq(Vec3A::splat(0.021), 1e-6), "{bounds:?}");
        assert!(bounds.center().length() < 0.05, "{bounds:?}");
        // Along a chord, the density is that of the ball voxel by voxel.
        let scale = opened.settings.volume[0].density.scale.rgb().x;
        for step in -12_i32..=12 {
            let at = bounds.center() + Vec3A::new(step as f32 * 0.001, 0.0, 0.0);
            let expected = if step.abs() <= 10 { scale } else { 0.0 };
            assert!((mu_t(&scene, at) - expected).abs() < 0.1 * scale, "at voxel {step}");
        }
        let described = scene::describe(&name, &VolumeCache::default(), NO_PROGRESS).unwrap();
        let [low, high] = described.grids[0].voxels.unwrap().bounds.unwrap();
        assert!((low[0] - 499_999.989_5).abs() < 1e-6 && (high[0] - 500_000.010_5).abs() < 1e-6);
    }
}

#[test]
fn a_scene_with_a_placement_of_its_own_stays_where_it_is() {
    let (_folder, name, opened) = open(&far_balls()[..1]);
    let mut settings = opened.unwrap().settings;
    settings.volume[0].translate = [0.0; 3];
    let far = *build(&settings).world.instances()[0].bounds();
    assert!((far.center().x - 500_000.0).abs() < 0.1, "{far:?} of {name}");
    // What is moved back by a scene is as exact as what is moved by the guess.
    settings.volume[0].translate = [-500_000.0, -20.0, 1.0];
    let near = *build(&settings).world.instances()[0].bounds();
    assert!(near.center().abs_diff_eq(Vec3A::Z, 1e-5), "{near:?}");
    assert!(near.size().abs_diff_eq(Vec3A::splat(0.021), 1e-6), "{near:?}");
}

#[test]
fn voxels_of_a_frustum_lie_where_its_map_says() {
    let values = |voxel: IVec3| 1.0 + 0.1 * voxel.x as f32 + 0.05 * voxel.z as f32;
    for taper in [0.5, 2.0] {
        let voxels = ball(IVec3::ZERO, 6, 1.0).into_iter().map(|(at, _)| (at, values(at)));
        let grid = Grid {
            voxel_size: 2.0,
            translation: DVec3::new(0.0, 0.0, 1.0),
            frustum: Some([taper, 3.0]),
            ..Grid::fog("density", voxels.collect())
        };
        let (_folder, _, opened) = open(&[grid]);
        let opened = opened.unwrap();
        let scene = build(&opened.settings);
        let scale = opened.settings.volume[0].density.scale.rgb().x;
        for (voxel, _) in ball(IVec3::ZERO, 5, 1.0) {
            let depth = f64::from(voxel.z + 8) / 16.0;
            let widened = (1.0 + (1.0 / taper - 1.0) * depth) / 16.0;
            let [x, y] = [voxel.x, voxel.y].map(|c| f64::from(c) * widened * 2.0);
            let world = DVec3::new(x, y, depth * 3.0 * 2.0 + 1.0).as_vec3a();
            let found = mu_t(&scene, world) / scale;
            assert!((found - values(voxel)).abs() < 1e-3, "{found} at {voxel}");
        }
        check_majorants(&scene);
    }
}

/// Holds the majorants of a scene's first volume against what is in their cells.
fn check_majorants(scene: &flambeau::transport::Scene) {
    let volume = scene.world.instances()[0].volume();
    let CoefficientBounds::Cells(cells) = volume.bounds() else { panic!("no cells") };
    let mut met = 0;
    cells.for_each_cell(|_, bounds, majorant| {
        for n in 0..64 {
            let t = Vec3A::new((n & 3) as f32, (n >> 2 & 3) as f32, (n >> 4) as f32) / 3.0;
            let inside = volume.properties().mu_t(bounds.min + t * bounds.size()).x;
            assert!(inside <= majorant.mu_t * 1.0001, "{inside} over {majorant:?}");
            met += usize::from(inside > 0.0);
        }
    });
    assert!(met > 100, "{met}");
}

#[test]
fn a_frustum_is_not_looked_at_behind_its_tip() {
    let mut voxels = ball(IVec3::ZERO, 6, 1.0);
    let frustum = Some([0.5, 3.0]);
    let open_frustum = |voxels: &[(IVec3, f32)]| {
        open(&[Grid { frustum, ..Grid::fog("density", voxels.to_vec()) }]).2
    };
    assert!(open_frustum(&voxels).is_ok());
    voxels.push((IVec3::new(0, 0, -30), 1.0));
    let error = open_frustum(&voxels).unwrap_err().to_string();
    assert!(error.contains("tip of its frustum"), "{error}");
}

#[cfg(unix)]
#[test]
fn names_that_are_no_text_are_opened_saved_and_found_again() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let odd = folder.path().join(std::ffi::OsStr::from_bytes(b"fum\xe9e"));
    if std::fs::create_dir(&odd).is_err() {
        eprintln!("skipped: this file system takes no such names");
        return;
    }
    let path = odd.join(std::ffi::OsStr::from_bytes(b"br\xfbl\xe9.vdb"));
    std::fs::write(&path, file(&[Grid::fog("density", ball(IVec3::ZERO, 4, 1.0))])).unwrap();
    let name = flambeau::files::name_of(&path);
    let settings = scene::load(&name).unwrap();
    build(&settings);
    assert_eq!(scene::files_on_disk(&settings).unwrap(), std::slice::from_ref(&path));
    assert!(scene::fingerprints(&settings, NO_PROGRESS).is_ok());
    let saved = odd.join(std::ffi::OsStr::from_bytes(b"sc\xe8ne.toml"));
    scene::save(&settings, &saved).unwrap();
    assert_eq!(scene::load(&flambeau::files::name_of(&saved)).unwrap(), settings);
    let absent = flambeau::files::name_of(&odd.join(Path::new("absent.vdb")));
    assert!(scene::load(&absent).unwrap_err().to_string().contains("no such file"));
}
