//! Starts renders, and places their probes meanwhile on a thread of its own, so that no picture
//! waits for them: a render whose probes are not there yet begins without and starts over when they
//! are. Probes are reused while what they are made from stays the same, whatever the camera does.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::built::{BuiltScene, RenderStart};
use super::mailbox::Mailbox;
use crate::error::{Error, Progress, Result};
use crate::render::pool::{Pool, Priority};
use crate::render::{Request, Resume, Session};
use crate::scene::Settings;
use crate::transport::prepare::SceneProbes;
use crate::transport::probes::Probes;
use crate::transport::{Frame, PixelSampler, Scene};

/// Places the probes of a scene unless they are given up on the way.
type PlaceProbes = dyn Fn(&Scene, Progress) -> Result<Option<SceneProbes>> + Send + Sync;

/// The handle of the thread. Dropping it stops what is being placed and ends the thread.
pub struct ProbePlacer {
    session: Arc<Session>,
    shared: Arc<Shared>,
    thread: Option<std::thread::JoinHandle<()>>,
}

struct Shared {
    state: Mutex<PlacerState>,
    requests: Mailbox<PlaceRequest>,
    /// Grows when what is being placed is wanted no more.
    generation: AtomicU64,
}

/// A scene to place probes in, wanted as long as the generation is the present one.
struct PlaceRequest {
    built: BuiltScene,
    generation: u64,
}

#[derive(Default)]
struct PlacerState {
    /// The probes placed last, and the scene that they were placed in.
    ready: Option<(BuiltScene, Option<Arc<SceneProbes>>)>,
    /// The render that awaits its probes.
    waiting: Option<(BuiltScene, RenderStart)>,
}

impl ProbePlacer {
    /// Starts the thread, which has `threads` workers (`None`: as many as fit), for renders in
    /// `session`.
    ///
    /// # Errors
    /// When the system refuses to start threads.
    pub fn new(session: Arc<Session>, threads: Option<usize>) -> Result<Self> {
        let pool = Pool::new(threads, Priority::Background)?;
        let place = move |scene: &Scene, progress: Progress| {
            pool.install(|| SceneProbes::placed(scene, progress))
        };
        Self::with(session, place)
    }

    /// A placer that places probes by `place`.
    fn with(
        session: Arc<Session>,
        place: impl Fn(&Scene, Progress) -> Result<Option<SceneProbes>> + Send + Sync + 'static,
    ) -> Result<Self> {
        let shared = Arc::new(Shared {
            state: Mutex::default(),
            requests: Mailbox::default(),
            generation: AtomicU64::new(0),
        });
        let (worker, renders) = (shared.clone(), session.clone());
        let thread = std::thread::Builder::new()
            .name("probe placer".to_owned())
            .spawn(move || work(&worker, &renders, &place))
            .map_err(|error| Error::io("the thread that places probes", error))?;
        Ok(Self { session, shared, thread: Some(thread) })
    }

    /// Starts to render `built`, with its probes as soon as they are there, on from `resume` if
    /// there is any. The latest wins: of an earlier start they are placed no further, unless this
    /// one has the same.
    pub fn start(&self, built: &BuiltScene, start: RenderStart, resume: Option<Resume>) {
        let mut state = self.shared.state();
        let known = state.known(built);
        let provisional = known.is_none();
        let request = request(built, start, known.flatten(), provisional);
        self.session.start(Request { resume, ..request });
        let goes_on = provisional && state.waiting.as_ref().is_some_and(|(b, _)| same(b, built));
        // Only now, so that the render is there to be improved.
        state.waiting = provisional.then(|| (built.clone(), start));
        if goes_on {
            return;
        }
        let generation = self.shared.generation.fetch_add(1, Ordering::Relaxed) + 1;
        match provisional {
            true => self.shared.requests.post(PlaceRequest { built: built.clone(), generation }),
            false => self.shared.requests.clear(),
        }
    }

    /// The probes of `built`, if they are there.
    pub fn probes(&self, built: &BuiltScene) -> Option<Arc<SceneProbes>> {
        let state = self.shared.state();
        let (source, probes) = state.ready.as_ref()?;
        probes.clone().filter(|_| same(source, built))
    }
}

impl Drop for ProbePlacer {
    fn drop(&mut self) {
        self.shared.generation.fetch_add(1, Ordering::Relaxed);
        self.shared.requests.stop();
        if let Some(thread) = self.thread.take() {
            // A panic over there was reported there already.
            let _ = thread.join();
        }
    }
}

impl Shared {
    /// The state, also after a panic of the other side: it is sound after every statement.
    fn state(&self) -> MutexGuard<'_, PlacerState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps the probes that were placed, if they are still wanted; returns the render that awaits
    /// them.
    fn take_in(
        &self,
        built: BuiltScene,
        generation: u64,
        probes: Option<&Arc<SceneProbes>>,
    ) -> Option<(BuiltScene, RenderStart)> {
        let mut state = self.state();
        if self.generation.load(Ordering::Relaxed) != generation {
            return None;
        }
        state.ready = Some((built, probes.cloned()));
        state.waiting.take()
    }
}

impl PlacerState {
    /// The probes of `built` as far as known: `None` if they have to be placed first. Lets go of
    /// those that no strategy of the same scene could use.
    fn known(&mut self, built: &BuiltScene) -> Option<Option<Arc<SceneProbes>>> {
        self.ready = self.ready.take().filter(|(source, _)| same_places(source, built));
        if Probes::recipe(built.scene.strategy()).is_none() {
            return Some(None);
        }
        let (source, probes) = self.ready.as_mut().filter(|(source, _)| same(source, built))?;
        // The newer scene lets go of the older one.
        source.clone_from(built);
        Some(probes.clone())
    }
}

fn work(shared: &Shared, session: &Session, place: &PlaceProbes) {
    while let Some(PlaceRequest { built, generation }) = shared.requests.take() {
        let go_on = |_: f32| shared.generation.load(Ordering::Relaxed) == generation;
        let scene = built.scene.clone();
        // Should it fail, the render goes on without; its thread has reported why. Probes that were
        // given up are not taken in.
        let probes = catch_unwind(AssertUnwindSafe(|| place(&scene, &go_on)));
        let probes = probes.ok().and_then(Result::ok).flatten().map(Arc::new);
        if let Some((built, start)) = shared.take_in(built, generation, probes.as_ref()) {
            let sampler = probes.map(|probes| sampler(&built, start, Some(probes)));
            session.improve(start.generation, sampler);
        }
    }
}

fn sampler(
    built: &BuiltScene,
    start: RenderStart,
    probes: Option<Arc<SceneProbes>>,
) -> Arc<dyn PixelSampler> {
    let seed = built.settings.picture_seed();
    Arc::new(Frame::with_probes(built.scene.clone(), start.size, seed, probes))
}

/// Asks to render a scene with what there is of its probes.
fn request(
    built: &BuiltScene,
    start: RenderStart,
    probes: Option<Arc<SceneProbes>>,
    provisional: bool,
) -> Request {
    let RenderStart { size, generation } = start;
    let sampler = sampler(built, start, probes);
    let spp = built.settings.film.spp;
    Request { sampler, size, spp, generation, resume: None, provisional }
}

/// Whether two scenes have the same probes.
fn same(a: &BuiltScene, b: &BuiltScene) -> bool {
    Probes::recipe(a.scene.strategy()) == Probes::recipe(b.scene.strategy()) && same_places(a, b)
}

/// Whether two scenes would have the same probes with the same strategy.
fn same_places(a: &BuiltScene, b: &BuiltScene) -> bool {
    // All keys are named, so that a new one cannot leave stale probes. The film has no part in the
    // probes, the volumes are compared as they were built at their frame, and the strategy by its
    // recipe. Of the camera, only its position in the frame matters.
    let Settings {
        scene,
        camera: _,
        film: _,
        time: _,
        path,
        environment,
        volume: _,
        light,
        surface,
        strategy: _,
    } = &a.settings;
    *environment == b.settings.environment
        && *scene == b.settings.scene
        && *path == b.settings.path
        && *light == b.settings.light
        && *surface == b.settings.surface
        && a.scene.world.has_volumes_of(&b.scene.world)
        && (!Probes::heed_camera(&b.scene)
            || a.scene.camera.position() == b.scene.camera.position())
}

#[cfg(test)]
mod tests;
