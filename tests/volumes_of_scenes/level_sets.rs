//! Level sets: shown as fog where a scene asks for it, and never else.

use flambeau::error::NO_PROGRESS;
use flambeau::scene::settings::{Albedo, Color, GridKey, Settings};
use flambeau::scene::{self, Overrides, Role, VolumeCache};
use glam::{IVec3, Vec3A};

use crate::grids::{Grid, ball, file};
use crate::of_file;

/// Center and radius of the sphere, and half the width of its band, in voxels of 0.1.
const CENTER: i32 = 40;
const RADIUS: f32 = 30.0;
const BAND: f32 = 3.0;

/// Distances to a sphere: leaves in the band and tiles of ∓ the background in and around it.
fn sphere() -> Grid {
    let (mut voxels, mut tiles) = (Vec::new(), Vec::new());
    for n in 0..10_i32.pow(3) {
        let origin = 8 * IVec3::new(n / 100, n / 10 % 10, n % 10);
        let all = (0..512).map(|n| origin + IVec3::new(n >> 6, n >> 3 & 7, n & 7));
        let distance = |voxel: IVec3| (voxel - CENTER).as_vec3().length() - RADIUS;
        let leaf: Vec<_> =
            all.map(|voxel| (voxel, 0.1 * distance(voxel).clamp(-BAND, BAND))).collect();
        match leaf.iter().all(|(_, value)| *value == leaf[0].1) {
            true => tiles.push((origin, leaf[0].1)),
            false => voxels.extend(leaf),
        }
    }
    assert!(tiles.iter().any(|(_, value)| *value < 0.0), "tiles inside");
    let class = "level set";
    Grid { class, tiles, background: 0.1 * BAND, ..Grid::fog("surface", voxels) }
}

fn written(grids: &[Grid]) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("body.vdb");
    std::fs::write(&path, file(grids)).unwrap();
    let name = path.to_str().unwrap().to_owned();
    (folder, name)
}

fn scene_of(name: &str, grid: &str) -> Settings {
    let mut settings = of_file(name.to_owned());
    settings.volume[0].density.grid = Some(grid.to_owned());
    settings.volume[0].density.level_set = true;
    settings
}

fn error_of(settings: &Settings) -> String {
    scene::assemble(settings, &VolumeCache::default(), NO_PROGRESS).unwrap_err().to_string()
}

#[test]
fn a_scene_shows_the_inside_as_fog() {
    let (_folder, name) = written(&[sphere(), Grid::fog("density", ball(IVec3::ZERO, 2, 0.5))]);
    let settings = scene_of(&name, "surface");
    let cache = VolumeCache::default();
    let built = scene::assemble(&settings, &cache, NO_PROGRESS).unwrap();
    let [instance] = built.world.instances() else { panic!() };
    let volume = instance.volume();
    for x in 0..80 {
        let voxel = IVec3::new(x, 40, 43);
        let depth = RADIUS - (voxel - CENTER).as_vec3().length();
        let found = volume.properties().mu_t(voxel.as_vec3a()).x;
        assert!((found - (depth / BAND).clamp(0.0, 1.0)).abs() < 1e-5, "{found} at {voxel}");
    }
    let bounds = instance.bounds();
    let expected = [0.1 * (CENTER as f32 - RADIUS), 0.1 * (CENTER as f32 + RADIUS)];
    assert!(bounds.min.abs_diff_eq(Vec3A::splat(expected[0]), 0.11), "{bounds:?}");
    assert!(bounds.max.abs_diff_eq(Vec3A::splat(expected[1]), 0.11), "{bounds:?}");

    let again = scene::assemble(&settings, &cache, NO_PROGRESS).unwrap();
    let same = std::ptr::eq(&**again.world.instances()[0].volume(), &**volume);
    assert!(same, "neither read nor converted again");
    let mut twice = settings.clone();
    twice.volume[0].density.level_set = false;
    twice.volume[0].density.grid = None;
    let other = scene::assemble(&twice, &cache, NO_PROGRESS).unwrap();
    assert_eq!(other.world.instances()[0].volume().properties().mu_t(Vec3A::ZERO).x, 0.5);
}

#[test]
fn what_asks_for_no_fog_is_told_how_to() {
    let (_folder, name) = written(&[sphere(), Grid::fog("smoke", ball(IVec3::ZERO, 2, 1.0))]);
    let mut settings = scene_of(&name, "surface");
    settings.volume[0].density.level_set = false;
    let error = error_of(&settings);
    assert!(error.contains("volume.0.density.level_set = true"), "{error}");
    settings.volume[0].density.level_set = true;
    settings.volume[0].albedo = Albedo::Grid(GridKey { grid: "surface".to_owned() });
    let error = error_of(&settings);
    assert!(error.contains("albedo.grid") && error.contains("fog volume"), "{error}");
    let error = error_of(&scene_of(&name, "smoke"));
    assert!(error.contains("class is fog volume"), "{error}");

    let (_folder, name) = written(&[sphere()]);
    let opened = scene::open(&name, &Overrides::default(), &VolumeCache::default(), NO_PROGRESS);
    let error = opened.unwrap_err().to_string();
    let key = "density = { grid = \"surface\", level_set = true }";
    assert!(error.contains("a level set") && error.contains(key), "{error}");
    let text = format!("camera.position = [0, -9, 0]\n[[volume]]\nfile = {name:?}\n{key}");
    let scene = scene::parse(&text, "body", "/".as_ref(), &Overrides::default()).unwrap();
    scene::assemble(&scene, &VolumeCache::default(), NO_PROGRESS).unwrap();
    assert!(scene::to_toml(&scene, None).unwrap().contains("level_set = true"));
    let text = "[[volume]]\nshape = 'box'\ndensity.level_set = true";
    let error = scene::parse(text, "box", "/".as_ref(), &Overrides::default()).unwrap_err();
    assert!(error.to_string().contains("volume.0.density.level_set"), "{error}");
}

#[test]
fn the_role_of_a_level_set_is_density_alone() {
    let (_folder, name) = written(&[Grid { name: "density", ..sphere() }]);
    let grids = scene::describe(&name, &VolumeCache::default(), NO_PROGRESS).unwrap().grids;
    let suited: Vec<_> = Role::ALL.into_iter().filter(|role| role.suits(&grids[0])).collect();
    assert_eq!(suited, [Role::Density]);
    assert!(Role::Density.best_of(&grids).is_none(), "not unless it is asked for");
    let mut settings = of_file(name);
    let volume = &mut settings.volume[0];
    volume.density.scale = Color::Gray(0.0);
    Role::Density.give(volume, &grids[0]);
    assert!(volume.density.level_set && Role::Density.is_of(volume, "density"));
    let depth = volume.density.scale.rgb().x * 0.2 * RADIUS;
    assert!((1.0..10.0).contains(&depth), "{depth}");
    scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
}

#[test]
fn frames_of_a_sequence_have_fogs_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let smaller = Grid { voxels: ball(IVec3::ZERO, 2, -0.1), tiles: Vec::new(), ..sphere() };
    let other = Grid::fog("smoke", ball(IVec3::ZERO, 2, 0.5));
    for (frame, grids) in [(1, vec![sphere()]), (2, vec![smaller]), (3, vec![other])] {
        std::fs::write(folder.path().join(format!("body_{frame}.vdb")), file(&grids)).unwrap();
    }
    let mut settings = scene_of(folder.path().join("body_#.vdb").to_str().unwrap(), "surface");
    let cache = VolumeCache::default();
    for (frame, at, density) in [(1.0, Vec3A::splat(40.0), 1.0), (2.0, Vec3A::ZERO, 1.0 / BAND)] {
        settings.time.frame = frame;
        let built = scene::assemble_frame(&settings, &cache, NO_PROGRESS).unwrap();
        let found = built.scene.world.instances()[0].volume().properties().mu_t(at).x;
        assert!((found - density).abs() < 1e-6 && built.gaps.is_empty(), "{found} in {frame}");
    }
    settings.time.frame = 3.0;
    let built = scene::assemble_frame(&settings, &cache, NO_PROGRESS).unwrap();
    assert!(built.scene.world.instances().is_empty() && !built.gaps.is_empty());
}
