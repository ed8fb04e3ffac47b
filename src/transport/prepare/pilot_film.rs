//! The film that a pilot pass is run for.

use glam::UVec2;

use super::SceneProbes;
use crate::error::{Progress, Result};
use crate::transport::emission::EmissionEstimator;
use crate::transport::path_setup::Guides;
use crate::transport::scene::Scene;

/// A film for which a pilot pass is run.
#[derive(Clone, Copy, Debug)]
pub(in crate::transport) struct PilotFilm<'s> {
    pub(in crate::transport) scene: &'s Scene,
    /// Width and height in pixels.
    pub(in crate::transport) size: UVec2,
    pub(in crate::transport) emission_estimator: &'s EmissionEstimator,
}

impl PilotFilm<'_> {
    /// The guides of the film by all probes.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub(in crate::transport) fn guides(
        self,
        probes: &SceneProbes,
        progress: Progress,
    ) -> Result<Guides> {
        Guides::new(probes.fine(self.scene, progress)?, self.scene, self.size, progress)
    }
}
