use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU32};
use std::time::{Duration, Instant};

use glam::UVec2;

use super::*;
use crate::error::NO_PROGRESS;
use crate::render::schedule::Limits;
use crate::render::{Film, Picture, RenderJob, render_headless};
use crate::scene::{Overrides, Settings, VolumeCache, assemble, parse};

const SIZE: UVec2 = UVec2::new(48, 32);
const SPP: u32 = 3;

/// Smoke with a lamp in it: probes change every sample of it.
const SMOKE: &str = r#"
film = { spp = 3, seed = 5 }
camera.position = [0, -5, 0]
[[volume]]
shape = "sphere"
density.scale = 2.0
albedo = 0.9
[[light]]
type = "point"
position = [0.2, 0, 0.3]
intensity = 3.0
"#;

/// Opened by the test, and counted by whoever passes.
#[derive(Default)]
struct Gate {
    open: AtomicBool,
    passed: AtomicU32,
}

struct Scenes {
    cache: VolumeCache,
    settings: Settings,
}

impl Scenes {
    fn new(text: &str) -> Self {
        let settings = parse(text, "", Path::new(""), &Overrides::default()).unwrap();
        Self { cache: VolumeCache::default(), settings }
    }

    fn build(&self) -> BuiltScene {
        let scene = assemble(&self.settings, &self.cache, NO_PROGRESS).unwrap();
        let scene = Arc::new(scene);
        BuiltScene { settings: self.settings.clone(), notes: Vec::new(), gaps: Vec::new(), scene }
    }
}

/// A placer that waits at a gate before it places anything.
fn probe_placer() -> (ProbePlacer, Arc<Gate>) {
    let session = Arc::new(Session::new(Some(2), || ()).unwrap());
    let gate = Arc::new(Gate::default());
    let at = gate.clone();
    let probe_placer = ProbePlacer::with(session, move |scene, progress| {
        while !at.open.load(Ordering::Relaxed) && progress(0.0) {
            std::thread::sleep(Duration::from_millis(1));
        }
        let probes = SceneProbes::placed(scene, progress)?;
        at.passed.fetch_add(1, Ordering::Relaxed);
        Ok(probes)
    });
    (probe_placer.unwrap(), gate)
}

fn start(generation: u64) -> RenderStart {
    RenderStart { size: SIZE, generation }
}

fn wait(probe_placer: &ProbePlacer, will_do: impl Fn(&Picture) -> bool) -> Arc<Picture> {
    let begun = Instant::now();
    loop {
        if let Some(picture) = probe_placer.session.latest().filter(|picture| will_do(picture)) {
            return picture;
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "no such picture");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// The film of a headless render, which starts with its probes.
fn headless(built: &BuiltScene) -> Film {
    let job = RenderJob {
        sampler: Arc::new(
            Frame::new(built.scene.clone(), SIZE, built.settings.film.seed, NO_PROGRESS).unwrap(),
        ),
        size: SIZE,
        limits: Limits { spp: SPP, seconds: None },
        resume: None,
        threads: Some(1),
    };
    render_headless(job, &AtomicBool::new(false), &mut |_, _| {}).unwrap().film
}

#[test]
fn a_picture_comes_before_the_probes_and_with_them_the_one_of_a_headless_render() {
    let built = Scenes::new(SMOKE).build();
    let (probe_placer, gate) = probe_placer();
    probe_placer.start(&built, start(1), None);
    let paths = u64::from(SIZE.element_product() * SPP);
    let before = wait(&probe_placer, |picture| picture.stats.paths == paths);
    assert!(!before.stats.finished, "its probes are still to come");
    assert!(probe_placer.probes(&built).is_none());

    gate.open.store(true, Ordering::Relaxed);
    let after = wait(&probe_placer, |picture| picture.stats.finished);
    assert!(after.generation == 1 && after.complete);
    let film = probe_placer.session.snapshot().recv().unwrap();
    assert_eq!(film, headless(&built));
    assert_ne!(before.pixels, after.pixels);
    assert!(probe_placer.probes(&built).is_some());
}

#[test]
fn camera_and_film_edits_reuse_the_probes_and_others_do_not() {
    let mut scenes = Scenes::new(SMOKE);
    let (probe_placer, gate) = probe_placer();
    gate.open.store(true, Ordering::Relaxed);
    let mut generation = 0;
    let mut made_by = |scenes: &Scenes| {
        generation += 1;
        let built = scenes.build();
        probe_placer.start(&built, start(generation), None);
        wait(&probe_placer, |picture| picture.generation == generation && picture.stats.finished);
        assert_eq!(probe_placer.session.snapshot().recv().unwrap(), headless(&built));
        gate.passed.load(Ordering::Relaxed)
    };
    assert_eq!(made_by(&scenes), 1);
    scenes.settings.camera.position[0] = 1.0;
    scenes.settings.film.seed = 9;
    scenes.settings.strategy.majorant_boost = false;
    assert_eq!(made_by(&scenes), 1);
    scenes.settings.strategy.probe_mis = false;
    assert_eq!(made_by(&scenes), 1);
    scenes.settings.strategy.probe_mis = true;
    assert_eq!(made_by(&scenes), 1, "switched off and on again they are still there");
    scenes.settings.light[0].position = Some([0.0, 0.5, 0.0]);
    assert_eq!(made_by(&scenes), 2);
    scenes.settings.volume[0].density.scale = crate::scene::settings::Color::Gray(3.0);
    assert_eq!(made_by(&scenes), 3);
    scenes.settings.strategy.advanced.probe_count = 512;
    assert_eq!(made_by(&scenes), 4);
}

#[test]
fn a_fog_without_borders_has_probes_around_its_camera() {
    let fog = SMOKE.replace("\"sphere\"", "\"everywhere\"").replace("2.0", "0.1");
    let mut scenes = Scenes::new(&fog);
    let first = scenes.build();
    scenes.settings.camera.fov_x = 20.0;
    assert!(same(&first, &scenes.build()));
    scenes.settings.camera.position[0] = 1.0;
    assert!(!same(&first, &scenes.build()));
}

/// A drag of the camera lets the probes under way go on; an edit of what they are made from gives
/// them up.
#[test]
fn edits_while_probes_are_placed() {
    let mut scenes = Scenes::new(SMOKE);
    let (probe_placer, gate) = probe_placer();
    probe_placer.start(&scenes.build(), start(1), None);
    let generation = || probe_placer.shared.generation.load(Ordering::Relaxed);
    let under_way = generation();
    for generation in 2..5 {
        scenes.settings.camera.position[0] += 0.1;
        probe_placer.start(&scenes.build(), start(generation), None);
    }
    assert_eq!(generation(), under_way);
    scenes.settings.light[0].position = Some([0.0, 0.5, 0.0]);
    let last = scenes.build();
    probe_placer.start(&last, start(5), None);
    assert_ne!(generation(), under_way);
    gate.open.store(true, Ordering::Relaxed);
    wait(&probe_placer, |picture| picture.generation == 5 && picture.stats.finished);
    assert_eq!(probe_placer.session.snapshot().recv().unwrap(), headless(&last));
    assert_eq!(gate.passed.load(Ordering::Relaxed), 1);
}

/// Strategies with the same recipe have the same probes, whatever else differs.
#[test]
fn the_recipe_tells_all_that_decides_the_probes() {
    let glowing = SMOKE.replace("albedo = 0.9", "albedo = 0.5\nemission.mode = 'source'");
    let mut scenes = Scenes::new(&glowing.replace("= 'source'", "= 'source'\nemission.le = 1.0"));
    let probes = |scenes: &Scenes| {
        format!("{:?}", SceneProbes::placed(&scenes.build().scene, NO_PROGRESS).unwrap())
    };
    let first = probes(&scenes);
    let strategy = &mut scenes.settings.strategy;
    strategy.emission_decoupling ^= true;
    strategy.emission_ratio_tracking ^= true;
    strategy.advanced.boost_mode = crate::transport::strategy::BoostMode::Literal;
    strategy.advanced.boost_amount = 3.0;
    strategy.advanced.distance = crate::transport::strategy::Distance::Probes;
    strategy.advanced.equiangular ^= true;
    strategy.advanced.guide_directions ^= true;
    strategy.advanced.guide_all_vertices ^= true;
    strategy.advanced.low_discrepancy ^= true;
    assert_eq!(Probes::recipe(strategy), Probes::recipe(&Default::default()));
    assert!(probes(&scenes) == first);
    scenes.settings.strategy.nee = false;
    assert_ne!(Probes::recipe(&scenes.settings.strategy), Probes::recipe(&Default::default()));
    assert!(probes(&scenes) != first);
}
