//! Read-only view of the probes for diagnostics: only the leaves, which are the probes that guide.

use glam::Vec3A;

use super::caustic_lobes::CausticLobe;
use super::octree::child_of;
use super::probe::Probe;
use super::probes::{Probes, in_scattered};
use crate::math::Aabb;

/// A probe with its cube.
#[derive(Clone, Copy, Debug)]
pub struct ProbeView<'p> {
    /// Cube of the probe, in world space.
    pub bounds: Aabb,
    probe: &'p Probe,
    caustic_lobes: &'p [CausticLobe],
}

impl ProbeView<'_> {
    /// Score of the probe for a ray of the unit `direction`: the estimated radiance scattered back
    /// along the ray, μ_s ∫ L ρ dω, per length. 0 where nothing scatters.
    pub fn score(&self, direction: Vec3A) -> f32 {
        // The power is μ_s times the radiance.
        let mu_s = self.probe.power() / self.probe.radiance();
        let score = mu_s * in_scattered(self.probe, self.caustic_lobes, direction);
        if score.is_finite() { score } else { 0.0 }
    }
}

impl Probes {
    /// Calls `found` with every probe that guides.
    pub fn for_each<'p>(&'p self, mut found: impl FnMut(ProbeView<'p>)) {
        let mut left = vec![(0, self.octree.bounds())];
        while let Some((node, bounds)) = left.pop() {
            match self.octree.first_child(node) {
                Some(first) => {
                    left.extend((0..8).map(|i| (first + i, child_of(&bounds, i))));
                }
                None => {
                    let (probe, caustic_lobes) =
                        (&self.probes[node as usize], self.caustic_lobes.of(node));
                    found(ProbeView { bounds, probe, caustic_lobes });
                }
            }
        }
    }
}
