//! Expected counts of light samples, emission walks and ways to gather the end of a ray: the
//! picture is the same with any of them. Where a toggle is said to change nothing, so is every bit.

use std::sync::Arc;

use crate::common::{
    self, EVERYTHING, Expected, REFERENCED, Verdicts, all_strategies, build, full_name,
    measure_closely, name, with_strategy,
};
use flambeau::{
    scene::{self, Overrides, effect::no_effect_with},
    transport::{
        Frame, PathSample, Scene,
        learned_counts::LearnedCounts,
        strategy::{Integrator, NeeEvaluation, Preset, Strategy},
        toggle::Toggle,
    },
};
use glam::UVec2;

/// Counts that are a hash of technique, class, position and throughput give the mean of counts of
/// one, with paths of up to one, two and three bounces and with long ones, under every kind of
/// emission walk. Each setting is held to 3.7 % at 99 %.
#[test]
fn the_picture_does_not_depend_on_the_counts() {
    let full = Preset::Full.strategy();
    let strategies = [
        full,
        Preset::Emission.strategy(),
        Strategy { nee: false, ..full },
        Strategy { emission_ratio_tracking: false, ..full },
        Strategy { emission_ratio_tracking: false, emission_decoupling: false, ..full },
        Strategy { majorant_boost: false, probe_mis: false, ..full },
    ];
    let colored = EVERYTHING.replace("scale = 2.0", "scale = [1.5, 2.0, 2.5]");
    let mut verdicts = Verdicts::of_power(REFERENCED);
    for cap in [1, 2, 3, 0] {
        let text = format!("{colored}\n[path]\nmax_scatters = {cap}");
        let scene = build(&text);
        let reference =
            measure_closely(&with_strategy(&scene, Preset::Emission.strategy()), 2_000_000);
        for (hash, strategy) in strategies.into_iter().enumerate() {
            let scene = with_strategy(&scene, strategy);
            let counts = LearnedCounts::hashed(0.5, hash as u32);
            let label = format!("{cap} bounces, {}", full_name(&strategy));
            let expected = Expected::measured(&reference);
            verdicts.hold_counts(&label, &scene, counts, 1_000_000, &expected);
        }
    }
    verdicts.finish();
}

/// A volume of a shape, with its medium.
fn volume(shape: &str, scale: f64, albedo: f64, emission: &str) -> String {
    let half_size = if shape == "everywhere" { "" } else { "half_size = 0.8" };
    format!(
        "[[volume]]\nshape = \"{shape}\"\n{half_size}\ndensity = {{ scale = {scale} }}\n\
         albedo = {albedo}\n{emission}\n"
    )
}

/// Scenes in which some toggles have no effect, each with its name.
fn plain_scenes() -> [(&'static str, String); 6] {
    let source = r#"emission = { mode = "source", le = 2.0 }"#;
    let constant = |value: f64| format!("emission = {{ mode = \"constant\", value = {value} }}");
    let black_ball = "[[surface]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0.3\n\
                      material = { type = \"conductor\", alpha = 0.1, reflectance = 0.0 }\n";
    [
        ("smoke alone", volume("noise", 3.0, 0.8, "")),
        ("fire that nothing scatters", volume("noise", 3.0, 0.0, source)),
        ("fire around a black ball", volume("box", 0.3, 0.0, &constant(0.5)) + black_ball),
        ("fire in smoke", volume("noise", 2.0, 0.7, source)),
        (
            "fires that are off",
            volume("noise", 2.0, 1.0, source) + &volume("everywhere", 0.05, 0.7, &constant(0.0)),
        ),
        (
            "fog that burns, and fire",
            volume("everywhere", 0.05, 0.7, &constant(0.01))
                + &volume("box", 0.5, 0.5, &constant(1.0)),
        ),
    ]
}

/// Wherever a toggle is said to have no effect, samples with it on and off are the same to the
/// last bit, and take the same steps.
#[test]
fn a_toggle_without_effect_changes_no_bit() {
    let mut claims = 0;
    for (what, volumes) in plain_scenes() {
        let text = format!(
            "[camera]\nposition = [0, -4, 0.5]\ntarget = [0, 0, 0]\n\
             [environment]\nradiance = 0.3\n{volumes}"
        );
        let settings =
            scene::parse(&text, what, std::path::Path::new("."), &Overrides::default()).unwrap();
        let built = build(&text);
        let mut known: Vec<(Strategy, Vec<PathSample>)> = Vec::new();
        let mut samples = |strategy: Strategy| {
            if let Some((_, known)) = known.iter().find(|(other, _)| *other == strategy) {
                return known.clone();
            }
            let found = samples_of(&built, strategy);
            known.push((strategy, found.clone()));
            found
        };
        for set in all_strategies().into_iter().step_by(3) {
            for (march, point) in [(false, false), (false, true), (true, false)] {
                let mut strategy = set;
                strategy.advanced.share_learning = true;
                strategy.integrator = if march { Integrator::March } else { Integrator::Path };
                let evaluation = if point { NeeEvaluation::Point } else { NeeEvaluation::Line };
                strategy.advanced.nee_evaluation = evaluation;
                for toggle in Toggle::all() {
                    if no_effect_with(toggle, &settings, &strategy).is_none() {
                        continue;
                    }
                    let [on, off] = [true, false].map(|on| samples(toggle.set(&strategy, on)));
                    assert_eq!(on, off, "{what}: {toggle:?} beside {}", name(&strategy));
                    claims += 1;
                }
            }
        }
    }
    assert!(claims > 300, "{claims}");
}

/// Some samples of a small film, its probes and its pilot made anew.
fn samples_of(scene: &Scene, strategy: Strategy) -> Vec<PathSample> {
    const SIDE: u32 = 6;
    let mut strategy = strategy;
    strategy.advanced.probe_count = 64;
    let scene = Arc::new(with_strategy(scene, strategy));
    let probes = common::placed(&scene);
    let frame = Frame::with_probes(scene, UVec2::splat(SIDE), common::seed(), probes);
    let frame = common::prepared(frame);
    let pixels = (0..SIDE * SIDE).map(|i| UVec2::new(i % SIDE, i / SIDE));
    pixels.flat_map(|pixel| [frame.sample(pixel, 0), frame.sample(pixel, 1)]).collect()
}
