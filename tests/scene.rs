//! Scene files: what they may say, what is refused and how, and that saving loses nothing.

use std::path::Path;

use flambeau::error::NO_PROGRESS;
use flambeau::scene::settings::{
    Albedo, CameraKey, CameraSettings, Color, EmissionMode, EmissionSettings, Extent, GridKey,
    LightKind, LightSettings, MaterialKind, MaterialSettings, Normalize, RampKind, SkySettings,
    SurfaceSettings, SurfaceShape, VelocitySettings, VelocityUnit, VolumeSettings, VolumeShape,
    WorldUp,
};
use flambeau::scene::{self, Overrides, Settings, VolumeCache, keys};
use flambeau::transport::strategy::{BoostMode, Preset};
use glam::Vec3A;
use rand::{Rng, RngExt, SeedableRng};

fn parse(text: &str) -> flambeau::error::Result<Settings> {
    scene::parse(text, "torch.toml", Path::new("/scenes"), &Overrides::default())
}

fn set(text: &str, assignments: &[&str]) -> flambeau::error::Result<Settings> {
    let set = assignments.iter().map(|s| s.to_string()).collect();
    let overrides = Overrides { preset: None, set };
    scene::parse(text, "torch.toml", Path::new("/scenes"), &overrides)
}

/// The scene of the format's description.
const EXAMPLE: &str = r#"
[camera]
position = [0.0, -6.5, 2.2]
target   = [0.3, 0.0, -0.35]
up       = [0.0, 0.0, 1.0]
fov_x    = 36.0                     # degrees, full horizontal angle

[film]
size = [128, 128]                   # the window uses its own size unless told to keep this one
seed = 0
spp  = 0                            # 0: until stopped

[path]
max_scatters = 0                    # real scattering events + reflections; 0: unbounded

[environment]
radiance = 0.0                      # number or [r, g, b]; later: file, rotation

[[volume]]
name = "flame"
file = "flame.vdb"                  # or shape = ...
translate = [0, 0, 0]               # placement: scale, then rotate, then translate
rotate = [0, 0, 0]
scale = 1.0
density  = { grid = "density", scale = 1.0 }        # mu_t = scale * value; scale may be [r, g, b]
albedo   = 0.2                      # number, [r, g, b] or { grid = "albedo" }
phase    = { g = 0.0 }
emission = { mode = "grid", grid = "emission", scale = 1.0 }

[[light]]                           # type = "sun" | "point" | "spot" | "sphere" | "quad"
type = "point"
position = [0, 0, 2]
intensity = [1, 1, 1]               # point, spot: W/sr; sun: irradiance; sphere, quad: radiance

[[surface]]                         # shape = "plane" | "quad" | "sphere" | "box" | later "mesh"
shape = "plane"
point = [0, 0, -1.001]
normal = [0, 0, 1]
half_size = 6.0                     # absent: infinite
material = { type = "diffuse", reflectance = 0.5 }
emission = 0.0                      # radiance, both sides; any surface can emit

[[surface]]
shape = "sphere"
center = [1.6, -0.8, -0.5]
radius = 0.5
material = { type = "conductor", alpha = 0.2, reflectance = 0.8 }

[strategy]
preset = "full"
emission_decoupling = true
emission_ratio_tracking = true
majorant_boost = true
nee = true
probe_mis = true
[strategy.advanced]
boost_mode = "stratified"
"#;

#[test]
fn the_example_of_the_format_parses() {
    let scene = parse(EXAMPLE).unwrap();
    assert_eq!(scene.camera.target, [0.3, 0.0, -0.35]);
    assert_eq!(scene.film.size, [128, 128]);
    let flame = &scene.volume[0];
    assert_eq!(flame.file.as_deref(), Some("/scenes/flame.vdb"));
    assert_eq!((flame.density_grid(), flame.emission_grid()), ("density", Some("emission")));
    assert_eq!(flame.albedo, Albedo::Gray(0.2));
    assert_eq!(scene.light[0].intensity, Color::Rgb([1.0; 3]));
    assert_eq!(scene.surface[0].half_size, Some(Extent::Uniform(6.0)));
    let metal = scene.surface[1].material.unwrap();
    assert_eq!((metal.kind, metal.alpha()), (MaterialKind::Conductor, 0.2));
    assert_eq!(scene.strategy, Preset::Full.strategy());
    assert_eq!(parse("").unwrap(), Settings::default());
}

#[test]
fn every_spelling_of_a_value_is_understood() {
    let scene = parse(
        r#"
        [[volume]]
        shape = "ramp"
        kind = "exponential"
        half_size = [1, 2, 3]
        h = 0.5
        axis = "x"
        albedo = { grid = "albedo" }
        density.scale = [1, 2, 3]
        matrix = [[1, 0, 0, 4], [0, 1, 0, 5], [0, 0, 1, 6]]
        emission = { mode = "blackbody", kelvin_scale = 1000, normalize = "t4" }
        [[volume]]
        file = "builtin:torch_hd"
        albedo = [0.1, 0.2, 0.3]
        [[light]]
        type = "sun"
        irradiance = 3
        [[light]]
        type = "quad"
        radiance = [1, 2, 3]
        [strategy.advanced]
        boost_mode = "literal"
        "#,
    )
    .unwrap();
    let ramp = &scene.volume[0];
    assert_eq!((ramp.kind(), ramp.h()), (RampKind::Exponential, 0.5));
    assert_eq!(ramp.half_size(), Extent::Axes([1.0, 2.0, 3.0]));
    assert_eq!(ramp.albedo, Albedo::Grid(GridKey { grid: "albedo".into() }));
    assert_eq!(ramp.density.scale, Color::Rgb([1.0, 2.0, 3.0]));
    assert_eq!(ramp.emission_grid(), Some("density"), "a shape has the one grid");
    assert_eq!(scene.volume[1].file.as_deref(), Some("builtin:torch_hd"));
    assert_eq!(scene.light[0].intensity, Color::Gray(3.0));
    assert_eq!(scene.light[1].intensity, Color::Rgb([1.0, 2.0, 3.0]));
    assert_eq!(scene.strategy.advanced.boost_mode, BoostMode::Literal);
}

/// Each malformed scene with what its message must say beside the file's name: the key in full,
/// and the mend.
const MALFORMED: &[(&str, &[&str])] = &[
    ("[camera\n", &["line 1"]),
    ("[film]\nsize = [1, 2\nspp = 3", &["line 3"]),
    ("[camera]\nfov = 3", &["camera.fov:", "unknown key", "camera.fov_x"]),
    ("[[volume]]\nshape = 'box'\ndensity.scael = 3", &["volume.0.density.scael:", "scale"]),
    ("[[volume]]\nshape = 'box'\n[[volume]]\nalbdo = 1", &["volume.1.albdo:", "volume.1.albedo"]),
    ("[[volumes]]\nshape = 'box'", &["volumes:", "nearest known key is volume"]),
    ("kelvin_scale = 3", &["kelvin_scale:", "volume.N.emission.kelvin_scale"]),
    ("[camera]\nfov_x = 'wide'", &["camera.fov_x:", "expected number", "\"wide\""]),
    ("[camera]\nfov_x = 200", &["camera.fov_x:", "200 is out of range", "179.9"]),
    ("[camera]\nfov_x = nan", &["camera.fov_x:", "not a finite number"]),
    ("[camera]\nposition = [1, 1e300, 1]", &["camera.position.1:", "not a finite number"]),
    ("[camera]\nposition = [1, 2]", &["camera.position:", "[number, number, number]", "list of 2"]),
    ("[camera]\nposition = [1, 'a', 2]", &["camera.position.1:", "expected number"]),
    ("[camera]\nposition = [0, 0, 0]", &["camera.target:", "same point"]),
    ("[camera]\nup = [0, 3, 0]", &["camera.up:", "along the view"]),
    (
        "[camera]\nfov_x = 40\nfocal_length = 35",
        &["camera.focal_length:", "fov_x", "leave one out"],
    ),
    ("[camera]\nfocal_length = 'long'", &["camera.focal_length:", "millimeters"]),
    ("[camera]\nfocal_length = 0", &["camera.focal_length:", "above 0"]),
    ("[camera]\nfocus_distance = 0", &["camera.focus_distance:", "> 0"]),
    ("[camera]\nkey = 1", &["camera.key:", "[[camera.key]]"]),
    ("[[camera.key]]\nframe = 2\n[[camera.key]]\nframe = 2", &["camera.key:", "ascend"]),
    (
        "[[camera.key]]\nframe = 2.5\nposition = [1, 2, 3]\ntarget = [1, 2, 3]",
        &["camera.target:", "same point", "frame 2.5"],
    ),
    ("[[camera.key]]\nfocal_length = 5\nfov_x = 9", &["camera.key.0.focal_length:", "leave one"]),
    ("[film]\nspp = 1.5", &["film.spp:", "expected integer"]),
    ("[film]\nspp = 4294967296", &["film.spp:", "4294967296 is out of range", "0..4294967295"]),
    ("[film]\nsize = [0, 9]", &["film.size.0:", "1..16384"]),
    ("[film]\nseed = -1", &["film.seed:", "out of range"]),
    ("[environment]\nradiance = -1", &["environment.radiance:", ">= 0"]),
    ("[environment]\nradiance = [1, -1, 1]", &["environment.radiance.1:", ">= 0"]),
    ("[environment]\nradiance = 'red'", &["environment.radiance:", "number or [r, g, b]"]),
    ("[environment]\nsky = { sun_elevation = -5 }", &["environment.sky.sun_elevation:", "0..90"]),
    ("[environment]\nsky = { turbidity = 0.5 }", &["environment.sky.turbidity:", "1..10"]),
    ("[environment]\nsky = {}\nfile = 'a'", &["environment.sky:", "file or sky", "leave one"]),
    ("[environment]\nfile = ''", &["environment.file:", "empty", ".hdr"]),
    (
        "[environment]\nfile = 'a.hdr'\ngradient = [1, 1, 1]",
        &["environment.gradient:", "file or gradient", "leave one out"],
    ),
    ("[environment]\ngradient = [1, 2]", &["environment.gradient:", "bottom", "list of 2"]),
    ("[environment]\ngradient = [1, -2, 1]", &["environment.gradient.1:", ">= 0"]),
    ("[environment]\ngradient = [1, [0, 1], 1]", &["environment.gradient.1:", "[r, g, b]"]),
    (
        "[environment]\nradiance = 1\ngradient = [1, 1, 1]",
        &["environment.gradient:", "radiance or gradient", "leave one out"],
    ),
    ("[environment]\nexposure = 99", &["environment.exposure:", "-32..32"]),
    ("[environment]\ntint = -1", &["environment.tint:", ">= 0"]),
    ("[scene]\nup = 'x'", &["scene.up:", "\"z\" | \"y\""]),
    ("[volume]\nshape = 'box'", &["volume:", "[[volume]]"]),
    ("[[volume]]", &["volume.0.file:", "needs a file or a shape"]),
    ("[[volume]]\nfile = 'a.vdb'\nshape = 'box'", &["volume.0.shape:", "not both"]),
    ("[[volume]]\nshape = 'cube'", &["volume.0.shape:", "\"cube\"", "\"box\""]),
    (
        "[[volume]]\nshape = 'box'\nradius = 1",
        &["volume.0.radius:", "belongs to shape = \"sphere\"", "here shape = \"box\""],
    ),
    ("[[volume]]\nfile = 'a.vdb'\nradius = 1", &["volume.0.radius:", "there is no shape"]),
    ("[[volume]]\nshape = 'ramp'\nh = 1", &["volume.0.h:", "kind = \"exponential\""]),
    ("[[volume]]\nshape = 'ramp'\nb = -1", &["volume.0.b:", "falls to -1"]),
    ("[[volume]]\nshape = 'sphere'\nradius = 0", &["volume.0.radius:", "> 0"]),
    ("[[volume]]\nshape = 'box'\nscale = 0", &["volume.0.scale:", "not 0"]),
    ("[[volume]]\nshape = 'box'\nalbedo = 1.5", &["volume.0.albedo:", "0..1"]),
    ("[time]\nshutter = 10.5", &["time.shutter:", "0..10"]),
    ("[time]\nshutter = -0.5", &["time.shutter:", "0..10"]),
    ("[[volume]]\nshape = 'box'\nvelocity.grid = 'v'", &["volume.0.velocity:", "only a file"]),
    (
        "[[volume]]\nfile = 'a.vdb'\nvelocity.unit = 'frame'",
        &["volume.0.velocity.grid:", "name a grid"],
    ),
    (
        "[[volume]]\nfile = 'a.vdb'\nvelocity = { grid = 'v', grids = ['x', 'y', 'z'] }",
        &["volume.0.velocity.grids:", "leave one of them out"],
    ),
    (
        "[[volume]]\nfile = 'a.vdb'\nvelocity.grids = ['x', 'y']",
        &["volume.0.velocity.grids:", "[string, string, string]"],
    ),
    (
        "[[volume]]\nfile = 'a.vdb'\nvelocity = { grid = 'v', unit = 'hour' }",
        &["volume.0.velocity.unit:", "\"second\"", "\"frame\""],
    ),
    (
        "[[volume]]\nshape = 'everywhere'\ndensity.curve = [[0, 0]]\nemission.mode = 'constant'",
        &["volume.0.density.scale:", "infinitely bright"],
    ),
    (
        "[[volume]]\nshape = 'box'\ndensity.curve = [[0, 1], [0, 2]]",
        &["volume.0.density.curve:", "ascend"],
    ),
    (
        "[[volume]]\nshape = 'box'\ndensity.curve = [[0, 1], [1, -2]]",
        &["volume.0.density.curve:", "negative"],
    ),
    (
        "[[volume]]\nshape = 'box'\nemission = { mode = 'source', curve = [[0, 1]] }",
        &["volume.0.emission.curve:", "\"blackbody\""],
    ),
    (
        "[[volume]]\nshape = 'box'\nemission = { mode = 'source', intensity_curve = [[0, 1]] }",
        &["volume.0.emission.intensity_curve:", "intensity_grid"],
    ),
    ("[[volume]]\nshape = 'box'\nphase.mix = 1.5", &["volume.0.phase.mix:", "0..1"]),
    ("[[volume]]\nshape = 'box'\nphase.g = 1", &["volume.0.phase.g:", "-0.999..0.999"]),
    (
        "[[volume]]\nshape = 'box'\nscale = 2\nmatrix = [[1,0,0,0],[0,1,0,0],[0,0,1,0]]",
        &["volume.0.matrix:", "leave those out"],
    ),
    (
        "[[volume]]\nshape = 'box'\nmatrix = [[1,0,0,0],[0,1,0,0],[1,1,0,0]]",
        &["volume.0.matrix:", "flatten"],
    ),
    (
        "[[volume]]\nshape = 'box'\nemission = { mode = 'source', kelvin_scale = 3 }",
        &["volume.0.emission.kelvin_scale:", "mode = \"blackbody\"", "mode = \"source\""],
    ),
    (
        "[[volume]]\nshape = 'box'\nemission = { mode = 'ramp', stops = [] }",
        &["volume.0.emission.stops:", "at least one"],
    ),
    (
        "[[volume]]\nshape = 'box'\nemission = { mode = 'ramp', stops = [[1,0,0,0],[0,1,1,1]] }",
        &["volume.0.emission.stops:", "ascend"],
    ),
    (
        "[[volume]]\nshape = 'box'\nemission = { mode = 'ramp', stops = [[1,0,0]] }",
        &["volume.0.emission.stops.0:", "list of 3"],
    ),
    (
        "[[volume]]\nshape = 'box'\nemission = { mode = 'source', le = [0, -1, 0] }",
        &["volume.0.emission.le.1:", ">= 0"],
    ),
    ("[[light]]\ntype = 'lamp'", &["light.0.type:", "\"sun\" | \"point\""]),
    ("[[light]]\nangle = 3", &["light.0.angle:", "type = \"sun\"", "type = \"point\""]),
    ("[[light]]\ntype = 'sun'\ndirection = [0, 0, 0]", &["light.0.direction:", "zero"]),
    ("[[light]]\ntype = 'sun'\nirradiance = 1\nintensity = 1", &["light.0.irradiance:", "same"]),
    ("[[light]]\ntype = 'quad'\nhalf_v = [1, 0, 0]", &["light.0.half_v:", "different edges"]),
    ("[[surface]]\nshape = 'mesh'", &["surface.0.shape:", "not there yet"]),
    ("[[surface]]\nshape = 'box'", &["surface.0.half_size:", "needs a half_size"]),
    ("[[surface]]\nhalf_size = [1, 2, 3]", &["surface.0.half_size:", "one number"]),
    ("[[surface]]\nradius = 1", &["surface.0.radius:", "shape = \"sphere\""]),
    (
        "[[surface]]\nmaterial = { type = 'diffuse', alpha = 1 }",
        &["surface.0.material.alpha:", "type = \"conductor\""],
    ),
    (
        "[[surface]]\nmaterial.reflectance = 2",
        &["surface.0.material.reflectance:", "2 is out of range", "0..1"],
    ),
    ("[strategy]\nmajorant_bost = true", &["strategy.majorant_bost:", "strategy.majorant_boost"]),
    ("[strategy]\nmajorant_boost = 1", &["strategy.majorant_boost:", "expected boolean"]),
    ("[strategy]\npreset = 'best'", &["strategy.preset:", "\"best\"", "\"full\""]),
    ("[strategy]\nintegrator = 'walk'", &["strategy.integrator:", "\"path\"", "\"march\""]),
    (
        "[strategy.advanced]\nlight_selection = 'probe'",
        &["strategy.advanced.light_selection:", "\"hierarchy\"", "\"probes\""],
    ),
    (
        "[strategy.advanced]\ntracker = 'decomposition'",
        &["strategy.advanced.tracker:", "(probe_mis = false)", "(distance = \"null\")"],
    ),
    (
        "[strategy]\npreset = 'baseline'\n[strategy.advanced]\ntracker = 'decomposition'",
        &["strategy.advanced.tracker:", "(emission_ratio_tracking = true)", "tracker = \"delta\""],
    ),
    ("[strategy.advanced]\nboost_amount = -1", &["strategy.advanced.boost_amount:", "0..1000"]),
];

#[test]
fn malformed_scenes_are_refused_by_file_key_and_mend() {
    for (text, expected) in MALFORMED {
        let message = match parse(text) {
            Ok(_) => panic!("accepted: {text}"),
            Err(error) => error.to_string(),
        };
        assert!(message.starts_with("torch.toml: "), "{text}\n{message}");
        for part in *expected {
            assert!(message.contains(part), "{text}\n{message}\nlacks {part}");
        }
    }
}

/// A focal length is a field of view on the sensor that it is given for, in the file as on the
/// command line.
#[test]
fn focal_lengths_are_fields_of_view() {
    let fov_x = |text: &str, more: &[&str]| set(text, more).unwrap().camera.fov_x;
    let fifty = fov_x("camera.focal_length = 50", &[]);
    assert!((fifty - 39.5978).abs() < 1e-3, "{fifty}");
    let super_35 = fov_x("[camera]\nfocal_length = 50\nsensor_width = 24.9", &[]);
    assert!((super_35 - 27.96).abs() < 0.01, "{super_35}");
    assert_eq!(fov_x("camera.fov_x = 20", &["camera.focal_length=50"]), fifty);
    let keyed = set("[[camera.key]]\nframe = 4\nfocal_length = 50", &["time.frame=9"]).unwrap();
    assert_eq!(keyed.present_camera().fov_x, fifty);
}

#[test]
fn the_command_line_goes_over_the_preset_over_the_file_over_the_defaults() {
    let file = "[strategy]\npreset = 'baseline'\nmajorant_boost = true\n[film]\nspp = 7\n\
                [strategy.advanced]\nboost_amount = 2.0";
    let strategy = parse(file).unwrap().strategy;
    assert!(strategy.majorant_boost && !strategy.emission_decoupling);

    let with = |preset, set: &[&str]| {
        let set = set.iter().map(|s| s.to_string()).collect();
        let overrides = Overrides { preset, set };
        scene::parse(file, "torch.toml", Path::new("/scenes"), &overrides).unwrap()
    };
    let preset = with(Some(Preset::Baseline), &[]).strategy;
    assert!(!preset.majorant_boost, "--preset goes over the file");
    assert_eq!(preset.advanced.boost_amount, 2.0, "a preset leaves the advanced choices alone");
    let both = with(Some(Preset::Baseline), &["strategy.emission_decoupling=true", "film.spp=9"]);
    assert!(both.strategy.emission_decoupling && !both.strategy.majorant_boost);
    assert_eq!((both.film.spp, both.film.seed), (9, 0));
    let last = with(None, &["strategy.majorant_boost=false", "strategy.preset=full"]).strategy;
    assert!(last.majorant_boost, "the later of two --set wins");
}

#[test]
fn trackers_are_accepted_where_their_walks_know_enough() {
    for text in [
        "[strategy]\npreset = 'emission'\nadvanced.tracker = 'decomposition'",
        "[strategy.advanced]\ntracker = 'decomposition'\ndistance = 'null'",
        "[strategy.advanced]\ntracker = 'spectral'",
        "[strategy]\npreset = 'baseline'\nadvanced.tracker = 'spectral'",
    ] {
        parse(text).unwrap();
    }
    let full = Overrides { preset: Some(Preset::Full), set: Vec::new() };
    let file = "[strategy]\npreset = 'emission'\nadvanced.tracker = 'decomposition'";
    let refused = scene::parse(file, "torch.toml", Path::new("/scenes"), &full).unwrap_err();
    assert!(refused.to_string().contains("strategy.advanced.tracker"), "{refused}");
}

#[test]
fn set_reaches_every_key() {
    let text = "[[volume]]\nshape = 'box'\nhalf_size = 2\n[[volume]]\nfile = 'a.vdb'\nalbedo = 0.5";
    let scene = set(
        text,
        &[
            "volume.0.density.scale = 0.35",
            "volume.1.albedo.grid=colour",
            "volume.1.emission.mode=blackbody",
            "volume.1.emission.kelvin_scale=1000",
            "volume.2.shape=sphere",
            "volume.2.name=3",
            "camera.position.1=-9",
            "environment.radiance=[1, 2, 3]",
            "surface.0.material.type=black",
        ],
    )
    .unwrap();
    assert_eq!(scene.volume[0].density.scale, Color::Gray(0.35));
    assert_eq!(scene.volume[1].albedo, Albedo::Grid(GridKey { grid: "colour".into() }));
    assert_eq!(scene.volume[1].emission.kelvin_scale, Some(1000.0));
    assert_eq!(scene.volume[2].shape, Some(VolumeShape::Sphere));
    assert_eq!(scene.volume[2].name, "3", "a name may look like a number");
    assert_eq!(scene.camera.position, [0.0, -9.0, 0.0]);
    assert_eq!(scene.environment.radiance, Color::Rgb([1.0, 2.0, 3.0]));
    assert_eq!(scene.surface[0].material.unwrap().kind, MaterialKind::Black);
}

#[test]
fn the_sources_of_the_sky_replace_each_other() {
    let text = "[environment]\nradiance = 1\nexposure = 2";
    let with = |assignments: &[&str]| set(text, assignments).unwrap().environment;
    let gradient = with(&["environment.gradient=[1, [1, 2, 3], 0]"]);
    assert!(gradient.radiance.is_black() && gradient.exposure == 2.0);
    assert_eq!(gradient.gradient.unwrap()[1], Color::Rgb([1.0, 2.0, 3.0]));
    let image = with(&["environment.gradient=[1, 2, 3]", "environment.file=/a.hdr"]);
    assert_eq!((image.file.as_deref(), image.gradient), (Some("/a.hdr"), None));
    let sky = with(&["environment.file=/a.hdr", "environment.sky={ turbidity = 5 }"]);
    assert_eq!((sky.file, sky.sky.unwrap().turbidity), (None, 5.0));
    let even = with(&["environment.sky={}", "environment.radiance=3"]);
    assert_eq!((even.sky, even.radiance), (None, Color::Gray(3.0)));
    let both = set(text, &["environment.sky.turbidity=5"]).unwrap_err().to_string();
    assert!(both.contains("environment.sky") && both.contains("leave one out"), "{both}");
}

#[test]
fn a_new_choice_takes_the_keys_of_the_old_one_with_it() {
    let text =
        "[[volume]]\nshape = 'box'\nhalf_size = 2\nemission = { mode = 'constant', value = 3 }";
    let scene =
        set(text, &["volume.0.radius=2", "volume.0.shape=sphere", "volume.0.emission.mode=none"]);
    let volume = &scene.unwrap().volume[0];
    assert_eq!((volume.radius, volume.half_size), (Some(2.0), None));
    assert_eq!(volume.emission.value, None);
    let scene = set(text, &["volume.0.file=/b.vdb"]).unwrap();
    assert_eq!((scene.volume[0].shape, scene.volume[0].half_size), (None, None));

    let mut edited = parse(text).unwrap();
    edited.volume[0].shape = Some(VolumeShape::Everywhere);
    assert!(scene::validate(&edited, "edit").is_err());
    let tidied = scene::tidy(&edited).unwrap();
    assert_eq!(tidied.volume[0].half_size, None);
    scene::validate(&tidied, "edit").unwrap();
}

#[test]
fn faulty_overrides_are_refused_by_name() {
    let text = "[[volume]]\nshape = 'box'\n";
    for (assignment, expected) in [
        ("film.spp", &["--set:", "film.spp", "key.path=value"][..]),
        ("film.ssp=3", &["--set: film.ssp:", "film.spp"]),
        ("film.spp=many", &["--set: film.spp:", "expected integer", "\"many\""]),
        ("volume.2.shape=box", &["--set: volume:", "there are 1", "volume.1 adds one"]),
        ("volume.first.shape=box", &["--set: volume:", "expected an index", "first"]),
        ("camera.position.3=1", &["camera.position", "no item 3"]),
        ("camera.position.0.x=1", &["camera.position.0 has no keys"]),
        ("volume=3", &["--set: volume:", "[[volume]]"]),
        ("volume.0=3", &["--set: volume.0:", "expected table"]),
        ("strategy.preset=best", &["--set: strategy.preset:", "\"best\""]),
        ("environment.group=sky", &["environment.group:", "not there yet"]),
        ("a.b.c=1", &["--set: a:", "unknown key"]),
        ("=1", &["--set:", "unknown key"]),
    ] {
        let message = set(text, &[assignment]).unwrap_err().to_string();
        for part in expected {
            assert!(message.contains(part), "{assignment}\n{message}\nlacks {part}");
        }
    }
}

#[test]
fn the_nearest_key_of_any_misspelled_key_is_the_key_itself() {
    for key in keys::all() {
        let path = key.path.replace(".N.", ".0.");
        let misspelled = format!("{path}x=1");
        let text = "[[volume]]\nshape = 'box'\n[[light]]\n[[surface]]\n";
        let message = set(text, &[misspelled.as_str()]).unwrap_err().to_string();
        assert!(message.contains(&format!("nearest known key is {path}")), "{message}");
    }
}

#[test]
fn saving_and_loading_loses_nothing() {
    let mut rng = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(1);
    let folder = tempfile::tempdir().unwrap();
    let home = folder.path().canonicalize().unwrap();
    std::fs::create_dir(home.join("scenes")).unwrap();
    let path = home.join("scenes/saved.toml");
    let mut saved = 0;
    for _ in 0..400 {
        let settings = any_settings(&mut rng, &home);
        if scene::validate(&settings, "generated").is_err() {
            continue;
        }
        scene::save(&settings, &path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let overrides = Overrides::default();
        let back = scene::parse(&text, "saved", path.parent().unwrap(), &overrides).unwrap();
        assert_eq!(back, settings, "{text}");
        assert!(!text.contains(home.to_str().unwrap()), "names are relative: {text}");
        let absolute = scene::to_toml(&settings, None).unwrap();
        let back = scene::parse(&absolute, "header", Path::new("/elsewhere"), &overrides).unwrap();
        assert_eq!(back, settings, "{absolute}");
        saved += 1;
    }
    assert!(saved > 200, "only {saved} generated settings were valid");
}

/// A picture of 8 x 4 pixels with a bright one, the first to the right of a quarter of the columns
/// and just above the horizon.
fn picture(folder: &Path) -> String {
    let mut pixels = [[0_u8; 4]; 32];
    pixels[8 + 2] = [128, 128, 128, 129];
    let path = folder.join("a set.hdr");
    let head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    std::fs::write(&path, [&head[..], &pixels.concat()].concat()).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The middle column looks along +z where +y is up and along −y where +z is up, the left quarter
/// along +x; a rotation turns the picture counter-clockwise seen from above.
#[test]
fn pictures_of_the_sky_are_read_and_oriented_as_the_format_says() {
    let folder = tempfile::tempdir().unwrap();
    let home = folder.path().canonicalize().unwrap();
    picture(&home);
    for (up, rotation, left_quarter) in [
        ("z", 0.0, Vec3A::X),
        ("y", 0.0, Vec3A::X),
        ("z", 90.0, Vec3A::Y),
        ("y", 90.0, Vec3A::NEG_Z),
        ("z", -90.0, Vec3A::NEG_Y),
    ] {
        let text = format!(
            "scene.up = '{up}'\n[environment]\nfile = 'a set.hdr'\nrotation = {rotation}\n\
             exposure = 1\ntint = [1, 0.5, 0]"
        );
        let settings = scene::parse(&text, "s", &home, &Overrides::default()).unwrap();
        let built = scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
        let environment = built.lights.environment();
        // The pixel reaches an eighth of a turn to the right, and up.
        assert!(environment.middle().dot(left_quarter) > 0.8, "{up} {rotation}");
        let seen = environment.radiance(environment.middle());
        assert!((seen - Vec3A::new(2.0, 1.0, 0.0)).abs().max_element() < 0.2, "{seen}");
        assert_eq!(environment.radiance(-left_quarter), Vec3A::ZERO);
    }
}

#[test]
fn pictures_of_the_sky_are_files_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let home = folder.path().canonicalize().unwrap();
    let file = picture(&home);
    let text = "[environment]\nfile = 'a set.hdr'";
    let settings = scene::parse(text, "s", &home, &Overrides::default()).unwrap();
    assert_eq!(settings.environment.file.as_ref(), Some(&file));
    assert_eq!(scene::files_on_disk(&settings).unwrap(), [Path::new(&file)]);
    let before = scene::fingerprints(&settings, NO_PROGRESS).unwrap();
    assert_eq!(before.len(), 1);
    assert!(scene::to_toml(&settings, Some(&home)).unwrap().contains("file = \"a set.hdr\""));

    // Values that are no radiance are counted and told.
    let odd = home.join("odd.exr");
    let value = |x: usize| if x == 2 { f32::NAN } else { x as f32 - 1.0 };
    exr::prelude::write_rgb_file(&odd, 4, 2, |x, _| (value(x), 1.0_f32, 1.0_f32)).unwrap();
    let mut edited = settings.clone();
    edited.environment.file = odd.to_str().map(str::to_owned);
    let built = scene::assemble_frame(&edited, &VolumeCache::default(), NO_PROGRESS).unwrap();
    assert_eq!(built.gaps.len(), 1);
    assert!(built.gaps[0].to_string().starts_with("4 of its pixels"), "{}", built.gaps[0]);
    assert!(built.gaps[0].file().ends_with("odd.exr"));
    std::fs::remove_file(&odd).unwrap();
    let missing = scene::assemble(&edited, &VolumeCache::default(), NO_PROGRESS).unwrap_err();
    assert!(missing.to_string().contains("odd.exr"), "{missing}");
}

/// The sun of a sky stands where its elevation and azimuth say, turned with the sky, and is seen
/// unless the sky is hidden.
#[test]
fn the_sun_of_a_sky_stands_where_its_keys_say() {
    let build = |text: &str| {
        let settings = scene::parse(text, "s", Path::new("/"), &Overrides::default()).unwrap();
        scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap()
    };
    let seen = |text: &str, direction: Vec3A| {
        build(text).lights.suns_behind(None, direction.normalize()).count()
    };
    let sky = "[environment]\nsky = { sun_elevation = 45, sun_azimuth = 90 }\n";
    assert_eq!(seen(sky, Vec3A::new(1.0, 0.0, 1.0)), 1);
    assert_eq!(seen(&format!("{sky}rotation = 90"), Vec3A::new(0.0, 1.0, 1.0)), 1);
    assert_eq!(seen(&format!("scene.up = 'y'\n{sky}"), Vec3A::new(1.0, 1.0, 0.0)), 1);
    assert_eq!(seen(&format!("{sky}visible = false"), Vec3A::new(1.0, 0.0, 1.0)), 0);
    let without = sky.replace("90 }", "90, sun = false }");
    assert_eq!(seen(&without, Vec3A::new(1.0, 0.0, 1.0)), 0);
    assert!(!build(&without).lights.has_suns() && build(&without).lights.environment().varies());
}

fn any_settings(rng: &mut impl Rng, home: &Path) -> Settings {
    let mut settings = Settings { camera: any_camera(rng), ..Settings::default() };
    settings.film.size = [rng.random_range(1..16384), rng.random_range(1..16384)];
    settings.film.seed = rng.random_range(0..1 << 53);
    settings.film.spp = rng.random();
    settings.path.max_scatters = rng.random_range(0..=100_000);
    match rng.random_range(0..4) {
        2 => {
            let sun_azimuth = rng.random_range(-90.0..90.0);
            settings.environment.sky = Some(SkySettings { sun_azimuth, ..Default::default() });
        }
        0 => settings.environment.file = Some(home.join("a'b/set.hdr").to_str().unwrap().into()),
        1 => settings.environment.radiance = color(rng),
        _ => settings.environment.gradient = Some([0; 3].map(|_| color(rng))),
    }
    settings.environment.rotation = rng.random_range(-360.0..360.0);
    settings.environment.exposure = rng.random_range(-9.0..9.0);
    settings.environment.tint = color(rng);
    settings.environment.visible = rng.random();
    settings.scene.up = [WorldUp::Z, WorldUp::Y][rng.random_range(0..2)];
    settings.strategy.emission_decoupling = rng.random();
    settings.strategy.majorant_boost = rng.random();
    settings.strategy.advanced.boost_amount = rng.random_range(0.0..9.0);
    settings.volume = (0..rng.random_range(0..3)).map(|_| any_volume(rng, home)).collect();
    settings.light = (0..rng.random_range(0..3)).map(|_| any_light(rng)).collect();
    settings.surface = (0..rng.random_range(0..3)).map(|_| any_surface(rng)).collect();
    // What the choices leave over is not part of a scene.
    scene::tidy(&settings).unwrap()
}

fn any_camera(rng: &mut impl Rng) -> CameraSettings {
    CameraSettings {
        position: vector(rng),
        fov_x: rng.random_range(0.1..=179.0),
        sensor_width: maybe(rng, |rng| rng.random_range(1.0..90.0)).unwrap_or(36.0),
        f_stop: maybe(rng, |rng| rng.random_range(0.1..90.0)).unwrap_or(0.0),
        focus_distance: maybe(rng, |rng| rng.random_range(0.1..90.0)),
        shift: [rng.random_range(-1.0..1.0), 0.0],
        key: (0..rng.random_range(0..4)).map(|number| any_key(rng, number)).collect(),
        ..CameraSettings::default()
    }
}

fn any_key<R: Rng>(rng: &mut R, number: i32) -> CameraKey {
    CameraKey {
        frame: 1.5 * f64::from(number),
        position: maybe(rng, vector),
        target: maybe(rng, vector),
        fov_x: maybe(rng, |rng| rng.random_range(0.1..=179.0)),
    }
}

fn any_volume(rng: &mut impl Rng, home: &Path) -> VolumeSettings {
    let shapes = [VolumeShape::Box, VolumeShape::Sphere, VolumeShape::Everywhere];
    let shapes = [&shapes[..], &[VolumeShape::Ramp, VolumeShape::Noise]].concat();
    let mut volume = VolumeSettings {
        name: ["", "quote \" and \\ and \n new line", "nébuleuse"][rng.random_range(0..3)].into(),
        albedo: match rng.random_range(0..3) {
            0 => Albedo::Gray(rng.random()),
            1 => Albedo::Rgb([rng.random(), 1.0, 0.0]),
            _ => Albedo::Grid(GridKey { grid: "albedo".into() }),
        },
        half_size: maybe(rng, |rng| Extent::Axes([rng.random::<f32>() + 0.1; 3])),
        radius: maybe(rng, |rng| rng.random::<f32>() + 0.1),
        a: maybe(rng, |rng| rng.random()),
        b: maybe(rng, |rng| rng.random()),
        h: maybe(rng, |rng| rng.random::<f32>() + 0.1),
        kind: maybe(rng, |_| RampKind::Exponential),
        octaves: maybe(rng, |rng| rng.random_range(1..=12)),
        seed: maybe(rng, |rng| rng.random()),
        ..VolumeSettings::default()
    };
    match rng.random_range(0..3) {
        0 => volume.file = Some("builtin:torch_hd".into()),
        1 => volume.file = Some(home.join("a'b/smoke.vdb").to_str().unwrap().into()),
        _ => volume.shape = Some(shapes[rng.random_range(0..shapes.len())]),
    }
    match rng.random_range(0..2) {
        0 => (volume.translate, volume.rotate) = (vector(rng), vector(rng)),
        _ => {
            volume.matrix = Some([[1.0, 0.5, 0.0, 3.5], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
        }
    }
    volume.density.scale = color(rng);
    volume.density.grid = maybe(rng, |_| "soot".into());
    volume.density.curve =
        maybe(rng, |rng| vec![[0.0, 0.5], [1.0, rng.random()]]).unwrap_or_default();
    volume.phase.g = rng.random_range(-0.999..=0.999);
    volume.phase.g2 = maybe(rng, |_| 0.25).unwrap_or_default();
    volume.phase.mix = maybe(rng, |rng| rng.random()).unwrap_or_default();
    volume.emission = any_emission(rng);
    if volume.file.is_some() {
        volume.velocity = VelocitySettings {
            grid: None,
            grids: Some(["v.x".into(), "v.y".into(), "v.z".into()]),
            unit: VelocityUnit::Frame,
            scale: rng.random(),
        };
    }
    volume
}

fn any_emission(rng: &mut impl Rng) -> EmissionSettings {
    let modes = [EmissionMode::None, EmissionMode::Grid, EmissionMode::Constant];
    let others = [EmissionMode::Source, EmissionMode::Blackbody, EmissionMode::Ramp];
    EmissionSettings {
        mode: [modes, others].concat()[rng.random_range(0..6)],
        grid: maybe(rng, |_| "heat".into()),
        curve: maybe(rng, |_| vec![[0.0, -0.5]]).unwrap_or_default(),
        intensity_grid: maybe(rng, |_| "flame".into()),
        color: maybe(rng, color),
        kelvin_offset: maybe(rng, |rng| rng.random()),
        normalize: maybe(rng, |_| Normalize::T4),
        stops: maybe(rng, |rng| vec![[0.0; 4], [1.5, rng.random(), 0.25, 1e-8]]),
        ..EmissionSettings::default()
    }
}

fn any_light(rng: &mut impl Rng) -> LightSettings {
    let kinds = [LightKind::Sun, LightKind::Point, LightKind::Spot, LightKind::Sphere];
    LightSettings {
        kind: kinds[rng.random_range(0..4)],
        intensity: color(rng),
        visible: rng.random(),
        position: maybe(rng, vector),
        direction: maybe(rng, vector),
        angle: maybe(rng, |rng| rng.random_range(0.0..180.0)),
        ..LightSettings::default()
    }
}

fn any_surface(rng: &mut impl Rng) -> SurfaceSettings {
    let kinds = [MaterialKind::Diffuse, MaterialKind::Conductor, MaterialKind::Black];
    SurfaceSettings {
        shape: [SurfaceShape::Plane, SurfaceShape::Sphere, SurfaceShape::Quad]
            [rng.random_range(0..3)],
        center: maybe(rng, vector),
        half_size: maybe(rng, |rng| Extent::Uniform(rng.random::<f32>() + 0.1)),
        emission: color(rng),
        material: maybe(rng, |rng| MaterialSettings {
            kind: kinds[rng.random_range(0..3)],
            reflectance: Some(Color::Gray(rng.random())),
            alpha: maybe(rng, |rng| rng.random_range(0.001..=1.0)),
        }),
        ..SurfaceSettings::default()
    }
}

fn maybe<R: Rng, T>(rng: &mut R, value: impl FnOnce(&mut R) -> T) -> Option<T> {
    let value = value(rng);
    rng.random::<bool>().then_some(value)
}

fn vector<R: Rng + ?Sized>(rng: &mut R) -> [f32; 3] {
    [0; 3].map(|_| rng.random_range(-9.0..9.0))
}

fn color<R: Rng + ?Sized>(rng: &mut R) -> Color {
    match rng.random_range(0..3) {
        0 => Color::Gray(rng.random_range(0.0..1e6)),
        1 => Color::Gray(0.1),
        _ => Color::Rgb([0; 3].map(|_| rng.random())),
    }
}
