//! One scene, every combination of the toggles, one picture; and its error falls as 1/N.

mod common;

use common::{Verdicts, all_strategies, build, measure, name, with_strategy};
use flambeau::transport::strategy::{Advanced, BoostMode, Preset, Strategy};

/// Fire with soot inside scattering smoke on a floor, a lamp, a sun and a metal ball.
const EVERYTHING: &str = r#"
    [camera]
    position = [0, -5, 1.5]
    target = [0, 0, 0]
    fov_x = 40
    [environment]
    radiance = [0.02, 0.03, 0.05]
    [[volume]]
    name = "fire"
    shape = "noise"
    half_size = [0.5, 0.5, 0.9]
    frequency = 2.0
    contrast = 3.0
    density = { scale = 1.5 }
    albedo = 0.3
    emission = { mode = "source", le = [8.0, 3.0, 1.0] }
    [[volume]]
    name = "smoke"
    shape = "noise"
    half_size = [1.2, 0.8, 1.0]
    translate = [0.2, -0.4, 0.0]
    frequency = 1.0
    contrast = 2.0
    density = { scale = 2.0 }
    albedo = [0.9, 0.8, 0.7]
    phase = { g = 0.5 }
    [[light]]
    type = "sphere"
    center = [1.5, -1.0, 1.2]
    radius = 0.2
    radiance = [2.0, 4.0, 8.0]
    [[light]]
    type = "sun"
    direction = [-1, 1, -1]
    irradiance = 0.5
    angle = 3
    [[light]]
    type = "spot"
    position = [-2, -2, 3]
    target = [0, 0, 0]
    intensity = 4.0
    cone = 30
    blend = 0.5
    [[surface]]
    shape = "plane"
    point = [0, 0, -1.0]
    normal = [0, 0, 1]
    half_size = 5.0
    material = { type = "diffuse", reflectance = 0.5 }
    [[surface]]
    shape = "sphere"
    center = [1.2, -0.6, -0.6]
    radius = 0.4
    material = { type = "conductor", alpha = 0.3, reflectance = 0.9 }
"#;

#[test]
fn every_combination_gives_one_picture() {
    let scene = build(EVERYTHING);
    let reference = measure(&with_strategy(&scene, Preset::Full.strategy()), 2_000_000);
    let mut verdicts = Verdicts::default();
    let literal = Advanced { boost_mode: BoostMode::Literal, ..Advanced::default() };
    let strong = Advanced { boost_amount: 5.0, ..Advanced::default() };
    let finer = [literal, strong].map(|advanced| Strategy { advanced, ..Strategy::default() });
    for strategy in all_strategies().into_iter().chain(finer) {
        let estimate = measure(&with_strategy(&scene, strategy), 1_000_000);
        for channel in 0..3 {
            verdicts.check_equal(&name(&strategy), &estimate, &reference, channel);
            let weak = estimate.error(channel) > common::POWER * estimate.mean[channel];
            assert!(!weak, "{}: too weak {estimate:?}", name(&strategy));
        }
    }
    verdicts.finish();
}
