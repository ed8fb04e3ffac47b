//! Ray marching, the one integrator whose pictures are biased: exact where nothing varies, nearer
//! to the right picture the shorter its step where something does.

use std::sync::Arc;

use crate::common::{
    self, Expected, POWER, REFERENCED, Verdicts, Z_LIMIT, build, measure, measure_closely,
    with_strategy,
};
use flambeau::{
    math::mean,
    transport::{
        PathSample, Scene,
        strategy::{Advanced, Integrator, NeeEvaluation, Preset, Strategy},
        tracking::MOST_COLLISIONS,
    },
};
use glam::UVec2;

/// Ray marching in steps of so many voxels, fire as a light on.
fn marching(march_step: f32) -> Strategy {
    let advanced = Advanced { march_step, ..Advanced::default() };
    Strategy { integrator: Integrator::March, advanced, ..Preset::Full.strategy() }
}

/// With fire as a light, by lines and by points, and without.
fn looks() -> [Strategy; 3] {
    let line = marching(1.0);
    let mut point = line;
    point.advanced.nee_evaluation = NeeEvaluation::Point;
    [line, point, Strategy { nee: false, ..line }]
}

/// Three media in one slab across z in [0, 1], a channel each, seen along its normal: g 0, with the
/// optical depths 1, 4 and 1 and the albedos 0.5, 0.9 and 0. Of one piece or made of cells.
fn slab(shape: &str, more: &str) -> Scene {
    build(&format!(
        r#"
        [camera]
        position = [0, 0, 2]
        target = [0, 0, 0]
        up = [0, 1, 0]
        fov_x = 0.01
        [[volume]]
        {shape}
        half_size = [40, 40, 0.5]
        translate = [0, 0, 0.5]
        density = {{ scale = [1.0, 4.0, 1.0] }}
        albedo = [0.5, 0.9, 0.0]
        {more}
        "#
    ))
}

const ONE_PIECE: &str = "shape = \"box\"";
const CELLS: &str = "shape = \"ramp\"\naxis = \"z\"\na = 1.0\nb = 0.0";

/// Where nothing varies marching is unbiased: the emissivities of adding-doubling (tests/slabs.rs);
/// the last channel does not scatter.
#[test]
fn slabs_glow_as_they_should() {
    let mut verdicts = Verdicts::default();
    let glow = r#"emission = { mode = "source", le = 1.0 }"#;
    for (what, shape, march_step) in [("one piece", ONE_PIECE, 1.0), ("cells", CELLS, 4.0)] {
        let scene = slab(shape, glow);
        let marching = marching(march_step);
        for strategy in [marching, Strategy { nee: false, ..marching }] {
            let label = format!("{what}, nee {}", strategy.nee);
            let expected = Expected::known(&[0.45482, 0.46333, 1.0 - (-1.0_f64).exp()]);
            verdicts.hold(&label, &with_strategy(&scene, strategy), 40_000, &expected);
        }
    }
    verdicts.finish();
}

/// The transmittances of the same slab, for light that a hemisphere behind it sends.
#[test]
fn slabs_let_light_through_as_they_should() {
    let mut verdicts = Verdicts::default();
    let behind = r#"
        [[surface]]
        shape = "plane"
        point = [0, 0, 3]
        material = { type = "black" }
        [environment]
        radiance = 1.0
    "#;
    for (what, shape, march_step) in [("one piece", ONE_PIECE, 1.0), ("cells", CELLS, 4.0)] {
        let scene = with_strategy(&slab(shape, behind), marching(march_step));
        let expected = Expected::known(&[0.44606, 0.12852, (-1.0_f64).exp()]);
        verdicts.hold(what, &scene, 120_000, &expected);
    }
    verdicts.finish();
}

/// σ = 0.2 + 0.3 t over a length of 3: the bias is below 1e-6 of the value, by ½ L Δ³ (0.3)²/12 with
/// steps Δ of 3/128.
#[test]
fn a_ramp_of_extinction() {
    let scene = build(
        r#"
        [camera]
        position = [0, 0, 2]
        target = [0, 0, 0]
        up = [0, 1, 0]
        fov_x = 0.01
        [[volume]]
        shape = "ramp"
        half_size = [1, 1, 1.5]
        axis = "z"
        a = 0.2
        b = 0.3
        albedo = 0.0
        emission = { mode = "source", le = [1.0, 0.5, 0.0] }
        [environment]
        radiance = [0.0, 0.0, 1.0]
        "#,
    );
    let mut verdicts = Verdicts::default();
    let expected = Expected::known(&[0.857726, 0.5 * 0.857726, 0.142274]);
    verdicts.hold("ramp", &with_strategy(&scene, marching(1.0)), 16_384, &expected);
    verdicts.finish();
}

/// Uneven smoke of many cells with the light of a lamp, of a fire and of the sky in it, on a floor.
const UNEVEN: &str = r#"
    [camera]
    position = [0, -4, 0.5]
    target = [0, 0, 0]
    fov_x = 24
    [[volume]]
    shape = "noise"
    half_size = [1.0, 0.9, 0.8]
    rotate = [0, 0, 20]
    frequency = 1.5
    octaves = 3
    contrast = 4.0
    density = { scale = [6.0, 9.0, 12.0] }
    albedo = [0.9, 0.8, 0.7]
    phase = { g = 0.6 }
    [[volume]]
    shape = "sphere"
    radius = 0.25
    translate = [-0.4, 0.1, -0.2]
    density = { scale = 1.0 }
    albedo = 0.2
    emission = { mode = "source", le = [4.0, 2.0, 1.0] }
"#;

const LIGHTS: &str = r#"
    [environment]
    radiance = 0.5
    [[surface]]
    shape = "sphere"
    center = [0.35, 0.1, 0.2]
    radius = 0.12
    material = { type = "black" }
    emission = [2.0, 2.5, 3.0]
    [[surface]]
    shape = "plane"
    point = [0, 0, -0.9]
    normal = [0, 0, 1]
    half_size = 4.0
    material = { type = "diffuse", reflectance = 0.5 }
"#;

/// What shines through dark uneven smoke, by the length of the step: too much of it, less and less.
#[test]
fn bias_falls_with_the_step() {
    let dark = UNEVEN
        .replace("albedo = [0.9, 0.8, 0.7]", "albedo = 0.0")
        .replace("scale = [6.0, 9.0, 12.0]", "scale = [10.0, 20.0, 30.0]");
    let scene = build(&(dark + "[environment]\nradiance = 100.0"));
    let reference = measure(&with_strategy(&scene, Preset::Full.strategy()), 300_000);
    let excess = [100.0, 2.0, 0.5].map(|march_step| {
        let estimate = measure(&with_strategy(&scene, marching(march_step)), 30_000);
        [0, 1, 2].map(|channel| {
            let mean = reference.mean[channel];
            let excess = estimate.mean[channel] / mean - 1.0;
            let error = estimate.error(channel).hypot(reference.error(channel)) / mean;
            println!("step {march_step}, channel {channel}: {excess:.5} ± {error:.5}");
            [excess, error]
        })
    });
    let [longest, shorter, short] = excess;
    for channel in 0..3 {
        let [bias, error] = longest[channel];
        assert!(bias > 0.01 && bias > Z_LIMIT * error, "{longest:?}");
        assert!(shorter[channel][0] < 0.5 * bias, "{longest:?}, then {shorter:?}");
        let [bias, error] = short[channel];
        assert!(bias.abs() < Z_LIMIT * error && error < POWER, "{short:?}");
    }
}

/// Steps of a voxel leave no bias to be seen: lamp, fire, sky and floor in colored smoke look as
/// paths show them.
#[test]
fn uneven_smoke_is_lit_as_by_paths() {
    let scene = build(&("[path]\nmax_scatters = 2\n".to_owned() + UNEVEN + LIGHTS));
    let full = with_strategy(&scene, Preset::Full.strategy());
    let expected = Expected::measured(&measure_closely(&full, 160_000));
    let mut verdicts = Verdicts::of_power(REFERENCED);
    for strategy in [marching(1.0), Strategy { nee: false, ..marching(1.0) }] {
        let label = format!("nee {}", strategy.nee);
        verdicts.hold(&label, &with_strategy(&scene, strategy), 128_000, &expected);
    }
    verdicts.finish();
}

/// A furnace is one whatever the medium: what a marched ray loses on its way, it emits or scatters,
/// in the same steps.
#[test]
fn furnaces_are_exact_however_long_the_step() {
    let furnace = UNEVEN.replace("le = [4.0, 2.0, 1.0]", "le = 1.0").replacen(
        "phase = { g = 0.6 }",
        "phase = { g = 0.6 }\nemission = { mode = \"source\", le = 1.0 }",
        1,
    );
    let floor = r#"
        [environment]
        radiance = 1.0
        [[surface]]
        shape = "plane"
        point = [0, 0, -0.4]
        normal = [0, 0, 1]
        half_size = 2.0
        material = { type = "diffuse", reflectance = 1.0 }
    "#;
    let scene = build(&(furnace + floor));
    let mut verdicts = Verdicts::default();
    // Looks at points have infinite variance inside of what glows.
    let finite = |s: &Strategy| s.advanced.nee_evaluation == NeeEvaluation::Line;
    for strategy in looks().into_iter().filter(finite) {
        for march_step in [1.0, 100.0] {
            let advanced = Advanced { march_step, ..strategy.advanced };
            let scene = with_strategy(&scene, Strategy { advanced, ..strategy });
            let expected = Expected::known(&[1.0; 3]);
            verdicts.hold(&format!("step {march_step}"), &scene, 30_000, &expected);
        }
    }
    verdicts.finish();
}

/// The samples of a small picture.
fn samples(scene: &Scene, strategy: Strategy) -> Vec<PathSample> {
    let size = UVec2::splat(6);
    let frame = crate::common::frame_of(Arc::new(with_strategy(scene, strategy)), size, 0);
    let pixel = |i: u32| UVec2::new(i % size.x, i / size.x);
    (0..4 * size.x * size.y).map(|i| frame.sample(pixel(i / 4), i % 4)).collect()
}

#[test]
fn the_same_path_every_time_whatever_the_toggles_that_mean_nothing_here() {
    let scene = build(&(UNEVEN.to_owned() + LIGHTS));
    let expected = samples(&scene, marching(1.0));
    assert!(expected.iter().any(|path| path.indirect != flambeau::math::Rgb::ZERO));
    for toggles in common::all_strategies().into_iter().filter(|strategy| strategy.nee) {
        let strategy = Strategy { integrator: Integrator::March, ..toggles };
        assert_eq!(samples(&scene, strategy), expected, "{}", common::name(&strategy));
    }
}

const EXTREMES: &str = r#"
    [camera]
    position = [0, -4, 0.1]
    target = [0, 0, 0]
    [environment]
    radiance = 1.0
    [[volume]]
    shape = "noise"
    frequency = 2.0
    contrast = 5.0
    albedo = [0.9, 0.5, 0.0]
    density.scale = DENSITY
"#;

const FOG: &str = r#"
    [[volume]]
    shape = "everywhere"
    density.scale = [0.1, 1.0, 0.0]
    albedo = 0.8
"#;

const FLOOR: &str = r#"
    [[surface]]
    shape = "plane"
    point = [0, 0, -0.3]
    normal = [0, 0, 1]
    material = { type = "conductor", alpha = 0.3, reflectance = 0.8 }
"#;

/// Smoke from nothing to the end of single precision, alone, in fog that never ends, over a floor.
#[test]
fn whatever_comes_has_a_number() {
    let more = [String::new(), FOG.to_owned(), FLOOR.to_owned(), FOG.to_owned() + FLOOR];
    for density in ["0.0", "1e-30", "1.0", "1e9", "3e38"] {
        for more in &more {
            let scene = build(&(EXTREMES.replace("DENSITY", density) + more));
            for strategy in looks() {
                for path in samples(&scene, strategy) {
                    assert!(path.beauty().is_finite(), "{density}{more}: {path:?}");
                    assert!((0.0..=1.0).contains(&path.alpha), "{density}{more}: {path:?}");
                }
            }
        }
    }
}

#[test]
fn an_empty_scene_is_its_environment() {
    let scene = build("[environment]\nradiance = 0.25");
    assert!(samples(&scene, marching(1.0)).iter().all(|path| mean(path.beauty()) == 0.25));
}

/// Steps far shorter than a voxel in a volume of many: a march is cut, and its path says so.
#[test]
fn no_ray_takes_unbounded_time() {
    let long = r#"
        [camera]
        position = [0, -401, 0.1]
        target = [0, 0, 0.1]
        fov_x = 0.01
        [[volume]]
        shape = "noise"
        half_size = [0.25, 400.0, 0.25]
        frequency = 2.0
        albedo = 0.0
        density.scale = 1e-6
    "#;
    let paths = samples(&build(long), marching(0.05));
    assert!(paths.iter().all(|path| path.tracking_steps == MOST_COLLISIONS && path.was_cut));
    let paths = samples(&build(long), marching(4.0));
    assert!(paths.iter().all(|path| path.tracking_steps > 1000 && !path.was_cut));
}
