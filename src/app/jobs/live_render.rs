//! Keeps the picture up to date with the document: decides what is stale, builds and starts it,
//! and lets every edit of a fast drag come to its first picture.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::UVec2;

use super::built::{BuiltScene, Grids, RenderStart};
use super::probe_placer::ProbePlacer;
use super::scene_loader::{LoadJob, LoadOutcome, LoadReport, Loader};
use crate::app::ui::notices::Notice;
use crate::error::{Error, Result};
use crate::render::picture::Extras;
use crate::render::{Area, Layer, Picture, Resume, Session};
use crate::scene::settings::{FilmSettings, TimeSettings};
use crate::scene::{Note, Settings, VolumeCache};
use crate::transport::Scene;
use crate::transport::prepare::SceneProbes;

/// Time after which a build gives way to the next edit, and shows its progress.
const BUILD_PATIENCE: Duration = Duration::from_millis(250);
/// Bytes that volumes of frames which are not shown may take.
const ROOM: usize = 1 << 30;

/// An event since the last frame.
pub enum News {
    /// A file was opened.
    Opened {
        /// Name of the source, as the user gave it.
        source: String,
        /// Settings of the scene.
        settings: Box<Settings>,
        /// The guesses made for a bare volume.
        notes: Vec<Note>,
        /// Notice on how a snapshot goes on, where one was opened, which keeps the size of its
        /// film.
        reopened: Option<Notice>,
    },
    /// A file could not be opened, or a sample could not be taken.
    Failed(String),
    /// An edit could not be built.
    Refused(String),
    /// The settings are built.
    Accepted,
    /// A render was started or requested; the number is its generation.
    Started(u64),
}

/// The loader and the session, and what they are at.
pub struct LiveRender {
    loader: Loader,
    /// The volumes that were read, which the second side shares.
    cache: Arc<VolumeCache>,
    session: Arc<Session>,
    probe_placer: Arc<ProbePlacer>,
    built: Option<BuiltScene>,
    grids: Arc<Grids>,
    opening: Option<(String, Instant)>,
    building: Option<(Settings, Instant)>,
    /// The number of the latest request to the loader.
    request: u64,
    /// Settings that could not be built, so that they are not tried again in every frame.
    refused: Option<Settings>,
    started: Option<Started>,
    generation: u64,
    /// Latest generation whose failure was reported.
    failed: u64,
    paused: bool,
    /// Whether the render waits for something else that needs the machine.
    held: bool,
    extras: Extras,
    /// The pixels that get all samples.
    area: Option<Area>,
    /// Whether files of the scene have changed since it was built.
    is_stale: bool,
    /// Whether `built` is another render's, which is not what this one is to show.
    built_is_borrowed: bool,
    picture: Option<Arc<Picture>>,
    /// Samples of the snapshot that was opened last, until its render starts.
    resume: Option<Resume>,
}

/// The render under way.
struct Started {
    scene: Arc<Scene>,
    /// Settings that the render was built from, with the film's own size.
    settings: Settings,
    generation: u64,
}

impl Started {
    fn new(built: &BuiltScene, start: RenderStart) -> Self {
        let mut settings = built.settings.clone();
        settings.film.size = start.size.into();
        Self { scene: built.scene.clone(), settings, generation: start.generation }
    }
}

impl LiveRender {
    /// Starts the loader and the session with `threads` workers (`None`: as many as fit);
    /// `wake` asks the window for a frame.
    pub fn new(
        threads: Option<usize>,
        wake: impl Fn() + Clone + Send + Sync + 'static,
    ) -> Result<Self> {
        let session = Arc::new(Session::new(threads, wake.clone())?);
        let cache = Arc::new(VolumeCache::with_room(ROOM));
        Self::with_cache(session, threads, cache, wake)
    }

    /// A second render of the same volumes under another strategy. It shows nothing until it has
    /// built the scene with that strategy.
    pub fn second_render(
        &self,
        threads: Option<usize>,
        wake: impl Fn() + Clone + Send + Sync + 'static,
    ) -> Result<Self> {
        let session = Arc::new(Session::new(threads, wake.clone())?);
        let mut second_render = Self::with_cache(session, threads, self.cache.clone(), wake)?;
        second_render.built = self.built.clone();
        second_render.grids = self.grids.clone();
        second_render.built_is_borrowed = true;
        Ok(second_render)
    }

    fn with_cache(
        session: Arc<Session>,
        threads: Option<usize>,
        cache: Arc<VolumeCache>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self> {
        let probe_placer = Arc::new(ProbePlacer::new(session.clone(), threads)?);
        Ok(Self {
            loader: Loader::new(probe_placer.clone(), cache.clone(), wake)?,
            cache,
            session,
            probe_placer,
            built: None,
            grids: Arc::default(),
            opening: None,
            building: None,
            request: 0,
            refused: None,
            started: None,
            generation: 0,
            failed: 0,
            paused: false,
            held: false,
            extras: Extras::default(),
            area: None,
            is_stale: false,
            built_is_borrowed: false,
            picture: None,
            resume: None,
        })
    }

    /// Opens a path or `builtin:NAME`; what is shown stays until that is built.
    pub fn open(&mut self, source: &str) {
        self.building = None;
        self.opening = Some((source.to_owned(), Instant::now()));
        self.request = self.loader.request(LoadJob::Open(source.to_owned()), None);
    }

    /// Stops opening or building.
    pub fn cancel(&mut self) {
        self.loader.cancel();
        self.opening = None;
        if let Some((settings, _)) = self.building.take() {
            self.refused = Some(settings);
        }
    }

    /// Whether an edit is being built, which starts another film.
    pub fn is_building(&self) -> bool {
        self.building.is_some()
    }

    /// The source that is being opened.
    pub fn opening(&self) -> Option<&str> {
        self.opening.as_ref().map(|(source, _)| source.as_str())
    }

    /// The fraction done of a load or build that takes long enough to mention.
    pub fn progress(&self) -> Option<f32> {
        let opening = self.opening.as_ref().map(|(_, since)| since);
        let building = self.building.as_ref().map(|(_, since)| since);
        let since = opening.or(building)?;
        if since.elapsed() > BUILD_PATIENCE { self.loader.progress() } else { None }
    }

    /// The latest picture.
    pub fn picture(&self) -> Option<&Arc<Picture>> {
        self.picture.as_ref()
    }

    /// The scene that was built last, and its settings.
    pub fn built(&self) -> Option<&BuiltScene> {
        self.built.as_ref()
    }

    /// The probes of the scene that was built last, once they are there.
    pub fn probes(&self) -> Option<Arc<SceneProbes>> {
        self.probe_placer.probes(self.built.as_ref()?)
    }

    /// The grids of all files seen so far.
    pub fn grids(&self) -> &Arc<Grids> {
        &self.grids
    }

    /// The session of the render, for snapshots of its film.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// Settings that the session's film was built from, with its own size.
    pub fn rendered(&self) -> Option<&Settings> {
        self.started.as_ref().map(|started| &started.settings)
    }

    /// Whether the render is of the scene of these settings, on whatever film.
    pub fn renders(&self, settings: &Settings) -> bool {
        self.rendered().is_some_and(|rendered| same_scene(rendered, settings))
    }

    /// The volumes that were read.
    pub fn cache(&self) -> &VolumeCache {
        &self.cache
    }

    /// Whether sampling is paused.
    pub fn paused(&self) -> bool {
        self.paused
    }

    /// Pauses or resumes sampling.
    pub fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
        self.session.set_paused(paused || self.held);
    }

    /// Whether the render waits for something else that needs the machine.
    pub fn held(&self) -> bool {
        self.held
    }

    /// Lets the render wait for something else, or go on unless it is paused.
    pub fn set_held(&mut self, held: bool) {
        if self.held != held {
            self.held = held;
            self.session.set_paused(self.paused || held);
        }
    }

    /// Which layer pictures bring along, if any.
    pub fn set_layer(&mut self, layer: Option<Layer>) {
        self.set_extras(Extras { layer, ..self.extras });
    }

    /// Sets whether pictures bring the variance of each pixel along.
    pub fn set_shows_variance(&mut self, shows: bool) {
        self.set_extras(Extras { variance: shows, ..self.extras });
    }

    fn set_extras(&mut self, extras: Extras) {
        if self.extras != extras {
            self.extras = extras;
            self.session.set_extras(extras);
        }
    }

    /// Gives all samples to the pixels of `area`, or to all pixels.
    pub fn render_region_only(&mut self, area: Option<Area>) {
        if self.area != area {
            self.area = area;
            self.session.render_region_only(area);
        }
    }

    /// Throws the samples away and starts again.
    pub fn restart(&mut self) {
        self.started = None;
        self.refused = None;
        self.set_paused(false);
    }

    /// Builds the scene anew, whose files have changed; what is shown stays until that is done.
    pub fn reload(&mut self) {
        self.is_stale = true;
        self.refused = None;
    }

    /// Whether the picture shown is one of the latest render.
    pub fn is_current(&self) -> bool {
        match (&self.started, &self.picture) {
            (Some(started), Some(picture)) => picture.generation >= started.generation,
            _ => false,
        }
    }

    /// Takes in what the threads have done. Called at the start of a frame.
    pub fn poll(&mut self) -> Vec<News> {
        let mut news = Vec::new();
        while let Some(report) = self.loader.poll() {
            match report {
                LoadReport::Ended(outcome) => self.take_in(*outcome, &mut news),
                LoadReport::Grids(grids) => self.grids = grids,
            }
        }
        self.picture = self.session.latest();
        if let Some((generation, failure)) = self.session.last_failure()
            && self.failed < generation
        {
            self.failed = generation;
            let replay = failure.replay_options().map_or_else(String::new, |options| {
                format!(
                    "; save the scene and follow the path with: flambeau replay SCENE {options}"
                )
            });
            news.push(News::Failed(format!("{failure}{replay}")));
        }
        news
    }

    fn take_in(&mut self, outcome: LoadOutcome, news: &mut Vec<News>) {
        if outcome.number == self.request {
            self.building = None;
            self.opening = None;
        } else if let LoadJob::Open(_) = &outcome.job {
            // It was done just before another request; nobody waits for it any more.
            return;
        }
        match (outcome.job, outcome.result) {
            (_, Err(Error::Cancelled)) => {}
            (job, Ok(built)) => {
                if let Some(start) = outcome.started {
                    self.started = Some(Started::new(&built, start));
                }
                news.push(match job {
                    LoadJob::Build(_) => News::Accepted,
                    LoadJob::Open(source) => {
                        self.refused = None;
                        let (settings, notes) = (built.settings.clone(), built.notes.clone());
                        let (resume, reopened) = outcome
                            .reopened
                            .map(|reopened| (reopened.resume, reopened.notice))
                            .unzip();
                        self.resume = resume.flatten();
                        News::Opened { source, settings: Box::new(settings), notes, reopened }
                    }
                });
                self.built = Some(built);
                self.built_is_borrowed = false;
            }
            (LoadJob::Open(_), Err(error)) => news.push(News::Failed(error.to_string())),
            (LoadJob::Build(settings), Err(error)) => {
                self.refused = Some(*settings);
                news.push(News::Refused(error.to_string()));
            }
        }
    }

    /// Brings the render in line with `settings` on a film of `size` pixels. Another size or other
    /// settings of the film start the scene that is there on a new film; settings of anything else
    /// build a new scene, which then starts in its place. The samples go on where neither differs.
    /// Called at the end of a frame; gives the time after which it should be called again, where
    /// the build under way is too young to give way to this one.
    pub fn update(
        &mut self,
        settings: &Settings,
        size: UVec2,
        news: &mut Vec<News>,
    ) -> Option<Duration> {
        let built = self.built.as_ref();
        self.built_is_borrowed &= built.is_some_and(|built| !same_scene(&built.settings, settings));
        if !self.built_is_borrowed {
            self.start(&settings.film, size, news);
        }
        self.build(settings, size, news)
    }

    /// The next render's number, which is news.
    fn next_start(&mut self, size: UVec2, news: &mut Vec<News>) -> RenderStart {
        self.generation += 1;
        news.push(News::Started(self.generation));
        RenderStart { size, generation: self.generation }
    }

    /// Starts the scene that was built last on this film, unless it runs already. The session sees
    /// to it that each start of a fast series may show its first picture.
    fn start(&mut self, film: &FilmSettings, size: UVec2, news: &mut Vec<News>) {
        let Some(built) = &mut self.built else { return };
        let wanted = FilmSettings { size: size.into(), ..*film };
        let runs = |started: &Started| {
            Arc::ptr_eq(&started.scene, &built.scene) && started.settings.film == wanted
        };
        if self.started.as_ref().is_some_and(runs) {
            return;
        }
        built.settings.film = wanted;
        let built = built.clone();
        let start = self.next_start(size, news);
        let resume = self.resume.take();
        if resume.as_ref().is_some_and(|resume| resume.film.size() != size) {
            let text = "The graphics card cannot display a picture of this size, so it cannot be \
                        resumed. It is rendered from the start, smaller.";
            news.push(News::Failed(text.to_owned()));
        }
        let resume = resume.filter(|resume| resume.film.size() == size);
        self.probe_placer.start(&built, start, resume);
        self.started = Some(Started::new(&built, start));
    }

    /// Asks for a build where the settings differ from what was built last.
    fn build(
        &mut self,
        settings: &Settings,
        size: UVec2,
        news: &mut Vec<News>,
    ) -> Option<Duration> {
        let is_same = |other: &Settings| same_scene(other, settings);
        let built = self.built.as_ref()?;
        if is_same(&built.settings) && !self.is_stale {
            if self.refused.take().is_some() {
                news.push(News::Accepted);
            }
            return None;
        }
        if self.opening.is_some() || self.refused.as_ref().is_some_and(is_same) {
            return None;
        }
        if let Some((asked, since)) = &self.building
            && !self.is_stale
            && (is_same(asked) || since.elapsed() < BUILD_PATIENCE)
        {
            return (!is_same(asked)).then(|| BUILD_PATIENCE.saturating_sub(since.elapsed()));
        }
        self.is_stale = false;
        self.building = Some((settings.clone(), Instant::now()));
        let start = self.next_start(size, news);
        self.request = self.loader.request(LoadJob::Build(Box::new(settings.clone())), Some(start));
        None
    }
}

/// Whether two settings build the same scene: all but the film decides.
fn same_scene(a: &Settings, b: &Settings) -> bool {
    same_shot(a, b) && a.strategy == b.strategy
}

/// Whether two settings show the same picture: all but the film and the strategy decides.
pub fn same_shot(a: &Settings, b: &Settings) -> bool {
    a.camera == b.camera && same_matter(a, b)
}

/// Whether volumes look the same at two times. The pace of frames matters to what moves only.
fn same_time(a: &TimeSettings, b: &TimeSettings) -> bool {
    let moves = a.shutter > 0.0 || a.since_whole_frame() != 0.0;
    a.frame == b.frame && a.shutter == b.shutter && (!moves || a.fps == b.fps)
}

/// Whether two settings are of the same things under the same light, wherever the camera is.
pub fn same_matter(a: &Settings, b: &Settings) -> bool {
    let Settings {
        scene,
        camera: _,
        film: _,
        time,
        path,
        environment,
        volume,
        light,
        surface,
        strategy: _,
    } = a;
    same_time(time, &b.time)
        && *scene == b.scene
        && *path == b.path
        && *environment == b.environment
        && *volume == b.volume
        && *light == b.light
        && *surface == b.surface
}
