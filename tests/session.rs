//! The progressive session and the headless render, with samplers that only count and compute.

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Condvar, Mutex};
use std::time::{Duration, Instant};

use flambeau::error::NO_PROGRESS;
use flambeau::math::Rgb;
use flambeau::render::estimate::{PixelEstimate, gray};
use flambeau::render::picture::Extras;
use flambeau::render::schedule::Limits;
use flambeau::render::{
    Film, FilmStats, Headless, Layer, Picture, RenderJob, Request, Resume, Session, render_headless,
};
use flambeau::scene;
use flambeau::transport::{Frame, PathSample, PixelSampler, SampleNumber};
use glam::UVec2;

const SIZE: UVec2 = UVec2::new(75, 50);
const PATIENCE: Duration = Duration::from_secs(20);
/// Steps of each path of a [`Shade`].
const STEPS: u32 = 5;

/// A number in [0, 1) for each pixel and sample.
fn noise(pixel: UVec2, sample: u32) -> f32 {
    let mut z = u64::from(pixel.x) << 40 | u64::from(pixel.y) << 20 | u64::from(sample);
    for _ in 0..3 {
        z = (z ^ (z >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9).wrapping_add(0x9e37_79b9);
    }
    (z >> 40) as f32 / (1u64 << 24) as f32
}

fn path(pixel: UVec2, sample: u32) -> PathSample {
    let value = noise(pixel, sample);
    PathSample {
        emission: Rgb::new(value, 0.1, 0.0),
        indirect: Rgb::new(0.0, value * 1.0e-3, 3.0 * value),
        alpha: value,
        depth: (value > 0.25).then_some(value),
        tracking_steps: 2,
        ..Default::default()
    }
}

/// Counts its samples and interrupts after so many.
struct Counting {
    calls: AtomicU64,
    limit: u64,
    interrupt: Arc<AtomicBool>,
}

impl Counting {
    fn new(limit: u64) -> Arc<Self> {
        Arc::new(Self { calls: AtomicU64::new(0), limit, interrupt: Arc::default() })
    }
}

impl PixelSampler for Counting {
    fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
        let call = self.calls.fetch_add(1, Ordering::SeqCst) + 1;
        if call == self.limit {
            self.interrupt.store(true, Ordering::SeqCst);
        }
        // Whoever comes later sees the interrupt, even if its thread was held up before it.
        while call > self.limit && !self.interrupt.load(Ordering::SeqCst) {
            std::thread::yield_now();
        }
        path(pixel, number.index())
    }
}

fn render(sampler: &Arc<Counting>, spp: u32, threads: usize, resume: Option<Film>) -> Headless {
    let job = RenderJob {
        sampler: Arc::clone(sampler) as _,
        size: SIZE,
        limits: Limits { spp, seconds: None },
        resume,
        threads: Some(threads),
    };
    render_headless(job, &sampler.interrupt, &mut |_, _| {}).unwrap()
}

#[test]
fn the_same_film_for_any_number_of_threads() {
    let one = render(&Counting::new(u64::MAX), 21, 1, None);
    assert_eq!(one.film.sample_range(), (21, 21));
    for threads in [2, 4] {
        let many = render(&Counting::new(u64::MAX), 21, threads, None);
        assert_eq!(many.pool.threads(), threads);
        assert_eq!(many.film, one.film, "{threads} threads");
    }
}

/// Broken off anywhere, even twice, and continued: the film of the uninterrupted render.
#[test]
fn interrupted_and_resumed_is_uninterrupted() {
    let pixels = u64::from(SIZE.x * SIZE.y);
    let straight = render(&Counting::new(u64::MAX), 12, 2, None).film;
    for limit in [1, 17, pixels / 2, pixels + 1, 5 * pixels + 777] {
        let first = render(&Counting::new(limit), 12, 2, None);
        assert!(first.interrupted);
        let late = first.film.totals.paths - limit;
        assert!(late < 2, "{late} samples after the interrupt at {limit}");
        let second = render(&Counting::new(3000), 12, 3, Some(first.film));
        assert!(second.interrupted);
        let third = render(&Counting::new(u64::MAX), 12, 1, Some(second.film));
        assert!(!third.interrupted);
        assert_eq!(third.film, straight, "interrupted after {limit} samples");
    }
}

#[test]
fn a_snapshot_file_goes_on_as_if_never_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("half.exr");
    let half = render(&Counting::new(30_001), 15, 2, None);
    flambeau::image::exr::write(&file, &half.film, &Default::default()).unwrap();
    let read = flambeau::image::exr::read_snapshot(&file).unwrap();
    let resumed = render(&Counting::new(u64::MAX), 15, 4, Some(read.film)).film;
    assert_eq!(resumed, render(&Counting::new(u64::MAX), 15, 1, None).film);
}

#[test]
fn more_samples_than_wanted_are_left_alone() {
    let film = render(&Counting::new(u64::MAX), 5, 2, None).film;
    let sampler = Counting::new(u64::MAX);
    let same = render(&sampler, 3, 2, Some(film.try_clone().unwrap()));
    assert_eq!(sampler.calls.load(Ordering::SeqCst), 0);
    assert_eq!(same.film, film);
}

#[test]
fn a_film_of_another_size_is_refused() {
    let job = RenderJob {
        sampler: Counting::new(u64::MAX),
        size: SIZE,
        limits: Limits { spp: 1, seconds: None },
        resume: Some(Film::new(UVec2::new(3, 4)).unwrap()),
        threads: Some(1),
    };
    let error = render_headless(job, &AtomicBool::new(false), &mut |_, _| {}).err().unwrap();
    let text = error.to_string();
    assert!(text.contains("3 x 4") && text.contains("75 x 50"), "{text}");
}

/// Where setting up has taken all of the time, there is a whole picture all the same, and no more.
#[test]
fn without_any_time_every_pixel_gets_one_sample() {
    let job = |resume, seconds| RenderJob {
        sampler: Counting::new(u64::MAX),
        size: SIZE,
        limits: Limits { spp: 0, seconds: Some(seconds) },
        resume,
        threads: Some(2),
    };
    let interrupt = AtomicBool::new(false);
    let done = render_headless(job(None, 0.0), &interrupt, &mut |_, _| {}).unwrap();
    assert!(!done.interrupted);
    assert_eq!(done.film.sample_range(), (1, 1));
    let again = render_headless(job(Some(done.film), 0.0), &interrupt, &mut |_, _| {}).unwrap();
    assert_eq!(again.film.sample_range(), (1, 1));
}

#[test]
fn the_time_limit_ends_a_render_without_samples_limit() {
    let sampler = Counting::new(u64::MAX);
    let job = RenderJob {
        sampler: Arc::clone(&sampler) as _,
        size: SIZE,
        limits: Limits { spp: 0, seconds: Some(0.2) },
        resume: None,
        threads: Some(2),
    };
    let done = render_headless(job, &AtomicBool::new(false), &mut |_, _| {}).unwrap();
    assert!(!done.interrupted && done.seconds >= 0.2);
    assert_eq!(done.film.totals.paths, sampler.calls.load(Ordering::SeqCst));
}

/// The variance that a film reports, against the variance between renders of other seeds: the
/// first is what one render knows of itself, the second is what it stands for. Both means over the
/// picture scatter by a few percent at this many pixels and seeds.
#[test]
fn the_reported_variance_is_that_between_seeds() {
    const SCENE: &str = "
        environment.radiance = 0.5
        [[volume]]
        shape = 'sphere'
        density.scale = 2.0
        albedo = 0.8
        emission = { mode = 'source', le = 1.0 }
    ";
    let (size, spp, seeds) = (UVec2::new(32, 32), 11, 24);
    let folder = std::path::Path::new("/");
    let settings = scene::parse(SCENE, "test", folder, &Default::default()).unwrap();
    let scene = flambeau::scene::assemble(&settings, &Default::default(), NO_PROGRESS).unwrap();
    let scene = Arc::new(scene);
    let (mut reported, mut means) = (0.0, Vec::new());
    for seed in 0..seeds {
        let job = RenderJob {
            sampler: Arc::new(Frame::new(Arc::clone(&scene), size, seed, NO_PROGRESS).unwrap()),
            size,
            limits: Limits { spp, seconds: None },
            resume: None,
            threads: Some(2),
        };
        let film = render_headless(job, &AtomicBool::new(false), &mut |_, _| {}).unwrap().film;
        reported += FilmStats::of(&film).gray_variance_of_mean.unwrap() / seeds as f64;
        let pixels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
        let grays = pixels.map(|pixel| gray(PixelEstimate::of(&film, pixel).unwrap().mean()));
        means.push(grays.collect::<Vec<f64>>());
    }
    let pixels = means[0].len();
    let between = |pixel: usize| {
        let mean = means.iter().map(|film| film[pixel]).sum::<f64>() / seeds as f64;
        means.iter().map(|film| (film[pixel] - mean).powi(2)).sum::<f64>() / (seeds - 1) as f64
    };
    let between = (0..pixels).map(between).sum::<f64>() / pixels as f64;
    assert!((reported / between - 1.0).abs() < 0.1, "{reported} reported, {between} between seeds");
}

/// A gray of its own for each request; can be held back, and tells how many samples it took.
struct Shade {
    value: f32,
    calls: AtomicU64,
    gate: Gate,
    panic_at: Option<(UVec2, u32)>,
    delay: Duration,
}

/// Lets so many samples through.
#[derive(Default)]
struct Gate {
    left: Mutex<Option<u64>>,
    opened: Condvar,
}

impl Gate {
    fn set(&self, left: Option<u64>) {
        *self.left.lock().unwrap() = left;
        self.opened.notify_all();
    }

    fn pass(&self) {
        let closed = |left: &mut Option<u64>| *left == Some(0);
        let mut left = self.opened.wait_while(self.left.lock().unwrap(), closed).unwrap();
        if let Some(left) = left.as_mut() {
            *left -= 1;
        }
    }
}

impl Shade {
    fn new(value: f32) -> Arc<Self> {
        Self::build(value, None, None, Duration::ZERO)
    }

    fn build(
        value: f32,
        gate: Option<u64>,
        panic_at: Option<(UVec2, u32)>,
        delay: Duration,
    ) -> Arc<Self> {
        let gate = Gate { left: Mutex::new(gate), ..Default::default() };
        Arc::new(Self { value, calls: AtomicU64::new(0), gate, panic_at, delay })
    }

    fn calls(&self) -> u64 {
        self.calls.load(Ordering::SeqCst)
    }
}

impl PixelSampler for Shade {
    fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
        self.calls.fetch_add(1, Ordering::SeqCst);
        self.gate.pass();
        if !self.delay.is_zero() {
            std::thread::sleep(self.delay);
        }
        assert_ne!(self.panic_at, Some((pixel, number.index())), "a fault on purpose");
        PathSample {
            background: Rgb::splat(self.value),
            tracking_steps: STEPS,
            ..Default::default()
        }
    }
}

fn session() -> (Arc<Session>, Receiver<()>) {
    let (sender, receiver) = channel();
    let session = Session::new(Some(2), move || {
        // A test that has ended listens no more.
        let _ = sender.send(());
    })
    .unwrap();
    (Arc::new(session), receiver)
}

fn request(sampler: &Arc<Shade>, spp: u32, generation: u64) -> Request {
    Request {
        sampler: Arc::clone(sampler) as _,
        size: SIZE,
        spp,
        generation,
        resume: None,
        provisional: false,
    }
}

/// Waits for a picture that will do.
fn wait(
    session: &Session,
    published: &Receiver<()>,
    will_do: impl Fn(&Picture) -> bool,
) -> Arc<Picture> {
    let start = Instant::now();
    loop {
        if let Some(picture) = session.latest().filter(|picture| will_do(picture)) {
            return picture;
        }
        assert!(start.elapsed() < PATIENCE, "no such picture in {PATIENCE:?}");
        let _ = published.recv_timeout(Duration::from_millis(50));
    }
}

#[test]
fn a_request_is_refined_to_its_end() {
    let (session, published) = session();
    assert!(session.latest().is_none());
    session.start(request(&Shade::new(0.5), 3, 7));
    let picture = wait(&session, &published, |picture| picture.stats.finished);
    assert_eq!((picture.generation, picture.size, picture.complete), (7, SIZE, true));
    assert_eq!(picture.stats.samples_per_pixel, 3.0);
    assert_eq!(picture.stats.paths, u64::from(SIZE.x * SIZE.y) * 3);
    assert_eq!(picture.stats.noise, Some(0.0));
    assert!(picture.pixels.iter().all(|pixel| pixel[..3] == [0.5; 3]));
}

/// The first picture needs one sample in 64 and covers the film all the same.
#[test]
fn the_first_picture_is_coarse_and_whole() {
    let (session, published) = session();
    let blocks = u64::from(SIZE.x.div_ceil(8) * SIZE.y.div_ceil(8));
    let sampler = Shade::build(0.5, Some(blocks), None, Duration::ZERO);
    session.start(request(&sampler, 0, 1));
    let picture = wait(&session, &published, |_| true);
    assert!(!picture.complete && !picture.stats.finished);
    assert_eq!(picture.stats.paths, blocks);
    assert!(picture.pixels.iter().all(|pixel| pixel[0] == 0.5));
    sampler.gate.set(None);
    wait(&session, &published, |picture| picture.complete);
}

#[test]
fn the_latest_request_wins_and_the_old_picture_stays_until_then() {
    let (session, published) = session();
    let first = Shade::new(0.1);
    session.start(request(&first, 0, 1));
    wait(&session, &published, |picture| picture.complete);
    let blocks = u64::from(SIZE.x.div_ceil(4) * SIZE.y.div_ceil(4));
    let second = Shade::build(0.2, Some(10), None, Duration::ZERO);
    session.start(request(&second, 0, 2));
    while second.calls() < 12 {
        std::thread::yield_now();
    }
    let taken = first.calls();
    assert_eq!(session.latest().unwrap().generation, 1, "nothing new to show yet");
    let (third, fourth) = (Shade::new(0.3), Shade::new(0.4));
    session.start(request(&third, 0, 3));
    session.start(request(&fourth, 0, 4));
    second.gate.set(None);
    let picture = wait(&session, &published, |picture| picture.generation == 4);
    assert!(picture.pixels.iter().all(|pixel| pixel[0] == 0.4));
    assert_eq!(first.calls(), taken, "the first request went on");
    assert_eq!(third.calls(), 0, "the third request was never current");
    assert!(second.calls() <= blocks + 2, "the second got more than its first picture");
}

/// A request that has shown something is given up within one sample a thread.
#[test]
fn cancelling_is_prompt() {
    let (session, published) = session();
    let old = Shade::new(0.1);
    session.start(request(&old, 0, 1));
    wait(&session, &published, |picture| picture.complete);
    old.gate.set(Some(0));
    std::thread::sleep(Duration::from_millis(50));
    session.start(request(&Shade::new(0.2), 1, 2));
    let before = old.calls();
    old.gate.set(None);
    wait(&session, &published, |picture| picture.generation == 2);
    assert!(old.calls() - before <= 2, "{} samples late", old.calls() - before);
}

/// Requests that come faster than even coarse pictures must not starve the screen.
#[test]
fn a_drag_shows_pictures_on_the_way() {
    let (session, published) = session();
    let shown = Arc::new(AtomicU32::new(0));
    for generation in 1..60 {
        let slow = Shade::build(0.1, None, None, Duration::from_millis(2));
        session.start(request(&slow, 0, generation));
        std::thread::sleep(Duration::from_millis(8));
        if published.try_iter().count() > 0 {
            shown.fetch_add(1, Ordering::Relaxed);
        }
    }
    assert!(shown.load(Ordering::Relaxed) >= 3, "{shown:?} pictures during the drag");
}

#[test]
fn pause_holds_and_resume_goes_on() {
    let (session, published) = session();
    let sampler = Shade::new(0.1);
    session.start(request(&sampler, 0, 1));
    wait(&session, &published, |picture| picture.complete);
    session.set_paused(true);
    // The film served after the pause is a barrier: no work follows it.
    let film = session.snapshot().recv_timeout(PATIENCE).unwrap();
    let held = sampler.calls();
    std::thread::sleep(Duration::from_millis(30));
    assert_eq!(sampler.calls(), held);
    assert_eq!(film.totals.paths, held);
    // An edit while paused still shows its first picture, and no more.
    let edited = Shade::new(0.2);
    session.start(request(&edited, 0, 2));
    let picture = wait(&session, &published, |picture| picture.generation == 2);
    session.snapshot().recv_timeout(PATIENCE).unwrap();
    assert!(!picture.complete);
    assert_eq!(edited.calls(), picture.stats.paths);
    session.set_paused(false);
    wait(&session, &published, |picture| picture.complete && picture.generation == 2);
}

#[test]
fn steps_come_when_asked_for_even_after_the_end() {
    let (session, published) = session();
    session.start(request(&Shade::new(1.0), 4, 1));
    let picture = wait(&session, &published, |picture| picture.stats.finished);
    assert!(picture.layer.numbers.is_empty());

    session.set_extras(Extras { layer: Some(Layer::Steps), ..Extras::default() });
    let picture = wait(&session, &published, |picture| !picture.layer.numbers.is_empty());
    assert_eq!((picture.generation, picture.stats.samples_per_pixel), (1, 4.0));
    assert_eq!(picture.layer.numbers, vec![STEPS as f32; picture.pixels.len()]);
    assert_eq!(picture.layer.range, Some([STEPS as f32; 2]));
    session.start(request(&Shade::new(1.0), 4, 2));
    let picture = wait(&session, &published, |picture| picture.generation == 2);
    assert_eq!(picture.layer.numbers.len(), picture.pixels.len());

    session.set_extras(Extras::default());
    session.start(request(&Shade::new(1.0), 4, 3));
    let picture = wait(&session, &published, |picture| picture.generation == 3);
    assert!(picture.layer.numbers.is_empty());
}

/// The better sampler is slow: what was shown stays until as much of the new picture is there.
#[test]
fn an_improved_render_starts_over_behind_the_picture() {
    let (session, published) = session();
    let pixels = u64::from(SIZE.x * SIZE.y);
    session.start(Request { provisional: true, ..request(&Shade::new(0.1), 3, 1) });
    let before = wait(&session, &published, |picture| picture.stats.paths == 3 * pixels);
    assert!(before.complete && !before.stats.finished, "a better sampler is to come");
    let snapshot = session.snapshot();
    std::thread::sleep(Duration::from_millis(20));
    assert!(snapshot.try_recv().is_err(), "it waits for that");

    session.improve(7, Some(Shade::new(0.9)));
    let better = Shade::build(0.2, Some(3 * pixels - 1), None, Duration::ZERO);
    session.improve(1, Some(better.clone()));
    while better.calls() < 3 * pixels - 1 {
        std::thread::yield_now();
    }
    std::thread::sleep(Duration::from_millis(20));
    assert!(Arc::ptr_eq(&before, &session.latest().unwrap()), "the old picture has more samples");
    better.gate.set(None);
    let after = wait(&session, &published, |picture| picture.stats.finished);
    assert_eq!((after.generation, after.stats.paths), (1, 3 * pixels));
    assert!(after.pixels.iter().all(|pixel| pixel[0] == 0.2));
    let film = snapshot.recv_timeout(PATIENCE).unwrap();
    assert_eq!(film, session.snapshot().recv_timeout(PATIENCE).unwrap());
}

#[test]
fn improvements_wait_for_the_end_of_a_pause_and_may_fail_to_come() {
    let (session, published) = session();
    session.start(Request { provisional: true, ..request(&Shade::new(0.1), 0, 1) });
    wait(&session, &published, |picture| picture.complete);
    session.set_paused(true);
    session.snapshot().recv_timeout(PATIENCE).unwrap();
    let better = Shade::new(0.2);
    session.improve(1, Some(better.clone()));
    let film = session.snapshot().recv_timeout(PATIENCE).unwrap();
    assert_eq!((better.calls(), film.sample_range().0 > 0), (0, true));
    session.set_paused(false);
    wait(&session, &published, |picture| picture.pixels[0][0] == 0.2);

    session.start(Request { provisional: true, ..request(&Shade::new(0.3), 2, 2) });
    wait(&session, &published, |picture| picture.generation == 2 && picture.complete);
    assert!(!session.latest().unwrap().stats.finished);
    session.improve(2, None);
    let picture = wait(&session, &published, |picture| picture.stats.finished);
    assert_eq!((picture.generation, picture.stats.samples_per_pixel), (2, 2.0));
}

/// What shows nothing yet loses no time: it is broken off for the better sampler.
#[test]
fn an_improvement_does_not_wait_for_a_first_picture() {
    let (session, published) = session();
    let endless = Shade::build(0.1, None, None, Duration::from_millis(5));
    session.start(Request { provisional: true, ..request(&endless, 1, 1) });
    while endless.calls() == 0 {
        std::thread::yield_now();
    }
    session.improve(1, Some(Shade::new(0.2)));
    let picture = wait(&session, &published, |_| true);
    assert_eq!(picture.pixels[0][0], 0.2);
    assert!(endless.calls() < 20, "{} samples in vain", endless.calls());
}

#[test]
fn snapshots_come_at_any_time_and_can_be_resumed() {
    let (session, published) = session();
    assert!(session.snapshot().recv_timeout(PATIENCE).is_err(), "there is nothing to copy");
    session.start(request(&Shade::new(0.25), 4, 1));
    session.snapshot().recv_timeout(PATIENCE).unwrap();
    wait(&session, &published, |picture| picture.stats.finished);
    let film = session.snapshot().recv_timeout(PATIENCE).unwrap();
    assert_eq!(film.sample_range(), (4, 4));
    let more = Shade::new(0.75);
    let resume = Some(Resume { film, seconds: 100.0, cpu_seconds: 50.0 });
    session.start(Request { resume, ..request(&more, 12, 2) });
    let picture =
        wait(&session, &published, |picture| picture.generation == 2 && picture.stats.finished);
    assert_eq!(more.calls(), u64::from(SIZE.x * SIZE.y) * 8);
    assert!((picture.pixels[77][0] - (0.25 * 4.0 + 0.75 * 8.0) / 12.0).abs() < 1e-6);
    assert!((100.0..200.0).contains(&picture.stats.seconds), "the time goes on as well");
    assert!((50.0..100.0).contains(&picture.stats.cpu_seconds), "and so does CPU time");
}

/// What a film was begun with may not be what is at hand at first: its samples wait.
#[test]
fn a_resumed_film_is_shown_and_waits_for_the_better_sampler() {
    let (session, published) = session();
    session.start(request(&Shade::new(0.25), 4, 1));
    wait(&session, &published, |picture| picture.stats.finished);
    let film = session.snapshot().recv_timeout(PATIENCE).unwrap();
    let (poor, better) = (Shade::new(0.9), Shade::new(0.75));
    let resume = Some(Resume { film, seconds: 0.0, cpu_seconds: 0.0 });
    session.start(Request { resume, provisional: true, ..request(&poor, 8, 2) });
    let picture = wait(&session, &published, |picture| picture.generation == 2);
    assert_eq!((picture.pixels[77][0], picture.stats.samples_per_pixel), (0.25, 4.0));
    std::thread::sleep(Duration::from_millis(100));
    session.improve(2, Some(better.clone()));
    let picture =
        wait(&session, &published, |picture| picture.generation == 2 && picture.stats.finished);
    assert_eq!((poor.calls(), better.calls()), (0, u64::from(SIZE.x * SIZE.y) * 4));
    assert_eq!(picture.pixels[77][0], 0.5);
}

#[test]
fn a_faulty_sampler_is_reported_and_survived() {
    let (session, published) = session();
    let at = (UVec2::new(33, 20), 2);
    session.start(request(&Shade::build(0.1, None, Some(at), Duration::ZERO), 0, 5));
    let start = Instant::now();
    while session.last_failure().is_none() && start.elapsed() < PATIENCE {
        let _ = published.recv_timeout(Duration::from_millis(50));
    }
    let (generation, failure) = session.last_failure().unwrap();
    assert_eq!((generation, failure.at), (5, Some(at)));
    assert!(failure.message.contains("on purpose"));
    let film = session.snapshot().recv_timeout(PATIENCE).unwrap();
    assert_eq!(film.samples(at.0), 2);
    session.start(request(&Shade::new(0.9), 1, 6));
    wait(&session, &published, |picture| picture.generation == 6 && picture.stats.finished);
    assert!(session.last_failure().is_none());
}

#[test]
fn impossible_requests_are_reported() {
    let (session, published) = session();
    let huge = Request { size: UVec2::splat(1 << 22), ..request(&Shade::new(0.1), 1, 1) };
    session.start(huge);
    published.recv_timeout(PATIENCE).unwrap();
    let (_, failure) = session.last_failure().unwrap();
    assert!(failure.message.contains("memory"), "{}", failure.message);
    session.start(request(&Shade::new(0.1), 1, 2));
    wait(&session, &published, |picture| picture.generation == 2);
}

#[test]
fn dropping_ends_work_at_once() {
    let (session, published) = session();
    let sampler = Shade::new(0.1);
    session.start(request(&sampler, 0, 1));
    wait(&session, &published, |_| true);
    drop(session);
    let end = sampler.calls();
    std::thread::sleep(Duration::from_millis(20));
    assert_eq!(sampler.calls(), end);
}
