//! Light that metals throw into the medium, found by directions towards its images.

use crate::common::{
    CLOSELY, Expected, REFERENCED, Verdicts, asking, build, full_name, measure_closely, measure_to,
    measure_with, with_strategy,
};
use flambeau::transport::{
    PathSample,
    strategy::{Advanced, Distance, Preset, ScatterProbability, Strategy},
};
use glam::Vec3A;

/// Uneven mist that a lamp lights off a mirror, while a board keeps its direct light away. With two
/// events a path at most, the mirror is one and the mist the other.
const MIRROR: &str = r#"
    [path]
    max_scatters = 2
    [[surface]]
    shape = "sphere"
    center = [-2.0, 0.0, 1.2]
    radius = 0.08
    emission = [50.0, 80.0, 100.0]
    material = { type = "black" }
    [[surface]]
    shape = "quad"
    center = [-1.55, 0.0, 0.8]
    half_u = [0.25, 0.0, 0.4]
    half_v = [0.0, 1.0, 0.0]
    material = { type = "black" }
    [[surface]]
    shape = "quad"
    center = [-1.2, 0.0, 1.9]
    half_u = [0.35, 0.0, 0.0]
    half_v = [0.0, 0.35, 0.0]
    material = { type = "conductor", alpha = 0.002, reflectance = 0.8 }
"#;

/// The same light without a mirror: from the lamp's image, through a hole where the mirror was.
const IMAGE: &str = r#"
    [path]
    max_scatters = 1
    [[surface]]
    shape = "sphere"
    center = [-2.0, 0.0, 2.6]
    radius = 0.08
    emission = [40.0, 64.0, 80.0]
    material = { type = "black" }
    [[surface]]
    shape = "quad"
    center = [-6.55, 0.0, 1.9]
    half_u = [5.0, 0.0, 0.0]
    half_v = [0.0, 10.0, 0.0]
    material = { type = "black" }
    [[surface]]
    shape = "quad"
    center = [4.15, 0.0, 1.9]
    half_u = [5.0, 0.0, 0.0]
    half_v = [0.0, 10.0, 0.0]
    material = { type = "black" }
    [[surface]]
    shape = "quad"
    center = [-1.2, -5.35, 1.9]
    half_u = [0.35, 0.0, 0.0]
    half_v = [0.0, 5.0, 0.0]
    material = { type = "black" }
    [[surface]]
    shape = "quad"
    center = [-1.2, 5.35, 1.9]
    half_u = [0.35, 0.0, 0.0]
    half_v = [0.0, 5.0, 0.0]
    material = { type = "black" }
"#;

const MIST: &str = r#"
    [camera]
    position = [0.0, -5.0, 0.4]
    target = [0.0, 0.0, 0.0]
    fov_x = 32.0
    [[volume]]
    shape = "noise"
    half_size = [1.3, 0.8, 0.9]
    frequency = 1.0
    contrast = 1.0
    density = { scale = 0.4 }
    albedo = [0.95, 0.9, 0.85]
    phase = { g = 0.5 }
"#;

/// Every light there is over rough metals, flat, bent and without end, in thick mist.
const METALS: &str = r#"
    [camera]
    position = [0.0, -4.0, 0.6]
    target = [0.0, 0.0, 0.0]
    fov_x = 40.0
    [[volume]]
    shape = "box"
    half_size = [1.3, 0.9, 0.8]
    density = { scale = 1.0 }
    albedo = [0.9, 0.8, 0.7]
    phase = { g = 0.3 }
    [[volume]]
    shape = "sphere"
    radius = 0.2
    translate = [0.5, 0.1, 0.1]
    density = { scale = 1.0 }
    albedo = 0.2
    emission = { mode = "source", le = [1.5, 0.5, 0.2] }
    [[light]]
    type = "sun"
    direction = [0.4, 0.3, -1.0]
    irradiance = 0.4
    angle = 4
    [[light]]
    type = "point"
    position = [-0.4, 0.2, 1.3]
    intensity = 0.3
    [[surface]]
    shape = "sphere"
    center = [-0.5, 0.0, -0.2]
    radius = 0.3
    material = { type = "conductor", alpha = 0.2, reflectance = [0.9, 0.7, 0.4] }
    [[surface]]
    shape = "box"
    center = [0.3, 0.5, -0.5]
    half_size = [0.3, 0.1, 0.2]
    material = { type = "conductor", alpha = 0.25, reflectance = 0.9 }
    [[surface]]
    shape = "plane"
    point = [0.0, 0.0, -0.81]
    normal = [0.0, 0.0, 1.0]
    material = { type = "conductor", alpha = 0.3, reflectance = [0.6, 0.7, 0.9] }
"#;

fn with(change: impl Fn(&mut Advanced)) -> Strategy {
    let mut advanced = asking();
    change(&mut advanced);
    Strategy { advanced, ..Preset::Full.strategy() }
}

/// The power is that of the rest; the mirror's roughness moves light by a thousandth of its way, and
/// none of it away from the picture.
#[test]
fn light_off_a_mirror_is_that_of_its_image() {
    let scattered = |path: &PathSample| path.direct + path.indirect;
    let image = with_strategy(&build(&format!("{MIST}{IMAGE}")), with(|_| ()));
    let mirror = build(&format!("{MIST}{MIRROR}"));
    let expected = Expected::measured(&measure_to(&image, 600_000, CLOSELY, scattered));
    let mut verdicts = Verdicts::of_power(REFERENCED);
    for strategy in [
        with(|_| ()),
        with(|a| a.share_learning = true),
        with(|a| a.distance = Distance::Probes),
        with(|a| a.scatter_probability = ScatterProbability::Even),
        with(|a| (a.guide_directions, a.guide_all_vertices) = (false, true)),
    ] {
        let label = full_name(&strategy);
        let scene = with_strategy(&mirror, strategy);
        verdicts.hold_part(&label, &scene, 3_000_000, &expected, scattered);
    }
    verdicts.finish();
}

/// Rough metals can be found by chance as well.
#[test]
fn guides_to_metals_change_nothing() {
    let scene = build(METALS);
    let by_chance = with_strategy(&scene, with(|a| a.guide_caustics = false));
    let expected = Expected::measured(&measure_closely(&by_chance, 4_000_000));
    let mut verdicts = Verdicts::of_power(REFERENCED);
    for strategy in [
        with(|_| ()),
        with(|a| a.guide_directions = false),
        with(|a| a.scatter_probability = ScatterProbability::Even),
    ] {
        let label = full_name(&strategy);
        verdicts.hold(&label, &with_strategy(&scene, strategy), 2_000_000, &expected);
    }
    verdicts.finish();
}

/// The point of it: the same light takes a thousandth of the paths, in fact less, that chance needs.
/// So steep a fall needs no z-test.
#[test]
fn guides_to_metals_find_their_light() {
    let scene = build(&format!("{MIST}{MIRROR}"));
    let variance = |guide_caustics| {
        let strategy = with(|a| a.guide_caustics = guide_caustics);
        let estimate = measure_with(&with_strategy(&scene, strategy), 300_000, |p| p.indirect);
        estimate.variance[1]
    };
    let (guided, by_chance) = (variance(true), variance(false));
    assert!(guided < 1e-3 * by_chance, "{guided} guided, {by_chance} by chance");
}

/// Smoke in the bundle looks bright from where it scatters to, smoke beside it does not; and the
/// same on any number of threads.
#[test]
fn probes_know_bundles_of_light() {
    let radiance = |guide_caustics, point| {
        let strategy = with(|a| (a.guide_caustics, a.probe_learning) = (guide_caustics, false));
        let scene = with_strategy(&build(&format!("{MIST}{MIRROR}")), strategy);
        crate::common::probes_of(&scene).unwrap().radiance_at(point, Vec3A::Y)
    };
    // The middle of the bundle goes from the image (-2, 0, 2.6) through (-1.2, 0, 1.9).
    let inside = Vec3A::new(0.0, 0.0, 0.85);
    let beside = Vec3A::new(-1.0, 0.0, -0.5);
    let [lit, dark] = [inside, beside].map(|point| radiance(true, point));
    assert!(lit > 100.0 * dark.max(1e-6), "{lit} in the bundle, {dark} beside it");
    assert!(radiance(false, inside) < 0.1 * lit);
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(lit, alone.install(|| radiance(true, inside)));
}
