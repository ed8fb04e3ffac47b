//! Setup of the paths of a film: probes that guide them, and expected counts.

use std::sync::Arc;

use glam::UVec2;

use super::context::PathContext;
use super::emission::EmissionEstimator;
use super::learned_counts::LearnedCounts;
use super::probes::{Brightness, Probes};
use super::scene::Scene;
use super::spending::Spending;
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
