//! Choosing one light among many: lights at infinite distance by their irradiance, the rest through
//! the hierarchy.

use std::ops::Range;

use glam::Vec3A;

use super::choice::By;
use super::emitter::{MOST_IMPORTANT, Receiver};
use super::kinds::Light;
use super::tree::LightTree;
use crate::volume::world::World;

/// Chooses among some of a scene's lights, by their index in the scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Selector {
    distant: Vec<DistantLight>,
    /// The lights of the tree, in its order.
    placed: Vec<u32>,
    tree: LightTree,
    /// Location of each light of the scene in the hierarchy or among the distant lights.
    places: Vec<LeafPlace>,
}

/// A light at infinite distance: a sun, or the environment.
#[derive(Clone, Copy, Debug)]
struct DistantLight {
    light: u32,
    /// Luminance of its irradiance.
    importance: f32,
    /// Unit direction towards its middle.
    direction: Vec3A,
}

#[derive(Clone, Copy, Debug)]
enum LeafPlace {
    Distant(u32),
    Tree(u32),
    Nowhere,
}

impl Selector {
    /// Chooses among the `group` of a scene's `lights`.
    pub(super) fn new(lights: &[Light], group: Range<usize>, world: &World) -> Self {
        let (mut distant, mut placed, mut emitters) = (Vec::new(), Vec::new(), Vec::new());
        let mut places = Vec::with_capacity(lights.len());
        for (index, light) in lights.iter().enumerate() {
            if !group.contains(&index) {
                places.push(LeafPlace::Nowhere);
                continue;
            }
            let index = index as u32;
            places.push(match (light.distant(), light.emitter(world)) {
                (Some((irradiance, direction)), _) => {
                    let importance = if irradiance > 0.0 { irradiance } else { 0.0 };
                    let importance = importance.min(MOST_IMPORTANT);
                    distant.push(DistantLight { light: index, importance, direction });
                    LeafPlace::Distant(distant.len() as u32 - 1)
                }
                (_, Some(emitter)) => {
                    placed.push(index);
                    emitters.push(emitter);
                    LeafPlace::Tree(emitters.len() as u32 - 1)
                }
                (_, None) => LeafPlace::Nowhere,
            });
        }
        Self { distant, placed, tree: LightTree::new(&emitters), places }
    }

    /// The indices of the lights at infinite distance.
    pub(super) fn distant(&self) -> impl Iterator<Item = u32> {
        self.distant.iter().map(|distant| distant.light)
    }

    /// Number of lights to choose from.
    pub(super) fn len(&self) -> usize {
        self.distant.len() + self.placed.len()
    }

    /// A light and its probability; `pick` is in [0, 1).
    pub(super) fn choose(&self, to: &Receiver, by: &By, pick: f64) -> Option<(u32, f32)> {
        match by {
            By::Hierarchy => self.choose_by_hierarchy(to, pick),
            By::Uniform => {
                let index = ((pick * self.len() as f64) as usize).min(self.len().checked_sub(1)?);
                let distant = self.distant.get(index).map(|distant| distant.light);
                let light = distant.unwrap_or_else(|| self.placed[index - self.distant.len()]);
                Some((light, 1.0 / self.len() as f32))
            }
            By::Shares(shares) => match shares.pick(pick) {
                Ok(light) => Some((light, self.probability(light, to, by))),
                Err(left) => {
                    let (light, probability) = self.choose_by_hierarchy(to, left)?;
                    Some((light, shares.probability(light, probability)))
                }
            },
        }
    }

    fn choose_by_hierarchy(&self, to: &Receiver, pick: f64) -> Option<(u32, f32)> {
        if self.distant.is_empty() {
            let (index, probability) = self.tree.sample(to, pick)?;
            return Some((self.placed[index as usize], probability));
        }
        self.choose_with_distant(to, pick)
    }

    fn choose_with_distant(&self, to: &Receiver, pick: f64) -> Option<(u32, f32)> {
        let total = self.total(to);
        let mut left = pick * f64::from(total);
        for &DistantLight { light, importance, .. } in &self.distant {
            if left < f64::from(importance) {
                return Some((light, importance / total));
            }
            left -= f64::from(importance);
        }
        let rest = self.tree.importance(to);
        let pick = (left / f64::from(rest)).min(1.0 - f64::EPSILON);
        let (index, probability) = self.tree.sample(to, pick)?;
        Some((self.placed[index as usize], probability * (rest / total)))
    }

    /// Probability with which [`Selector::choose`] draws a light.
    pub(super) fn probability(&self, light: u32, to: &Receiver, by: &By) -> f32 {
        match (by, self.place(light)) {
            (_, LeafPlace::Nowhere) => 0.0,
            (By::Hierarchy, place) => self.probability_by_hierarchy(place, to),
            (By::Uniform, _) => 1.0 / self.len() as f32,
            (By::Shares(shares), place) => {
                shares.probability(light, self.probability_by_hierarchy(place, to))
            }
        }
    }

    fn place(&self, light: u32) -> LeafPlace {
        self.places.get(light as usize).copied().unwrap_or(LeafPlace::Nowhere)
    }

    /// Rough irradiance of a light at the receiver, if unoccluded, and the unit direction towards
    /// its middle; `None` where it cannot contribute.
    pub(super) fn guess(&self, light: u32, to: &Receiver) -> Option<(f32, Vec3A)> {
        match self.place(light) {
            LeafPlace::Distant(distant) => {
                let distant = &self.distant[distant as usize];
                Some((distant.importance, distant.direction))
            }
            LeafPlace::Tree(index) => {
                let towards = self.tree.center_of(index)? - to.position;
                let importance = self.tree.importance_of(index, to);
                (importance > 0.0).then(|| (importance, towards.normalize_or_zero()))
            }
            LeafPlace::Nowhere => None,
        }
    }

    fn probability_by_hierarchy(&self, place: LeafPlace, to: &Receiver) -> f32 {
        match place {
            LeafPlace::Distant(distant) => {
                let total = self.total(to);
                if total > 0.0 { self.distant[distant as usize].importance / total } else { 0.0 }
            }
            LeafPlace::Tree(index) if self.distant.is_empty() => self.tree.probability(index, to),
            LeafPlace::Tree(index) => {
                let total = self.total(to);
                let share = if total > 0.0 { self.tree.importance(to) / total } else { 0.0 };
                share * self.tree.probability(index, to)
            }
            LeafPlace::Nowhere => 0.0,
        }
    }

    /// Sum of the importances of all lights: about the irradiance at a receiver, unoccluded.
    pub(super) fn total(&self, to: &Receiver) -> f32 {
        self.distant.iter().map(|distant| distant.importance).sum::<f32>()
            + self.tree.importance(to)
    }
}
