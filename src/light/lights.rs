//! All lights of a scene: the choice among them, and the densities of that choice for lights that
//! scattered rays meet.

use glam::Vec3A;

use super::choice::{By, ChosenLight, LightChoice, LightGroup};
use super::emitter::{Emitter, Receiver};
use super::environment::Environment;
use super::kinds::Light;
use super::light_scores::LightScores;
use super::selector::Selector;
use super::sun::Sun;
use crate::surface::{Hit, Surface};
use crate::volume::world::World;

/// All lights of a scene.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    environment: Environment,
    /// The environment among the lights, where it varies.
    light_of_environment: Option<u32>,
    lights: Vec<Light>,
    light_of_surface: Vec<Option<u32>>,
    light_of_instance: Vec<Option<u32>>,
    all: Selector,
    fires: Selector,
    lamps: Selector,
}

impl Lights {
    /// Gathers the lights; an environment that varies, every emitting surface of finite area and
    /// every emissive volume that ends somewhere becomes one.
    pub fn new(
        environment: Environment,
        mut lights: Vec<Light>,
        surfaces: &[Surface],
        world: &World,
    ) -> Self {
        let mut light_of_surface = vec![None; surfaces.len()];
        for (index, surface) in surfaces.iter().enumerate() {
            if surface.emits() && surface.shape.area().is_some() {
                light_of_surface[index] = Some(lights.len() as u32);
                let (shape, radiance) = (surface.shape.clone(), surface.emission);
                lights.push(Light::Surface { index, shape, radiance });
            }
        }
        let light_of_environment = environment.varies().then_some(lights.len() as u32);
        lights.extend(environment.varies().then(|| Light::Environment(environment.clone())));
        let first_fire = lights.len();
        let mut light_of_instance = vec![None; world.instances().len()];
        for &instance in world.emissive() {
            light_of_instance[instance as usize] = Some(lights.len() as u32);
            lights.push(Light::Volume(instance));
        }
        let [all, fires, lamps] = [0..lights.len(), first_fire..lights.len(), 0..first_fire]
            .map(|group| Selector::new(&lights, group, world));
        Self {
            environment,
            light_of_environment,
            lights,
            light_of_surface,
            light_of_instance,
            all,
            fires,
            lamps,
        }
    }

    /// Light from all around, behind everything else.
    pub fn environment(&self) -> &Environment {
        &self.environment
    }

    /// Density over solid angle with which a light sample at a receiver has the unit `direction`
    /// towards the environment, the choice of the light included; `None` where it does not vary,
    /// and BSDF and phase sampling find all of its light.
    pub fn pdf_of_environment(
        &self,
        to: &Receiver,
        choice: &LightChoice,
        direction: Vec3A,
    ) -> Option<f32> {
        let light = self.light_of_environment?;
        Some(self.probability(light, to, choice) * self.environment.pdf_solid_angle(direction))
    }

    /// The light that `pick`, in [0, 1), chooses for a receiver; `None` where no light can
    /// contribute.
    pub fn choose(
        &self,
        to: &Receiver,
        choice: &LightChoice,
        pick: f64,
    ) -> Option<ChosenLight<'_>> {
        let (index, probability) = self.selector(choice.among).choose(to, &choice.by, pick)?;
        Some(ChosenLight { index, light: self.lights.get(index as usize)?, probability })
    }

    /// Probability with which [`Lights::choose`] draws a light, by its index in the scene.
    pub fn probability(&self, light: u32, to: &Receiver, choice: &LightChoice) -> f32 {
        self.selector(choice.among).probability(light, to, &choice.by)
    }

    /// Number of lights to choose from.
    pub fn len(&self, among: LightGroup) -> usize {
        self.selector(among).len()
    }

    /// Rough share, 0 to 1, of fires in the unoccluded irradiance at a receiver; 0 without lights.
    pub fn share_of_fires(&self, to: &Receiver) -> f32 {
        if self.lamps.len() == 0 || self.fires.len() == 0 {
            return if self.fires.len() > 0 { 1.0 } else { 0.0 };
        }
        let [fires, lamps] = [self.fires.total(to), self.lamps.total(to)];
        let share = fires / (fires + lamps);
        if share.is_finite() { share } else { 0.5 }
    }

    /// Rough irradiance of a light at the receiver, if unoccluded.
    pub fn irradiance(&self, light: u32, to: &Receiver) -> f32 {
        self.all.guess(light, to).map_or(0.0, |guess| guess.0)
    }

    /// The choice by `scores` at a receiver whose BSDF or phase function has the `value` for a unit
    /// direction; a rough value will do.
    pub fn choice_by(
        &self,
        scores: &LightScores,
        to: &Receiver,
        among: LightGroup,
        value: impl Fn(Vec3A) -> f32,
    ) -> LightChoice {
        let selector = self.selector(among);
        let shares = scores.at(|light| {
            let guess = selector.guess(light, to);
            guess.map_or(0.0, |(irradiance, direction)| irradiance * value(direction))
        });
        LightChoice { among, by: By::Shares(shares) }
    }

    /// Density over solid angle with which a light sample at a receiver has the direction to `hit`
    /// on the surface `index`, the choice of the light included; 0 where it cannot be drawn.
    pub fn pdf_of_surface(
        &self,
        index: usize,
        to: &Receiver,
        choice: &LightChoice,
        hit: &Hit,
    ) -> f32 {
        let Some(Some(light)) = self.light_of_surface.get(index) else { return 0.0 };
        match &self.lights[*light as usize] {
            Light::Surface { shape, .. } => {
                self.probability(*light, to, choice) * shape.pdf_solid_angle(to.position, hit)
            }
            _ => 0.0,
        }
    }

    /// Probability with which the emissive volume `instance` is chosen from a receiver.
    pub fn probability_of_volume(&self, instance: u32, to: &Receiver, choice: &LightChoice) -> f32 {
        match self.light_of_instance.get(instance as usize) {
            Some(Some(light)) => self.selector(choice.among).probability(*light, to, &choice.by),
            _ => 0.0,
        }
    }

    /// Radiance of every sun's disk seen along the unit `direction`, each with the density with
    /// which light samples at a receiver have that direction.
    pub fn suns_behind(
        &self,
        from: Option<(&Receiver, &LightChoice)>,
        direction: Vec3A,
    ) -> impl Iterator<Item = (&Sun, f32)> {
        self.all.distant().filter_map(move |index| match &self.lights[index as usize] {
            Light::Sun(sun) if sun.shows_along(direction) => {
                let pdf = from.map_or(0.0, |(to, choice)| {
                    self.probability(index, to, choice) * sun.pdf_solid_angle()
                });
                Some((sun, pdf))
            }
            _ => None,
        })
    }

    /// Whether there are suns, whose disks are seen at the end of rays.
    pub fn has_suns(&self) -> bool {
        self.all.distant().any(|index| matches!(self.lights[index as usize], Light::Sun(_)))
    }

    /// Summaries of all lights at finite distances.
    pub fn emitters(&self, world: &World) -> Vec<Emitter> {
        self.lights.iter().filter_map(|light| light.emitter(world)).collect()
    }

    fn selector(&self, among: LightGroup) -> &Selector {
        match among {
            LightGroup::All => &self.all,
            LightGroup::Fires => &self.fires,
            LightGroup::Lamps => &self.lamps,
        }
    }
}
