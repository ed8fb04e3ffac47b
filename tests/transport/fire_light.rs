//! Fire as a light: what it sends to floors and fog, against closed forms and quadratures.
//!
//! In fire whose parts all have the same L_e and that does not scatter, a ray of optical distance
//! τ brings L_e (1 − e^−τ), however the fire is made up. An integral over the directions is all
//! that is left.

use std::f64::consts::{PI, TAU};

use crate::common::{
    Expected, Verdicts, build, every_nth, every_setting, full_name, with_strategy,
};
use flambeau::transport::{
    Scene,
    strategy::{Advanced, LightSelection, NeeEvaluation, Preset, Strategy},
};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

/// Looks at fire: what they bring back, how they choose it, under every strategy and under none
/// of those for emission; and no look at all.
fn looks() -> Vec<Strategy> {
    let mut looks = vec![Strategy { nee: false, ..Strategy::default() }];
    for preset in [Preset::Full, Preset::Baseline] {
        for nee_evaluation in [NeeEvaluation::Line, NeeEvaluation::Point] {
            for light_selection in [LightSelection::Hierarchy, LightSelection::Uniform] {
                let advanced = Advanced { nee_evaluation, light_selection, ..Advanced::default() };
                looks.push(Strategy { nee: true, advanced, ..preset.strategy() });
            }
        }
    }
    looks
}

/// Those that a receiver on the border of the fire allows.
fn looks_along_lines() -> Vec<Strategy> {
    let line = |look: &Strategy| look.advanced.nee_evaluation == NeeEvaluation::Line;
    looks().into_iter().filter(line).collect()
}

/// Holds the first vertex's light against a value per channel, in each of `settings`; with three
/// times the paths where fire is found by chance only.
fn check_direct(
    verdicts: &mut Verdicts,
    label: &str,
    scene: &Scene,
    settings: &[Strategy],
    paths: u32,
    expected: [f64; 3],
) {
    for setting in settings {
        let paths = if setting.nee { 2 * paths } else { 6 * paths };
        let label = format!("{label}, {}", full_name(setting));
        let (scene, expected) = (with_strategy(scene, *setting), Expected::known(&expected));
        verdicts.hold_part(&label, &scene, paths, &expected, |sample| sample.direct);
    }
}

/// ∫ L cos θ dω / π over the hemisphere around z, for L(ω).
fn reflected(radiance: impl Fn(DVec3) -> f64 + Sync) -> f64 {
    const STEPS: u32 = 1200;
    let sum: f64 = (0..STEPS)
        .into_par_iter()
        .map(|i| {
            let sin2 = (f64::from(i) + 0.5) / f64::from(STEPS);
            let (sin, cos) = (sin2.sqrt(), (1.0 - sin2).sqrt());
            let along = |j: u32| {
                let (y, x) = (TAU * (f64::from(j) + 0.5) / f64::from(2 * STEPS)).sin_cos();
                radiance(DVec3::new(sin * x, sin * y, cos))
            };
            (0..2 * STEPS).map(along).sum::<f64>()
        })
        .sum();
    sum / (2.0 * f64::from(STEPS) * f64::from(STEPS))
}

/// The part of a ray of t > 0 inside a box.
fn through_box(origin: DVec3, direction: DVec3, low: DVec3, high: DVec3) -> Option<(f64, f64)> {
    let (a, b) = ((low - origin) / direction, (high - origin) / direction);
    let (t0, t1) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
    (t0 < t1).then_some((t0, t1))
}

/// A floor at z = 0 of reflectance 1, seen at the point (x, y) from beside it.
fn floor_at(x: f64, y: f64) -> String {
    format!(
        r#"
        [camera]
        position = [{x}, {}, 0.4]
        target = [{x}, {y}, 0]
        fov_x = 0.01
        [path]
        max_scatters = 1
        [[surface]]
        shape = "plane"
        point = [0, 0, 0]
        normal = [0, 0, 1]
        material = {{ type = "diffuse", reflectance = 1.0 }}
        "#,
        y - 2.0
    )
}

/// Normal irradiance of a glowing, absorbing ball; another one, brighter, is hidden behind a wall,
/// where looks at it are in vain but counted in the densities.
#[test]
fn irradiance_of_a_glowing_ball() {
    let mut verdicts = Verdicts::default();
    for (distance, expected) in [(2.0, 0.097_267_781), (5.0, 0.015_562_845)] {
        let scene = build(&format!(
            r#"{}
            [[volume]]
            shape = "sphere"
            radius = 1.0
            translate = [0, 0, {distance}]
            density = {{ scale = 0.1 }}
            albedo = 0.0
            emission = {{ mode = "source", le = 1.0 }}
            [[volume]]
            shape = "sphere"
            radius = 0.5
            translate = [4, 0, 2]
            density = {{ scale = 0.2 }}
            albedo = 0.0
            emission = {{ mode = "source", le = 5.0 }}
            [[surface]]
            shape = "quad"
            center = [1.8, 0, 1.5]
            half_u = [0, 3, 0]
            half_v = [0, 0, 1.5]
            material = {{ type = "black" }}
            "#,
            floor_at(0.0, 0.0)
        ));
        let label = format!("irradiance at {distance}");
        check_direct(&mut verdicts, &label, &scene, &looks(), 250_000, [expected / PI; 3]);
    }
    verdicts.finish();
}

/// Its fluence, scattered once by a needle of fog along the view: 1 − 1/e of the paths scatter in
/// it, and sideways it is clear.
#[test]
fn fluence_of_a_glowing_ball() {
    let mut verdicts = Verdicts::default();
    for (distance, fluence) in [(2.0, 0.102_811_08), (5.0, 0.015_691_105_1)] {
        let scene = build(&format!(
            r#"
            [camera]
            position = [0, 0, -0.01]
            target = [0, 0, 0]
            up = [0, 1, 0]
            fov_x = 0.01
            [path]
            max_scatters = 1
            [[volume]]
            shape = "box"
            half_size = [1e-5, 1e-5, 0.01]
            density = {{ scale = 50.0 }}
            albedo = 1.0
            [[volume]]
            shape = "sphere"
            radius = 1.0
            translate = [{distance}, 0, 0]
            density = {{ scale = 0.1 }}
            albedo = 0.0
            emission = {{ mode = "source", le = 1.0 }}
            "#,
        ));
        let expected = (1.0 - (-1.0_f64).exp()) * fluence / (4.0 * PI);
        let label = format!("fluence at {distance}");
        // From afar one path in a hundred would find the ball by chance.
        let settings: Vec<_> =
            looks().into_iter().filter(|look| look.nee || distance < 3.0).collect();
        check_direct(&mut verdicts, &label, &scene, &settings, 300_000, [expected; 3]);
    }
    verdicts.finish();
}

/// A ramp of density 0.5 + 0.5 (z + 1) in its own space, placed somehow, glowing isothermally.
struct Ramp {
    place: &'static str,
    density: [f64; 3],
}

/// Half size of a [`Ramp`].
const HALF: DVec3 = DVec3::new(0.6, 0.4, 1.0);
/// L_e of a [`Ramp`].
const LE: [f64; 3] = [2.0, 1.0, 0.5];

impl Ramp {
    fn text(&self) -> String {
        format!(
            r#"
            [[volume]]
            shape = "ramp"
            half_size = [0.6, 0.4, 1.0]
            {}
            axis = "z"
            a = 0.5
            b = 0.5
            density = {{ scale = {:?} }}
            albedo = 0.0
            emission = {{ mode = "source", le = {LE:?} }}
            "#,
            self.place, self.density
        )
    }
}

/// Light at the middle of the floor from ramps that may overlap.
fn under_ramps(label: &str, ramps: &[Ramp], settings: &[Strategy], paths: u32) {
    let volumes: String = ramps.iter().map(Ramp::text).collect();
    let scene = build(&format!("{}{volumes}", floor_at(0.0, 0.0)));
    let places: Vec<DAffine3> = scene.world.instances().iter().map(local_from_world).collect();
    let origin = DVec3::ZERO;
    let expected = [0, 1, 2].map(|channel| {
        LE[channel]
            * reflected(|direction| {
                let depth = |(ramp, place): (&Ramp, &DAffine3)| {
                    let local = place.transform_point3(origin);
                    let along = place.transform_vector3(direction);
                    let chord = through_box(local, along, -HALF, HALF);
                    let (t0, t1) = chord.unwrap_or_default();
                    let middle = local.z + 0.5 * (t0 + t1) * along.z;
                    ramp.density[channel] * (0.5 + 0.5 * (middle + 1.0)) * (t1 - t0)
                };
                -f64::exp_m1(-ramps.iter().zip(&places).map(depth).sum::<f64>())
            })
    });
    let mut verdicts = Verdicts::default();
    check_direct(&mut verdicts, label, &scene, settings, paths, expected);
    verdicts.finish();
}

fn local_from_world(instance: &flambeau::volume::world::Instance) -> DAffine3 {
    let place = instance.world_from_local();
    DAffine3 { matrix3: place.matrix3.as_dmat3(), translation: place.translation.as_dvec3() }
        .inverse()
}

/// Turned, stretched and mirrored placements of one ramp, chromatic.
#[test]
fn placed_ramps_light_a_floor() {
    let density = [0.3, 1.0, 3.0];
    let ramps = [
        Ramp {
            place: "rotate = [20, 50, -30]\nscale = [1, 0.5, 1.5]\ntranslate = [0.5, 0, 2]",
            density,
        },
        Ramp {
            place: "rotate = [-70, 10, 40]\nscale = [0.7, -1, 0.8]\ntranslate = [-2, 0.5, 1.5]",
            density,
        },
    ];
    under_ramps("placed ramps", &ramps, &looks(), 130_000);
}

/// Of two overlapping fires one has a thousandth of the other's power. Only the weak one is green,
/// so that it cannot hide in the strong one's light. With ratio tracking: one path in a thousand
/// would be absorbed by the weak one.
#[test]
fn a_weak_fire_within_a_strong_one() {
    let ramps = [
        Ramp { place: "translate = [0, 0, 2]", density: [2.0, 0.0, 1.0] },
        Ramp {
            place: "rotate = [0, 40, 0]\ntranslate = [0.5, 0.2, 2.2]\nscale = 1.2",
            density: [0.0, 1e-3, 1e-3],
        },
    ];
    // By power a point of the weak one is drawn once in a thousand looks.
    let evenly = |look: &Strategy| {
        let advanced = &look.advanced;
        advanced.nee_evaluation == NeeEvaluation::Line
            || advanced.light_selection == LightSelection::Uniform
    };
    let settings: Vec<_> =
        looks().into_iter().filter(|look| look.emission_ratio_tracking && evenly(look)).collect();
    under_ramps("weak in strong", &ramps, &settings, 200_000);
}

/// A fire that stands on the floor, from beside it, where its nearest part is at the height of the
/// eye of the floor, and from below, where it begins at the very point.
#[test]
fn fire_that_touches_the_floor() {
    let half = DVec3::new(0.5, 0.5, 1.0);
    let center = DVec3::Z;
    let mut verdicts = Verdicts::default();
    for (x, settings, paths) in [(0.8, looks(), 200_000), (0.2, looks_along_lines(), 500_000)] {
        let scene = build(&format!(
            r#"{}
            [[volume]]
            shape = "box"
            half_size = [0.5, 0.5, 1.0]
            translate = [0, 0, 1]
            density = {{ scale = [0.2, 1.0, 4.0] }}
            albedo = 0.0
            emission = {{ mode = "source", le = 1.0 }}
            "#,
            floor_at(x, 0.0)
        ));
        let eye = DVec3::new(x, -2.0, 0.4);
        let point = DVec3::new(x, 0.0, 0.0);
        let towards = (point - eye).normalize();
        let expected = [0.2, 1.0, 4.0].map(|kappa| {
            let depth = |origin: DVec3, direction: DVec3, end: f64| {
                let chord = through_box(origin, direction, center - half, center + half);
                chord.map_or(0.0, |(t0, t1)| kappa * (t1.min(end) - t0).max(0.0))
            };
            let arriving = reflected(|direction| -(-depth(point, direction, 1e9)).exp_m1());
            (-depth(eye, towards, (point - eye).length())).exp() * arriving
        });
        let label = format!("on the floor at {x}");
        check_direct(&mut verdicts, &label, &scene, &settings, paths, expected);
    }
    verdicts.finish();
}

/// A glowing ball inside a ball that absorbs and ends above the floor: every look passes from one
/// into the other and out of both.
#[test]
fn looks_pass_an_absorber_and_leave_it() {
    let scene = build(&format!(
        r#"{}
        [[volume]]
        shape = "sphere"
        radius = 0.5
        translate = [0, 0, 2.5]
        density = {{ scale = 0.0 }}
        emission = {{ mode = "constant", value = 3.0 }}
        [[volume]]
        shape = "sphere"
        radius = 1.5
        translate = [0, 0, 2.5]
        density = {{ scale = [0.0, 0.5, 1.0] }}
        albedo = 0.0
        "#,
        floor_at(0.0, 0.0)
    ));
    let expected = [0.0, 0.5, 1.0].map(|kappa: f64| {
        reflected(|direction| {
            let squared = 2.5 * 2.5 * (1.0 - direction.z * direction.z);
            if squared >= 0.25 {
                return 0.0;
            }
            let (inner, outer) = ((0.25 - squared).sqrt(), (2.25 - squared).sqrt());
            if kappa == 0.0 {
                return 6.0 * inner;
            }
            let through = |length: f64| (-kappa * length).exp();
            3.0 / kappa * (through(outer - inner) - through(outer + inner))
        })
    });
    let mut verdicts = Verdicts::default();
    check_direct(&mut verdicts, "in an absorber", &scene, &looks(), 210_000, expected);
    verdicts.finish();
}

/// Inside a sphere of reflectance ρ each bounce lights all of it alike: a clear ball of emission ε
/// and volume V in its middle brings ε V / (π R²) · (ρ + ρ² + ...), up to as many terms as a path
/// may turn.
#[test]
fn a_round_room_lit_by_a_fire() {
    let room = |turns: u32| {
        build(&format!(
            r#"
            [camera]
            position = [1.5, 0, 0]
            target = [3, 0, 0]
            fov_x = 60
            [path]
            max_scatters = {turns}
            [[volume]]
            shape = "sphere"
            radius = 1.0
            density = {{ scale = 0.0 }}
            emission = {{ mode = "constant", value = 2.0 }}
            [[surface]]
            shape = "sphere"
            center = [0, 0, 0]
            radius = 3.0
            material = {{ type = "diffuse", reflectance = 0.5 }}
            "#
        ))
    };
    let unit = 2.0 * (4.0 / 3.0 * PI) / (PI * 9.0);
    let mut verdicts = Verdicts::default();
    for (turns, expected) in [(1, 0.5), (2, 0.75), (0, 1.0)] {
        let scene = room(turns);
        for setting in looks() {
            let paths = if setting.nee { 150_000 } else { 300_000 };
            let label = format!("{turns} turns, {}", full_name(&setting));
            let expected = Expected::known(&[expected * unit]);
            verdicts.hold(&label, &with_strategy(&scene, setting), 2 * paths, &expected);
        }
    }
    verdicts.finish();
}

/// Fire without soot above a floor, of emission ε = 0.5 + 0.5 z'.
#[test]
fn fire_without_soot_lights_a_floor() {
    let (half, center) = (DVec3::new(2.0, 2.0, 1.0), DVec3::new(0.0, 0.0, 1.5));
    let scene = build(&format!(
        r#"{}
        [[volume]]
        shape = "ramp"
        half_size = [2.0, 2.0, 1.0]
        translate = [0, 0, 1.5]
        axis = "z"
        a = 0.5
        b = 0.5
        density = {{ scale = 0.0 }}
        emission = {{ mode = "grid", scale = 1.0, color = [1.0, 0.5, 2.0] }}
        "#,
        floor_at(0.0, 0.0)
    ));
    let expected = reflected(|direction| {
        let chord = through_box(DVec3::ZERO, direction, center - half, center + half);
        let (t0, t1) = chord.unwrap_or_default();
        (0.5 + 0.5 * (0.5 * (t0 + t1) * direction.z - 0.5)) * (t1 - t0)
    });
    let expected = [1.0, 0.5, 2.0].map(|color| color * expected);
    // Unboosted, one look in ten or so finds a collision to read the emission at.
    let mut verdicts = Verdicts::of_power(0.02);
    for setting in every_nth(3, every_setting()) {
        let paths = if setting.majorant_boost { 80_000 } else { 200_000 };
        check_direct(&mut verdicts, "no soot", &scene, &[setting], paths, expected);
    }
    verdicts.finish();
}
