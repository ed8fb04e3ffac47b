//! Scenes whose radiance has a closed form or a quadrature.

use crate::common::{
    Expected, Verdicts, boost_modes, build, few_guides, full_name, half_of_strategies, measure,
    name, with_strategy,
};
use flambeau::{
    math::Rgb,
    transport::{
        PathSample,
        strategy::{Advanced, BoostMode, Distance, Strategy},
    },
};

/// A camera at z = −1 looking along +z at what lies above z = 0.
const UPWARD: &str = r#"
    [camera]
    position = [0, 0, -1]
    target = [0, 0, 0]
    up = [0, 1, 0]
    fov_x = 0.01
"#;

/// Holds the first channels against known values in every combination of the toggles. Nothing here
/// both glows and scatters, so that fire is never looked at, and once with that toggle on is enough.
fn in_every_combination(
    verdicts: &mut Verdicts,
    label: &str,
    text: &str,
    most: u32,
    expected: &[f64],
) {
    let scene = build(text);
    for strategy in half_of_strategies().into_iter().filter(|strategy| strategy.nee) {
        let label = format!("{label} {}", name(&strategy));
        verdicts.hold(&label, &with_strategy(&scene, strategy), most, &Expected::known(expected));
    }
}

/// σ = 0.2 + 0.3 t over length 3: τ = 0.6 + 1.35 = 1.95, T = e^−1.95, and L = 1 − T for L_e = 1.
#[test]
fn linear_ramp() {
    let ramp = r#"
        [[volume]]
        shape = "ramp"
        half_size = [0.5, 0.5, 1.5]
        translate = [0, 0, 1.5]
        axis = "z"
        kind = "linear"
        a = 0.2
        b = 0.3
        density = { scale = 1.0 }
        albedo = 0.0
    "#;
    let mut verdicts = Verdicts::default();
    let transmitted = format!("{UPWARD}[environment]\nradiance = 1.0\n{ramp}");
    in_every_combination(&mut verdicts, "T", &transmitted, 400_000, &[0.142_274]);
    let glowing = format!("{UPWARD}{ramp}emission = {{ mode = \"source\", le = 1.0 }}");
    in_every_combination(&mut verdicts, "L", &glowing, 40_000, &[0.857_726]);
    verdicts.finish();
}

/// σ = 2 e^(−t/0.5) over length 2: τ = 1 − e^−4.
#[test]
fn exponential_ramp() {
    let text = format!(
        r#"{UPWARD}
        [environment]
        radiance = 1.0
        [[volume]]
        shape = "ramp"
        half_size = [0.5, 0.5, 1]
        translate = [0, 0, 1]
        axis = "z"
        kind = "exponential"
        a = 2.0
        h = 0.5
        density = {{ scale = 1.0 }}
        albedo = 0.0
        "#
    );
    let expected = (-(1.0 - (-4.0_f64).exp())).exp();
    let mut verdicts = Verdicts::default();
    in_every_combination(&mut verdicts, "T", &text, 200_000, &[expected]);
    verdicts.finish();
}

/// Emission 1 + 0.5 t under an extinction of 0.8 over length 2, as two volumes that overlap:
/// ∫₀² (1 + 0.5 t) e^(−0.8 t) dt = 1.368777.
#[test]
fn overlapping_emission_and_absorption() {
    let text = format!(
        r#"{UPWARD}
        [[volume]]
        shape = "box"
        half_size = [0.5, 0.5, 1]
        translate = [0, 0, 1]
        density = {{ scale = 0.8 }}
        albedo = 0.0
        [[volume]]
        shape = "ramp"
        half_size = [0.5, 0.5, 1]
        translate = [0, 0, 1]
        axis = "z"
        a = 1.0
        b = 0.5
        density = {{ scale = 0.0 }}
        emission = {{ mode = "grid", scale = 1.0 }}
        "#
    );
    let mut verdicts = Verdicts::default();
    in_every_combination(&mut verdicts, "L", &text, 1_000_000, &[1.368_777]);
    verdicts.finish();
}

/// Fire without soot: emission j over length d without any extinction is j·d.
#[test]
fn emission_without_extinction() {
    let mut verdicts = Verdicts::default();
    let uniform = format!(
        r#"{UPWARD}
        [[volume]]
        shape = "box"
        half_size = [0.5, 0.5, 2]
        translate = [0, 0, 2]
        density = {{ scale = 0.0 }}
        emission = {{ mode = "constant", value = [2.0, 0.5, 0.0] }}
        "#
    );
    // Without ratio tracking one path in five or so finds anything at all.
    in_every_combination(&mut verdicts, "uniform", &uniform, 2_000_000, &[8.0, 2.0]);
    let varying = format!(
        r#"{UPWARD}
        [[volume]]
        shape = "ramp"
        half_size = [0.5, 0.5, 2]
        translate = [0, 0, 2]
        axis = "z"
        a = 0.5
        b = 1.0
        density = {{ scale = 0.0 }}
        emission = {{ mode = "grid", scale = 0.5 }}
        "#
    );
    let expected = 0.5 * (0.5 * 4.0 + 8.0);
    in_every_combination(&mut verdicts, "ramp", &varying, 3_000_000, &[expected]);
    verdicts.finish();
}

/// The optimal majorant depends on the walk's own weight and on what lies ahead, and changes
/// nothing but the noise: at as many looks as it finds, at half and at four times as many.
#[test]
fn optimal_majorant() {
    let ramp = |a: f64, b: f64, z: f64, rest: &str| {
        format!(
            r#"
            [[volume]]
            shape = "ramp"
            half_size = [0.5, 0.5, 1]
            translate = [0, 0, {z}]
            axis = "z"
            a = {a}
            b = {b}
            albedo = 0.0
            {rest}
            "#
        )
    };
    let isothermal = "density = { scale = 1.0 }\nemission = { mode = \"source\", le = 1.0 }";
    let fire = ramp(
        0.5,
        1.0,
        3.0,
        "density = { scale = 0.0 }\nemission = { mode = \"grid\", scale = 1.0 }",
    );
    let smoke = ramp(0.5, 1.0, 1.0, "density = { scale = [0.5, 1.0, 1.5] }");
    let cases = [
        ("thin", ramp(0.2, 0.3, 1.0, isothermal), [1.0 - (-1.0_f64).exp(); 3]),
        ("thick", ramp(4.0, 12.0, 1.0, isothermal), [1.0; 3]),
        ("without extinction", fire.clone(), [3.0; 3]),
        ("behind colored smoke", smoke + &fire, [1.5, 3.0, 4.5_f64].map(|tau| 3.0 * (-tau).exp())),
    ];
    let mut verdicts = Verdicts::default();
    for (case, volumes, expected) in cases {
        let scene = build(&format!("{UPWARD}{volumes}"));
        for boost_amount in [16.0, 32.0, 128.0] {
            let advanced =
                Advanced { boost_mode: BoostMode::Optimal, boost_amount, ..Advanced::default() };
            let strategy = Strategy { advanced, ..Strategy::default() };
            let label = format!("{case}, amount {boost_amount}");
            let scene = with_strategy(&scene, strategy);
            verdicts.hold(&label, &scene, 300_000, &Expected::known(&expected));
        }
    }
    verdicts.finish();
}

/// A ball seen through its middle: L = L_e (1 − e^(−2κR)), with sharp borders.
#[test]
fn absorbing_ball() {
    let text = r#"
        [camera]
        position = [0, -5, 0]
        target = [0, 0, 0]
        fov_x = 0.01
        [[volume]]
        shape = "sphere"
        radius = 1.5
        density = { scale = 0.4 }
        albedo = 0.0
        emission = { mode = "source", le = [3.0, 1.0, 0.5] }
    "#;
    let mut verdicts = Verdicts::default();
    let expected = [3.0, 1.0, 0.5].map(|le| -le * (-1.2_f64).exp_m1());
    in_every_combination(&mut verdicts, "ball", text, 200_000, &expected);
    verdicts.finish();
}

/// Density per channel: each channel has its own transmittance, grey or not.
#[test]
fn chromatic_slab() {
    let text = format!(
        r#"{UPWARD}
        [environment]
        radiance = 1.0
        [[volume]]
        shape = "ramp"
        half_size = [0.5, 0.5, 0.5]
        translate = [0, 0, 0.5]
        axis = "z"
        a = 0.5
        b = 1.0
        density = {{ scale = [0.5, 1.0, 1.5] }}
        albedo = 0.0
        "#
    );
    let mut verdicts = Verdicts::default();
    let expected = [0.5, 1.0, 1.5_f64].map(|tau| (-tau).exp());
    in_every_combination(&mut verdicts, "T", &text, 400_000, &expected);
    verdicts.finish();
}

/// The same slab glows isothermally: each channel L_e (1 − T) of its own, in every boost mode.
#[test]
fn glowing_chromatic_slab() {
    let scene = build(&format!(
        r#"{UPWARD}
        [[volume]]
        shape = "ramp"
        half_size = [0.5, 0.5, 0.5]
        translate = [0, 0, 0.5]
        axis = "z"
        a = 0.5
        b = 1.0
        density = {{ scale = [0.5, 1.0, 1.5] }}
        albedo = 0.0
        emission = {{ mode = "source", le = [1.0, 2.0, 0.5] }}
        "#
    ));
    let mut verdicts = Verdicts::default();
    for strategy in half_of_strategies().into_iter().filter(|s| s.nee).chain(boost_modes()) {
        let expected = [(0.5, 1.0), (1.0, 2.0), (1.5_f64, 0.5)];
        let expected = Expected::known(&expected.map(|(tau, le)| -le * (-tau).exp_m1()));
        let scene = with_strategy(&scene, strategy);
        verdicts.hold(&full_name(&strategy), &scene, 300_000, &expected);
    }
    verdicts.finish();
}

/// Single scattering of a point light in fog (Sun et al. 2005): extinction β, albedo 1, the light
/// at distance d under an angle to the view, of length `length`.
fn airlight(beta: f64, distance: f64, degrees: f64, length: f64, g: f64) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let (x, z) = (distance * sin, distance * cos);
    format!(
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
        density = {{ scale = {beta} }}
        albedo = 1.0
        phase = {{ g = {g} }}
        [[light]]
        type = "point"
        position = [{x}, 0, {z}]
        intensity = 1.0
        [[surface]]
        shape = "plane"
        point = [0, 0, {length}]
        normal = [0, 0, 1]
        material = {{ type = "black" }}
        "#
    )
}

/// β, distance, degrees and length; g; radiance.
const AIRLIGHTS: [([f64; 4], f64, f64); 5] = [
    ([0.1, 5.0, 20.0, 20.0], 0.0, 0.005_838_609_954),
    ([0.1, 5.0, 20.0, 20.0], 0.8, 0.004_566_362),
    ([0.1, 5.0, 20.0, 20.0], -0.5, 0.005_534_000),
    ([1.0, 2.0, 90.0, 3.0], 0.0, 0.001_823_829_325),
    ([1.0, 2.0, 90.0, 3.0], 0.8, 0.000_234_263),
];

#[test]
fn airlight_of_a_point_light() {
    let mut verdicts = Verdicts::default();
    for (case, g, expected) in AIRLIGHTS {
        let [beta, distance, degrees, length] = case;
        let text = airlight(beta, distance, degrees, length, g);
        let label = format!("β {beta}, g {g},");
        in_every_combination(&mut verdicts, &label, &text, 400_000, &[expected]);
    }
    verdicts.finish();
}

/// The same by every guide; those of later vertices have nothing to say here. The lines of probes
/// know too little of a lamp beside the ray, equal angles know all of it.
#[test]
fn airlight_by_every_guide() {
    let mut verdicts = Verdicts::default();
    for (case, g, expected) in AIRLIGHTS {
        let [beta, distance, degrees, length] = case;
        let scene = build(&airlight(beta, distance, degrees, length, g));
        for strategy in few_guides() {
            let Advanced { distance, equiangular, .. } = strategy.advanced;
            let alone = distance == Distance::Probes && !equiangular;
            let paths = if alone { 900_000 } else { 100_000 };
            let (scene, expected) = (with_strategy(&scene, strategy), Expected::known(&[expected]));
            verdicts.hold(&full_name(&strategy), &scene, 2 * paths, &expected);
        }
    }
    verdicts.finish();
}

/// In an isothermal volume that does not scatter, L = L_e · alpha path by path in the mean
/// (identity 3): emission formed after interpolation, opacity from the same walk.
fn isothermal_radiance_is_alpha(volume: &str, camera: &str) {
    let text = format!(
        r#"
        [camera]
        {camera}
        [[volume]]
        {volume}
        albedo = 0.0
        emission = {{ mode = "source", le = [2.0, 1.0, 0.5] }}
        "#
    );
    let scene = build(&text);
    let le = Rgb::new(2.0, 1.0, 0.5);
    // What differs by nothing is held to the usual share of the radiance.
    let radiance = Rgb::from(measure(&scene, 20_000).mean.map(|mean| mean as f32));
    let expected = Expected::known(&radiance.to_array().map(f64::from));
    let mut verdicts = Verdicts::default();
    for strategy in half_of_strategies().into_iter().filter(|s| s.nee).chain(boost_modes()) {
        let scene = with_strategy(&scene, strategy);
        let difference = |sample: &PathSample| sample.emission - sample.alpha * le + radiance;
        verdicts.hold_part(&full_name(&strategy), &scene, 600_000, &expected, difference);
    }
    verdicts.finish();
}

#[test]
fn isothermal_noise() {
    let volume = r#"
        shape = "noise"
        half_size = 1.0
        frequency = 2.0
        contrast = 3.0
        rotate = [20, 30, 40]
        scale = [1.0, 0.8, 1.2]
        density = { scale = 2.0 }
    "#;
    let camera = "position = [0, -5, 0.5]\ntarget = [0, 0, 0]\nfov_x = 30";
    isothermal_radiance_is_alpha(volume, camera);
}

#[test]
fn isothermal_volume_file() {
    let volume = r#"
        file = "../assets/plume.vdb"
        rotate = [0, 10, 70]
        density = { scale = 6.0 }
    "#;
    let camera = "position = [0, -7, 1.5]\ntarget = [0, 0, 1.5]\nfov_x = 30";
    isothermal_radiance_is_alpha(volume, camera);
}
