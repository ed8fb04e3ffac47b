//! The light probes of a scene in two stages: few that are placed at once, and all of them once a
//! pilot pass asks for them.

use std::sync::{Arc, OnceLock};

use super::learning;
use crate::error::{Progress, Result};
use crate::transport::probes::Probes;
use crate::transport::scene::Scene;

/// Part of the probes and photons that are placed at once: enough to see whether probes pay.
const COARSE: u32 = 4;

/// The light probes of a scene: few for first samples and to decide whether probes pay in a
/// picture, and all of them, with their learned indirect light, for pictures where they do.
#[derive(Debug)]
pub struct SceneProbes {
    coarse: Arc<Probes>,
    fine: OnceLock<Arc<Probes>>,
}

impl SceneProbes {
    /// Places the first probes for `scene`, if its strategy asks for any and anything scatters. The
    /// same scene always gets the same ones. `progress` is called for every few probes, from many
    /// threads at once.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn placed(scene: &Scene, progress: Progress) -> Result<Option<Self>> {
        let coarse = placed(scene, COARSE, progress)?;
        Ok(coarse.map(|coarse| Self { coarse: Arc::new(coarse), fine: OnceLock::new() }))
    }

    /// The few probes of the first stage, which have not learned any indirect light.
    pub fn coarse(&self) -> &Arc<Probes> {
        &self.coarse
    }

    /// All probes, placed now if they have not been; `scene` is the one that the coarse probes were
    /// placed for, or another of the same [recipe](Probes::recipe).
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn fine(&self, scene: &Scene, progress: Progress) -> Result<&Arc<Probes>> {
        if let Some(fine) = self.fine.get() {
            return Ok(fine);
        }
        // Should two threads place them at once, they find the same ones.
        let fine = fine(scene, progress)?.map_or_else(|| self.coarse.clone(), Arc::new);
        Ok(self.fine.get_or_init(|| fine))
    }

    /// The best probes that have been placed so far.
    pub fn best(&self) -> &Arc<Probes> {
        self.fine.get().unwrap_or(&self.coarse)
    }
}

/// All probes of a scene, with their learned indirect light.
fn fine(scene: &Scene, progress: Progress) -> Result<Option<Probes>> {
    let Some(mut probes) = placed(scene, 1, progress)? else { return Ok(None) };
    if scene.strategy.advanced.probe_learning && scene.strategy.guides() {
        let learned = learning::indirect_light(&probes, scene, progress)?;
        probes.learn(&learned);
    }
    Ok(Some(probes))
}

/// One of `part` of the probes of a scene, with its share of the photons.
fn placed(scene: &Scene, part: u32, progress: Progress) -> Result<Option<Probes>> {
    let Some(mut probes) = Probes::placed(scene, part, progress)? else { return Ok(None) };
    if scene.strategy.advanced.guide_caustics && scene.strategy.guides() {
        probes.find_caustics(scene, part, progress)?;
    }
    Ok(Some(probes))
}
