//! Slabs of known reflectance, transmittance and emissivity (adding-doubling; the row with
//! g 0.75, albedo 0.9, depth 2 is van de Hulst's), and half spaces.
//!
//! By reciprocity the radiance along the normal of a slab that a uniform hemisphere lights with
//! radiance 1 is its reflectance for light along the normal (hemisphere on the camera's side) or
//! its transmittance (hemisphere behind). Black planes make the hemispheres.

use crate::common::{
    Expected, Verdicts, build, every_guide, every_line_setting, every_nth, full_name,
    half_of_strategies, name, with_strategy,
};
use flambeau::transport::strategy::{Preset, Strategy};

/// g, albedo, optical depth, R, T, ε.
const ROWS: [[f64; 6]; 7] = [
    [0.0, 0.5, 1.0, 0.09912, 0.44606, 0.45482],
    [0.0, 0.9, 4.0, 0.40814, 0.12852, 0.46333],
    [0.0, 1.0, 16.0, 0.90363, 0.09637, 0.0],
    [0.75, 0.9, 2.0, 0.09739, 0.66096, 0.24165],
    [0.75, 0.99, 4.0, 0.28432, 0.64651, 0.069175],
    [0.85, 1.0, 4.0, 0.19091, 0.80909, 0.0],
    [-0.5, 0.9, 4.0, 0.49920, 0.08385, 0.41695],
];

/// A slab across z in [0, 1], seen from z = 2 along −z with a very narrow view.
fn slab(g: f64, albedo: f64, depth: f64, more: &str) -> String {
    format!(
        r#"
        [camera]
        position = [0, 0, 2]
        target = [0, 0, 0]
        up = [0, 1, 0]
        fov_x = 0.01
        [[volume]]
        shape = "box"
        half_size = [20000, 20000, 0.5]
        translate = [0, 0, 0.5]
        density = {{ scale = {depth} }}
        albedo = {albedo}
        phase = {{ g = {g} }}
        {more}
        "#
    )
}

fn black_plane(z: f64) -> String {
    format!(
        r#"
        [[surface]]
        shape = "plane"
        point = [0, 0, {z}]
        normal = [0, 0, 1]
        material = {{ type = "black" }}
        [environment]
        radiance = 1.0
        "#
    )
}

/// Paths that bring the standard error of a mean to 0.4 % of it. Values of 0 and 1 have variance
/// m (1 − m); with ratio tracking each of a path's vertices adds its chance to see the light, a sum
/// that may exceed 1, and the variance is larger.
fn paths_for(expected: f64, strategy: &Strategy) -> u32 {
    let spread = if strategy.emission_ratio_tracking { 0.45 } else { 0.0 };
    let variance = expected * (1.0 - expected) + spread * expected;
    (variance / (0.004 * expected).powi(2)) as u32 + 4096
}

#[test]
fn reflectance_and_transmittance() {
    let mut verdicts = Verdicts::default();
    for [g, albedo, depth, r, t, _] in ROWS {
        for (what, plane, expected) in [("R", -1.0, r), ("T", 3.0, t)] {
            let scene = build(&slab(g, albedo, depth, &black_plane(plane)));
            for preset in [Preset::Baseline, Preset::Full] {
                let scene = with_strategy(&scene, preset.strategy());
                let label = format!("{what} of g {g}, albedo {albedo}, depth {depth}, {preset}");
                let most = 2 * paths_for(expected, scene.strategy());
                verdicts.hold(&label, &scene, most, &Expected::known(&[expected]));
            }
        }
    }
    verdicts.finish();
}

/// Transmittance by every guide, of slabs thin enough for probes alone.
#[test]
fn transmittance_by_every_guide() {
    let mut verdicts = Verdicts::default();
    for [g, albedo, depth, _, t, _] in [ROWS[0], ROWS[3]] {
        let scene = build(&slab(g, albedo, depth, &black_plane(3.0)));
        for strategy in every_guide() {
            let label = format!("T of g {g}, albedo {albedo}, {}", full_name(&strategy));
            let scene = with_strategy(&scene, strategy);
            verdicts.hold(&label, &scene, 2 * paths_for(t, &strategy), &Expected::known(&[t]));
        }
    }
    verdicts.finish();
}

/// Each combination meets two or three of the rows.
#[test]
fn emissivity_in_every_combination_of_toggles() {
    let mut verdicts = Verdicts::default();
    let rows = ROWS.into_iter().filter(|row| row[5] > 0.0);
    for (row, [g, albedo, depth, _, _, emissivity]) in rows.enumerate() {
        let scene = build(&slab(g, albedo, depth, r#"emission = { mode = "source", le = 1.0 }"#));
        for strategy in half_of_strategies().into_iter().skip(row % 2).step_by(2) {
            let label = format!("ε of g {g}, albedo {albedo}, depth {depth}, {}", name(&strategy));
            let (scene, most) = (with_strategy(&scene, strategy), paths_for(emissivity, &strategy));
            verdicts.hold(&label, &scene, 3 * most, &Expected::known(&[emissivity]));
        }
    }
    verdicts.finish();
}

/// Three rows in one slab, a channel each, made of cells and wide enough to be endless: density
/// and albedo are chromatic, and looks at its glow come from inside it. In every third of the settings
/// whose looks a vertex inside fire allows.
#[test]
fn emissivity_channel_by_channel() {
    let rows = [ROWS[0], ROWS[1], [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]];
    let [density, albedo] = [2, 1].map(|column| rows.map(|row| row[column]));
    // Without looks the rows stand above. The last channel does not scatter: along the normal 1 − e^−1.
    let expected = [rows[0][5], rows[1][5], 1.0 - (-1.0_f64).exp()];
    let scene = build(&format!(
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
        a = 1.0
        b = 0.0
        density = {{ scale = {density:?} }}
        albedo = {albedo:?}
        emission = {{ mode = "source", le = 1.0 }}
        "#
    ));
    let mut verdicts = Verdicts::default();
    let looking = every_line_setting().into_iter().filter(|setting| setting.nee);
    for setting in every_nth(3, looking) {
        let (scene, expected) = (with_strategy(&scene, setting), Expected::known(&expected));
        verdicts.hold(&full_name(&setting), &scene, 1_000_000, &expected);
    }
    verdicts.finish();
}

/// Isotropic half space: √(1 − ω) H(1). A depth of 200 leaves nothing of the other side.
#[test]
fn half_spaces() {
    let mut verdicts = Verdicts::default();
    for (albedo, expected) in [(0.9, 0.585_053), (0.99, 0.247_279)] {
        let scene = build(&slab(0.0, albedo, 200.0, r#"emission = { mode = "source", le = 1.0 }"#));
        for preset in [Preset::Baseline, Preset::Full] {
            let scene = with_strategy(&scene, preset.strategy());
            let label = format!("half space of albedo {albedo}, {preset}");
            let most = 8 * paths_for(expected, scene.strategy());
            verdicts.hold(&label, &scene, most, &Expected::known(&[expected]));
        }
    }
    verdicts.finish();
}

/// In a white slab nothing is lost: R + T = 1, each path counted on one of the two sides. Each
/// combination meets one or two of the slabs.
#[test]
fn a_conservative_slab_keeps_everything() {
    let mut verdicts = Verdicts::default();
    for (row, (g, depth)) in [(0.0, 16.0), (0.85, 4.0), (-0.5, 2.0)].into_iter().enumerate() {
        let scene = build(&slab(g, 1.0, depth, "[environment]\nradiance = 1.0"));
        for strategy in half_of_strategies().into_iter().skip(row % 2).step_by(2) {
            let label = format!("white slab, g {g}, depth {depth}, {}", name(&strategy));
            let scene = with_strategy(&scene, strategy);
            verdicts.hold(&label, &scene, 200_000, &Expected::known(&[1.0]));
        }
    }
    verdicts.finish();
}
