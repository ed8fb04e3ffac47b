//! All that is done before the first sample can be given up, anywhere, and changes nothing
//! otherwise.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::UVec2;

use super::prepare::SceneProbes;
use super::*;
use crate::error::{Error, NO_PROGRESS, Progress, Result};
use crate::scene::{self, Overrides, VolumeCache};

const SIZE: UVec2 = UVec2::new(16, 12);

/// Asks for everything: probes with scores of several lights, caustics, learning, the optimal
/// majorant and a pilot, in an emissive volume with cells.
pub(super) const SCENE: &str = r#"
    [camera]
    position = [0, -4, 0]
    target = [0, 0, 0]
    [strategy.advanced]
    boost_mode = "optimal"
    light_selection = "probes"
    probe_count = 64
    [[volume]]
    shape = "noise"
    half_size = 1.0
    frequency = 2.0
    density = { scale = 1.0 }
    albedo = 0.8
    emission = { mode = "source", le = [2.0, 1.0, 0.2] }
    [[light]]
    type = "sphere"
    center = [2.0, -1.0, 2.0]
    radius = 0.3
    intensity = 20.0
    [[light]]
    type = "point"
    position = [-2.0, -1.0, 2.0]
    intensity = 20.0
    [[surface]]
    shape = "sphere"
    center = [1.5, 0.0, 0.0]
    radius = 0.4
    material = { type = "conductor", alpha = 0.1, reflectance = 0.9 }
"#;

/// Runs `work` on one thread and cancels it at the call of that number to `progress`; returns the
/// result and the number of calls.
fn questions<R: Send>(
    stop_at: u64,
    work: impl Fn(Progress) -> Result<R> + Send + Sync,
) -> (Result<R>, u64) {
    let asked = AtomicU64::new(0);
    let progress = |fraction: f32| {
        assert!((0.0..=1.0).contains(&fraction), "{fraction} of the work");
        asked.fetch_add(1, Ordering::Relaxed) + 1 < stop_at
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let result = pool.install(|| work(&progress));
    (result, asked.load(Ordering::Relaxed))
}

/// Gives `work` up at many of its questions; none but `late` of them may follow.
fn check_giving_up<R: Send>(
    what: &str,
    least: u64,
    late: u64,
    work: impl Fn(Progress) -> Result<R> + Send + Sync,
) {
    let (done, all) = questions(u64::MAX, &work);
    assert!(done.is_ok() && all >= least, "{what}: {all} questions where {least} are due");
    for stop_at in (1..=all).step_by((all / 12).max(1) as usize) {
        let (ended, asked) = questions(stop_at, &work);
        assert!(matches!(ended, Err(Error::Cancelled)), "{what}: given up at {stop_at} of {all}");
        assert!(asked <= stop_at + late, "{what}: {asked} questions, the answer came at {stop_at}");
    }
}

/// Every probe reports progress, and so do every path that one learns from, every photon and every
/// pilot pixel.
#[test]
fn setting_up_a_frame_can_be_given_up_anywhere() {
    let scene = Arc::new(Scene::of_text(SCENE));
    let probes = SceneProbes::placed(&scene, NO_PROGRESS).unwrap().unwrap();
    let coarse = probes.coarse();
    let due = coarse.len() - 1 + coarse.leaves().len() + 256 + 4096;
    check_giving_up("few probes", due as u64, 0, |progress| SceneProbes::placed(&scene, progress));
    let fine = probes.fine(&scene, NO_PROGRESS).unwrap();
    let due = fine.len() - 1 + 2 * fine.leaves().len() + 256 + 16384;
    check_giving_up("all probes", due as u64, 0, |progress| {
        let probes = SceneProbes::placed(&scene, NO_PROGRESS).unwrap().unwrap();
        probes.fine(&scene, progress).map(Clone::clone)
    });
    let probes = Some(Arc::new(probes));
    check_giving_up("film", 24 * 24 + 32, 0, |progress| {
        Frame::try_with_probes(scene.clone(), SIZE, 0, probes.clone(), progress)
    });
    // Four pilots fly at once, and each of the others may ask once more.
    check_giving_up("pilot", 500, 3, |progress| {
        Frame::with_probes(scene.clone(), SIZE, 0, probes.clone()).prepare(progress)
    });
}

#[test]
fn building_volumes_can_be_given_up_anywhere() {
    let settings = scene::parse(SCENE, "test", Path::new("."), &Overrides::default()).unwrap();
    check_giving_up("volumes", 3 * 16 * 16 * 16, 0, |progress| {
        scene::assemble(&settings, &VolumeCache::default(), progress)
    });
}

/// Work that could have been cancelled and was not gives the same paths.
#[test]
fn what_was_not_given_up_is_the_same() {
    let scene = Arc::new(Scene::of_text(SCENE));
    let frame = |progress| Frame::new(scene.clone(), SIZE, 0, progress).unwrap();
    let (plain, asked) = (frame(NO_PROGRESS), frame(&|_| true));
    assert_eq!(format!("{:?}", asked.first), format!("{:?}", plain.first));
    assert_eq!(asked.emission_estimator, plain.emission_estimator);
    let plain = plain.prepared(NO_PROGRESS).unwrap();
    let asked = asked.prepared(&|_| true).unwrap();
    assert_eq!(asked.counts(), plain.counts());
    assert!(asked.prepare(&|_| false).is_ok(), "what is found is not looked for again");
    let paths = |frame: &PreparedFrame| [0, 1, 2].map(|s| frame.sample(UVec2::new(8, 6), s));
    assert_eq!(paths(&asked), paths(&plain));
}
