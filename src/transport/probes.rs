//! Probes: spheres spread over the medium that know the light around them and say where along a ray
//! scattering pays (Huang et al. 2021, section 3).
//!
//! They fill the leaves of an octree that is finer where more light is scattered, so that each
//! stands for about as much of it. A probe keeps directions its light comes from instead of a score
//! for one camera; the score towards any ray is read from them, μ_s ∫ L ρ dω, and weighed with the
//! transmittance on the way. So they serve every vertex, and stay as they are when the camera moves.
//!
//! They guide and no more: whatever they say, the picture's mean stays, as long as no sample
//! changes what guides it.

mod airlight;
mod brightness;
mod caustic_lobes;
pub(super) mod caustics;
mod distance_pdf;
mod octree;
mod probe;
mod scores;
mod view;

use glam::{UVec2, Vec3A};
use rayon::prelude::*;

use super::{
    emission::EmissionEstimator,
    scene::Scene,
    strategy::{Advanced, Distance, LightSelection, Strategy},
};
use crate::{
    error::{Progress, Result, report},
    light::Scores,
    math::{Aabb, PathRng, Ray, mean},
    volume::{medium::Segment, world::MediumRay},
};
pub use brightness::Brightness;
use caustic_lobes::CausticLobes;
pub(super) use caustic_lobes::{CausticLobe, PhotonSegment};
pub use distance_pdf::DistancePdf;
use distance_pdf::{DistancePdfBuilder, RayPiece};
use octree::{Octree, child_of};
pub(super) use probe::Indirect;
use probe::Probe;
pub use view::ProbeView;

/// Levels that are cut wherever a volume may scatter.
const FIRST_LEVELS: u32 = 3;
/// Light outside of the octree, relative to its mean radiance inside.
const OUTSIDE: f32 = 0.05;
/// Share of the directions that go towards the glow around the lights if all of their light is
/// scattered.
const MOST_AIRLIGHT: f32 = 0.5;
/// Transmittance below which a line asks the probes no more.
const DARK: f32 = 1e-4;
/// Parts of the work that are done, about, once probes are placed and once caustics are found.
pub(super) const PLACED: f32 = 0.3;
pub(super) const CAUSTICS_FOUND: f32 = 0.4;
/// Fixed, with numbers that no picture is likely to use.
pub(super) const SEED: u64 = 0x7072_6f62_6573_2e2e;

/// The probes of a scene.
#[derive(Clone, Debug)]
pub struct Probes {
    octree: Octree,
    /// By node; those of inner nodes are what their leaves began as.
    probes: Vec<Probe>,
    /// Of the lights, by node, at leaves from where any is seen; empty if they are not asked for.
    scores: Vec<Option<Scores>>,
    /// Bundles of light that metals throw.
    caustic_lobes: CausticLobes,
    /// Radiance scattered outside of the octree per unit of μ_s.
    outside: f32,
    /// Mean cosine of what scatters most.
    mean_cosine: f32,
    /// Share of the lights' light that is scattered at least once.
    scattered: f32,
}

impl Probes {
    /// Probes that know what is looked at from them, if the strategy of `scene` asks for any and
    /// anything scatters.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub(super) fn placed(scene: &Scene, progress: Progress) -> Result<Option<Self>> {
        let Some(recipe) = Self::recipe(&scene.strategy) else { return Ok(None) };
        let scores_lights = recipe.advanced.light_selection == LightSelection::Probes
            && scene.lights.len(recipe.nee) > 1;
        if !scene.strategy.guides() && !scores_lights {
            return Ok(None);
        }
        let Some((bounds, scattering)) = support(scene) else { return Ok(None) };
        let octree = Octree::new(&bounds);
        let cube = octree.bounds();
        let builder =
            Builder { scene, emission_estimator: EmissionEstimator::coarse(), scattering };
        let first = builder.probe(0, &cube);
        let scattered = airlight::scattered_share(scene, progress)?;
        let mut probes = Self {
            octree,
            probes: vec![first],
            scores: Vec::new(),
            caustic_lobes: CausticLobes::default(),
            outside: 0.0,
            mean_cosine: 0.0,
            scattered,
        };
        probes.refine(&builder, recipe.advanced.probe_count, progress)?;
        probes.outside = OUTSIDE * probes.mean_radiance();
        probes.mean_cosine = probes.weighted_cosine();
        if scores_lights {
            probes.score_lights(&builder, progress)?;
        }
        Ok(Some(probes))
    }

    /// What of a strategy decides the probes, all else put to its default: strategies that agree in
    /// it have the same. `None` where it asks for none.
    pub fn recipe(strategy: &Strategy) -> Option<Strategy> {
        let asks = strategy.guides() || strategy.advanced.light_selection == LightSelection::Probes;
        let plain = Strategy::default();
        let aside = plain.advanced;
        asks.then_some(Strategy {
            emission_decoupling: plain.emission_decoupling,
            emission_ratio_tracking: plain.emission_ratio_tracking,
            majorant_boost: plain.majorant_boost,
            advanced: Advanced {
                boost_mode: aside.boost_mode,
                boost_amount: aside.boost_amount,
                boost_clamp_voxels: aside.boost_clamp_voxels,
                distance: if strategy.guides() { aside.distance } else { Distance::Null },
                scatter_probability: aside.scatter_probability,
                share_learning: aside.share_learning,
                tracker: aside.tracker,
                guide_all_vertices: aside.guide_all_vertices,
                equiangular: aside.equiangular,
                guide_directions: aside.guide_directions,
                low_discrepancy: aside.low_discrepancy,
                ..strategy.advanced
            },
            ..*strategy
        })
    }

    /// Every probe that guides, by its number, with its box.
    pub(super) fn leaves(&self) -> Vec<(u32, Aabb)> {
        self.octree.leaves()
    }

    /// Takes what was learned of the indirect light. Half of it from the eight of a cut together:
    /// each alone has seen few paths.
    pub(super) fn learn(&mut self, learned: &[(u32, Indirect)]) {
        let family = |node: u32| node.div_ceil(8) as usize;
        let mut families = vec![(Indirect::default(), 0.0); family(self.probes.len() as u32) + 1];
        for (node, indirect) in learned {
            let (sum, leaves) = &mut families[family(*node)];
            sum.merge(indirect, 1.0);
            *leaves += 1.0;
        }
        for (node, indirect) in learned {
            let (sum, leaves) = &families[family(*node)];
            let mut shared = Indirect::default();
            shared.merge(indirect, 0.5);
            shared.merge(sum, 0.5 / leaves);
            self.probes[*node as usize].learn(&shared);
        }
        self.outside = OUTSIDE * self.mean_radiance();
        self.mean_cosine = self.weighted_cosine();
    }

    /// Whether the probes of `scene` are placed around its camera: in a fog without borders.
    pub fn heed_camera(scene: &Scene) -> bool {
        let mut instances = scene.world.instances().iter();
        instances.any(|instance| {
            instance.volume().properties().scatters() && !is_finite(instance.bounds())
        })
    }

    /// Cuts leaves level by level where they stand for more than their part of the light.
    fn refine(&mut self, builder: &Builder<'_>, count: u32, progress: Progress) -> Result<()> {
        let mut level = vec![(0, self.octree.bounds())];
        let mut power: f32 = self.power_of(&level[0]);
        for depth in 0..octree::DEEPEST {
            let least = 4.0 * power / count as f32;
            let split: Vec<(u32, Aabb)> = level
                .iter()
                .filter(|leaf| {
                    let first = depth < FIRST_LEVELS && builder.may_scatter(&leaf.1);
                    first || self.power_of(leaf) > least
                })
                .copied()
                .collect();
            if split.is_empty() || self.octree.len() + 8 * split.len() > 2 * count as usize {
                break;
            }
            level = split.iter().flat_map(|leaf| self.split(leaf)).collect();
            let place = |(node, bounds): &(u32, Aabb)| {
                report(progress, 0.0)?;
                Ok(builder.probe(*node, bounds))
            };
            let probes: Result<Vec<Probe>> = level.par_iter().map(place).collect();
            self.probes.extend(probes?);
            let sum = |leaves: &[(u32, Aabb)]| leaves.iter().map(|l| self.power_of(l)).sum::<f32>();
            power += sum(&level) - sum(&split);
        }
        Ok(())
    }

    /// Scores the lights for each leaf.
    fn score_lights(&mut self, builder: &Builder<'_>, progress: Progress) -> Result<()> {
        let leaves = self.octree.leaves();
        let score = |(node, bounds): &(u32, Aabb)| {
            report(progress, PLACED)?;
            Ok((*node, builder.scores(*node, bounds)))
        };
        let scored: Result<Vec<(u32, Option<Scores>)>> = leaves.par_iter().map(score).collect();
        let scored = scored?;
        self.scores = vec![None; self.probes.len()];
        for (node, scores) in scored {
            self.scores[node as usize] = scores;
        }
        Ok(())
    }

    /// Those of the lights around a point, if lights are chosen by them there.
    pub fn scores(&self, point: Vec3A) -> Option<&Scores> {
        if self.scores.is_empty() {
            return None;
        }
        self.scores.get(self.octree.leaf_at(point)? as usize)?.as_ref()
    }

    /// The children of a leaf.
    fn split(&mut self, leaf: &(u32, Aabb)) -> [(u32, Aabb); 8] {
        let first = self.octree.split(leaf.0);
        std::array::from_fn(|i| (first + i as u32, child_of(&leaf.1, i as u32)))
    }

    /// Power scattered in a leaf.
    fn power_of(&self, (node, bounds): &(u32, Aabb)) -> f32 {
        self.probes[*node as usize].power() * bounds.size().element_product()
    }

    /// Number of probes.
    pub fn len(&self) -> usize {
        self.probes.len()
    }

    /// Whether there are none, which does not happen.
    pub fn is_empty(&self) -> bool {
        self.probes.is_empty()
    }

    /// Mean cosine of the scattering, as the probes see it.
    pub fn mean_cosine(&self) -> f32 {
        self.mean_cosine
    }

    /// Share of the directions after scattering that are best drawn from the glow around a light.
    pub fn share_of_airlight(&self) -> f32 {
        MOST_AIRLIGHT * self.scattered
    }

    fn weighted_cosine(&self) -> f32 {
        let power: f32 = self.probes.iter().map(Probe::power).sum();
        let sum: f32 = self.probes.iter().map(|probe| probe.power() * probe.g()).sum();
        let mean = sum / power;
        if mean.is_finite() { mean } else { self.probes[0].g() }
    }

    fn mean_radiance(&self) -> f32 {
        let sum: f32 = self.probes.iter().map(Probe::radiance).filter(|r| r.is_finite()).sum();
        sum / self.probes.len() as f32
    }

    /// The density along `ray` whose medium is given; `None` where nothing scatters.
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

    /// Calls `found` with the stretches along `ray` whose medium is given, from near to far, each
    /// with the leaf it lies in and with μ_s in place of what is scattered. It says what of the
    /// light is left behind them: where that is dark, leaves are told apart no more.
    pub(super) fn visit(
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

    /// Radiance thought to be scattered at a point back along a ray of the unit `direction`, per unit
    /// of μ_s.
    pub fn radiance_at(&self, point: Vec3A, direction: Vec3A) -> f32 {
        self.radiance(self.octree.leaf_at(point), direction)
    }

    /// What is known of the light around a point; `None` outside of the octree.
    pub(super) fn around(&self, point: Vec3A) -> Option<Surroundings<'_>> {
        let leaf = self.octree.leaf_at(point)?;
        let probe = &self.probes[leaf as usize];
        let caustic_lobes = self.caustic_lobes.of(leaf);
        let bundled: f32 = caustic_lobes.iter().map(|lobe| lobe.fluence).sum();
        let [direct, indirect] = probe.fluences();
        Some(Surroundings { caustic_lobes, direct, indirect: (indirect - bundled).max(0.0) })
    }

    /// Takes bundles of light.
    pub(super) fn take_photon_segments(&mut self, segments: Vec<PhotonSegment>) {
        self.caustic_lobes = CausticLobes::new(segments, self.probes.len());
    }

    /// Length of the diagonal of the cube that the probes fill.
    pub(super) fn size(&self) -> f32 {
        self.octree.bounds().diagonal()
    }

    /// The middle of that cube.
    pub(super) fn center(&self) -> Vec3A {
        self.octree.bounds().center()
    }

    fn radiance(&self, leaf: Option<u32>, direction: Vec3A) -> f32 {
        leaf.map_or(self.outside, |leaf| {
            in_scattered(&self.probes[leaf as usize], self.caustic_lobes.of(leaf), direction)
        })
    }

    /// The part of a segment between two parameters, inside of a leaf.
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
pub(super) struct Surroundings<'p> {
    /// Bundles of light that metals throw.
    pub(super) caustic_lobes: &'p [CausticLobe],
    /// What comes straight from lights.
    pub(super) direct: f32,
    /// All else.
    pub(super) indirect: f32,
}

/// ∫ L ρ dω in a leaf back along a ray with the unit `direction`.
fn in_scattered(probe: &Probe, caustic_lobes: &[CausticLobe], direction: Vec3A) -> f32 {
    let even = probe.in_scattered(direction);
    caustic_lobes.iter().fold(even, |sum, lobe| sum + lobe.in_scattered(probe.g(), direction))
}

/// What probes are made from.
struct Builder<'s> {
    scene: &'s Scene,
    /// Looks at fire.
    emission_estimator: EmissionEstimator,
    /// Boxes of the volumes that may scatter.
    scattering: Vec<Aabb>,
}

impl Builder<'_> {
    /// The probe of a node.
    fn probe(&self, node: u32, bounds: &Aabb) -> Probe {
        let mut rng = PathRng::new(SEED, UVec2::new(node, 0), 0);
        Probe::new(self.scene, &self.emission_estimator, bounds, &mut rng)
    }

    /// Those of the lights around a leaf.
    fn scores(&self, node: u32, bounds: &Aabb) -> Option<Scores> {
        scores::scores(self.scene, node, bounds)
    }

    fn may_scatter(&self, bounds: &Aabb) -> bool {
        let apart = |b: &Aabb| b.min.cmpgt(bounds.max).any() || b.max.cmplt(bounds.min).any();
        self.scattering.iter().any(|volume| !apart(volume))
    }
}

/// A box around what scatters, and the boxes of its volumes; `None` where nothing does. Of a fog
/// that never ends, where it matters: around all else there is.
fn support(scene: &Scene) -> Option<(Aabb, Vec<Aabb>)> {
    let scattering: Vec<Aabb> = scene
        .world
        .instances()
        .iter()
        .filter(|instance| instance.volume().properties().scatters())
        .map(|instance| *instance.bounds())
        .collect();
    let mut all = scattering.iter().filter(|b| is_finite(b)).fold(Aabb::EMPTY, |a, b| a.union(b));
    if !scattering.iter().all(is_finite) {
        let camera = scene.camera.position();
        all = all.union(&Aabb::new(camera, camera));
        let lights = scene.lights.emitters(&scene.world);
        all = lights.iter().fold(all, |a, light| a.union(&light.bounds));
        let bounded = scene.surfaces.iter().filter_map(|surface| surface.shape.bounds());
        all = bounded.fold(all, |a, b| a.union(&b));
        let margin = Vec3A::splat((0.5 * all.diagonal()).max(1.0));
        all = Aabb::new(all.min - margin, all.max + margin);
    }
    let usable = !scattering.is_empty() && is_finite(&all) && all.diagonal() > 0.0;
    (usable && all.size().max_element().is_finite()).then_some((all, scattering))
}

fn is_finite(bounds: &Aabb) -> bool {
    bounds.min.is_finite() && bounds.max.is_finite() && !bounds.is_empty()
}
