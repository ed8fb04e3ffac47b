//! Placing probes: leaves of an octree are cut where they stand for more than their share of the
//! scattered light.

use glam::{UVec2, Vec3A};
use rayon::prelude::*;

use super::airlight;
use super::caustic_lobes::CausticLobes;
use super::light_scores::light_scores;
use super::octree::{self, Octree, child_of};
use super::probe::Probe;
use super::probes::{OUTSIDE, Probes};
use super::stages::{PLACED, SEED};
use crate::error::{Progress, Result, report};
use crate::light::LightScores;
use crate::math::{Aabb, PathRng};
use crate::transport::direct;
use crate::transport::emission::EmissionEstimator;
use crate::transport::scene::Scene;
use crate::transport::strategy::{Advanced, Distance, LightSelection, Strategy};

/// Levels that are cut wherever a volume may scatter.
const FIRST_LEVELS: u32 = 3;

impl Probes {
    /// Probes with the light of light samples alone, if the strategy of `scene` asks for any and
    /// anything scatters: one of `part` of those that it asks for.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub(in crate::transport) fn placed(
        scene: &Scene,
        part: u32,
        progress: Progress,
    ) -> Result<Option<Self>> {
        let Some(recipe) = Self::recipe(&scene.strategy) else { return Ok(None) };
        let scores_lights = recipe.advanced.light_selection == LightSelection::Probes
            && scene.lights.len(direct::choice(&recipe).among) > 1;
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
            light_scores: Vec::new(),
            caustic_lobes: CausticLobes::default(),
            outside: 0.0,
            mean_cosine: 0.0,
            scattered,
        };
        probes.refine(&builder, (recipe.advanced.probe_count / part).max(1), progress)?;
        probes.outside = OUTSIDE * probes.mean_radiance();
        probes.mean_cosine = probes.weighted_cosine();
        if scores_lights {
            probes.score_lights(&builder, progress)?;
        }
        Ok(Some(probes))
    }

    /// The part of a strategy that decides the probes, all else set to its default: strategies that
    /// agree in it share their probes. `None` for a strategy without probes.
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

    /// Whether the probes of `scene` depend on its camera: in a fog without borders they are placed
    /// around it.
    pub fn heed_camera(scene: &Scene) -> bool {
        let mut instances = scene.world.instances().iter();
        instances.any(|instance| {
            instance.volume().properties().scatters() && !is_finite(instance.bounds())
        })
    }

    /// Cuts leaves level by level where they stand for more than their share of the light.
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

    /// LightScores the lights for each leaf.
    fn score_lights(&mut self, builder: &Builder<'_>, progress: Progress) -> Result<()> {
        let leaves = self.octree.leaves();
        let score = |(node, bounds): &(u32, Aabb)| {
            report(progress, PLACED)?;
            Ok((*node, builder.light_scores(*node, bounds)))
        };
        let scored: Result<Vec<(u32, Option<LightScores>)>> =
            leaves.par_iter().map(score).collect();
        let scored = scored?;
        self.light_scores = vec![None; self.probes.len()];
        for (node, scores) in scored {
            self.light_scores[node as usize] = scores;
        }
        Ok(())
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
}

/// Builder of probes.
struct Builder<'s> {
    scene: &'s Scene,
    /// Walk that gathers the emission of volumes along shadow rays.
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

    /// LightScores of the lights for a leaf.
    fn light_scores(&self, node: u32, bounds: &Aabb) -> Option<LightScores> {
        light_scores(self.scene, node, bounds)
    }

    fn may_scatter(&self, bounds: &Aabb) -> bool {
        let apart = |b: &Aabb| b.min.cmpgt(bounds.max).any() || b.max.cmplt(bounds.min).any();
        self.scattering.iter().any(|volume| !apart(volume))
    }
}

/// A box around the scattering media, and the boxes of their volumes; `None` where nothing
/// scatters. A fog without borders is cut to a box around everything else.
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
