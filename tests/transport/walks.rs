//! Trackers and estimators of transmittance: whichever is chosen, the same means, known in closed
//! form or by quadrature.

use crate::common::{self, Estimate, Expected, Verdicts, build, measure, with_strategy};
use flambeau::{
    math::{PathRng, Ray, Rgb},
    transport::{
        Scene, shadow,
        strategy::{Advanced, NeeEvaluation, Preset, Strategy, Tracker, TransmittanceEstimator},
    },
};
use glam::{DVec3, UVec2, Vec3A};

const ESTIMATORS: [TransmittanceEstimator; 3] = [
    TransmittanceEstimator::Marching,
    TransmittanceEstimator::Residual,
    TransmittanceEstimator::Ratio,
];

/// A tracker with every other setting that it may stand beside, by name.
fn trackers() -> Vec<(String, Strategy)> {
    let with = |strategy: Strategy, tracker| {
        let advanced = Advanced { tracker, ..Advanced::default() };
        (format!("{tracker:?} {}", common::name(&strategy)), Strategy { advanced, ..strategy })
    };
    let emission = Preset::Emission.strategy();
    let decoupled = Strategy { emission_decoupling: true, ..Preset::Baseline.strategy() };
    vec![
        with(emission, Tracker::Decomposition),
        with(emission, Tracker::Spectral),
        with(Preset::Full.strategy(), Tracker::Spectral),
        with(decoupled, Tracker::Spectral),
        with(Preset::Baseline.strategy(), Tracker::Spectral),
    ]
}

/// A slab across z in [0, 1] seen from z = 2 along −z, its density running linearly through it with
/// mean 1: reflectance and transmittance depend on its optical depth alone.
fn slab(density: &str, albedo: &str, more: &str) -> Scene {
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
        density = {{ scale = {density} }}
        albedo = {albedo}
        {more}
        "#
    ))
}

/// A black plane that leaves the hemisphere on one side.
fn plane(z: f64) -> String {
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

/// Isotropic slabs of depth 1 and albedo 0.5, depth 4 and albedo 0.9: R and T as in tests/slabs.rs.
const REFLECTED: [f64; 2] = [0.09912, 0.40814];
const TRANSMITTED: [f64; 2] = [0.44606, 0.12852];

/// Two of them in one, a channel each, for decomposition; and one of them in a channel whose
/// neighbors differ a little. Where they differ much, the weights of spectral tracking grow beyond
/// what a test can measure.
#[test]
fn slabs_channel_by_channel() {
    let mut verdicts = Verdicts::of_power(0.01);
    for (what, z, values) in [("R", -1.0, REFLECTED), ("T", 3.0, TRANSMITTED)] {
        let apart = slab("[1.0, 4.0, 4.0]", "[0.5, 0.9, 0.9]", &plane(z));
        let alike = slab("[1.0, 0.8, 1.2]", "[0.5, 0.6, 0.4]", &plane(z));
        for (name, strategy) in trackers() {
            let (scene, channels) = match strategy.advanced.tracker {
                Tracker::Decomposition => (&apart, 2),
                _ => (&alike, 1),
            };
            let scene = with_strategy(scene, strategy);
            let expected = Expected::known(&values[..channels]);
            verdicts.hold(&format!("{what}, {name}"), &scene, 400_000, &expected);
        }
    }
    verdicts.finish();
}

/// What gets through smoke that only absorbs, exp(−τ), where the scattering walk brings it.
#[test]
fn absorbing_slabs_by_the_scattering_walk() {
    let scene = slab("[0.5, 1.0, 1.5]", "0.0", &plane(3.0));
    let mut verdicts = Verdicts::default();
    let by_it = |(_, strategy): &(_, Strategy)| !strategy.emission_ratio_tracking;
    for (name, strategy) in trackers().into_iter().filter(by_it) {
        let expected = Expected::known(&[0.5, 1.0, 1.5_f64].map(|depth| (-depth).exp()));
        verdicts.hold(&name, &with_strategy(&scene, strategy), 1_000_000, &expected);
    }
    verdicts.finish();
}

/// Two volumes that overlap, of different colors and phase functions, with haze around: `ALBEDO`.
const OVERLAPPING: &str = r#"
    [camera]
    position = [0, -4, 0.5]
    target = [0, 0, 0]
    fov_x = 34
    [[volume]]
    shape = "noise"
    half_size = [1.0, 0.9, 0.8]
    rotate = [0, 0, 20]
    frequency = 1.5
    density = { scale = [1.0, 2.0, 2.5] }
    albedo = ALBEDO
    phase = { g = 0.6 }
    [[volume]]
    shape = "sphere"
    radius = 0.6
    translate = [-0.4, 0.1, -0.2]
    density = { scale = [1.0, 0.7, 0.7] }
    albedo = ALBEDO
    phase = { g = -0.3 }
"#;

/// In a white furnace everything is white.
#[test]
fn furnaces_by_every_tracker() {
    let text = OVERLAPPING.replace("ALBEDO", "1.0") + "[environment]\nradiance = 1.0";
    let scene = build(&text);
    let mut verdicts = Verdicts::default();
    for (name, strategy) in trackers() {
        let expected = Expected::known(&[1.0; 3]);
        verdicts.hold(&name, &with_strategy(&scene, strategy), 200_000, &expected);
    }
    verdicts.finish();
}

/// Lamps around the same, one of them a fire.
fn lit() -> Scene {
    build(
        &(OVERLAPPING.replace("ALBEDO", "[0.9, 0.8, 0.7]")
            + r#"
        emission = { mode = "source", le = [1.0, 0.5, 0.2] }
        [[volume]]
        shape = "everywhere"
        density = { scale = 0.03 }
        albedo = 0.9
        [[light]]
        type = "point"
        position = [1.5, -1.0, 1.5]
        intensity = [4.0, 4.0, 4.0]
        [[light]]
        type = "quad"
        center = [-1.5, 0.5, 1.5]
        half_u = [0.3, 0, 0.3]
        half_v = [0, 0.3, 0]
        radiance = [3.0, 4.0, 6.0]
        [[surface]]
        shape = "plane"
        point = [0, 0, -0.9]
        normal = [0, 0, 1]
        half_size = 4.0
        material = { type = "diffuse", reflectance = 0.5 }
    "#),
    )
}

/// Largest standard error of lit scenes by each way to walk: three times the usual.
const POWER: f64 = 0.015;

fn agree(scene: &Scene, reference: &Estimate, settings: Vec<(String, Strategy)>, paths: u32) {
    let mut verdicts = Verdicts::of_power(POWER);
    let expected = Expected::measured(reference);
    for (name, strategy) in settings {
        verdicts.hold(&name, &with_strategy(scene, strategy), 2 * paths, &expected);
    }
    verdicts.finish();
}

#[test]
fn lit_scenes_agree_by_every_tracker() {
    let scene = lit();
    let reference = measure(&with_strategy(&scene, Preset::Emission.strategy()), 160_000);
    agree(&scene, &reference, trackers(), 40_000);
}

/// Where looks at lamps and at points of a fire go through smoke.
#[test]
fn lit_scenes_agree_by_every_estimator() {
    let scene = lit();
    let with = |transmittance, nee_evaluation| {
        let advanced = Advanced { transmittance, nee_evaluation, ..Advanced::default() };
        Strategy { advanced, ..Preset::Emission.strategy() }
    };
    let plain = with(TransmittanceEstimator::Ratio, NeeEvaluation::Line);
    let reference = measure(&with_strategy(&scene, plain), 120_000);
    let settings = ESTIMATORS
        .map(|estimator| (format!("{estimator:?}"), with(estimator, NeeEvaluation::Line)));
    agree(&scene, &reference, settings.into(), 40_000);

    // A fire that is looked at from outside of it, where its points are of finite variance.
    let outside = build(
        r#"
        [camera]
        position = [0, -5, 0]
        target = [0, 0, -1]
        fov_x = 20
        [[volume]]
        shape = "sphere"
        radius = 0.4
        translate = [0, 0, 1.2]
        density = { scale = 0.5 }
        albedo = 0.0
        emission = { mode = "constant", value = [1.0, 0.5, 0.2] }
        [[volume]]
        shape = "noise"
        half_size = [2, 2, 0.4]
        frequency = 1.5
        density = { scale = [1.0, 2.0, 4.0] }
        albedo = 0.0
        [[surface]]
        shape = "plane"
        point = [0, 0, -1]
        normal = [0, 0, 1]
        half_size = 3.0
        material = { type = "diffuse", reflectance = 0.8 }
        "#,
    );
    let reference = measure(&with_strategy(&outside, plain), 120_000);
    let settings = ESTIMATORS.map(|estimator| {
        (format!("{estimator:?} at points"), with(estimator, NeeEvaluation::Point))
    });
    agree(&outside, &reference, settings.into(), 40_000);
}

/// Media whose transmittance is known by quadrature: uneven and overlapping, thin and thick, with
/// a channel that is clear, uneven again under another transform, stored in a grid.
fn media() -> Vec<(&'static str, Scene)> {
    let noise = |scale: &str, more: &str| {
        build(&format!(
            "[[volume]]\nshape = 'noise'\nhalf_size = 1.0\nfrequency = 1.5\ncontrast = 2.0\n\
             density.scale = {scale}\n{more}"
        ))
    };
    let ball = "[[volume]]\nshape = 'sphere'\nradius = 0.6\ndensity.scale = [1.5, 0.5, 0.2]\n\
                [[volume]]\nshape = 'everywhere'\ndensity.scale = 0.1";
    vec![
        ("thin", noise("0.4", "")),
        ("thick", noise("5.0", "")),
        ("colored", noise("[0.0, 1.0, 3.0]", "")),
        ("overlapping", noise("[2.0, 1.0, 0.3]", ball)),
        (
            "grid",
            build("[[volume]]\nfile = '../assets/torch_hd.vdb'\ndensity.scale = [2.0, 5.0, 9.0]"),
        ),
    ]
}

/// A ray through the middle of the scene's first volume, and the length to go.
fn through(scene: &Scene) -> (Ray, f32) {
    let bounds = scene.world.instances()[0].bounds();
    let from = bounds.min + Vec3A::new(0.1, 0.35, 0.3) * bounds.size();
    let to = bounds.min + Vec3A::new(0.8, 0.6, 0.7) * bounds.size();
    (Ray::new(from, (to - from).normalize()), (to - from).length())
}

/// exp(−τ) by the midpoint rule.
fn quadrature(scene: &Scene, ray: &Ray, length: f32) -> DVec3 {
    const STEPS: u32 = 20_000;
    let step = f64::from(length) / f64::from(STEPS);
    let tau = (0..STEPS).fold(DVec3::ZERO, |tau, i| {
        let point = ray.at(((f64::from(i) + 0.5) * step) as f32);
        let mu_t = scene.world.matter_at(point).map_or(Rgb::ZERO, |matter| matter.mu_t);
        tau + step * mu_t.as_dvec3()
    });
    (-tau).exp()
}

#[test]
fn estimators_of_transmittance_have_its_mean() {
    /// Most of them in a batch, of which there are as many as samples of a pixel elsewhere.
    const BATCH: u32 = 256;
    /// Ratio tracking is noisy where little gets through.
    const SOME: f64 = 0.015;
    let mut verdicts = Verdicts::of_power(SOME);
    for (name, scene) in media() {
        let (ray, length) = through(&scene);
        let expected = quadrature(&scene, &ray, length);
        assert!(expected.min_element() < 0.9, "{name}: there is something in the way, {expected}");
        for estimator in ESTIMATORS {
            let (mut sum, mut squares, mut present) = (DVec3::ZERO, DVec3::ZERO, 0);
            let mut reads = 0;
            let seed = common::seed().wrapping_add(verdicts.next_seed());
            let mean = |batches: u32| {
                for index in present..batches * BATCH {
                    let mut rng = PathRng::new(seed, UVec2::ZERO, index);
                    let medium = scene.world.along(ray, length);
                    let (value, read) = shadow::transmittance(medium, estimator, &mut rng);
                    sum += value.as_dvec3();
                    squares += (value * value).as_dvec3();
                    reads += read;
                }
                present = batches * BATCH;
                let n = f64::from(present);
                let mean = sum / n;
                let variance = (squares / n - mean * mean).max(DVec3::ZERO) / (n - 1.0);
                // The quadrature errs where fields have kinks and volumes a border.
                let variance = variance + (1e-4 * expected) * (1e-4 * expected);
                (0..3).map(|c| [mean[c], variance[c]]).collect()
            };
            let advanced = Advanced { transmittance: estimator, ..Advanced::default() };
            let strategy = Strategy { advanced, ..Strategy::default() };
            let label = format!("{name}, {estimator:?}");
            verdicts.follow(&label, &strategy, 400, &Expected::known(&expected.to_array()), mean);
            assert!(reads > 0, "{name}: nothing was read");
        }
    }
    verdicts.finish();
}

/// What is said of a segment holds at each of its points.
#[test]
fn bounds_hold_the_extinction() {
    let (mut checked, mut useful) = (0, 0);
    for (name, scene) in media() {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let bounds = *scene.world.instances()[0].bounds();
        let mut point = || {
            let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
            bounds.min + u * bounds.size()
        };
        for _ in 0..300 {
            let from = point();
            let towards = point() - from;
            let length = towards.length();
            let mut medium = scene.world.along(Ray::new(from, towards / length), length);
            while let Some(segment) = medium.next_segment() {
                let (low, high) = medium.bounds_of_mu_t();
                for i in 0..8 {
                    let u = (i as f32 + 0.5) / 8.0;
                    let mu_t = medium.mu_t(segment.t0 + u * (segment.t1 - segment.t0));
                    let slack = 1e-5 * high;
                    let holds = mu_t.cmpge(low - slack) & mu_t.cmple(high + slack);
                    assert!(holds.all(), "{name}: {mu_t} not in {low} to {high}");
                    checked += 1;
                }
                useful += u32::from(low.max_element() > 0.1 * high.max_element());
            }
        }
    }
    assert!(checked > 10_000 && useful > 1000, "{checked} {useful}");
}
