//! Each technique where it brings nearly all of the light, of a known value and with little noise:
//! an error of half a per cent is found with a probability of 99 %.

use std::f64::consts::PI;

use crate::common::{
    Expected, Verdicts, asking, boost_modes, build, every_guide, few_guides, full_name,
    half_of_strategies, seed, with_strategy,
};
use flambeau::{
    math::{PathRng, Ray},
    transport::{
        PathSample, Scene, shadow,
        strategy::{
            Advanced, BoostMode, Distance, LightSelection, NeeEvaluation, Preset, Strategy,
            Tracker, TransmittanceEstimator,
        },
    },
};
use glam::{UVec2, Vec3A};

/// Standard error of a fixed test that would find half a per cent so surely.
const HALF_PERCENT: f64 = 0.005 / 7.326;
/// The same where several settings share a technique, and are pooled.
const TOGETHER: f64 = 3.0 * HALF_PERCENT;

/// Emission in every way to gather it: a thick ramp that glows isothermally, L = 1 − e^−6.
#[test]
fn emission_by_every_walk() {
    let scene = build(
        r#"
        [camera]
        position = [0, 0, -1]
        target = [0, 0, 0]
        up = [0, 1, 0]
        fov_x = 0.01
        [[volume]]
        shape = "ramp"
        half_size = [0.5, 0.5, 1]
        translate = [0, 0, 1]
        axis = "z"
        a = 2.0
        b = 1.0
        albedo = 0.0
        emission = { mode = "source", le = [1.0, 2.0, 0.5] }
        "#,
    );
    let radiance = -(-6.0_f64).exp_m1();
    let expected = Expected::known(&[1.0, 2.0, 0.5].map(|le| le * radiance));
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    // Boosted by so little that the smoke takes more steps than the fire.
    let weak = [BoostMode::Clamped, BoostMode::Literal].map(|boost_mode| {
        let advanced = Advanced { boost_mode, boost_amount: 1.0, ..Advanced::default() };
        Strategy { advanced, ..Strategy::default() }
    });
    let settings = half_of_strategies().into_iter().filter(|s| s.nee).chain(boost_modes());
    for strategy in settings.chain(weak) {
        let label = full_name(&strategy);
        verdicts.hold(&label, &with_strategy(&scene, strategy), 4_000_000, &expected);
    }
    verdicts.finish();
}

/// A white floor at z = 0, seen around the origin, and what lights it.
fn floor(lights: &str) -> Scene {
    build(&format!(
        r#"
        [camera]
        position = [0, -2, 0.5]
        target = [0, 0, 0]
        fov_x = 0.001
        [path]
        max_scatters = 1
        [[surface]]
        shape = "plane"
        point = [0, 0, 0]
        normal = [0, 0, 1]
        material = {{ type = "diffuse", reflectance = [1.0, 0.5, 0.25] }}
        {lights}
        "#
    ))
}

/// The radiance of [`floor`] under an irradiance.
fn reflected(irradiance: f64) -> Expected {
    Expected::known(&[1.0, 0.5, 0.25].map(|reflectance| reflectance * irradiance / PI))
}

/// The usual way to choose lights and the even one, with two presets.
fn looks(presets: [Preset; 2]) -> Vec<Strategy> {
    let mut looks = Vec::new();
    for preset in presets {
        for light_selection in [LightSelection::Hierarchy, LightSelection::Uniform] {
            let advanced = Advanced { light_selection, ..asking() };
            looks.push(Strategy { nee: true, advanced, ..preset.strategy() });
        }
    }
    looks
}

/// Fires without soot, all of whose flux goes through the floor as if it came from their centers,
/// looked at along lines and at points. With a walk of its own the rest, which is found by chance,
/// has little noise as well.
#[test]
fn looks_at_fire() {
    let ball = |x: f64, z: f64| {
        format!(
            r#"
            [[volume]]
            shape = "sphere"
            radius = 1.0
            translate = [{x}, 0, {z}]
            density = {{ scale = 0.0 }}
            emission = {{ mode = "constant", value = 2.0 }}
            "#
        )
    };
    let flux = 2.0 * 4.0 / 3.0 * PI;
    let (near, far) = (floor(&ball(0.0, 12.0)), floor(&(ball(-9.0, 12.0) + &ball(9.0, 12.0))));
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    for look in looks([Preset::Full, Preset::Emission]) {
        for nee_evaluation in [NeeEvaluation::Line, NeeEvaluation::Point] {
            let look = Strategy { advanced: Advanced { nee_evaluation, ..look.advanced }, ..look };
            for (scene, irradiance) in
                [(&near, flux / 144.0), (&far, 2.0 * flux * 12.0 / 15.0_f64.powi(3))]
            {
                let scene = with_strategy(scene, look);
                verdicts.hold(&full_name(&look), &scene, 4_000_000, &reflected(irradiance));
            }
        }
    }
    verdicts.finish();
}

/// A wall through a fire without soot: what lies behind it is looked at in vain, and counts in the
/// density of every look all the same. ∫ ε cos θ / r² dV over the part before it, by the midpoint
/// rule.
#[test]
fn looks_at_fire_behind_a_wall() {
    const WALL: f64 = 5.8;
    let scene = floor(&format!(
        r#"
        [[volume]]
        shape = "sphere"
        radius = 1.0
        translate = [6, 0, 3]
        density = {{ scale = 0.0 }}
        emission = {{ mode = "constant", value = 2.0 }}
        [[surface]]
        shape = "quad"
        center = [{WALL}, 0, 3]
        half_u = [0, 2, 0]
        half_v = [0, 0, 2]
        material = {{ type = "black" }}
        "#
    ));
    const STEPS: u32 = 200;
    let step = 2.0 / f64::from(STEPS);
    let middle = |i: u32| (f64::from(i) + 0.5) * step - 1.0;
    // Slices across the wall, each a disk, from the ball's face to the wall.
    let depth = WALL - 5.0;
    let mut irradiance = 0.0;
    for i in 0..STEPS {
        let x = depth * (f64::from(i) + 0.5) / f64::from(STEPS) - 1.0;
        for (y, z) in (0..STEPS * STEPS).map(|j| (middle(j % STEPS), middle(j / STEPS))) {
            if x * x + y * y + z * z < 1.0 {
                let square = (x + 6.0).powi(2) + y * y + (z + 3.0).powi(2);
                irradiance += 2.0 * (z + 3.0) / (square * square.sqrt());
            }
        }
    }
    let expected = reflected(irradiance * step * step * depth / f64::from(STEPS));
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    for look in looks([Preset::Full, Preset::Emission]) {
        verdicts.hold(&full_name(&look), &with_strategy(&scene, look), 4_000_000, &expected);
    }
    verdicts.finish();
}

/// One light of each kind, and two at once.
#[test]
fn looks_at_lamps() {
    let point = "[[light]]\ntype = \"point\"\nposition = [1, 0, 2]\nintensity = 3.0\n";
    let spot = "[[light]]\ntype = \"spot\"\nposition = [0, 1, 3]\ntarget = [0, 0, 0]\n\
                intensity = 4.0\ncone = 40\nblend = 0.2\n";
    let sun = |angle: f64| {
        format!(
            "[[light]]\ntype = \"sun\"\ndirection = [3, 0, -4]\nirradiance = 2.0\nangle = {angle}\n"
        )
    };
    let sphere = "[[light]]\ntype = \"sphere\"\ncenter = [0, 0, 4]\nradius = 0.5\nradiance = 5.0\n";
    let hidden = "[[light]]\ntype = \"sphere\"\ncenter = [2, 0, 4]\nradius = 0.5\nradiance = 5.0\n\
                  visible = false\n";
    let quad = "[[light]]\ntype = \"quad\"\ncenter = [0, 0, 3]\nhalf_u = [0.6, 0, 0]\n\
                half_v = [0, 0.3, 0]\nradiance = 7.0\n";
    // Of a differential area to a rectangle across its normal, a quarter after the other.
    let [x, y] = [0.6_f64 / 3.0, 0.3 / 3.0];
    let quarter = |x: f64, y: f64| x / (1.0 + x * x).sqrt() * (y / (1.0 + x * x).sqrt()).atan();
    let form_factor = 2.0 / PI * (quarter(x, y) + quarter(y, x));
    let of_point = 3.0 * 2.0 / 5.0_f64.powf(1.5);
    let of_sphere = |x: f64| 5.0 * PI * 0.25 * 4.0 / (x * x + 16.0).powf(1.5);
    let cases = [
        ("point", point.to_owned(), of_point),
        ("spot", spot.to_owned(), 4.0 * 3.0 / 10.0_f64.powf(1.5)),
        ("sun", sun(0.0), 2.0 * 0.8),
        ("disk", sun(2.0), 2.0 * 0.8),
        ("sphere", sphere.to_owned(), of_sphere(0.0)),
        ("invisible", hidden.to_owned(), of_sphere(2.0)),
        ("quad", quad.to_owned(), 7.0 * PI * form_factor),
        ("both", format!("{point}{hidden}"), of_point + of_sphere(2.0)),
    ];
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    for (what, lights, irradiance) in cases {
        let scene = floor(&lights);
        for look in looks([Preset::Full, Preset::Baseline]) {
            let label = format!("{what}, {}", full_name(&look));
            verdicts.hold(&label, &with_strategy(&scene, look), 4_000_000, &reflected(irradiance));
        }
    }
    verdicts.finish();
}

/// Thin smoke in front of an even sky, and the sky itself.
#[test]
fn the_sky_at_the_end_of_the_ray() {
    let scene = build(
        r#"
        [camera]
        position = [0, 0, -1]
        target = [0, 0, 0]
        up = [0, 1, 0]
        fov_x = 0.01
        [environment]
        radiance = [1.0, 2.0, 0.5]
        [[volume]]
        shape = "ramp"
        half_size = [0.5, 0.5, 1]
        translate = [0, 0, 1]
        axis = "z"
        a = 0.02
        b = 0.03
        albedo = 0.0
        "#,
    );
    let expected = Expected::known(&[1.0, 2.0, 0.5].map(|sky| sky * (-0.1_f64).exp()));
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    for strategy in half_of_strategies().into_iter().filter(|strategy| strategy.nee) {
        let label = full_name(&strategy);
        verdicts.hold(&label, &with_strategy(&scene, strategy), 4_000_000, &expected);
    }
    verdicts.finish();
}

/// Smoke that loses nothing, across z in [0, 1] and seen along its normal, of optical depth `depth`.
fn white_slab(depth: f64, more: &str) -> Scene {
    build(&format!(
        r#"
        [camera]
        position = [0, 0, 2]
        target = [0, 0, 0]
        up = [0, 1, 0]
        fov_x = 0.01
        [[volume]]
        shape = "ramp"
        half_size = [40, 40, 0.5]
        translate = [0, 0, 0.5]
        axis = "z"
        a = 0.6
        b = 0.8
        density = {{ scale = {depth} }}
        albedo = 1.0
        {more}
        "#
    ))
}

const SKY: &str = "[environment]\nradiance = 1.0\n";

/// Distances by every guide, of the sun's light scattered once: E ρ ∫ σ e^−2τ dt = E (1 − e^−2τ) / 8π.
/// The smoke is so thin that chance rarely scatters and guided flights bring nearly all.
#[test]
fn scattering_by_every_guide() {
    let depth = 0.03;
    let scene = white_slab(
        depth,
        "[path]\nmax_scatters = 1\n[[light]]\ntype = \"sun\"\ndirection = [0, 0, -1]\n\
         irradiance = 100.0\n",
    );
    let scattered = 100.0 * -(-2.0 * depth).exp_m1() / (8.0 * PI);
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    for strategy in few_guides() {
        let (label, expected) = (full_name(&strategy), Expected::known(&[scattered]));
        verdicts.hold(&label, &with_strategy(&scene, strategy), 4_000_000, &expected);
    }
    verdicts.finish();
}

/// The same of later rays, which one flight of several kinds follows: in a furnace, where nothing is
/// lost however often a path scatters.
#[test]
fn scattering_of_later_rays() {
    let scene = white_slab(1.0, SKY);
    let mut verdicts = Verdicts::of_power(TOGETHER);
    // By probes alone it takes ten times the paths.
    let later = |a: &Advanced| a.guide_all_vertices && a.distance == Distance::Mis;
    for strategy in every_guide().into_iter().filter(|strategy| later(&strategy.advanced)) {
        let (label, expected) = (full_name(&strategy), Expected::known(&[1.0]));
        verdicts.hold(&label, &with_strategy(&scene, strategy), 4_000_000, &expected);
    }
    verdicts.finish();
}

/// A lamp in thin fog: ∫ σ e^−σ(t + r) / (4π r²) dt along the ray, by the midpoint rule.
#[test]
fn scattering_by_equal_angles() {
    let fog = 0.02;
    let scene = build(&format!(
        r#"
        [camera]
        position = [0, 0, 0]
        target = [0, 0, 1]
        up = [0, 1, 0]
        fov_x = 0.01
        [path]
        max_scatters = 1
        [[volume]]
        shape = "everywhere"
        density = {{ scale = {fog} }}
        albedo = 1.0
        [[light]]
        type = "point"
        position = [1, 0, 4]
        intensity = 100.0
        [[surface]]
        shape = "plane"
        point = [0, 0, 10]
        normal = [0, 0, 1]
        material = {{ type = "black" }}
        "#
    ));
    const STEPS: u32 = 100_000;
    let step = 10.0 / f64::from(STEPS);
    let scattered = |i: u32| {
        let t = (f64::from(i) + 0.5) * step;
        let square = 1.0 + (t - 4.0).powi(2);
        100.0 * fog * (-fog * (t + square.sqrt())).exp() / (4.0 * PI * square) * step
    };
    let expected = Expected::known(&[(0..STEPS).map(scattered).sum()]);
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    let by_angles = |strategy: &Strategy| strategy.advanced.equiangular;
    for strategy in every_guide().into_iter().filter(by_angles) {
        let label = full_name(&strategy);
        verdicts.hold(&label, &with_strategy(&scene, strategy), 4_000_000, &expected);
    }
    verdicts.finish();
}

/// What gets through a ramp, e^−τ, thin and so thick that roulette ends most walks.
#[test]
fn transmittance_by_every_estimator() {
    /// Estimates in a batch, of which there are as many as samples of a pixel elsewhere.
    const BATCH: u32 = 1024;
    for (depth, power) in [(0.3, HALF_PERCENT), (3.2, TOGETHER)] {
        let mut verdicts = Verdicts::of_power(power);
        let scene = white_slab(depth, "");
        let ray = Ray::new(2.0 * Vec3A::Z, -Vec3A::Z);
        for transmittance in [
            TransmittanceEstimator::Marching,
            TransmittanceEstimator::Residual,
            TransmittanceEstimator::Ratio,
        ] {
            let (mut sum, mut squares, mut present) = (0.0, 0.0, 0);
            let seed = seed().wrapping_add(verdicts.next_seed());
            let mean = |batches: u32| {
                for index in present..batches * BATCH {
                    let mut rng = PathRng::new(seed, UVec2::ZERO, index);
                    let medium = scene.world.along(ray, f32::INFINITY);
                    let value = shadow::transmittance(medium, transmittance, &mut rng).0;
                    sum += f64::from(value.x);
                    squares += f64::from(value.x * value.x);
                }
                present = batches * BATCH;
                let (n, mean) = (f64::from(present), sum / f64::from(present));
                vec![[mean, (squares / n - mean * mean).max(0.0) / (n - 1.0)]]
            };
            let advanced = Advanced { transmittance, ..asking() };
            let strategy = Strategy { advanced, ..Strategy::default() };
            let label = format!("depth {depth}, {transmittance:?}");
            let expected = Expected::known(&[(-depth).exp()]);
            verdicts.follow(&label, &strategy, 1 << 16, &expected, mean);
        }
        verdicts.finish();
    }
}

/// Scattering itself by every tracker, where each path scatters often and nothing is lost.
#[test]
fn scattering_by_every_tracker() {
    let scene = white_slab(2.0, SKY);
    let mut verdicts = Verdicts::of_power(TOGETHER);
    for tracker in [Tracker::Delta, Tracker::Decomposition, Tracker::Spectral] {
        for preset in [Preset::Baseline, Preset::Emission] {
            let advanced = Advanced { tracker, ..Advanced::default() };
            let strategy = Strategy { advanced, ..preset.strategy() };
            if strategy.tracker_refusal().is_none() {
                let label = format!("{tracker:?} {preset}");
                let expected = Expected::known(&[1.0; 3]);
                verdicts.hold(&label, &with_strategy(&scene, strategy), 4_000_000, &expected);
            }
        }
    }
    verdicts.finish();
}

/// A floor under smoke that loses nothing, in a furnace: it reflects 0.08 and emits what is missing
/// of 1. From the third event on roulette takes one path of five, and what is left brings the same.
#[test]
fn roulette_is_made_up_for() {
    let scene = build(
        r#"
        [camera]
        position = [0, 0, 0.1]
        target = [0, 0, 0]
        up = [0, 1, 0]
        fov_x = 0.01
        [[volume]]
        shape = "box"
        half_size = [200, 200, 4]
        translate = [0, 0, 4.2]
        density = { scale = 1.0 }
        albedo = 1.0
        [environment]
        radiance = 1.0
        [[surface]]
        shape = "plane"
        point = [0, 0, 0]
        normal = [0, 0, 1]
        material = { type = "diffuse", reflectance = 0.08 }
        emission = 0.92
        "#,
    );
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    for preset in [Preset::Baseline, Preset::Emission] {
        let scene = with_strategy(&scene, preset.strategy());
        let reflected = |path: &PathSample| path.direct + path.indirect;
        let expected = Expected::known(&[0.08]);
        verdicts.hold_part(&preset.to_string(), &scene, 1_000_000, &expected, reflected);
    }
    verdicts.finish();
}

/// GGX's α.
const ALPHA: f64 = 0.4;

/// A metal under an even sky: what it reflects, by quadrature over the directions of
/// D(h) / (4 cos θ_o (1 + Λ_o + Λ_i)).
#[test]
fn metals_reflect_what_their_formula_says() {
    let scene = build(&format!(
        r#"
        [camera]
        position = [0, -3, 2]
        target = [0, 0, 0]
        fov_x = 0.001
        [path]
        max_scatters = 1
        [environment]
        radiance = 1.0
        [[surface]]
        shape = "plane"
        point = [0, 0, 0]
        normal = [0, 0, 1]
        material = {{ type = "conductor", alpha = {ALPHA}, reflectance = [0.9, 0.7, 0.4] }}
        "#
    ));
    let outgoing = glam::DVec3::new(0.0, -3.0, 2.0).normalize();
    let lambda = |v: glam::DVec3| {
        let tan2 = (1.0 - v.z * v.z) / (v.z * v.z);
        0.5 * ((1.0 + ALPHA * ALPHA * tan2).sqrt() - 1.0)
    };
    let reflected = |incoming: glam::DVec3| {
        let half = (outgoing + incoming).normalize();
        let square = half.z * half.z;
        let base = square * (ALPHA * ALPHA - 1.0) + 1.0;
        let distribution = ALPHA * ALPHA / (PI * base * base);
        distribution / (4.0 * outgoing.z * (1.0 + lambda(outgoing) + lambda(incoming)))
    };
    const STEPS: u32 = 1000;
    let mut sum = 0.0;
    for i in 0..STEPS {
        for j in 0..2 * STEPS {
            let cos = (f64::from(i) + 0.5) / f64::from(STEPS);
            let (y, x) = (PI * (f64::from(j) + 0.5) / f64::from(STEPS)).sin_cos();
            let sin = (1.0 - cos * cos).sqrt();
            sum += reflected(glam::DVec3::new(sin * x, sin * y, cos));
        }
    }
    let reflected = 2.0 * PI * sum / f64::from(STEPS * 2 * STEPS);
    let expected = Expected::known(&[0.9, 0.7, 0.4].map(|fresnel| fresnel * reflected));
    let mut verdicts = Verdicts::of_power(HALF_PERCENT);
    for preset in [Preset::Baseline, Preset::Full] {
        let scene = with_strategy(&scene, preset.strategy());
        verdicts.hold(&preset.to_string(), &scene, 1_000_000, &expected);
    }
    verdicts.finish();
}
