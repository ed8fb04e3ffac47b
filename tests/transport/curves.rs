//! Curves over the values of density and emission, and emission of two grids: closed forms of a box
//! of one value, and one mean for all strategies where the values vary.

use flambeau::transport::strategy::Preset;

use crate::common::{
    Expected, Verdicts, build, full_name, half_of_strategies, measure_closely, name, with_strategy,
};

/// A box of value 1 that a narrow film sees through along its depth of 2, before a sky of
/// `SKY`. Curves make that μ_t = 0.5 · 1.6 and ε = 3 · (0.5, 1, 2) · 0.7.
#[test]
fn a_box_behind_curves_absorbs_and_glows_by_their_values() {
    const SKY: f64 = 0.4;
    let scene = build(&format!(
        "[camera]
        position = [0, -5, 0]
        fov_x = 0.5
        [environment]
        radiance = {SKY}
        [[volume]]
        shape = 'box'
        density = {{ scale = 0.5, curve = [[0, 9], [0.8, 0.8], [1.2, 2.4]] }}
        albedo = 0
        [volume.emission]
        mode = 'constant'
        value = 3.0
        color = [0.5, 1, 2]
        intensity_grid = 'density'
        intensity_curve = [[0.5, 0.2], [1.5, 1.2]]"
    ));
    let mu_t: f64 = 0.5 * 1.6;
    let transmittance = (-2.0 * mu_t).exp();
    let expected = [0.5, 1.0, 2.0]
        .map(|color| 3.0 * 0.7 * color * (1.0 - transmittance) / mu_t + SKY * transmittance);
    let mut verdicts = Verdicts::default();
    for strategy in half_of_strategies() {
        let scene = with_strategy(&scene, strategy);
        verdicts.hold(&name(&strategy), &scene, 1_000_000, &Expected::known(&expected));
    }
    verdicts.finish();
}

/// A noise whose thin parts are dense by an inverted curve, and whose glow comes from two functions
/// of it: bounds that the curves leave would show as another mean under some strategy.
#[test]
fn all_strategies_agree_on_what_curves_make_of_a_noise() {
    let scene = build(
        "[camera]
        position = [0, -5, 1]
        [environment]
        radiance = 0.1
        [[volume]]
        shape = 'noise'
        frequency = 1.5
        contrast = 2.0
        density = { scale = 3.0, curve = [[0.2, 1], [0.45, 0], [0.6, 2], [0.8, 0.3]] }
        albedo = [0.8, 0.6, 0.4]
        phase = { g = 0.8, g2 = -0.4, mix = 0.3 }
        [volume.emission]
        mode = 'ramp'
        grid = 'density'
        curve = [[0, 1], [1, 0]]
        stops = [[0.3, 0, 0, 0], [0.6, 3, 1, 0.2]]
        intensity_grid = 'density'
        intensity_curve = [[0.3, 0], [0.5, 2], [0.7, 0.1]]",
    );
    let full = with_strategy(&scene, Preset::Full.strategy());
    let reference = measure_closely(&full, 4_000_000);
    let expected = Expected::measured(&reference);
    let mut verdicts = Verdicts::of_power(crate::common::REFERENCED);
    for strategy in half_of_strategies() {
        let label = full_name(&strategy);
        verdicts.hold(&label, &with_strategy(&scene, strategy), 2_000_000, &expected);
    }
    verdicts.finish();
}
