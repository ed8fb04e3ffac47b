//! Scenes with several fires and other lights, files placed freely and shared: looks at the fire
//! or none, and whichever way the light is chosen, one picture.

use crate::common::{CLOSELY, Expected, REFERENCED, Verdicts, build, measure_to, with_strategy};
use flambeau::transport::{
    PathSample, Scene,
    strategy::{Advanced, BoostMode, LightSelection, NeeEvaluation, Strategy},
};

/// No look at all, under every other strategy.
fn blind() -> Strategy {
    Strategy { nee: false, ..Strategy::default() }
}

/// Looks at the fire in every way, under two of the walks.
fn looks() -> Vec<(String, Strategy)> {
    let mut looks = Vec::new();
    for nee_evaluation in [NeeEvaluation::Line, NeeEvaluation::Point] {
        for light_selection in [LightSelection::Hierarchy, LightSelection::Uniform] {
            for boost_mode in [BoostMode::Stratified, BoostMode::Clamped] {
                let advanced =
                    Advanced { nee_evaluation, light_selection, boost_mode, ..Advanced::default() };
                let name = format!("{nee_evaluation:?} {light_selection:?} {boost_mode:?}");
                looks.push((name, Strategy { advanced, ..Strategy::default() }));
            }
        }
    }
    looks
}

fn along_lines() -> Vec<(String, Strategy)> {
    let line = |look: &(String, Strategy)| look.1.advanced.nee_evaluation == NeeEvaluation::Line;
    looks().into_iter().filter(line).collect()
}

/// Light that scatters or is reflected: what the camera itself sees of fire and lamps is no matter
/// of looks.
fn lit(sample: &PathSample) -> flambeau::math::Rgb {
    sample.direct + sample.indirect
}

/// Holds the light of `looks` against that without any.
fn agree(scene: &Scene, looks: &[(String, Strategy)], [looked, unlooked]: [u32; 2]) {
    let reference = measure_to(&with_strategy(scene, blind()), 6 * unlooked, CLOSELY, lit);
    let expected = Expected::measured(&reference);
    let mut verdicts = Verdicts::of_power(REFERENCED);
    for (name, look) in looks {
        verdicts.hold_part(name, &with_strategy(scene, *look), 2 * looked, &expected, lit);
    }
    verdicts.finish();
}

const FLOOR: &str = r#"
    [[surface]]
    shape = "plane"
    point = [0, 0, 0]
    normal = [0, 0, 1]
    half_size = 6.0
    material = { type = "diffuse", reflectance = 0.5 }
"#;

fn torch(place: &str) -> String {
    format!(
        r#"
        [[volume]]
        file = "../assets/torch_hd.vdb"
        {place}
        density = {{ scale = 2.0 }}
        albedo = 0.0
        emission = {{ mode = "blackbody", grid = "temperature", kelvin_scale = 1000.0 }}
        "#
    )
}

/// One file thrice, turned, stretched without measure and mirrored, around a spot of floor.
#[test]
fn placed_torches_light_a_floor() {
    let torches = [
        "rotate = [0, 0, 30]\nscale = 0.5\ntranslate = [0, 0.8, 0.3]",
        "rotate = [70, 20, 0]\nscale = [1.2, 0.3, 0.6]\ntranslate = [-1.2, 0, 0.8]",
        "rotate = [-20, 130, 45]\nscale = [0.4, -0.8, 0.5]\ntranslate = [1.0, -0.2, 1.2]",
    ];
    let torches: String = torches.map(torch).concat();
    let camera = r#"
        [camera]
        position = [0, -3, 2.5]
        target = [0, 0, 0]
        fov_x = 25
        [path]
        max_scatters = 1
    "#;
    agree(&build(&format!("{camera}{FLOOR}{torches}")), &looks(), [150_000, 2_700_000]);
}

/// Twenty torches, lamps and a sun: the hierarchy chooses as each light deserves, the other way
/// gives each one chance in twenty-five, and only surfaces are met by chance as well.
#[test]
fn twenty_torches_lamps_and_a_sun() {
    let torches: String = (0..20)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 20.0).sin_cos();
            let (radius, scale) = (1.6 + 0.4 * f64::from(i % 3), 0.3 + 0.1 * f64::from(i % 4));
            let (x, y, z) = (radius * cos, radius * sin, 0.3 + 0.2 * f64::from(i % 2));
            torch(&format!(
                "rotate = [0, {}, {}]\nscale = {scale}\ntranslate = [{x}, {y}, {z}]",
                7 * i,
                36 * i
            ))
        })
        .collect();
    let lights = r#"
        [camera]
        position = [0, -0.5, 5]
        target = [0, 0, 0]
        fov_x = 30
        [path]
        max_scatters = 2
        [[light]]
        type = "sun"
        direction = [-1, 1, -2]
        irradiance = 0.02
        angle = 5
        [[light]]
        type = "sphere"
        center = [0.5, 0.5, 1.5]
        radius = 0.2
        radiance = [0.2, 0.3, 0.5]
        [[light]]
        type = "point"
        position = [-3, 2, 2]
        intensity = [0.1, 0.1, 0.2]
        [[light]]
        type = "quad"
        center = [-0.8, 0.8, 1.0]
        half_u = [0.2, 0, 0]
        half_v = [0, 0.1, 0.1]
        radiance = 0.5
    "#;
    agree(&build(&format!("{lights}{FLOOR}{torches}")), &looks(), [200_000, 1_000_000]);
}

/// Fog without borders that glows itself, which no look can aim at, around a fire that one can,
/// both scattering.
#[test]
fn a_fire_in_fog_that_glows() {
    let text = format!(
        r#"{FLOOR}
        [camera]
        position = [0, -3, 1]
        target = [0, 0, 0.6]
        fov_x = 50
        [[volume]]
        shape = "everywhere"
        density = {{ scale = [0.2, 0.3, 0.4] }}
        albedo = 0.7
        phase = {{ g = 0.4 }}
        emission = {{ mode = "constant", value = [0.02, 0.03, 0.05] }}
        [[volume]]
        shape = "noise"
        half_size = [0.4, 0.4, 0.6]
        translate = [0.3, 0, 0.9]
        frequency = 2.0
        contrast = 2.0
        density = {{ scale = 2.0 }}
        albedo = 0.4
        emission = {{ mode = "source", le = [4.0, 2.0, 1.0] }}
        "#
    );
    agree(&build(&text), &along_lines(), [200_000, 400_000]);
}
