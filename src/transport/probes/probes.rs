//! The probes of a scene and their queries.

use glam::Vec3A;

use super::caustic_lobes::{CausticLobe, CausticLobes, PhotonSegment};
use super::distance_pdf::{DistancePdf, DistancePdfBuilder, RayPiece};
use super::octree::Octree;
use super::probe::{Indirect, PathSums, Probe};
use crate::light::LightScores;
use crate::math::{Aabb, Ray, mean};
use crate::volume::medium::Segment;
use crate::volume::world::MediumRay;

/// Light outside of the octree, relative to its mean radiance inside.
pub(super) const OUTSIDE: f32 = 0.05;
/// Paths of a leaf that count as much as all of those around it.
const TRUSTED: f32 = 8.0;
/// Share of the directions drawn towards lights (airlight) if all of their light is scattered.
const MOST_AIRLIGHT: f32 = 0.5;
/// Transmittance below which a ray reads no more leaves.
const DARK: f32 = 1e-4;

/// The probes of a scene.
#[derive(Clone, Debug)]
pub struct Probes {
    pub(super) octree: Octree,
    /// Probes by node; inner nodes keep the probe from before they were cut.
    pub(super) probes: Vec<Probe>,
    /// LightScores of the lights, by node, at leaves from which any light is visible; empty if
    /// lights are not chosen by probes.
    pub(super) light_scores: Vec<Option<LightScores>>,
    /// Caustics: light that specular surfaces reflect into the medium.
    pub(super) caustic_lobes: CausticLobes,
    /// Radiance scattered outside of the octree per unit of μ_s.
    pub(super) outside: f32,
    /// Mean cosine of the phase functions, weighted by scattered power.
    pub(super) mean_cosine: f32,
    /// Fraction of the lights' power that is scattered at least once.
    pub(super) scattered: f32,
}

impl Probes {
    /// Every probe that guides, by its number, with its box.
    pub(in crate::transport) fn leaves(&self) -> Vec<(u32, Aabb)> {
        self.octree.leaves()
    }

    /// Gives probes the indirect light that paths have found: few paths in a leaf are averaged with
    /// all of those around it, as if those were [`TRUSTED`] more.
    pub(in crate::transport) fn learn(&mut self, found: &[PathSums]) {
        let parents = self.octree.parents();
        let mut all = vec![PathSums::default(); self.probes.len()];
        for leaf in found {
            all[leaf.node as usize] = *leaf;
        }
        // Children follow their parent.
        for node in (1..all.len()).rev() {
            let PathSums { paths, sum, .. } = all[node];
            let parent = &mut all[parents[node] as usize];
            parent.paths += paths;
            parent.sum.merge(&sum, 1.0);
        }
        let mut means = vec![Indirect::default(); all.len()];
        for (node, PathSums { paths, sum, .. }) in all.iter().enumerate() {
            let trusted = if node > 0 { TRUSTED } else { 0.0 };
            let (paths, above) = (*paths as f32, means[parents[node] as usize]);
            let mut mean = sum.scaled(1.0 / (paths + trusted).max(1.0));
            mean.merge(&above, trusted / (paths + trusted).max(1.0));
            means[node] = mean;
        }
        for (node, _) in self.leaves() {
            self.probes[node as usize].learn(&means[node as usize]);
        }
        self.outside = OUTSIDE * self.mean_radiance();
        self.mean_cosine = self.weighted_cosine();
    }

    /// LightScores of the lights around a point, if lights are chosen by probes there.
    pub fn light_scores(&self, point: Vec3A) -> Option<&LightScores> {
        if self.light_scores.is_empty() {
            return None;
        }
        self.light_scores.get(self.octree.leaf_at(point)? as usize)?.as_ref()
    }

    /// Whether any probe knows of a caustic.
    pub(in crate::transport) fn has_caustics(&self) -> bool {
        !self.caustic_lobes.is_empty()
    }

    /// Number of probes.
    pub fn len(&self) -> usize {
        self.probes.len()
    }

    /// Whether there are no probes, which does not happen.
    pub fn is_empty(&self) -> bool {
        self.probes.is_empty()
    }

    /// Mean cosine of the phase functions, weighted by scattered power.
    pub fn mean_cosine(&self) -> f32 {
        self.mean_cosine
    }

    /// Share, 0 to 1, of the directions after scattering that are drawn towards airlight.
    pub fn share_of_airlight(&self) -> f32 {
        MOST_AIRLIGHT * self.scattered
    }

    pub(super) fn weighted_cosine(&self) -> f32 {
        let power: f32 = self.probes.iter().map(Probe::power).sum();
        let sum: f32 = self.probes.iter().map(|probe| probe.power() * probe.g()).sum();
        let mean = sum / power;
        if mean.is_finite() { mean } else { self.probes[0].g() }
    }

    pub(super) fn mean_radiance(&self) -> f32 {
        let sum: f32 = self.probes.iter().map(Probe::radiance).filter(|r| r.is_finite()).sum();
        sum / self.probes.len() as f32
    }

    /// The distance density along `ray` through `medium`; `None` where nothing scatters.
    pub fn along(&self, medium: MediumRay, ray: &Ray) -> Option<DistancePdf> {
        let mut distance_pdf = DistancePdfBuilder::new();
        let mut last = None;
        let mut radiance = 0.0;
        self.visit(medium, ray, |leaf, ray_piece| {
            if last != Some(leaf) {
                radiance = self.radiance(leaf, ray.direction);
                last = Some(leaf);
            }
            distance_pdf.add(&RayPiece { scattered: ray_piece.scattered * radiance, ..*ray_piece });
            distance_pdf.transmittance()
        });
        distance_pdf.finish()
    }

    /// Calls `found` with the pieces of `ray` in `medium`, from near to far, each with the leaf it
    /// lies in and with μ_s in place of the scattered radiance. `found` returns the transmittance
    /// up to the end of the piece: once that is dark, leaves are no longer told apart.
    pub(in crate::transport) fn visit(
        &self,
        mut medium: MediumRay,
        ray: &Ray,
        mut found: impl FnMut(Option<u32>, &RayPiece) -> f32,
    ) {
        let mut place = self.octree.locate(ray, 0.0);
        let mut left = 1.0;
        while let Some(segment) = medium.next_segment() {
            let mut t = segment.t0;
            if segment.majorant <= 0.0 {
                continue;
            }
            while t < segment.t1 {
                let dark = left < DARK;
                if t >= place.t_end && !dark {
                    place = self.octree.locate(ray, t);
                }
                let t1 = if dark { segment.t1 } else { segment.t1.min(place.t_end) };
                left = found(place.leaf, &self.ray_piece(&medium, &segment, t, t1, place.leaf));
                t = t1;
            }
        }
    }

    /// Estimated radiance scattered at a point back along a ray of the unit `direction`, per unit
    /// of μ_s.
    pub fn radiance_at(&self, point: Vec3A, direction: Vec3A) -> f32 {
        self.radiance(self.octree.leaf_at(point), direction)
    }

    /// Estimates of the light around a point; `None` outside of the octree.
    pub(in crate::transport) fn around(&self, point: Vec3A) -> Option<Surroundings<'_>> {
        let leaf = self.octree.leaf_at(point)?;
        let probe = &self.probes[leaf as usize];
        let caustic_lobes = self.caustic_lobes.of(leaf);
        let caustic: f32 = caustic_lobes.iter().map(|lobe| lobe.fluence).sum();
        let [direct, indirect] = probe.fluences();
        Some(Surroundings { caustic_lobes, direct, indirect: (indirect - caustic).max(0.0) })
    }

    /// Builds the caustics from the segments of photons.
    pub(in crate::transport) fn take_photon_segments(&mut self, segments: Vec<PhotonSegment>) {
        self.caustic_lobes = CausticLobes::new(segments, self.probes.len());
    }

    /// Length of the diagonal of the cube that the probes fill.
    pub(in crate::transport) fn size(&self) -> f32 {
        self.octree.bounds().diagonal()
    }

    /// Center of the cube that the probes fill.
    pub(in crate::transport) fn center(&self) -> Vec3A {
        self.octree.bounds().center()
    }

    fn radiance(&self, leaf: Option<u32>, direction: Vec3A) -> f32 {
        leaf.map_or(self.outside, |leaf| {
            in_scattered(&self.probes[leaf as usize], self.caustic_lobes.of(leaf), direction)
        })
    }

    /// Estimates for the part of a segment between two parameters, inside of a leaf.
    fn ray_piece(
        &self,
        medium: &MediumRay,
        segment: &Segment,
        t0: f32,
        t1: f32,
        leaf: Option<u32>,
    ) -> RayPiece {
        let majorant = segment.majorant;
        let (mu_t, mu_s) = if segment.uniform {
            let c = medium.coefficients(t0);
            // The clearest channel that is not clear sees farthest.
            let clear = c.mu_t.cmpeq(Vec3A::ZERO);
            let least = Vec3A::select(clear, Vec3A::splat(majorant), c.mu_t).min_element();
            (least, mean(c.mu_s))
        } else {
            let (density, albedo) = leaf.map_or((0.5, 0.5), |leaf| {
                let probe = &self.probes[leaf as usize];
                (probe.density, probe.albedo)
            });
            (majorant * density, majorant * density * albedo)
        };
        RayPiece { t0, t1, mu_t, majorant, scattered: mu_s }
    }
}

/// The light around a point, as ∫ L dω of its parts.
#[derive(Clone, Copy, Debug)]
pub(in crate::transport) struct Surroundings<'p> {
    /// Caustics: light that specular surfaces reflect into the medium.
    pub(in crate::transport) caustic_lobes: &'p [CausticLobe],
    /// Direct light.
    pub(in crate::transport) direct: f32,
    /// Indirect light other than the caustics.
    pub(in crate::transport) indirect: f32,
}

/// ∫ L ρ dω in a leaf back along a ray with the unit `direction`.
pub(super) fn in_scattered(probe: &Probe, caustic_lobes: &[CausticLobe], direction: Vec3A) -> f32 {
    let even = probe.in_scattered(direction);
    caustic_lobes.iter().fold(even, |sum, lobe| sum + lobe.in_scattered(probe.g(), direction))
}
