//! Lights chosen by what probes have seen of them: a distribution that is what it says it is, that
//! heeds what hides a light, and that changes no picture.

use std::sync::Arc;

use crate::common::{self, Expected, Verdicts, build, full_name, measure_to, with_strategy};
use flambeau::{
    light::{By, LightChoice, LightGroup, Receiver},
    math::{PathRng, Rgb},
    transport::{
        PathSample, Scene, direct,
        probes::Probes,
        strategy::{Advanced, LightSelection, NeeEvaluation, Strategy},
    },
};
use glam::{UVec2, Vec3A};

/// Uneven mist between walls, with fires, lamps and two suns on either side of them.
#[allow(clippy::too_many_lines, reason = "one scene as text")]
fn walls() -> String {
    let fires: String = (0..12)
        .map(|i| {
            let (x, y) = (f64::from(i % 4) - 1.5, f64::from(i / 4) - 1.0);
            format!(
                r#"
                [[volume]]
                shape = "sphere"
                radius = {}
                translate = [{x}, {y}, {}]
                density = {{ scale = 2.0 }}
                albedo = 0.3
                emission = {{ mode = "source", le = [3.0, 2.0, 1.0] }}
                "#,
                0.06 + 0.01 * f64::from(i % 3),
                -0.3 + 0.15 * f64::from(i % 5),
            )
        })
        .collect();
    let lamps: String = (0..8)
        .map(|i| {
            let (x, y) = (f64::from(i) / 2.0 - 1.75, if i % 2 == 0 { 1.4 } else { -1.4 });
            let kind = match i % 3 {
                0 => "type = \"sphere\"\nradius = 0.05\nradiance = [1, 2, 3]\ncenter",
                1 => "type = \"sphere\"\nradius = 0.1\nradiance = 0.5\nvisible = false\ncenter",
                _ => "type = \"quad\"\nhalf_u = [0.1, 0, 0]\nhalf_v = [0, 0, 0.1]\nradiance = 1\ncenter",
            };
            format!("[[light]]\n{kind} = [{x}, {y}, 0.3]\n")
        })
        .collect();
    let walls: String = [-1.0, 0.0, 1.0]
        .map(|x| {
            format!(
                r#"
                [[surface]]
                shape = "box"
                center = [{x}, 0, 0]
                half_size = [0.05, 1.6, 0.6]
                material = {{ type = "diffuse", reflectance = 0.5 }}
                "#
            )
        })
        .concat();
    format!(
        r#"
        [camera]
        position = [0.4, -4, 2]
        target = [0.2, 0, 0]
        fov_x = 30
        [path]
        max_scatters = 1
        [[volume]]
        shape = "noise"
        half_size = [2.2, 1.8, 0.9]
        frequency = 1.5
        contrast = 2.0
        density = {{ scale = 0.4 }}
        albedo = 0.9
        phase = {{ g = 0.5 }}
        [[light]]
        type = "sun"
        direction = [1, 0.3, -1]
        irradiance = 0.02
        angle = 4
        [[light]]
        type = "sun"
        direction = [-1, 0, -0.2]
        irradiance = 0.03
        {fires}{lamps}{walls}"#
    )
}

fn by(light_selection: LightSelection) -> Strategy {
    let advanced = Advanced { light_selection, probe_count: 1000, ..common::asking() };
    Strategy { advanced, ..Strategy::default() }
}

fn scored(text: &str, strategy: Strategy) -> (Scene, Arc<Probes>) {
    let scene = with_strategy(&build(text), strategy);
    let probes = crate::common::probes_of(&scene).unwrap();
    (scene, probes)
}

/// Places in the mist and the way to choose a light there, with the phase function of a vertex.
fn choices(scene: &Scene, probes: &Probes, count: u32) -> Vec<(Receiver, LightChoice)> {
    (0..count)
        .filter_map(|i| {
            let mut rng = PathRng::new(common::seed(), UVec2::new(i, 5), 0);
            let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
            let position = (2.0 * u - Vec3A::ONE) * Vec3A::new(2.0, 1.7, 0.8);
            let normal = (i % 3 == 0).then(|| (u - Vec3A::splat(0.5)).normalize());
            let to = Receiver { position, normal };
            let scores = probes.light_scores(position)?;
            let value = |direction: Vec3A| 1.1 + direction.x;
            Some((
                to,
                scene.lights.choice_by(scores, &to, direct::choice(scene.strategy()).among, value),
            ))
        })
        .collect()
}

/// Picks spread evenly over [0, 1) choose each light as often as its probability says, and all
/// that a light is chosen by says the same of it.
#[test]
fn lights_are_chosen_as_often_as_is_said() {
    const PICKS: u32 = 20_000;
    for nee in [true, false] {
        let (scene, probes) = scored(&walls(), Strategy { nee, ..by(LightSelection::Probes) });
        let count = scene.lights.len(direct::choice(scene.strategy()).among);
        assert_eq!(count, if nee { 22 } else { 10 });
        let choices = choices(&scene, &probes, 60);
        assert!(choices.len() > 40, "{}", choices.len());
        let mut by_name = 0;
        for (to, choice) in &choices {
            by_name += u32::from(matches!(choice.by, By::Shares(_)));
            let mut chosen = vec![0_u32; count];
            for i in 0..PICKS {
                let pick = (f64::from(i) + 0.5) / f64::from(PICKS);
                let Some(found) = scene.lights.choose(to, choice, pick) else { continue };
                chosen[found.index as usize] += 1;
                let said = scene.lights.probability(found.index, to, choice);
                assert!((found.probability - said).abs() <= 1e-5 * said);
            }
            let probabilities: Vec<f64> = (0..count)
                .map(|light| f64::from(scene.lights.probability(light as u32, to, choice)))
                .collect();
            for (light, &p) in probabilities.iter().enumerate() {
                // Chosen by name or by the hierarchy: two stretches of the picks, four ends.
                let share = f64::from(chosen[light]) / f64::from(PICKS);
                assert!((share - p).abs() < 4.0 / f64::from(PICKS), "{light}: {share} for {p}");
            }
            let found: u32 = chosen.iter().sum();
            let sum: f64 = probabilities.iter().sum();
            assert!((sum - f64::from(found) / f64::from(PICKS)).abs() < 1e-3, "{sum}");
            assert!(to.normal.is_some() || (sum - 1.0).abs() < 1e-5, "{sum}");
        }
        assert_eq!(by_name as usize, choices.len());
    }
}

/// A light that the hierarchy would ever choose may be chosen, however dark the probes think it.
#[test]
fn no_light_is_lost() {
    let (scene, probes) = scored(&walls(), by(LightSelection::Probes));
    let hierarchy = direct::choice(scene.strategy());
    let mut compared = 0;
    for (to, choice) in choices(&scene, &probes, 200) {
        for light in 0..scene.lights.len(LightGroup::All) as u32 {
            let [there, here] =
                [hierarchy, choice].map(|c| scene.lights.probability(light, &to, &c));
            assert!(here >= 0.29 * there, "{light}: {here} of {there}");
            compared += u32::from(there > 0.0);
        }
    }
    assert!(compared > 2000);
}

/// Between two walls, what is chosen is what is seen from there.
#[test]
fn hidden_lights_are_rarely_chosen() {
    let (scene, probes) = scored(&walls(), by(LightSelection::Probes));
    let hierarchy = direct::choice(scene.strategy());
    let instances = scene.world.instances();
    let mut shares = [0.0; 2];
    for y in [-0.9, -0.6, -0.1, 0.4, 0.8] {
        let to = Receiver { position: Vec3A::new(0.6, y, -0.2), normal: None };
        let scores = probes.light_scores(to.position).unwrap();
        let choice = scene.lights.choice_by(scores, &to, LightGroup::All, |_| 1.0);
        for &fire in scene.world.emissive() {
            let x = instances[fire as usize].emission_bounds().center().x;
            let hidden = !(0.0..1.0).contains(&x);
            for (share, choice) in shares.iter_mut().zip([&hierarchy, &choice]) {
                let p = scene.lights.probability_of_volume(fire, &to, choice);
                *share += if hidden { p / 5.0 } else { 0.0 };
            }
        }
    }
    assert!(shares[1] < 0.5 * shares[0] && shares[0] > 0.1, "{shares:?}");
}

/// Mist, surfaces inside and outside of it, with and without looks at fire, by lines and by points.
/// Points are looked at from outside of the fires alone, which neither scatter nor stand in the
/// mist then: one point of their glow has infinite variance from within.
#[test]
fn whichever_way_lights_are_chosen_there_is_one_picture() {
    let scene = build(&walls());
    let apart = walls().replace("albedo = 0.3", "albedo = 0.0").replace(
        "half_size = [2.2, 1.8, 0.9]",
        "half_size = [2.2, 1.8, 0.2]\ntranslate = [0, 0, 0.65]",
    );
    let apart = build(&apart);
    let lit = |sample: &PathSample| -> Rgb { sample.direct + sample.indirect };
    let [standing, apart] = [scene, apart].map(|scene| {
        let hierarchy = with_strategy(&scene, by(LightSelection::Hierarchy));
        let reference = measure_to(&hierarchy, 1_500_000, common::POWER, lit);
        (scene, Expected::measured(&reference))
    });
    let probes = by(LightSelection::Probes);
    let mut point = probes;
    point.advanced.nee_evaluation = NeeEvaluation::Point;
    // Each light gets one look in twenty-two, however near: the same error takes ten times as many
    // paths.
    let mut uniform = Verdicts::of_power(2.5 * common::POWER);
    let strategy = by(LightSelection::Uniform);
    let scene = with_strategy(&standing.0, strategy);
    uniform.hold_part(&full_name(&strategy), &scene, 2_000_000, &standing.1, lit);
    uniform.finish();
    // Both what is held and what it is held against have the usual error.
    let mut verdicts = Verdicts::of_power(std::f64::consts::SQRT_2 * common::POWER);
    for ((scene, expected), strategy, paths) in [
        (&standing, probes, 2_000_000),
        (&apart, point, 2_000_000),
        (&standing, Strategy { probe_mis: false, ..probes }, 4_000_000),
        (&standing, Strategy { emission_ratio_tracking: false, ..probes }, 2_000_000),
    ] {
        let scene = with_strategy(scene, strategy);
        verdicts.hold_part(&full_name(&strategy), &scene, paths, expected, lit);
    }
    verdicts.finish();
}

/// Scores do not ask for guides, and where there is nothing to choose there are none.
#[test]
fn scores_come_where_lights_are_chosen_by_them() {
    let scores = |strategy: Strategy| {
        let scene = with_strategy(&build(&walls()), strategy);
        crate::common::probes_of(&scene)
            .is_some_and(|probes| probes.light_scores(Vec3A::new(0.5, 0.0, 0.0)).is_some())
    };
    let probes = by(LightSelection::Probes);
    assert!(scores(probes));
    assert!(scores(Strategy { probe_mis: false, ..probes }));
    assert!(!scores(by(LightSelection::Hierarchy)));
}
