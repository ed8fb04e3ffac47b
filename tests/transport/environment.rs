//! Environments that vary over the directions: against closed forms and quadratures, and in every
//! way to sample them.
//!
//! Known values are held with a standard error that finds half a per cent with a probability of
//! 99 %, what was measured as all comparisons are (see `common`).

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use crate::common::{
    EVERYTHING, Expected, Verdicts, asking, build, full_name, measure_closely, measure_with,
    with_strategy,
};
use flambeau::light::{Environment, LightGroup, Lights, Orientation, Radiance, RadianceMap, Up};
use flambeau::math::Rgb;
use flambeau::transport::{
    Scene,
    learned_counts::{BounceClass, CountRule, LearnedCounts},
    strategy::{Advanced, Integrator, LightSelection, Preset, Strategy},
};
use glam::{DVec3, UVec2};

/// Standard error of a test that finds half a per cent so surely.
const HALF_PERCENT: f64 = 0.005 / 7.326;
/// The colors of the gradient, channel by channel: straight down, at the horizon, straight up.
const GRADIENT: [[f64; 3]; 3] = [[0.2, 0.4, 0.0], [1.0, 0.7, 0.5], [3.0, 1.0, 0.0]];
/// Exposure and tint of it.
const FACTORS: [f64; 3] = [1.0, 2.0, 0.5];
const SKY: &str = "
    [environment]
    gradient = [[0.2, 0.4, 0.0], [1.0, 0.7, 0.5], [3.0, 1.0, 0.0]]
    exposure = 1.0
    tint = [0.5, 1.0, 0.25]
";

/// Radiance of the gradient from a unit direction.
fn sky(direction: DVec3) -> DVec3 {
    let [bottom, horizon, top] = GRADIENT.map(DVec3::from_array);
    let end = if direction.z >= 0.0 { top } else { bottom };
    DVec3::from_array(FACTORS) * horizon.lerp(end, direction.z.abs())
}

/// ∫ of a function over all directions, by midpoints.
fn over_directions(steps: i32, of: impl Fn(DVec3) -> DVec3) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for i in -steps..steps {
        let z = (f64::from(i) + 0.5) / f64::from(steps);
        let across = (1.0 - z * z).sqrt();
        for j in 0..2 * steps {
            let (sin, cos) = (TAU * (f64::from(j) + 0.5) / f64::from(2 * steps)).sin_cos();
            sum += of(DVec3::new(across * cos, across * sin, z));
        }
    }
    sum * (TAU / f64::from(2 * steps) / f64::from(steps))
}

/// The presets and ray marching, with each way to choose lights somewhere.
fn strategies() -> Vec<Strategy> {
    let selections = [LightSelection::Hierarchy, LightSelection::Uniform, LightSelection::Probes];
    let presets = Preset::ALL.into_iter().zip(selections).map(|(preset, light_selection)| {
        let advanced = Advanced { light_selection, ..asking() };
        Strategy { advanced, ..preset.strategy() }
    });
    let march = Strategy { integrator: Integrator::March, ..Preset::Full.strategy() };
    presets.chain([march]).collect()
}

/// First counts without any light samples of lamps, or with a few.
fn lamp_counts(rule: CountRule) -> LearnedCounts {
    let mut counts = LearnedCounts::first(1.0);
    for class in BounceClass::ALL {
        counts.at_mut(class).lamp_samples = rule;
    }
    counts
}

/// Holds a scene against a value by all strategies, and with other numbers of light samples: none,
/// a third, and several.
fn hold_everywhere(verdicts: &mut Verdicts, label: &str, scene: &Scene, expected: &Expected) {
    for strategy in strategies() {
        let label = format!("{label} {}", full_name(&strategy));
        verdicts.hold(&label, &with_strategy(scene, strategy), 2_000_000, expected);
    }
    for (name, most) in [("no samples", 0.0), ("a third", 0.33), ("several", 3.0)] {
        let rule = CountRule { per_throughput: f32::INFINITY, most };
        let counts = lamp_counts(if most > 0.0 { rule } else { CountRule::NONE });
        verdicts.hold_counts(&format!("{label}, {name}"), scene, counts, 4_000_000, expected);
    }
}

fn floor(normal: [f64; 3], sky: &str) -> Scene {
    build(&format!(
        r#"
        [camera]
        position = [0, -1, 2]
        target = [0, 0, 0]
        fov_x = 0.001
        [path]
        max_scatters = 1
        [[surface]]
        shape = "plane"
        normal = {normal:?}
        material = {{ type = "diffuse", reflectance = [1.0, 0.5, 0.25] }}
        {sky}
        "#
    ))
}

/// A white plane under a gradient: facing up in closed form, tilted by a quadrature.
#[test]
fn a_plane_under_a_gradient() {
    let [_, horizon, top] = GRADIENT.map(DVec3::from_array);
    let reflectance = DVec3::new(1.0, 0.5, 0.25) * DVec3::from_array(FACTORS);
    let up = reflectance * (horizon + 2.0 / 3.0 * (top - horizon));
    let normal = DVec3::new(0.0, -0.8, 0.6);
    let tilted =
        over_directions(400, |d| sky(d) * d.dot(normal).max(0.0) / PI) * DVec3::new(1.0, 0.5, 0.25);
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    for (label, normal, radiance) in [("up", DVec3::Z, up), ("tilted", normal, tilted)] {
        let scene = floor(normal.to_array(), SKY);
        assert_eq!(scene.lights.len(LightGroup::Lamps), 1);
        hold_everywhere(&mut verdicts, label, &scene, &Expected::known(&radiance.to_array()));
    }
    verdicts.finish();
}

/// Where +y is up, the gradient is along it.
#[test]
fn a_gradient_goes_along_the_up_of_the_world() {
    let scene = floor([0.0, 0.0, 1.0], &format!("[scene]\nup = \"y\"\n{SKY}"));
    let turned = |d: DVec3| sky(DVec3::new(d.x, -d.z, d.y));
    let radiance =
        over_directions(400, |d| turned(d) * d.z.max(0.0) / PI) * DVec3::new(1.0, 0.5, 0.25);
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    verdicts.hold("y", &scene, 1_000_000, &Expected::known(&radiance.to_array()));
    verdicts.finish();
}

/// A ball of a medium that scatters forward, seen from above under a gradient: one scattering
/// event, by a quadrature over the ray and all directions, and the sky through the ball.
#[test]
fn a_ball_of_smoke_under_a_gradient() {
    const G: f64 = 0.8;
    const STEPS: i32 = 60;
    let scene = build(&format!(
        r#"
        [camera]
        position = [0, -4, 2]
        target = [0, 0, 0]
        fov_x = 0.001
        [path]
        max_scatters = 1
        [[volume]]
        shape = "sphere"
        radius = 1.0
        density = {{ scale = 1.0 }}
        albedo = 0.8
        phase = {{ g = {G} }}
        {SKY}
        "#
    ));
    let view = DVec3::new(0.0, 2.0, -1.0).normalize();
    let henyey_greenstein =
        |cos: f64| (1.0 - G * G) / (4.0 * PI * (1.0 + G * G - 2.0 * G * cos).powf(1.5));
    let to_edge = |from: DVec3, d: DVec3| {
        let along = from.dot(d);
        -along + (along * along + 1.0 - from.length_squared()).max(0.0).sqrt()
    };
    let mut radiance = (-2.0_f64).exp() * sky(view);
    for step in 0..STEPS {
        let t = 2.0 * (f64::from(step) + 0.5) / f64::from(STEPS);
        let point = (t - 1.0) * view;
        let scattered = over_directions(100, |d| {
            sky(d) * henyey_greenstein(d.dot(view)) * (-to_edge(point, d)).exp()
        });
        radiance += 0.8 * (-t).exp() * scattered * (2.0 / f64::from(STEPS));
    }
    let mut verdicts = Verdicts::of_power(2.0 * HALF_PERCENT);
    hold_everywhere(&mut verdicts, "ball", &scene, &Expected::known(&radiance.to_array()));
    verdicts.finish();
}

/// The scene under another environment.
fn under(scene: &Scene, environment: Environment) -> Scene {
    let mut scene = scene.clone();
    scene.lights = Lights::new(environment, Vec::new(), &scene.surfaces, &scene.world);
    scene
}

/// A sky with a sun of one texel, by far most of the light, and all but black from below.
fn sunny(is_hidden: bool) -> Environment {
    let size = UVec2::new(32, 16);
    let places = (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y)));
    let texels = places.map(|place| match place {
        (13, 4) => [300.0, 250.0, 150.0],
        (x, 0..8) => [0.3, 0.4, 0.5 + 0.01 * x as f32],
        _ => [0.01; 3],
    });
    let (map, _) = RadianceMap::new(size, texels.collect()).unwrap();
    let orientation = Orientation::new(Up::Z, 20.0);
    Environment::new(Radiance::Map(Arc::new(map)), Rgb::ONE, orientation, is_hidden)
}

/// All strategies and all numbers of light samples have one mean under an image with a sun in it,
/// beside a fire and a lamp.
#[test]
fn all_strategies_agree_under_a_sun_in_an_image() {
    let scene = under(&build(EVERYTHING), sunny(false));
    let reference = measure_closely(&with_strategy(&scene, Strategy::default()), 3_000_000);
    let mut verdicts = Verdicts::default();
    let expected = Expected::measured(&reference);
    for strategy in strategies().into_iter().filter(|s| s.integrator == Integrator::Path) {
        let label = full_name(&strategy);
        verdicts.hold(&label, &with_strategy(&scene, strategy), 3_000_000, &expected);
    }
    let rule = CountRule { per_throughput: f32::INFINITY, most: 0.33 };
    verdicts.hold_counts("a third", &scene, lamp_counts(rule), 3_000_000, &expected);
    let hashed = LearnedCounts::hashed(1.0, 3);
    verdicts.hold_counts("hashed", &scene, hashed, 3_000_000, &expected);
    verdicts.finish();
}

/// A hidden environment is black to the camera alone: its light on everything else and the alpha
/// stay what they are.
#[test]
fn a_hidden_environment_is_black_to_the_camera_alone() {
    const PATHS: u32 = 300_000;
    // Lamps that the camera sees belong to the background as well.
    let dark = build(&EVERYTHING.replace("radiance = [2.0, 4.0, 8.0]", "radiance = 0.0"));
    let [shown, hidden] = [false, true].map(|is_hidden| under(&dark, sunny(is_hidden)));
    assert_eq!(measure_with(&hidden, PATHS, |path| path.background).mean, [0.0; 3]);
    assert!(measure_with(&shown, PATHS, |path| path.background).mean[0] > 0.0);
    let mut verdicts = Verdicts::default();
    let alpha = |path: &flambeau::transport::PathSample| Rgb::splat(path.alpha);
    let expected = Expected::measured(&measure_with(&shown, PATHS, alpha)).deciding(1);
    verdicts.hold_part("alpha", &hidden, PATHS, &expected, alpha);
    let lit = |path: &flambeau::transport::PathSample| path.direct + path.indirect;
    let expected = Expected::measured(&measure_with(&shown, 3 * PATHS, lit));
    verdicts.hold_part("lit", &hidden, 3 * PATHS, &expected, lit);
    verdicts.finish();
}
