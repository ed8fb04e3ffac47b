//! A scene framed on a film, prepared in two stages: [`Frame::new`] places the probes and fits the
//! optimal majorant; the pilot pass, before the second sample of a pixel, learns how many samples
//! of each technique pay.

use std::sync::Arc;

use glam::{UVec2, Vec2};

use super::emission::EmissionEstimator;
use super::learned_counts::LearnedCounts;
use super::observer::{Nobody, Observer};
use super::path;
use super::path_setup::{Guides, PathSetup};
use super::prepare::pilot_film::PilotFilm;
use super::prepare::{self, SceneProbes, pilot};
use super::sample::{PathSample, PixelSampler, Prepared, SampleNumber};
use super::scene::Scene;
use super::spending::Spending;
use crate::error::{NO_PROGRESS, Progress, Result};
use crate::math::{PathRng, Slot};

/// A scene framed on a film.
#[derive(Clone, Debug)]
pub struct Frame {
    pub(super) scene: Arc<Scene>,
    size: UVec2,
    seed: u64,
    pub(super) emission_estimator: EmissionEstimator,
    scene_probes: Option<Arc<SceneProbes>>,
    /// Guides and counts of first samples.
    pub(super) first: PathSetup,
}

impl Frame {
    /// Frames `scene` on a film of `size` pixels; `seed` chooses the random numbers of the whole
    /// picture. Probes are placed where the strategy asks for them, and the optimal majorant is
    /// fitted, both whatever the seed.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn new(scene: Arc<Scene>, size: UVec2, seed: u64, progress: Progress) -> Result<Self> {
        let probes = SceneProbes::placed(&scene, progress)?.map(Arc::new);
        Self::try_with_probes(scene, size, seed, probes, progress)
    }

    /// Frames `scene` with probes that were placed for it before, or without any: they change the
    /// noise of the picture and not its mean. Takes a few milliseconds.
    pub fn with_probes(
        scene: Arc<Scene>,
        size: UVec2,
        seed: u64,
        probes: Option<Arc<SceneProbes>>,
    ) -> Self {
        let framed = Self::try_with_probes(scene.clone(), size, seed, probes, NO_PROGRESS);
        // Nothing cancels either.
        framed.unwrap_or_else(|_| Self {
            first: PathSetup {
                guides: None,
                counts: pilot::unlearned(&scene.strategy),
                spending: None,
            },
            emission_estimator: EmissionEstimator::coarse(),
            scene_probes: None,
            scene,
            size,
            seed,
        })
    }

    /// [`Frame::with_probes`], unless `progress` cancels it.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn try_with_probes(
        scene: Arc<Scene>,
        size: UVec2,
        seed: u64,
        probes: Option<Arc<SceneProbes>>,
        progress: Progress,
    ) -> Result<Self> {
        let emission_estimator = prepare::emission_estimator(&scene, size, progress)?;
        let film = PilotFilm { scene: &scene, size, emission_estimator: &emission_estimator };
        let first = pilot::first(film, probes.as_deref(), progress)?;
        Ok(Self { scene, size, seed, emission_estimator, scene_probes: probes, first })
    }

    /// A copy of the frame with another seed, which shares everything that was prepared.
    pub fn with_seed(&self, seed: u64) -> Self {
        Self { seed, ..self.clone() }
    }

    /// Pixels across and down.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Follows one path and shows each of its steps to `observer`.
    pub fn trace(
        &self,
        pixel: UVec2,
        number: SampleNumber,
        observer: &mut impl Observer,
    ) -> PathSample {
        let sample = number.index();
        let mut rng = if self.scene.strategy.advanced.low_discrepancy {
            PathRng::stratified(self.seed, pixel, sample)
        } else {
            PathRng::new(self.seed, pixel, sample)
        };
        let offset = Vec2::new(rng.at(Slot::PixelX), rng.at(Slot::PixelY));
        let ray = self.scene.camera_ray(self.size, pixel, offset, &mut rng);
        let setup = match number {
            SampleNumber::Later(_, Prepared { setup: Some(setup) }) => setup,
            _ => &self.first,
        };
        let context = setup.context(&self.emission_estimator);
        path::trace(&self.scene, context, ray, &mut rng, observer)
    }

    /// Runs the pilot pass of the frame.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn prepared(self, progress: Progress) -> Result<PreparedFrame> {
        let prepared = self.prepare(progress)?;
        Ok(PreparedFrame { frame: self, prepared })
    }

    /// The frame with all probes, and the expected counts of first samples for all samples, no
    /// pilot pass run.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn with_first_counts(self, progress: Progress) -> Result<PreparedFrame> {
        let counts = self.first.counts;
        self.with_counts(counts, progress)
    }

    /// The frame with all probes, and the expected `counts` of every sample of a pixel but the
    /// first.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn with_counts(self, counts: LearnedCounts, progress: Progress) -> Result<PreparedFrame> {
        let guides = match &self.scene_probes {
            Some(probes) => Some(self.pilot_film().guides(probes, progress)?),
            None => None,
        };
        let prepared = Prepared { setup: Some(PathSetup { guides, counts, spending: None }) };
        Ok(PreparedFrame { frame: self, prepared })
    }

    fn pilot_film(&self) -> PilotFilm<'_> {
        let Self { scene, size, emission_estimator, .. } = self;
        PilotFilm { scene, size: *size, emission_estimator }
    }
}

impl PixelSampler for Frame {
    fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
        self.trace(pixel, number, &mut Nobody)
    }

    fn prepare(&self, progress: Progress) -> Result<Prepared> {
        if self.scene.strategy.marches() {
            return Ok(Prepared::NOTHING);
        }
        let probes = self.scene_probes.as_deref();
        let setup = pilot::learn(self.pilot_film(), &self.first, probes, progress)?;
        Ok(Prepared { setup: Some(setup) })
    }
}

/// A frame whose pilot pass has run, of which any sample can be taken.
#[derive(Clone, Debug)]
pub struct PreparedFrame {
    frame: Frame,
    prepared: Prepared,
}

impl PreparedFrame {
    /// [`Frame::new`], and the pilot pass of the frame.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn new(scene: Arc<Scene>, size: UVec2, seed: u64, progress: Progress) -> Result<Self> {
        Frame::new(scene, size, seed, progress)?.prepared(progress)
    }

    /// A copy of the frame with another seed, which shares the result of the pilot pass.
    pub fn with_seed(&self, seed: u64) -> Self {
        Self { frame: self.frame.with_seed(seed), prepared: self.prepared.clone() }
    }

    /// Pixels across and down.
    pub fn size(&self) -> UVec2 {
        self.frame.size
    }

    /// The frame itself.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Expected counts that the pilot pass learned; `None` where none was run.
    pub fn counts(&self) -> Option<&LearnedCounts> {
        self.prepared.counts()
    }

    /// Probes that guide the paths, and the brightness of the film by them; `None` where none do.
    pub(super) fn guides(&self) -> Option<&Guides> {
        self.prepared.setup.as_ref().and_then(|setup| setup.guides.as_ref())
    }

    /// How the time of the picture is spent; `None` where no pilot pass was run.
    pub fn spending(&self) -> Option<&Spending> {
        self.prepared.spending()
    }

    /// Guided flights of a camera ray, relative to those that the probes propose: the most
    /// efficient number for this picture, 0 for none.
    pub fn guided_flights(&self) -> f32 {
        self.prepared.guided_flights().unwrap_or(1.0)
    }

    /// Sample `index` of a pixel, counted from 0.
    pub fn sample(&self, pixel: UVec2, index: u32) -> PathSample {
        self.trace(pixel, index, &mut Nobody)
    }

    /// Follows the path of sample `index` and shows each of its steps to `observer`.
    pub fn trace(&self, pixel: UVec2, index: u32, observer: &mut impl Observer) -> PathSample {
        self.frame.trace(pixel, SampleNumber::new(index, &self.prepared), observer)
    }
}

impl PixelSampler for PreparedFrame {
    fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
        self.frame.sample(pixel, number)
    }

    fn prepare(&self, _: Progress) -> Result<Prepared> {
        Ok(self.prepared.clone())
    }
}
