//! Choosing one light among many: suns by what they bring, the rest through the hierarchy.

use super::{Light, LightTree, MOST_IMPORTANT, Receiver};
use crate::{
    math::{PathRng, Slot, luminance},
    volume::world::World,
};

/// Chooses among some of a scene's lights, by their index in the scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Selector {
    /// Suns with the luminance of their irradiance.
    suns: Vec<(u32, f32)>,
    /// The lights of the tree, in its order.
    placed: Vec<u32>,
    tree: LightTree,
    /// Where each light of the scene is.
    places: Vec<Place>,
}

#[derive(Clone, Copy, Debug)]
enum Place {
    Sun(u32),
    Tree(u32),
    Nowhere,
}

impl Selector {
    pub(super) fn new(lights: &[Light], world: &World) -> Self {
        let (mut suns, mut placed, mut emitters) = (Vec::new(), Vec::new(), Vec::new());
        let mut places = Vec::with_capacity(lights.len());
        for (index, light) in lights.iter().enumerate() {
            let index = index as u32;
            places.push(match (light, light.emitter(world)) {
                (Light::Sun(sun), _) => {
                    let irradiance = luminance(sun.irradiance());
                    let importance = if irradiance > 0.0 { irradiance } else { 0.0 };
                    suns.push((index, importance.min(MOST_IMPORTANT)));
                    Place::Sun(suns.len() as u32 - 1)
                }
                (_, Some(emitter)) => {
                    placed.push(index);
                    emitters.push(emitter);
                    Place::Tree(emitters.len() as u32 - 1)
                }
                (_, None) => Place::Nowhere,
            });
        }
        Self { suns, placed, tree: LightTree::new(&emitters), places }
    }

    /// The suns' indices.
    pub(super) fn suns(&self) -> impl Iterator<Item = u32> {
        self.suns.iter().map(|sun| sun.0)
    }

    /// A light and its probability.
    pub(super) fn choose(
        &self,
        to: &Receiver,
        uniform: bool,
        rng: &mut PathRng,
    ) -> Option<(u32, f32)> {
        let count = self.suns.len() + self.placed.len();
        if count == 0 {
            return None;
        }
        let pick = rng.at64(Slot::LightPick);
        if uniform {
            let index = ((pick * count as f64) as usize).min(count - 1);
            let sun = self.suns.get(index).map(|sun| sun.0);
            let light = sun.unwrap_or_else(|| self.placed[index - self.suns.len()]);
            return Some((light, 1.0 / count as f32));
        }
        if self.suns.is_empty() {
            let (index, probability) = self.tree.sample(to, pick)?;
            return Some((self.placed[index as usize], probability));
        }
        self.choose_with_suns(to, pick)
    }

    fn choose_with_suns(&self, to: &Receiver, pick: f64) -> Option<(u32, f32)> {
        let total = self.total(to);
        let mut left = pick * f64::from(total);
        for &(light, importance) in &self.suns {
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
    pub(super) fn probability(&self, light: u32, to: &Receiver, uniform: bool) -> f32 {
        let place = self.places.get(light as usize).copied().unwrap_or(Place::Nowhere);
        if uniform {
            return match place {
                Place::Nowhere => 0.0,
                _ => 1.0 / (self.suns.len() + self.placed.len()) as f32,
            };
        }
        match place {
            Place::Sun(sun) => {
                let total = self.total(to);
                if total > 0.0 { self.suns[sun as usize].1 / total } else { 0.0 }
            }
            Place::Tree(index) if self.suns.is_empty() => self.tree.probability(index, to),
            Place::Tree(index) => {
                let total = self.total(to);
                let share = if total > 0.0 { self.tree.importance(to) / total } else { 0.0 };
                share * self.tree.probability(index, to)
            }
            Place::Nowhere => 0.0,
        }
    }

    /// What all lights may bring.
    fn total(&self, to: &Receiver) -> f32 {
        self.suns.iter().map(|sun| sun.1).sum::<f32>() + self.tree.importance(to)
    }
}
