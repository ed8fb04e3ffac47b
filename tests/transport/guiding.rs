//! Scattering guided by probes, by equal angles and towards glow: whatever the guide, one picture.

use std::sync::Arc;

use crate::common::{
    CLOSELY, Expected, REFERENCED, Verdicts, asking, build, every_guide, few_guides, full_name,
    half_of_strategies, measure_closely, measure_to, with_strategy,
};
use flambeau::transport::{
    PathSample, Scene,
    probes::Probes,
    strategy::{Advanced, Distance, Preset, Strategy},
};

/// A lamp and a small fire inside of uneven smoke, with haze all around; `SCALE` is its density.
const EMBEDDED: &str = r#"
    [camera]
    position = [0, -4, 0.5]
    target = [0, 0, 0]
    fov_x = 34
    [[volume]]
    shape = "noise"
    half_size = [1.0, 0.9, 0.8]
    rotate = [0, 0, 20]
    frequency = 1.5
    contrast = 2.0
    density = { scale = SCALE }
    albedo = [0.9, 0.8, 0.7]
    phase = { g = 0.6 }
    [[volume]]
    shape = "sphere"
    radius = 0.25
    translate = [-0.4, 0.1, -0.2]
    density = { scale = 1.0 }
    albedo = 0.2
    emission = { mode = "source", le = [1.0, 0.5, 0.2] }
    [[surface]]
    shape = "sphere"
    center = [0.35, 0.1, 0.2]
    radius = 0.12
    material = { type = "black" }
    emission = [2.0, 2.5, 3.0]
"#;

/// Most of its light is lost at each bounce: every ray in it scatters, and paths would be long.
const HAZE: &str = r#"
    [[volume]]
    shape = "everywhere"
    density = { scale = 0.03 }
    albedo = 0.5
"#;

const FLOOR: &str = r#"
    [[surface]]
    shape = "plane"
    point = [0, 0, -0.9]
    normal = [0, 0, 1]
    half_size = 4.0
    material = { type = "diffuse", reflectance = 0.5 }
"#;

/// Without guides, with all of them and with those of `settings`; the first of these, by `guided`
/// whichever it is, is what the others are held against.
fn guides_agree(text: &str, guided: bool, settings: Vec<Strategy>, paths: u32) {
    let scene = build(text);
    let full = Strategy { advanced: asking(), ..Preset::Full.strategy() };
    let unguided = Strategy { probe_mis: false, ..full };
    let (first, second) = if guided { (full, unguided) } else { (unguided, full) };
    let reference = measure_closely(&with_strategy(&scene, first), 4 * paths);
    let expected = Expected::measured(&reference);
    let mut verdicts = Verdicts::of_power(REFERENCED);
    for strategy in std::iter::once(second).chain(settings) {
        let scene = with_strategy(&scene, strategy);
        verdicts.hold(&full_name(&strategy), &scene, 2 * paths, &expected);
    }
    verdicts.finish();
}

#[test]
fn guides_agree_in_thin_smoke() {
    // Every two of the keys meet in every way.
    let settings = every_guide().into_iter().filter(|strategy| {
        let a = &strategy.advanced;
        let probes = a.distance == Distance::Probes;
        probes ^ a.equiangular ^ a.guide_directions ^ a.guide_all_vertices
    });
    guides_agree(&EMBEDDED.replace("SCALE", "0.4"), false, settings.collect(), 400_000);
}

/// Probes alone have rare bright samples in thick smoke, which is what MIS is there for.
#[test]
fn guides_agree_in_thick_smoke() {
    let shared = |strategy: &Strategy| strategy.advanced.distance == Distance::Mis;
    let settings = every_guide().into_iter().filter(shared).step_by(3).collect();
    guides_agree(&EMBEDDED.replace("SCALE", "5.0"), true, settings, 500_000);
}

/// With an end worth getting to and a fog that never ends.
#[test]
fn guides_agree_over_a_floor_in_haze() {
    let text = EMBEDDED.replace("SCALE", "1.5") + HAZE + FLOOR;
    guides_agree(&text, true, few_guides(), 400_000);
}

/// With the toggles for emission, whose walks share the medium with the guided ones; not without
/// looks at fire, which otherwise is found too rarely to tell.
#[test]
fn guides_agree_whatever_else_is_on() {
    let found = |s: &Strategy| s.probe_mis && s.nee && s.emission_ratio_tracking;
    let text = EMBEDDED.replace("SCALE", "1.5") + HAZE;
    guides_agree(&text, true, half_of_strategies().into_iter().filter(found).collect(), 2_000_000);
}

/// Of a ray's first scattering event alone: probes without chance are as good as chance wherever
/// their line has a density, and it has one wherever something scatters.
#[test]
fn probes_alone_find_all_that_chance_finds() {
    let text = EMBEDDED.replace("SCALE", "0.8") + "[path]\nmax_scatters = 1\n";
    let scene = build(&text);
    let by = |distance| {
        let advanced =
            Advanced { distance, equiangular: false, guide_directions: false, ..asking() };
        with_strategy(&scene, Strategy { advanced, ..Preset::Full.strategy() })
    };
    let direct = |path: &PathSample| path.direct;
    let probes = measure_to(&by(Distance::Probes), 1_000_000, CLOSELY, direct);
    let mut verdicts = Verdicts::of_power(REFERENCED);
    let expected = Expected::measured(&probes);
    verdicts.hold_part("first event", &by(Distance::Null), 3_000_000, &expected, direct);
    verdicts.finish();
}

/// Half of the samples by some probes, half by others or by none: each half has the same mean, so
/// that the picture does not care when probes are placed anew.
#[test]
fn probes_placed_anew_change_nothing() {
    let scene = build(&EMBEDDED.replace("SCALE", "0.8"));
    let by = |distance, probe_count| {
        let advanced = Advanced { distance, probe_count, ..asking() };
        with_strategy(&scene, Strategy { advanced, ..Preset::Full.strategy() })
    };
    let unlearned = || {
        let advanced = Advanced { probe_learning: false, ..asking() };
        with_strategy(&scene, Strategy { advanced, ..Preset::Full.strategy() })
    };
    let reference = measure_closely(&by(Distance::Null, 64), 2_000_000);
    let expected = Expected::measured(&reference);
    let mut verdicts = Verdicts::of_power(REFERENCED);
    for (label, scenes) in [
        ("few, then many", [by(Distance::Mis, 200), by(Distance::Mis, 6000)]),
        ("none, then some", [by(Distance::Null, 64), by(Distance::Mis, 1000)]),
        ("many, then few alone", [by(Distance::Mis, 3000), by(Distance::Probes, 300)]),
        ("unlearned, then learned", [unlearned(), by(Distance::Mis, 1000)]),
    ] {
        verdicts.hold_in_turn(label, &scenes, 800_000, &expected);
    }
    verdicts.finish();
}

/// A sun and a spot through a gap between two boards: shafts of light in uneven mist that scatters
/// forward.
#[test]
fn guides_agree_on_shafts_of_light() {
    let text = r#"
        [camera]
        position = [0, -4, 0.3]
        target = [0, 0, 0]
        fov_x = 14
        [[volume]]
        shape = "noise"
        half_size = [1.5, 1.2, 1.0]
        frequency = 1.0
        contrast = 2.0
        density = { scale = 0.25 }
        albedo = [0.95, 0.9, 0.85]
        phase = { g = 0.6 }
        [[light]]
        type = "sun"
        direction = [0.3, -0.2, -1]
        irradiance = 2.0
        angle = 1
        [[light]]
        type = "spot"
        position = [-0.8, 0.5, 2.5]
        target = [0, 0, 0]
        intensity = 8.0
        cone = 30
        blend = 0.5
        [[surface]]
        shape = "quad"
        center = [-1.9, 0, 1.1]
        half_u = [1.5, 0, 0]
        half_v = [0, 2, 0]
        material = { type = "black" }
        [[surface]]
        shape = "quad"
        center = [1.9, 0, 1.1]
        half_u = [1.5, 0, 0]
        half_v = [0, 2, 0]
        material = { type = "black" }
    "#;
    guides_agree(text, true, few_guides(), 400_000);
}

fn probes(text: &str, count: u32) -> (Scene, Option<Arc<Probes>>) {
    let advanced = Advanced { probe_count: count, ..Advanced::default() };
    let scene = with_strategy(&build(text), Strategy { advanced, ..Preset::Full.strategy() });
    let probes = crate::common::probes_of(&scene);
    (scene, probes)
}

/// Wherever the medium scatters, the line along a ray has a density, and it integrates to one.
#[test]
fn lines_cover_what_scatters() {
    let text = EMBEDDED.replace("SCALE", "2.0");
    let (scene, probes) = probes(&text, 2000);
    let probes = probes.unwrap();
    let mut covered = 0;
    for i in 0..400 {
        let offset = glam::Vec2::new(0.37, 0.61);
        let size = glam::UVec2::splat(20);
        let ray = scene.camera.ray(size, glam::UVec2::new(i % 20, i / 20), offset);
        let end = f32::INFINITY;
        let Some(line) = probes.along(scene.world.along(ray, end), &ray) else { continue };
        let (n, reach) = (20_000, 8.0);
        let mut integral = 0.0;
        for k in 0..n {
            let t = reach * (k as f32 + 0.5) / n as f32;
            let pdf = line.pdf(t);
            let scatters = scene.world.matter_at(ray.at(t)).is_some_and(|m| m.mu_s.x > 0.0);
            assert!(pdf > 0.0 || !scatters, "no density at {t} of pixel {i}");
            integral += f64::from(pdf) * f64::from(reach) / f64::from(n);
        }
        assert!((integral - 1.0).abs() < 0.02, "{integral}");
        covered += 1;
    }
    assert!(covered > 100);
}

/// More probes are placed where more light is scattered, about as many as were asked for, and the
/// light of a lamp is felt along a ray that passes it. More than behind the lamp, that is: in front
/// of it smoke that scatters forward is bright as well.
#[test]
fn probes_know_where_the_lamp_is() {
    let text = EMBEDDED
        .replace("SCALE", "0.4")
        .replace(r#"shape = "noise""#, r#"shape = "box""#)
        .replace("frequency = 1.5\n    contrast = 2.0\n", "");
    for count in [500, 4000] {
        let (scene, probes) = probes(&text, count);
        let probes = probes.unwrap();
        let lamp = glam::Vec3A::new(0.35, 0.1, 0.2);
        let origin = glam::Vec3A::new(0.35, -4.0, 0.42);
        let ray = flambeau::math::Ray::new(origin, glam::Vec3A::Y);
        let line = probes.along(scene.world.along(ray, f32::INFINITY), &ray).unwrap();
        let near = line.pdf(4.0 + lamp.y);
        let far = line.pdf(4.0 + lamp.y + 0.6);
        assert!(near > 2.0 * far, "{near} near the lamp, {far} behind it");
        let placed = probes.len();
        assert!(placed > count as usize / 8 && placed < 2 * count as usize, "{placed}");
    }
}

/// In the shade of a board, where no look finds the lamp, only learning tells that smoke is lit: by
/// the smoke around it. The same on any number of threads.
#[test]
fn probes_learn_of_light_around_corners() {
    let text = r#"
        [camera]
        position = [0, -4, 0]
        target = [0, 0, 0]
        [[volume]]
        shape = "box"
        half_size = 1.0
        density = { scale = 1.0 }
        albedo = 0.9
        [[light]]
        type = "point"
        position = [0, 0, 3]
        intensity = 10.0
        [[surface]]
        shape = "quad"
        center = [0, 0, 1.2]
        half_u = [0.8, 0, 0]
        half_v = [0, 0.8, 0]
        material = { type = "black" }
    "#;
    let radiance = |probe_learning| {
        let advanced = Advanced { probe_learning, ..Advanced::default() };
        let scene = with_strategy(&build(text), Strategy { advanced, ..Preset::Full.strategy() });
        let probes = crate::common::probes_of(&scene).unwrap();
        probes.radiance_at(glam::Vec3A::new(0.0, 0.0, 0.5), glam::Vec3A::Y)
    };
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let [guessed, learned] = [false, true].map(radiance);
    assert!(guessed == 0.0 && learned > 1e-4, "{learned} learned, {guessed} guessed");
    assert_eq!(learned, alone.install(|| radiance(true)));
}

#[test]
fn without_scattering_there_are_no_probes() {
    let dark = EMBEDDED.replace("SCALE", "2.0").replace("albedo = [0.9, 0.8, 0.7]", "albedo = 0.0");
    assert!(probes(&dark.replace("albedo = 0.2", "albedo = 0.0"), 500).1.is_none());
    let scene = build(&dark);
    let advanced = Advanced { distance: Distance::Null, ..Advanced::default() };
    let strategy = Strategy { advanced, ..Preset::Full.strategy() };
    assert!(crate::common::probes_of(&with_strategy(&scene, strategy)).is_none());
}
