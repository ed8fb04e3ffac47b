//! A scene framed on a film, prepared in two stages: [`Frame::new`] places the probes and fits the
//! optimal majorant; the pilot pass, before the second sample of a pixel, learns how many samples
//! of each technique pay.

use std::sync::Arc;

use glam::{UVec2, Vec2};

use super::context::PathContext;
use super::emission::EmissionEstimator;
use super::learned_counts::LearnedCounts;
use super::observer::{Nobody, Observer};
use super::path;
use super::prepare::{self, pilot};
use super::probes::{Brightness, Probes};
use super::sample::{PathSample, PixelSampler, Prepared, SampleNumber};
use super::scene::Scene;
use crate::error::{NO_PROGRESS, Progress, Result};
use crate::math::{PathRng, Slot};

/// A scene framed on a film.
#[derive(Clone, Debug)]
pub struct Frame {
    pub(super) scene: Arc<Scene>,
    size: UVec2,
    seed: u64,
    pub(super) emission_estimator: EmissionEstimator,
    pub(super) probes: Option<Arc<Probes>>,
    pub(super) brightness: Brightness,
    /// Counts of first samples.
    first_counts: LearnedCounts,
}

impl Frame {
    /// Frames `scene` on a film of `size` pixels; `seed` chooses the random numbers of the whole
    /// picture. Probes are placed where the strategy asks for them, and the optimal majorant is
    /// fitted, both whatever the seed.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn new(scene: Arc<Scene>, size: UVec2, seed: u64, progress: Progress) -> Result<Self> {
        let probes = prepare::probes(&scene, progress)?.map(Arc::new);
        Self::try_with_probes(scene, size, seed, probes, progress)
    }

    /// Frames `scene` with probes that were placed for it before, or without any: they change the
    /// noise of the picture and not its mean. Takes a few milliseconds.
    pub fn with_probes(
        scene: Arc<Scene>,
        size: UVec2,
        seed: u64,
        probes: Option<Arc<Probes>>,
    ) -> Self {
        // Nothing cancels either.
        let emission_estimator = prepare::emission_estimator(&scene, size, NO_PROGRESS)
            .unwrap_or(EmissionEstimator::coarse());
        let brightness = |probes: &Arc<Probes>| {
            Brightness::new(probes, &scene, size, NO_PROGRESS).unwrap_or_default()
        };
        let brightness = probes.as_ref().map(brightness).unwrap_or_default();
        let first_counts = first_counts(&scene, &probes);
        Self { scene, size, seed, emission_estimator, probes, brightness, first_counts }
    }

    /// [`Frame::with_probes`], unless `progress` cancels it.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn try_with_probes(
        scene: Arc<Scene>,
        size: UVec2,
        seed: u64,
        probes: Option<Arc<Probes>>,
        progress: Progress,
    ) -> Result<Self> {
        let emission_estimator = prepare::emission_estimator(&scene, size, progress)?;
        let brightness = match &probes {
            Some(probes) => Brightness::new(probes, &scene, size, progress)?,
            None => Brightness::default(),
        };
        let first_counts = first_counts(&scene, &probes);
        Ok(Self { scene, size, seed, emission_estimator, probes, brightness, first_counts })
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
        let ray = self.scene.camera.ray(self.size, pixel, offset);
        let counts = match number {
            SampleNumber::Later(_, Prepared { counts: Some(counts) }) => counts,
            _ => &self.first_counts,
        };
        path::trace(&self.scene, self.context(counts), ray, &mut rng, observer)
    }

    fn context<'s>(&'s self, counts: &'s LearnedCounts) -> PathContext<'s> {
        PathContext {
            emission_estimator: &self.emission_estimator,
            probes: self.probes.as_deref(),
            brightness: self.brightness,
            counts,
        }
    }

    /// Runs the pilot pass of the frame.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn prepared(self, progress: Progress) -> Result<PreparedFrame> {
        let prepared = self.prepare(progress)?;
        Ok(PreparedFrame { frame: self, prepared })
    }

    /// The frame with the expected counts of first samples for all samples, no pilot pass run.
    pub fn with_first_counts(self) -> PreparedFrame {
        PreparedFrame { frame: self, prepared: Prepared::NOTHING }
    }

    /// The frame with the expected counts of every sample of a pixel but the first.
    pub fn with_counts(self, counts: LearnedCounts) -> PreparedFrame {
        PreparedFrame { frame: self, prepared: Prepared { counts: Some(counts) } }
    }
}

fn first_counts(scene: &Scene, probes: &Option<Arc<Probes>>) -> LearnedCounts {
    pilot::first(&scene.strategy, probes.is_some() && scene.strategy.guides())
}

impl PixelSampler for Frame {
    fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample {
        self.trace(pixel, number, &mut Nobody)
    }

    fn prepare(&self, progress: Progress) -> Result<Prepared> {
        if self.scene.strategy.marches() {
            return Ok(Prepared::NOTHING);
        }
        let context = self.context(&self.first_counts);
        let counts = pilot::learn(&self.scene, self.size, context, progress)?;
        Ok(Prepared { counts: Some(counts) })
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
        Self { frame: self.frame.with_seed(seed), prepared: self.prepared }
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
        Ok(self.prepared)
    }
}
