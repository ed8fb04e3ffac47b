//! From a name to a scene that can be rendered: what is guessed of a bare volume, what is built of
//! settings, what is kept between builds, and what is refused.

#[path = "vdb/grids.rs"]
mod grids;
#[path = "volumes_of_scenes/level_sets.rs"]
mod level_sets;
#[path = "volumes_of_scenes/odd_files.rs"]
mod odd_files;
#[path = "volumes_of_scenes/velocities.rs"]
mod velocities;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use flambeau::error::{Error, NO_PROGRESS};
use flambeau::scene::settings::{Color, EmissionMode, Settings, VolumeSettings, VolumeShape};
use flambeau::scene::{self, Overrides, Setup, VolumeCache};
use glam::Vec3A;

fn asset(name: &str) -> String {
    format!("{}/assets/{name}.vdb", env!("CARGO_MANIFEST_DIR"))
}

/// A file of the folder of test data beside the repository, or `None` with a word if there is none.
fn shared(name: &str) -> Option<String> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared");
    let folder = std::env::var_os("FLAMBEAU_SHARED").map_or(PathBuf::from(beside), PathBuf::from);
    let path = folder.join(name);
    if !path.exists() {
        eprintln!("skipped: there is no {}", path.display());
        return None;
    }
    Some(path.to_str().unwrap().to_owned())
}

fn opened(name: &str) -> scene::Opened {
    scene::open(name, &Overrides::default(), &VolumeCache::default(), NO_PROGRESS).unwrap()
}

fn of_file(file: String) -> Settings {
    let volume = VolumeSettings { file: Some(file), ..VolumeSettings::default() };
    Settings { volume: vec![volume], ..Settings::default() }
}

fn build_error(settings: &Settings) -> String {
    flambeau::scene::assemble(settings, &VolumeCache::default(), NO_PROGRESS)
        .unwrap_err()
        .to_string()
}

#[test]
fn every_shipped_scene_is_built() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let settings = scene::load(path.to_str().unwrap()).unwrap();
        let built =
            flambeau::scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
        assert_eq!(built.world.instances().len(), settings.volume.len());
        count += 1;
    }
    assert!(count >= 14);
    let embedded = scene::load(scene::DEFAULT_SCENE).unwrap();
    let file = scene::load(&format!("{}/scenes/torch.toml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    assert_eq!(embedded, file);
    let builtin = |volume: &VolumeSettings| volume.file.as_ref().unwrap().starts_with("builtin:");
    assert!(embedded.volume.iter().all(builtin), "the default scene needs no file");
}

#[test]
fn fires_glow_in_a_dim_studio_and_smoke_is_lit() {
    let horizon = |settings: &Settings| settings.environment.gradient.unwrap()[1].rgb().x;
    for name in ["torch_hd", "campfire_hd", "explosion_hd"] {
        let opened = opened(&asset(name));
        let volume = &opened.settings.volume[0];
        assert_eq!(volume.name, name);
        assert_eq!(volume.density_grid(), "density");
        assert_eq!(volume.emission.mode, EmissionMode::Blackbody);
        assert_eq!(volume.emission_grid(), Some("temperature"));
        assert_eq!(volume.emission.kelvin_scale(), 1000.0, "Blender's temperature of 0 to 3");
        assert_eq!(Setup::of(&opened.settings), Some(Setup::Studio));
        assert!(horizon(&opened.settings) < 0.06, "the fire is the light");
        assert!(opened.notes.iter().any(|note| note.text.contains("\"temperature\"")));
    }
    for name in ["plume", "cloud", "fog"] {
        let settings = opened(&asset(name)).settings;
        assert_eq!(settings.volume[0].emission.mode, EmissionMode::None);
        assert_eq!(Setup::of(&settings), Some(Setup::Studio));
        assert!(horizon(&settings) > 0.15);
    }
}

#[test]
fn guessed_volumes_stand_upright_in_the_picture() {
    let houdini = shared("volumes/smoke.vdb");
    let files = ["torch_hd", "explosion_hd", "plume", "cloud", "fog"].map(asset);
    for file in files.into_iter().chain(houdini) {
        let settings = opened(&file).settings;
        let is_y_up = settings.volume[0].rotate != [0.0; 3];
        assert_eq!(is_y_up, file.ends_with("smoke.vdb"), "{file}");
        let built =
            flambeau::scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
        let bounds = built.world.instances()[0].bounds();
        assert!(bounds.min.z > -0.5 * bounds.size().z, "{file} hangs below its ground: {bounds:?}");
        let size = glam::UVec2::new(160, 90);
        let ray = built.camera.ray(size, size / 2, glam::Vec2::ZERO);
        assert!(bounds.intersect(&ray, 0.0, f32::INFINITY).is_some(), "{file} is not in view");
    }
}

#[test]
fn guesses_follow_names_and_ranges() {
    if let Some(file) = shared("peers/flame.vdb") {
        let volume = &opened(&file).settings.volume[0];
        assert_eq!(volume.emission_grid(), Some("emission"), "emission comes before temperature");
        assert_eq!(volume.rotate, [0.0; 3]);
    }
    if let Some(file) = shared("volumes/densityAndHeat.vdb") {
        let volume = &opened(&file).settings.volume[0];
        assert_eq!(volume.emission_grid(), Some("heat"));
        assert!(volume.emission.kelvin_scale() > 2000.0, "a maximum of 0.76 is not kelvin");
    }
    if let Some(file) = shared("volumes/raw/blender_cache_explosion_0018.vdb") {
        let volume = &opened(&file).settings.volume[0];
        assert_eq!(
            (volume.density_grid(), volume.emission_grid()),
            ("density", Some("temperature"))
        );
    }
    if let Some(path) = shared("volumes/sphere.vdb") {
        let message = scene::load(&path).unwrap_err().to_string();
        assert!(message.contains("sphere.vdb") && message.contains("level set"), "{message}");
    }
}

#[test]
fn overrides_reach_bare_volumes() {
    let overrides = Overrides { preset: None, set: vec!["volume.0.density.scale=3".into()] };
    let cache = VolumeCache::default();
    let opened = scene::open("builtin:plume", &overrides, &cache, NO_PROGRESS).unwrap();
    assert_eq!(opened.settings.volume[0].density.scale, Color::Gray(3.0));
    assert_eq!(opened.settings.volume[0].file.as_deref(), Some("builtin:plume"));
}

#[test]
fn what_cannot_be_opened_is_named_with_the_mend() {
    for (source, expected) in [
        ("no/such/scene.toml", &["no/such/scene.toml"][..]),
        ("no/such/smoke.vdb", &["no/such/smoke.vdb"]),
        ("picture.png", &["picture.png", ".toml", ".vdb"]),
        ("builtin:nosuch", &["builtin:nosuch", "builtin:torch_hd", "scenes are builtin:torch,"]),
        (concat!(env!("CARGO_MANIFEST_DIR"), "/README.md"), &["README.md", ".toml"]),
    ] {
        let message = scene::load(source).unwrap_err().to_string();
        expected.iter().for_each(|part| assert!(message.contains(part), "{source}: {message}"));
    }
    let missing = build_error(&of_file("/no/such/smoke.vdb".into()));
    assert!(missing.contains("/no/such/smoke.vdb"), "{missing}");
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().to_str().unwrap().to_owned();
    assert!(build_error(&of_file(folder)).contains("folder"));
}

#[test]
fn grids_that_are_not_there_are_answered_with_those_that_are() {
    let mut settings = of_file("builtin:torch_hd".into());
    settings.volume[0].density.grid = Some("nosuch".into());
    let message = build_error(&settings);
    for part in ["builtin:torch_hd", "volume.0.density.grid", "nosuch", "\"flame\""] {
        assert!(message.contains(part), "{message}");
    }
    let shape = VolumeSettings {
        shape: Some(VolumeShape::Box),
        density: settings.volume[0].density.clone(),
        ..VolumeSettings::default()
    };
    let message = build_error(&Settings { volume: vec![shape], ..Settings::default() });
    assert!(message.contains("volume.0.density.grid") && message.contains("\"density\""));

    if let Some(file) = shared("volumes/sphere.vdb") {
        let mut settings = of_file(file);
        settings.volume[0].density.grid = Some("ls_sphere".into());
        let message = build_error(&settings);
        assert!(
            message.contains("level set") && message.contains("density.level_set"),
            "{message}"
        );
        settings.volume[0].density.level_set = true;
        let built = scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap().world;
        let volume = built.instances()[0].volume();
        let center = volume.region().bounds().center();
        assert_eq!(volume.properties().mu_t(center).x, 1.0, "a tile inside");
    }
    if let Some(file) = shared("peers/flame.vdb") {
        let mut settings = of_file(file);
        settings.volume[0].density.grid = Some("emission".into());
        assert!(build_error(&settings).contains("holds vectors"));
    }
}

#[test]
fn the_street_keeps_one_torch_for_all_of_its_torches() {
    let street =
        scene::load(&format!("{}/scenes/street.toml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let built = flambeau::scene::assemble(&street, &VolumeCache::default(), NO_PROGRESS).unwrap();
    let files = street.volume.iter().map(|volume| volume.file.is_some());
    let torches: Vec<_> = std::iter::zip(files, built.world.instances())
        .filter_map(|(is_torch, instance)| is_torch.then_some(instance.volume()))
        .collect();
    assert_eq!(torches.len(), 200);
    assert!(torches.iter().all(|torch| std::sync::Arc::ptr_eq(torch, torches[0])));
}

#[test]
fn instances_of_a_file_share_its_volume() {
    let mut settings = of_file("builtin:plume".into());
    for x in 1..200 {
        let mut copy = settings.volume[0].clone();
        copy.translate = [x as f32, 0.0, 0.0];
        settings.volume.push(copy);
    }
    settings.volume[7].density.scale = Color::Gray(9.0);
    let built = flambeau::scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
    let instances = built.world.instances();
    let same = |i: usize| std::sync::Arc::ptr_eq(instances[0].volume(), instances[i].volume());
    assert!((1..200).all(|i| same(i) == (i != 7)));
    let moved = instances[5].bounds().min - instances[0].bounds().min;
    assert!(moved.abs_diff_eq(Vec3A::new(5.0, 0.0, 0.0), 1e-4));
}

#[test]
fn an_edit_reads_no_file_again_and_a_changed_file_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vdb");
    std::fs::copy(asset("plume"), &path).unwrap();
    let name = path.to_str().unwrap().to_owned();
    let mut settings = of_file(name.clone());
    let cache = VolumeCache::default();
    let first = flambeau::scene::assemble(&settings, &cache, NO_PROGRESS).unwrap();
    let file = cache.file(&name, NO_PROGRESS).unwrap();

    settings.camera.fov_x = 20.0;
    let turned = flambeau::scene::assemble(&settings, &cache, NO_PROGRESS).unwrap();
    let volume = |scene: &flambeau::transport::Scene| scene.world.instances()[0].volume().clone();
    assert!(std::sync::Arc::ptr_eq(&volume(&first), &volume(&turned)), "the camera is no volume");

    settings.volume[0].density.scale = Color::Gray(2.0);
    let thicker = flambeau::scene::assemble(&settings, &cache, NO_PROGRESS).unwrap();
    assert!(!std::sync::Arc::ptr_eq(&volume(&first), &volume(&thicker)));
    let same_file =
        |file: &_| std::sync::Arc::ptr_eq(file, &cache.file(&name, NO_PROGRESS).unwrap());
    assert!(same_file(&file), "an edit of numbers reads nothing");

    std::fs::copy(asset("torch_hd"), &path).unwrap();
    let replaced = flambeau::scene::assemble(&settings, &cache, NO_PROGRESS).unwrap();
    assert!(!same_file(&file));
    assert_ne!(
        replaced.world.instances()[0].bounds().size(),
        thicker.world.instances()[0].bounds().size()
    );
    settings.volume.clear();
    flambeau::scene::assemble(&settings, &cache, NO_PROGRESS).unwrap();
}

#[test]
fn building_can_be_cancelled_and_reports_how_far_it_is() {
    let settings = of_file(asset("explosion_hd"));
    let cancelled = flambeau::scene::assemble(&settings, &VolumeCache::default(), &|_| false);
    assert!(matches!(cancelled, Err(Error::Cancelled)));
    let calls = AtomicU32::new(0);
    let progress = |fraction: f32| {
        assert!((0.0..=1.0).contains(&fraction));
        calls.fetch_add(1, Ordering::Relaxed);
        true
    };
    flambeau::scene::assemble(&settings, &VolumeCache::default(), &progress).unwrap();
    assert!(calls.load(Ordering::Relaxed) > 1);
    let opening =
        scene::open(&asset("cloud"), &Overrides::default(), &VolumeCache::default(), &|_| false);
    assert!(matches!(opening, Err(Error::Cancelled)));
}

#[test]
fn grids_of_different_voxel_sizes_lie_over_each_other() {
    // The temperature of this file has voxels twice as large as those of its density.
    let mut settings = of_file("builtin:torch_hd".into());
    settings.volume[0].emission.mode = EmissionMode::Blackbody;
    settings.volume[0].emission.kelvin_scale = Some(1000.0);
    settings.volume[0].scale = scene::settings::Extent::Uniform(2.0);
    let cache = VolumeCache::default();
    let built = flambeau::scene::assemble(&settings, &cache, NO_PROGRESS).unwrap();
    let instance = &built.world.instances()[0];
    let described = scene::describe("builtin:torch_hd", &cache, NO_PROGRESS).unwrap();
    for grid in described.grids.iter().filter(|grid| grid.name != "flame") {
        let [min, max] = grid.voxels.unwrap().bounds.unwrap();
        let [min, max] = [min, max].map(|corner| Vec3A::from_array(corner.map(|c| c as f32)));
        let slack = Vec3A::splat(1e-3);
        assert!((instance.bounds().min - slack).cmple(2.0 * min).all(), "{}", grid.name);
        assert!((instance.bounds().max + slack).cmpge(2.0 * max).all(), "{}", grid.name);
    }
}

#[test]
fn files_are_described_grid_by_grid() {
    let cache = VolumeCache::default();
    let described = scene::describe(&asset("torch_hd"), &cache, NO_PROGRESS).unwrap();
    let names: Vec<&str> = described.grids.iter().map(|grid| grid.name.as_str()).collect();
    assert_eq!(names, ["density", "flame", "temperature"]);
    let temperature = described.grids[2].voxels.unwrap();
    assert!((temperature.max - 2.96).abs() < 0.01 && temperature.active == 16_018);
    assert!((described.grids[2].voxel_size[0] - 0.035).abs() < 1e-6);
    if let Some(file) = shared("volumes/smoke_000001.vdb") {
        let described = scene::describe(&file, &cache, NO_PROGRESS).unwrap();
        let obstacles = described.grids.iter().find(|grid| grid.name == "obstacles").unwrap();
        assert!(obstacles.voxels.is_none() && obstacles.unsupported.is_some());
    }
}
