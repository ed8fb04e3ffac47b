//! Keeps the picture up to date with the document: decides what is stale, builds and starts it,
//! and lets every edit of a fast drag come to its first picture.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::UVec2;

use super::loader::{Built, Grids, Job, Loader, Report};
use super::state::Document;
use crate::error::{Error, Result};
use crate::render::{Picture, Request, Session};
use crate::scene::Settings;
use crate::scene::settings::FilmSettings;
use crate::transport::{Frame, Scene};

/// A build that takes longer than this gives way to the next edit.
const PATIENCE: Duration = Duration::from_millis(250);

/// What happened since the last frame.
pub enum News {
    /// A file was opened.
    Opened {
        /// Where it came from, as the user named it.
        source: String,
        /// What it holds.
        settings: Settings,
        /// What was guessed for a bare volume, one a line.
        notes: Vec<String>,
    },
    /// A file could not be opened, or an edit could not be built.
    Failed(String),
    /// A render was started; the number is its generation.
    Started(u64),
}

/// The loader and the session, and what they are at.
pub struct Engine {
    loader: Loader,
    session: Session,
    built: Option<Built>,
    grids: Arc<Grids>,
    opening: Option<String>,
    building: Option<(Settings, Instant)>,
    /// Settings that could not be built, so that they are not tried again in every frame.
    refused: Option<Settings>,
    started: Option<Started>,
    generation: u64,
    /// The latest generation whose failure was told.
    failed: u64,
    paused: bool,
    picture: Option<Arc<Picture>>,
}

/// The render under way.
struct Started {
    scene: Arc<Scene>,
    settings: Settings,
    film: FilmKey,
    generation: u64,
}

/// What of the film makes another render.
#[derive(Clone, Copy, PartialEq, Eq)]
struct FilmKey {
    size: UVec2,
    seed: u64,
    spp: u32,
}

impl Engine {
    /// Starts the loader and the session with `threads` workers (`None`: as many as fit);
    /// `wake` asks the window for a frame.
    pub fn new(
        threads: Option<usize>,
        wake: impl Fn() + Clone + Send + Sync + 'static,
    ) -> Result<Self> {
        Ok(Self {
            loader: Loader::new(wake.clone())?,
            session: Session::new(threads, wake)?,
            built: None,
            grids: Arc::default(),
            opening: None,
            building: None,
            refused: None,
            started: None,
            generation: 0,
            failed: 0,
            paused: false,
            picture: None,
        })
    }

    /// Opens a path or `builtin:NAME`; what is shown stays until that is built.
    pub fn open(&mut self, source: &str) {
        self.building = None;
        self.opening = Some(source.to_owned());
        self.loader.request(Job::Open(source.to_owned()));
    }

    /// Stops opening or building.
    pub fn cancel(&mut self) {
        self.loader.cancel();
        self.opening = None;
        if let Some((settings, _)) = self.building.take() {
            self.refused = Some(settings);
        }
    }

    /// What is being opened.
    pub fn opening(&self) -> Option<&str> {
        self.opening.as_deref()
    }

    /// The fraction done of a load or build that takes long enough to mention.
    pub fn progress(&self) -> Option<f32> {
        let long = self.building.as_ref().is_some_and(|(_, since)| since.elapsed() > PATIENCE);
        if self.opening.is_some() || long { self.loader.progress() } else { None }
    }

    /// The latest picture.
    pub fn picture(&self) -> Option<&Arc<Picture>> {
        self.picture.as_ref()
    }

    /// The scene that was built last, and its settings.
    pub fn built(&self) -> Option<&Built> {
        self.built.as_ref()
    }

    /// The grids of all files seen so far.
    pub fn grids(&self) -> &Arc<Grids> {
        &self.grids
    }

    /// The session, for snapshots of its film.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// What the film of the session shows: the settings that it was built from, with its own size.
    pub fn rendered(&self) -> Option<&Settings> {
        self.started.as_ref().map(|started| &started.settings)
    }

    /// Whether sampling is paused.
    pub fn paused(&self) -> bool {
        self.paused
    }

    /// Pauses or resumes sampling.
    pub fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
        self.session.set_paused(paused);
    }

    /// Throws the samples away and starts again.
    pub fn restart(&mut self) {
        self.started = None;
        self.refused = None;
        self.set_paused(false);
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
            let outcome = match report {
                Report::Ended(outcome) => outcome,
                Report::Grids(grids) => {
                    self.grids = grids;
                    continue;
                }
            };
            self.building = None;
            match (outcome.job, outcome.result) {
                (_, Err(Error::Cancelled)) => self.opening = None,
                (Job::Open(source), Ok(built)) => {
                    self.opening = None;
                    self.refused = None;
                    let (settings, notes) = (built.settings.clone(), built.notes.clone());
                    news.push(News::Opened { source, settings, notes });
                    self.built = Some(built);
                }
                (Job::Open(_), Err(error)) => {
                    self.opening = None;
                    news.push(News::Failed(error.to_string()));
                }
                (Job::Build(_), Ok(built)) => self.built = Some(built),
                (Job::Build(settings), Err(error)) => {
                    self.refused = Some(settings);
                    news.push(News::Failed(error.to_string()));
                }
            }
        }
        self.picture = self.session.latest();
        if let Some((generation, failure)) = self.session.last_failure()
            && self.failed < generation
        {
            self.failed = generation;
            news.push(News::Failed(failure.to_string()));
        }
        news
    }

    /// Brings the render in line with the document on a film of `size` pixels. Called at the end
    /// of a frame; gives the time after which it should be called again, if it had to wait.
    pub fn update(
        &mut self,
        document: &Document,
        size: UVec2,
        news: &mut Vec<News>,
    ) -> Option<Duration> {
        let film = &document.settings.film;
        let film = FilmKey { size, seed: film.seed, spp: film.spp };
        self.start(film, news);
        self.build(&document.settings)
    }

    /// Starts the scene that was built last, unless it runs already. The session itself sees to it
    /// that each start of a fast series may show its first picture.
    fn start(&mut self, film: FilmKey, news: &mut Vec<News>) {
        let Some(built) = &self.built else { return };
        let running =
            |started: &Started| Arc::ptr_eq(&started.scene, &built.scene) && started.film == film;
        if self.started.as_ref().is_some_and(running) {
            return;
        }
        self.generation += 1;
        let scene = built.scene.clone();
        let sampler = Frame { scene: scene.clone(), size: film.size, seed: film.seed };
        self.session.start(Request {
            sampler: Arc::new(sampler),
            size: film.size,
            spp: film.spp,
            generation: self.generation,
            resume: None,
        });
        let mut settings = built.settings.clone();
        settings.film = FilmSettings { size: film.size.into(), seed: film.seed, spp: film.spp };
        self.started = Some(Started { scene, settings, film, generation: self.generation });
        news.push(News::Started(self.generation));
    }

    /// Asks for a build where the settings differ from what was built last.
    fn build(&mut self, settings: &Settings) -> Option<Duration> {
        let fresh = |other: &Settings| same_scene(other, settings);
        let built = self.built.as_ref()?;
        let done = fresh(&built.settings) || self.refused.as_ref().is_some_and(fresh);
        if done || self.opening.is_some() {
            return None;
        }
        if let Some((asked, since)) = &self.building
            && (fresh(asked) || since.elapsed() < PATIENCE)
        {
            return (!fresh(asked)).then(|| PATIENCE.saturating_sub(since.elapsed()));
        }
        self.building = Some((settings.clone(), Instant::now()));
        self.loader.request(Job::Build(settings.clone()));
        None
    }
}

/// Whether two settings build the same scene: all but the film decides.
fn same_scene(a: &Settings, b: &Settings) -> bool {
    let Settings { camera, film: _, path, environment, volume, light, surface, strategy } = a;
    *camera == b.camera
        && *path == b.path
        && *environment == b.environment
        && *volume == b.volume
        && *light == b.light
        && *surface == b.surface
        && *strategy == b.strategy
}
