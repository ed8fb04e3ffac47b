//! From inside the fire: camera, scattering and looks within an emissive medium that scatters.

use std::f64::consts::TAU;

use crate::common::{
    CLOSELY, Expected, REFERENCED, Verdicts, build, every_line_setting, every_nth, full_name,
    measure_to, name, seed, with_strategy,
};
use flambeau::{
    math::{PathRng, Ray},
    sampling::{mis, warp::about_axis},
    transport::{
        PathSample, Scene,
        direct::{self, LightSampling, PrevVertex},
        emission::{EmissionEstimator, ray::RayKind},
        strategy::{Preset, Strategy},
        vertex::Vertex,
    },
    volume::phase::PhaseMix,
};
use glam::{UVec2, Vec3A};
use rayon::prelude::*;

/// A camera within fire that varies, reaches through a floor and has a clear-cut fire beside it.
fn in_the_fire(density: f64, surfaces: &str) -> String {
    let fire = |shape: &str, density: f64, g: f64| {
        format!(
            r#"
            [[volume]]
            {shape}
            density = {{ scale = {density} }}
            albedo = [0.8, 0.6, 0.4]
            phase = {{ g = {g} }}
            emission = {{ mode = "source", le = 2.0 }}
            "#
        )
    };
    let noise =
        fire("shape = \"noise\"\nhalf_size = 1.0\nfrequency = 1.5\ncontrast = 2.0", density, 0.5);
    let ball =
        fire("shape = \"sphere\"\nradius = 0.7\ntranslate = [0.4, 0.9, 0.1]", 0.5 * density, 0.0);
    format!(
        r#"
        [camera]
        position = [0.1, -0.5, 0.2]
        target = [0.2, 1, 0]
        fov_x = 80
        {surfaces}{noise}{ball}
        "#
    )
}

/// In a furnace all is as bright inside the fire as anywhere else, wherever looks go.
#[test]
fn the_furnace_seen_from_inside() {
    let surfaces = r#"
        [environment]
        radiance = 2.0
        [[surface]]
        shape = "plane"
        point = [0, 0, -0.4]
        normal = [0, 0, 1]
        half_size = 2.0
        material = { type = "diffuse", reflectance = 0.5 }
        emission = 1.0
        [[surface]]
        shape = "sphere"
        center = [-0.2, 0.4, 0.1]
        radius = 0.2
        material = { type = "diffuse", reflectance = 1.0 }
    "#;
    let scene = build(&in_the_fire(3.0, surfaces));
    let mut verdicts = Verdicts::default();
    let looking = every_line_setting().into_iter().filter(|setting| setting.nee);
    for setting in every_nth(3, looking) {
        let (scene, expected) = (with_strategy(&scene, setting), Expected::known(&[2.0; 3]));
        verdicts.hold(&full_name(&setting), &scene, 200_000, &expected);
    }
    verdicts.finish();
}

/// A setting with looks for each way in which emission is gathered.
fn one_of_each_walk() -> Vec<Strategy> {
    let mut settings: Vec<Strategy> = Vec::new();
    for setting in every_line_setting().into_iter().filter(|setting| setting.nee) {
        if settings.iter().all(|other| name(other) != name(&setting)) {
            settings.push(setting);
        }
    }
    settings
}

/// Without its furnace the fire lights itself and a floor that it stands in: looks at it or none,
/// and however the path goes on, up to one turn, two and all.
#[test]
fn fire_lights_itself() {
    let floor = r#"
        [[surface]]
        shape = "plane"
        point = [0, 0, -0.4]
        normal = [0, 0, 1]
        half_size = 2.0
        material = { type = "diffuse", reflectance = 0.5 }
    "#;
    let mut verdicts = Verdicts::of_power(REFERENCED);
    for turns in [1, 2, 0] {
        let floor = format!("{floor}\n[path]\nmax_scatters = {turns}\n");
        let scene = build(&in_the_fire(1.5, &floor));
        let lit = |sample: &PathSample| sample.direct + sample.indirect;
        let blind = Strategy { nee: false, ..Preset::Full.strategy() };
        let reference = measure_to(&with_strategy(&scene, blind), 600_000, CLOSELY, lit);
        let expected = Expected::measured(&reference);
        for setting in one_of_each_walk() {
            let own_walk = setting.emission_ratio_tracking;
            let paths = if own_walk { 400_000 } else { 1_000_000 };
            let label = format!("{turns} turns, {}", full_name(&setting));
            let scene = with_strategy(&scene, setting);
            verdicts.hold_part(&label, &scene, paths, &expected, lit);
        }
    }
    verdicts.finish();
}

/// A glowing half space, as far as its border is concerned: z in [−2, 0]. No ray through it brings
/// more than ε/μ_t = 0.5.
fn glowing_slab() -> Scene {
    build(
        r#"
        [camera]
        position = [0, 0, 5]
        target = [0, 0, 0]
        up = [0, 1, 0]
        [path]
        max_scatters = 1
        [[volume]]
        shape = "box"
        half_size = [1.0, 1.0, 1.0]
        translate = [0, 0, -1]
        density = { scale = 0.5 }
        albedo = 0.5
        emission = { mode = "source", le = 1.0 }
        "#,
    )
}

/// A vertex in fog of its own, at a depth below the border.
fn vertex_below(depth: f32) -> Vertex {
    let mut phase = PhaseMix::default();
    phase.add(&flambeau::volume::phase::Phase::default(), flambeau::math::Rgb::ONE);
    Vertex::volume(&Ray::new(Vec3A::new(0.1, 0.2, -depth), Vec3A::X), 0.0, phase)
}

/// ∫ of the second moment of what one look brings over all directions, with a MIS weight or
/// without; and the largest value of the former's integrand over the phase function's density.
fn second_moments(scene: &Scene, depth: f32) -> [f64; 3] {
    const STEPS: u32 = 400;
    let vertex = vertex_below(depth);
    let [instance] = scene.world.instances() else { panic!("one volume") };
    let solid_angle = 2.0 * TAU / f64::from(STEPS * STEPS);
    let emission_estimator = EmissionEstimator::new(scene.strategy(), 0.0);
    (0..STEPS * STEPS)
        .into_par_iter()
        .map(|i| {
            let one_minus_cos = 2.0 * ((i / STEPS) as f32 + 0.5) / STEPS as f32;
            let angle = std::f32::consts::TAU * ((i % STEPS) as f32 + 0.5) / STEPS as f32;
            let direction = about_axis(one_minus_cos, angle);
            let ray = vertex.ray(direction);
            let light_pdf = instance.emission_pdf_along(&ray);
            let (value, phase_pdf) = vertex.eval(direction);
            let mut rng = PathRng::new(0, UVec2::ZERO, 0);
            let medium = scene.world.along(ray, f32::INFINITY);
            let radiance = emission_estimator.gather(medium, RayKind::Light, &mut rng).emission.x;
            let found = f64::from(value.x * radiance);
            let weight = f64::from(mis::mixture([1.0, 1.0], [light_pdf, phase_pdf]));
            let unweighted = found * found / f64::from(light_pdf);
            let weighted = unweighted * weight * weight;
            [unweighted * solid_angle, weighted * solid_angle, weighted / f64::from(phase_pdf)]
        })
        .reduce(|| [0.0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2].max(b[2])])
}

/// On a chord of length s the fire's glow is about ε s and the density of looks about p s³/3, so
/// that without its weight a look has a second moment of order 1/s. At depth h below the border
/// that integrates to order 1/h, and over all depths to a logarithm without bounds: as much for
/// each factor of the depth. With the half that the phase function samples the integrand stays
/// below max L², and the sum over ever smaller depths converges.
#[test]
fn mis_bounds_the_variance_near_the_border() {
    let scene = glowing_slab();
    // ∫ over the depths of a decade is h times the moment, times the same factor for each.
    let shells: Vec<[f64; 3]> = [1e-1, 1e-2, 1e-3, 1e-4_f32]
        .into_iter()
        .map(|depth| {
            let [unweighted, weighted, largest] = second_moments(&scene, depth);
            println!(
                "{depth}: {unweighted:.4} without MIS, {weighted:.4} with, at most {largest:.4}"
            );
            [unweighted * f64::from(depth), weighted * f64::from(depth), largest]
        })
        .collect();
    let [.., before, last] = shells.as_slice() else { panic!("four shells") };
    assert!((last[0] / before[0] - 1.0).abs() < 0.05, "no decade brings less: {shells:?}");
    assert!(last[1] < 0.2 * before[1], "decades bring less and less: {shells:?}");
    // w² p_ph / p_l is at most a quarter, and L at most ε/μ_t.
    let most = 0.25 * 0.5 * 0.5;
    assert!(shells.iter().all(|shell| shell[2] <= most), "no moment exceeds L²/4: {shells:?}");
}

/// What the two halves really bring has the same bound, path by path: f w L / p ≤ max L · f / p of
/// the phase function, which is max L.
#[test]
fn no_look_from_inside_exceeds_the_brightest_ray() {
    let slab = glowing_slab();
    let emission_estimator = EmissionEstimator::new(slab.strategy(), 0.0);
    let choice = direct::choice(slab.strategy());
    let sampling = LightSampling::one_of_each(choice);
    let brightest = 0.5_f32;
    let mut sums = [0.0; 2];
    const LOOKS: u32 = 20_000;
    for depth in [1e-1, 1e-3, 1e-5] {
        let vertex = vertex_below(depth);
        for i in 0..LOOKS {
            let mut rng = PathRng::new(seed(), UVec2::ZERO, i);
            let light =
                direct::sample_lights(&slab, &emission_estimator, &vertex, &sampling, &mut rng)
                    .contribution;
            assert!(light.max_element() <= brightest * 1.0001, "{depth}: a look brings {light}");
            let turn = vertex.sample(&mut rng).unwrap();
            let ray: Ray = vertex.ray(turn.direction);
            let (from, pdf_solid_angle) = (vertex.receiver(), turn.pdf_solid_angle);
            let prev_vertex =
                PrevVertex { from, fires: sampling, lamps: sampling, pdf_solid_angle };
            let (weight, _) = direct::weight_of_emission(&slab, &ray, Some(&prev_vertex));
            assert!((0.0..=1.0).contains(&weight));
            sums[0] += f64::from(light.x);
            sums[1] += f64::from(1.0 - weight);
        }
    }
    // Both halves take part.
    assert!(sums.iter().all(|sum| *sum > 0.01 * f64::from(LOOKS)), "{sums:?}");
}
