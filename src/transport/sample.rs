//! Contribution of one path to its pixel, and the trait of pixel samplers.

use glam::UVec2;

use super::learned_counts::LearnedCounts;
use super::path_setup::PathSetup;
use super::spending::Spending;
use super::tracking::MOST_COLLISIONS;
use super::tracking::event::{Event, Flight};
use crate::error::{Progress, Result, report};
use crate::math::{Rgb, mean};

/// The version of the paths, raised whenever (scene, strategy, seed, pixel, sample) leads to
/// another path than before. Snapshots carry it: samples of two versions come from two estimators
/// or two series of random numbers, so that only those of the same version are continued.
pub const PATH_VERSION: u64 = 4;

/// Contribution of one path to its pixel: four parts that sum to the beauty, and auxiliary values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathSample {
    /// Volume emission seen on the camera ray.
    pub emission: Rgb,
    /// Environment and emitting surfaces seen directly.
    pub background: Rgb,
    /// Light after one scattering event or reflection.
    pub direct: Rgb,
    /// Light after more than one scattering event or reflection.
    pub indirect: Rgb,
    /// 1 − transmittance to the background; 1 on surfaces.
    pub alpha: f32,
    /// Distance of the first event or surface, if there was one.
    pub depth: Option<f32>,
    /// Tentative collisions of all walks of the path, and steps of ray marching.
    pub tracking_steps: u32,
    /// Whether the path was cut, at [`path::MOST_VERTICES`](super::path::MOST_VERTICES) vertices or
    /// [`MOST_COLLISIONS`] collisions of a walk.
    pub was_cut: bool,
}

impl PathSample {
    /// All light of the path.
    pub fn beauty(&self) -> Rgb {
        self.emission + self.background + self.direct + self.indirect
    }
}

/// The contributions of one path, as they are gathered.
#[derive(Debug, Default)]
pub(super) struct Contributions {
    sample: PathSample,
}

impl Contributions {
    /// Adds volume emission on a ray after so many scattering events and reflections.
    pub(super) fn add_emission(&mut self, scatters: u32, contribution: Rgb) {
        match scatters {
            0 => self.sample.emission += contribution,
            _ => self.add_scattered(scatters, contribution),
        }
    }

    /// Adds radiance of the surface or environment at the end of a ray.
    pub(super) fn add_end(&mut self, scatters: u32, contribution: Rgb) {
        match scatters {
            0 => self.sample.background += contribution,
            _ => self.add_scattered(scatters, contribution),
        }
    }

    /// Adds light that comes by `scatters` events, at least one.
    pub(super) fn add_scattered(&mut self, scatters: u32, contribution: Rgb) {
        match scatters {
            1 => self.sample.direct += contribution,
            _ => self.sample.indirect += contribution,
        }
    }

    /// Adds a throughput that is no number, so that the film counts the sample.
    pub(super) fn spoil(&mut self, throughput: Rgb) {
        self.sample.indirect += throughput;
    }

    /// Counts the collisions of a walk, and notes a walk that was cut.
    pub(super) fn count(&mut self, collisions: u32) {
        self.sample.tracking_steps = self.sample.tracking_steps.saturating_add(collisions);
        self.sample.was_cut |= collisions >= MOST_COLLISIONS;
    }

    /// Notes that the path is cut.
    pub(super) fn cut(&mut self) {
        self.sample.was_cut = true;
    }

    /// Whether the path or one of its walks was cut.
    pub(super) fn is_cut(&self) -> bool {
        self.sample.was_cut
    }

    /// Notes coverage and depth of the camera ray, which a surface ends at `d`, if that is finite.
    /// `transmittance` is the emission walk's, if it had one.
    pub(super) fn note_first_event(&mut self, flight: &Flight, d: f32, transmittance: Option<Rgb>) {
        let is_open = d == f32::INFINITY;
        let (opacity, depth) = match flight.event {
            Event::Absorbed { real: false, .. } => (1.0, None),
            Event::Absorbed { t, .. } | Event::Scattered { t, .. } => (1.0, Some(t)),
            Event::Reached if is_open => (1.0 - mean(flight.weight), None),
            Event::Reached => (1.0, Some(d)),
        };
        let smooth = transmittance.filter(|_| is_open).map(|t| 1.0 - mean(t));
        (self.sample.alpha, self.sample.depth) = (smooth.unwrap_or(opacity), depth);
    }

    /// The finished sample.
    pub(super) fn finish(self) -> PathSample {
        self.sample
    }
}

/// Result of a picture's pilot pass, which all samples of a pixel but the first depend on. Made by
/// [`PixelSampler::prepare`].
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(super) setup: Option<PathSetup>,
}

impl Prepared {
    /// Result for samplers without a pilot pass.
    pub const NOTHING: Self = Self { setup: None };

    /// Guided flights of a camera ray, relative to those that the probes propose; 0 where none pay.
    /// `None` where no pilot pass was run.
    pub fn guided_flights(&self) -> Option<f32> {
        self.counts().map(|counts| counts.guided_flights)
    }

    /// How the time of the picture is spent; `None` where no pilot pass was run.
    pub fn spending(&self) -> Option<&Spending> {
        self.setup.as_ref()?.spending.as_ref()
    }

    /// Expected counts that the pilot pass learned; `None` where none was run.
    pub fn counts(&self) -> Option<&LearnedCounts> {
        self.setup.as_ref().map(|setup| &setup.counts)
    }
}

/// Number of a sample of a pixel.
#[derive(Clone, Copy, Debug)]
pub enum SampleNumber<'p> {
    /// The first sample, which waits for no pilot pass, so that a moving camera never does.
    First,
    /// Any later sample, by its index counted from 0, and the result of the pilot pass.
    Later(u32, &'p Prepared),
}

impl<'p> SampleNumber<'p> {
    /// Sample `index`, counted from 0.
    pub fn new(index: u32, prepared: &'p Prepared) -> Self {
        match index {
            0 => Self::First,
            _ => Self::Later(index, prepared),
        }
    }

    /// Index of the sample, counted from 0.
    pub fn index(&self) -> u32 {
        match *self {
            Self::First => 0,
            Self::Later(index, _) => index,
        }
    }
}

/// A sampler of pixels: the only interface of light transport to film and session.
pub trait PixelSampler: Send + Sync {
    /// One path through a pixel; the same arguments give the same path.
    fn sample(&self, pixel: UVec2, number: SampleNumber) -> PathSample;

    /// Runs the pilot pass, whose result all samples of a pixel but the first depend on. The same
    /// sampler always has the same result.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    fn prepare(&self, progress: Progress) -> Result<Prepared> {
        report(progress, 1.0)?;
        Ok(Prepared::NOTHING)
    }
}
