//! Furnaces: scenes in equilibrium, in which every pixel has the same known radiance, and places
//! where renderers have been seen to go wrong.

use crate::common::{
    Expected, Verdicts, build, every_guide, every_line_setting, every_nth, full_name,
    half_of_strategies, name, with_strategy,
};

use flambeau::transport::learned_counts::LearnedCounts;
use flambeau::transport::strategy::{NeeEvaluation, Preset, Strategy};

/// Largest standard error of settings whose counts are a hash.
const CLOSE: f64 = 0.0015;

const CAMERA: &str = r#"
    [camera]
    position = [0.3, -4, 1.2]
    target = [0, 0, 0]
    fov_x = 60
"#;

/// Two overlapping volumes, rotated and scaled, one of them with sharp borders.
fn volumes(albedo: f64, emission: &str) -> String {
    format!(
        r#"
        [[volume]]
        shape = "noise"
        half_size = 1.0
        frequency = 1.5
        contrast = 2.0
        rotate = [10, 20, 30]
        scale = [1.2, 0.9, 1.0]
        density = {{ scale = 3.0 }}
        albedo = {albedo}
        phase = {{ g = 0.6 }}
        {emission}
        [[volume]]
        shape = "sphere"
        radius = 0.8
        translate = [0.5, 0.2, -0.3]
        density = {{ scale = 0.7 }}
        albedo = {albedo}
        phase = {{ g = -0.3, g2 = 0.85, mix = 0.35 }}
        {emission}
        "#
    )
}

fn check_everywhere(text: &str, paths: u32, expected: f64) {
    let scene = build(text);
    let mut verdicts = Verdicts::default();
    for strategy in half_of_strategies() {
        let (scene, expected) = (with_strategy(&scene, strategy), Expected::known(&[expected; 3]));
        verdicts.hold(&name(&strategy), &scene, 8 * paths, &expected);
    }
    verdicts.finish();
}

/// Surfaces that glow with the fire: with B = 2, one of reflectance ρ emits (1 − ρ) B.
const GLOWING_SURFACES: &str = r#"
        [environment]
        radiance = 2.0
        [[surface]]
        shape = "plane"
        point = [0, 0, -1.1]
        normal = [0, 0, 1]
        half_size = 3.0
        material = { type = "diffuse", reflectance = 1.0 }
        [[surface]]
        shape = "sphere"
        center = [0.4, -0.6, 0.1]
        radius = 0.4
        material = { type = "diffuse", reflectance = 0.3 }
        emission = 1.4
        [[surface]]
        shape = "box"
        center = [-0.9, 0.3, -0.2]
        half_size = 0.25
        material = { type = "diffuse", reflectance = 0.6 }
        emission = 0.8
        [[surface]]
        shape = "quad"
        center = [0.9, 0.9, 0.3]
        half_u = [0.4, 0.1, 0.0]
        half_v = [0.0, 0.1, 0.5]
        material = { type = "black" }
        emission = 2.0
    "#;
const GLOW: &str = r#"emission = { mode = "source", le = 2.0 }"#;

/// Environment B, ε = μ_a B, a mirror-like metal of reflectance 1 is white only without masking
/// loss, so the surfaces are diffuse: one white, one of reflectance ρ that emits (1 − ρ) B.
#[test]
fn everything_glows_alike() {
    check_everywhere(&format!("{CAMERA}{GLOWING_SURFACES}{}", volumes(0.6, GLOW)), 300_000, 2.0);
}

/// Nor does it matter how often fires and lamps are sampled and emission is gathered at a vertex:
/// counts that are a hash of the vertex, under every kind of emission walk. Weights have to be made
/// of the counts of the vertex that a ray left, and of no other, at all vertices.
#[test]
fn everything_glows_alike_whatever_the_counts() {
    let scene = build(&format!("{CAMERA}{GLOWING_SURFACES}{}", volumes(0.8, GLOW)));
    let full = Preset::Full.strategy();
    let mut verdicts = Verdicts::of_power(CLOSE);
    for (hash, strategy) in [
        full,
        Preset::Emission.strategy(),
        Strategy { emission_ratio_tracking: false, ..full },
        Strategy { majorant_boost: false, probe_mis: false, ..full },
    ]
    .into_iter()
    .enumerate()
    {
        let (scene, expected) = (with_strategy(&scene, strategy), Expected::known(&[2.0; 3]));
        let counts = LearnedCounts::hashed(0.5, hash as u32);
        verdicts.hold_counts(&name(&strategy), &scene, counts, 8_000_000, &expected);
    }
    verdicts.finish();
}

/// White furnace: nothing absorbs, the environment is 1, and so is every pixel.
#[test]
fn nothing_is_lost_where_all_is_white() {
    let surfaces = r#"
        [environment]
        radiance = 1.0
        [[surface]]
        shape = "sphere"
        center = [0.4, -0.6, 0.1]
        radius = 0.4
        material = { type = "diffuse", reflectance = 1.0 }
    "#;
    check_everywhere(&format!("{CAMERA}{surfaces}{}", volumes(1.0, "")), 100_000, 1.0);
}

/// The same by every guide. Probes alone have rare heavy samples in thick smoke; this is thinner.
#[test]
fn nothing_is_lost_by_any_guide() {
    let environment = "[environment]\nradiance = 1.0\n";
    let volumes = volumes(1.0, "").replace("scale = 3.0", "scale = 1.0");
    let scene = build(&format!("{CAMERA}{environment}{volumes}"));
    let mut verdicts = Verdicts::default();
    for strategy in every_guide() {
        let (scene, expected) = (with_strategy(&scene, strategy), Expected::known(&[1.0; 3]));
        verdicts.hold(&full_name(&strategy), &scene, 200_000, &expected);
    }
    verdicts.finish();
}

/// A camera inside a medium without borders that glows: no way out, the same radiance everywhere.
#[test]
fn a_world_full_of_glowing_fog() {
    let text = format!(
        r#"{CAMERA}
        [[volume]]
        shape = "everywhere"
        density = {{ scale = 0.5 }}
        albedo = [0.2, 0.5, 0.8]
        emission = {{ mode = "source", le = 3.0 }}
        [[surface]]
        shape = "sphere"
        center = [0, 0, 0]
        radius = 1.0
        material = {{ type = "diffuse", reflectance = 0.5 }}
        emission = 1.5
        "#
    );
    check_everywhere(&text, 300_000, 3.0);
}

/// Fog without borders, fire in it and surfaces that emit what they do not reflect, all of one
/// radiance: only the fire can be looked at, from the fog, the surfaces and itself.
#[test]
fn a_fire_in_a_world_full_of_glowing_fog() {
    let scene = build(&format!(
        r#"{CAMERA}
        [[volume]]
        shape = "everywhere"
        density = {{ scale = [0.2, 0.4, 0.3] }}
        albedo = [0.2, 0.5, 0.7]
        emission = {{ mode = "source", le = 3.0 }}
        [[surface]]
        shape = "plane"
        point = [0, 0, -1.1]
        normal = [0, 0, 1]
        material = {{ type = "diffuse", reflectance = 0.6 }}
        emission = 1.2
        {}"#,
        volumes(0.5, r#"emission = { mode = "source", le = 3.0 }"#)
    ));
    let mut verdicts = Verdicts::default();
    // The fog's own glow lies where no sampled point does: points must not be taken for all of it.
    let mut point = Strategy::default();
    point.advanced.nee_evaluation = NeeEvaluation::Point;
    // Of the settings every third, which has each toggle with each row of finer keys.
    let looking = every_line_setting().into_iter().filter(|setting| setting.nee);
    for setting in every_nth(3, looking).into_iter().chain([point]) {
        let (scene, expected) = (with_strategy(&scene, setting), Expected::known(&[3.0; 3]));
        verdicts.hold(&full_name(&setting), &scene, 800_000, &expected);
    }
    verdicts.finish();
}

/// A glowing box without soot inside an absorber: emission and absorption of different volumes
/// count along one ray, each by its own borders.
#[test]
fn an_emissive_box_inside_an_absorber() {
    // ε = 1.5 over 2 lengths without own extinction, under 0.4 of absorption over 6 lengths:
    // ∫ from 2 to 4 of 1.5 e^(−0.4 t) dt = 3.75 (e^−0.8 − e^−1.6).
    let text = r#"
        [camera]
        position = [0, -3, 0]
        target = [0, 0, 0]
        fov_x = 0.01
        [[volume]]
        shape = "box"
        half_size = 3.0
        density = { scale = 0.4 }
        albedo = 0.0
        [[volume]]
        shape = "box"
        half_size = 1.0
        density = { scale = 0.0 }
        emission = { mode = "constant", value = 1.5 }
    "#;
    let expected = 3.75 * ((-0.8_f64).exp() - (-1.6_f64).exp());
    let scene = build(text);
    let mut verdicts = Verdicts::default();
    for strategy in half_of_strategies() {
        let (scene, expected) = (with_strategy(&scene, strategy), Expected::known(&[expected]));
        verdicts.hold(&name(&strategy), &scene, 1_500_000, &expected);
    }
    verdicts.finish();
}

/// Irradiance of a diffuse floor under a sphere lamp inside a purely absorbing ball that does not
/// reach the floor: the shadow ray leaves the medium half way and must not go on in it.
#[test]
fn light_samples_leave_the_medium() {
    let text = r#"
        [camera]
        position = [0, -1, 3]
        target = [0, 0, 0]
        fov_x = 0.01
        [path]
        max_scatters = 1
        [[volume]]
        shape = "sphere"
        radius = 1.0
        translate = [0, 0, 5]
        density = { scale = 1.0 }
        albedo = 0.0
        [[light]]
        type = "sphere"
        center = [0, 0, 5]
        radius = 0.1
        radiance = 10.0
        [[surface]]
        shape = "plane"
        point = [0, 0, 0]
        normal = [0, 0, 1]
        material = { type = "diffuse", reflectance = 1.0 }
    "#;
    let expected = radiance_under_the_lamp();
    let scene = build(text);
    let mut verdicts = Verdicts::default();
    for strategy in half_of_strategies() {
        let (scene, expected) = (with_strategy(&scene, strategy), Expected::known(&[expected]));
        verdicts.hold(&name(&strategy), &scene, 200_000, &expected);
    }
    verdicts.finish();
}

/// Radiance 10 of the lamp (radius r, distance d) through what its ball (radius R) holds of the
/// way: L/π ∫ e^−τ cos θ dω, with τ = √(R² − s²) − √(r² − s²) for rays that pass the middle at
/// s = d sin θ.
fn radiance_under_the_lamp() -> f64 {
    let (r, d, ball) = (0.1_f64, 5.0_f64, 1.0_f64);
    let steps = 10_000;
    (0..steps)
        .map(|i| {
            let s2 = r * r * (f64::from(i) + 0.5) / f64::from(steps);
            let tau = (ball * ball - s2).sqrt() - (r * r - s2).sqrt();
            // 2 π cos θ sin θ dθ = π d(sin² θ)
            10.0 * (-tau).exp() * r * r / (d * d * f64::from(steps))
        })
        .sum()
}

/// A fog without borders that is clear to one channel: the clear channel sees the environment, the
/// others the furnace, and no path waits for a collision that never comes.
#[test]
fn fog_that_is_clear_to_a_channel() {
    let text = format!(
        r#"{CAMERA}
        [environment]
        radiance = [5.0, 5.0, 1.0]
        [[volume]]
        shape = "everywhere"
        density = {{ scale = [0.3, 0.1, 0.0] }}
        albedo = 0.5
        emission = {{ mode = "source", le = 2.0 }}
        "#
    );
    let scene = build(&text);
    let mut verdicts = Verdicts::default();
    for strategy in half_of_strategies() {
        let expected = Expected::known(&[2.0, 2.0, 1.0]);
        verdicts.hold(&name(&strategy), &with_strategy(&scene, strategy), 400_000, &expected);
    }
    verdicts.finish();
}
