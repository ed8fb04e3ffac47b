//! What paths of a film are set up with: probes that guide them, and expected counts.

use std::sync::Arc;

use glam::UVec2;

use super::context::PathContext;
use super::emission::EmissionEstimator;
use super::learned_counts::{BounceClass, LearnedCounts};
use super::probes::{Brightness, Probes};
use super::scene::Scene;
use crate::error::{Progress, Result};

/// Probes that guide the paths of a film, and the expected counts of their techniques.
#[derive(Clone, Debug)]
pub struct PathSetup {
    /// Probes; `None` where the strategy asks for none or none pay.
    pub guides: Option<Guides>,
    /// Expected counts.
    pub counts: LearnedCounts,
    /// How the time of paths is spent, where that was counted.
    pub spending: Option<Spending>,
}

/// Kinds of work that paths spend their time on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// The paths themselves: distances, directions, surfaces.
    Paths,
    /// Light samples of fires.
    FireSamples,
    /// Light samples of all other lights.
    LampSamples,
    /// Emission walks along rays.
    Emission,
    /// Transmittance to the end of rays.
    Transmittance,
}

impl Work {
    /// All kinds, in their order.
    pub const ALL: [Self; Self::COUNT] =
        [Self::Paths, Self::FireSamples, Self::LampSamples, Self::Emission, Self::Transmittance];
    /// Number of kinds.
    pub const COUNT: usize = 5;

    /// Name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paths => "scattering and reflection",
            Self::FireSamples => "light samples of fires",
            Self::LampSamples => "light samples of other lights",
            Self::Emission => "emission along rays",
            Self::Transmittance => "transmittance to the background",
        }
    }
}

/// How the time of a picture is spent, by counted steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spending {
    /// Share, 0 to 1, of each kind of work, in the order of [`Work::ALL`].
    pub shares: [f32; Work::COUNT],
    /// Numbers at the vertices of each class, in the order of [`BounceClass::ALL`].
    pub bounces: [BounceCounts; BounceClass::COUNT],
}

/// Mean numbers at the vertices of one class.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BounceCounts {
    /// Vertices of a sample.
    pub vertices: f32,
    /// Light samples of fires, light samples of other lights, and emission walks, of a vertex.
    pub samples: [f32; 3],
}

/// Probes, and the brightness of a film by them.
#[derive(Clone, Debug)]
pub struct Guides {
    /// The probes.
    pub probes: Arc<Probes>,
    /// Mean in-scattered radiance over the film, estimated from the probes.
    pub brightness: Brightness,
}

impl PathSetup {
    /// The context of paths with this setup.
    pub fn context<'s>(&'s self, emission_estimator: &'s EmissionEstimator) -> PathContext<'s> {
        PathContext {
            emission_estimator,
            probes: self.guides.as_ref().map(|guides| &*guides.probes),
            brightness: self.guides.as_ref().map(|guides| guides.brightness).unwrap_or_default(),
            counts: &self.counts,
        }
    }
}

impl Guides {
    /// The guides of a film of `size` pixels, by `probes` that were placed in `scene`.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn new(
        probes: &Arc<Probes>,
        scene: &Scene,
        size: UVec2,
        progress: Progress,
    ) -> Result<Self> {
        let brightness = Brightness::new(probes, scene, size, progress)?;
        Ok(Self { probes: probes.clone(), brightness })
    }
}
