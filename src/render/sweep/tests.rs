//! A sweep of a scene small enough to be swept in a moment.

use super::*;
use crate::error::NO_PROGRESS;
use crate::render::pool::Priority;
use crate::scene::{self, Overrides, VolumeCache};
use crate::transport::toggle::Toggle;

const SCENE: &str = r#"
[camera]
position = [0.0, -4.0, 0.5]
target = [0.0, 0.0, 0.0]
[strategy.advanced]
probe_count = 64
[[volume]]
name = "ball of fire"
shape = "sphere"
radius = 1.0
density = { scale = 1.5 }
albedo = 0.6
emission = { mode = "source", le = [2.0, 1.0, 0.2] }
"#;

const SIZE: UVec2 = UVec2::new(24, 16);

fn scene() -> Scene {
    let folder = std::path::Path::new(".");
    let settings = scene::parse(SCENE, "test", folder, &Overrides::default()).unwrap();
    scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap()
}

fn swept(
    amount: Amount,
    threads: usize,
    interrupt: &AtomicBool,
    progress: &mut dyn FnMut(SweepProgress),
) -> (Vec<Trial>, Result<Swept>) {
    let scene = scene();
    let idle = |toggle, strategy: &Strategy| {
        let idle = toggle == Toggle::EmissionDecoupling && strategy.emission_ratio_tracking;
        idle.then_some("ratio tracking collects it")
    };
    let trials = plan(scene.strategy(), &idle);
    let pool = Pool::new(Some(threads), Priority::Normal).unwrap();
    let job = SweepJob { scene: &scene, trials: &trials, size: SIZE, seed: 3, amount };
    let swept = sweep(&job, &pool, interrupt, progress);
    (trials, swept)
}

/// Equal strategies are rendered once, everything else gets its samples, and the pictures do not
/// depend on the number of threads.
#[test]
fn every_strategy_gets_its_samples() {
    let amount = Amount { spp: 9, cpu_seconds: None, evenly: true };
    let go_on = AtomicBool::new(false);
    let mut steps = Vec::new();
    let (trials, one) = swept(amount, 1, &go_on, &mut |progress| steps.push(progress));
    let one = one.unwrap();
    assert!(!one.interrupted && one.failure.is_none());
    for (trial, tried) in std::iter::zip(&trials, &one.tried) {
        let samples = tried.map(|tried| tried.side.fewest_samples);
        let is_rendered = trial.source == TrialSource::Rendered;
        assert_eq!(samples, is_rendered.then_some(9), "{:?}", trial.kind);
    }
    assert_eq!(steps[0], SweepProgress::Preparing(0, 11));
    let mut parts = steps.iter().filter_map(|step| match step {
        SweepProgress::Rendering(part) => Some(*part),
        SweepProgress::Preparing(..) => None,
    });
    assert!(parts.clone().is_sorted() && parts.next_back() == Some(1.0));
    let ranking = one.ranking(&trials);
    assert_eq!(ranking.entries.len(), trials.len());
    assert!(ranking.best().is_some());

    let (_, three) = swept(amount, 3, &go_on, &mut |_| ());
    for (one, three) in std::iter::zip(one.tried, three.unwrap().tried) {
        let variance = |tried: Option<Tried>| tried.map(|tried| tried.side.variance_of_mean);
        assert_eq!(variance(one), variance(three));
    }
}

/// The same strategy rendered beside all others makes the picture that it makes alone.
#[test]
fn probes_that_are_shared_are_those_of_each_strategy() {
    let amount = Amount { spp: 4, cpu_seconds: None, evenly: true };
    let go_on = AtomicBool::new(false);
    let (trials, swept) = swept(amount, 2, &go_on, &mut |_| ());
    let swept = swept.unwrap();
    let pool = Pool::new(Some(2), Priority::Normal).unwrap();
    for kind in [
        TrialKind::Baseline,
        TrialKind::Alone(Toggle::LightProbes),
        TrialKind::Without(Toggle::FireAsLight),
    ] {
        let number = trials.iter().position(|trial| trial.kind == kind).unwrap();
        let scene = scene().with_strategy(trials[number].strategy);
        let frame: Arc<dyn PixelSampler> =
            Arc::new(Frame::new(Arc::new(scene), SIZE, 3, NO_PROGRESS).unwrap());
        let mut alone = [SideInProgress::new(frame, SIZE, amount).unwrap()];
        take_turns(&mut alone, &pool, &go_on, &mut |_| ());
        let [alone] = alone;
        let mean = SideFigures::of(&alone.finish(&pool).film, 1.0).mean_rgb;
        assert_eq!(swept.tried[number].unwrap().side.mean_rgb, mean, "{kind:?}");
    }
}

#[test]
fn every_strategy_gets_its_time() {
    let amount = Amount { spp: 0, cpu_seconds: Some(0.05), evenly: true };
    let (_, swept) = swept(amount, 2, &AtomicBool::new(false), &mut |_| ());
    let tried = swept.unwrap().tried;
    assert!(tried.iter().flatten().all(|tried| tried.side.cpu_seconds >= 0.05));
}

/// However short the time, all pixels have equally many samples in the end, enough for a variance;
/// otherwise the part of the picture that comes first would be all that is measured.
#[test]
fn the_last_pass_is_finished() {
    for seconds in [1e-6, 0.03] {
        let amount = Amount { spp: 0, cpu_seconds: Some(seconds), evenly: true };
        let (_, swept) = swept(amount, 2, &AtomicBool::new(false), &mut |_| ());
        for tried in swept.unwrap().tried.iter().flatten() {
            let side = &tried.side;
            assert!(side.fewest_samples >= 2 && side.variance_of_mean.is_some());
            assert_eq!(side.samples_per_pixel, f64::from(side.fewest_samples));
        }
    }
}

#[test]
fn an_interrupt_keeps_what_there_is() {
    let amount = Amount { spp: 1 << 20, cpu_seconds: None, evenly: true };
    let stop = AtomicBool::new(false);
    // A piece of work brings 64 samples at most, so that none is further behind than that.
    let (trials, swept_until) = swept(amount, 2, &stop, &mut |progress| {
        let enough =
            matches!(progress, SweepProgress::Rendering(part) if part * f64::from(1 << 20) > 80.0);
        stop.store(enough, Ordering::Relaxed);
    });
    let swept_until = swept_until.unwrap();
    assert!(swept_until.interrupted && swept_until.ranking(&trials).best().is_some());

    // Before every pixel has two samples, the noise is unknown.
    stop.store(false, Ordering::Relaxed);
    let (trials, early) = swept(amount, 2, &stop, &mut |progress| {
        stop.store(matches!(progress, SweepProgress::Rendering(_)), Ordering::Relaxed);
    });
    let early = early.unwrap();
    assert_eq!((early.interrupted, early.ranking(&trials).leave_on), (true, None));

    let at_once = AtomicBool::new(true);
    assert!(matches!(swept(amount, 2, &at_once, &mut |_| ()).1, Err(Error::Cancelled)));
}

#[test]
fn quick_films_show_the_same_in_fewer_pixels() {
    assert_eq!(quick_size(UVec2::new(64, 48)), UVec2::new(64, 48));
    let quick = quick_size(UVec2::new(1920, 1080));
    assert!(quick.x * quick.y <= 8300 && quick.x * quick.y > 8000, "{quick}");
    assert!((quick.x as f32 / quick.y as f32 * 9.0 / 16.0 - 1.0).abs() < 0.02);
    assert_eq!(quick_size(UVec2::new(1, 1 << 20)).x, 1);
}
