//! Lights: what can be looked at from a vertex, what is met by chance, and with which densities.

mod local;
mod scores;
mod selector;
mod sun;
mod tree;

pub use local::{Point, Spot};
pub use scores::{LightProbabilities, Scores, Visibility};
pub use sun::Sun;
pub use tree::{Emitter, LightTree, Receiver};

use glam::{Vec2, Vec3A};

use crate::{
    math::{PathRng, Rgb, Slot, luminance},
    surface::{Hit, Shape, Surface},
    volume::world::World,
};
use selector::Selector;

/// Bound of a light's importance; sums of them stay finite.
const MOST_IMPORTANT: f32 = 1e30;

/// A light that can be sampled.
#[derive(Clone, Debug)]
pub enum Light {
    /// Parallel light.
    Sun(Sun),
    /// All directions from a point.
    Point(Point),
    /// A cone from a point.
    Spot(Spot),
    /// The emitting surface of this index among the scene's surfaces.
    Surface {
        /// Index among the scene's surfaces.
        index: usize,
        /// A copy of its shape.
        shape: Shape,
        /// Its radiance.
        radiance: Rgb,
    },
    /// The emissive volume of this index among the world's instances.
    Volume(u32),
    /// An emitting shape that no ray meets: it neither shows nor hides anything.
    Invisible {
        /// Its shape.
        shape: Shape,
        /// Its radiance.
        radiance: Rgb,
    },
}

/// Light arriving at a point from one sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub direction: Vec3A,
    /// Distance to it; infinite for the sun.
    pub distance: f32,
    /// Radiance, or for a light of a single direction its irradiance across it.
    pub radiance: Rgb,
    /// Density over solid angle; 1 for a light of a single direction.
    pub pdf: f32,
    /// Whether a scattered ray can meet the light too, so that MIS must share.
    pub can_be_met: bool,
}

/// Which lights take part, and how one is chosen among them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightChoice {
    /// Emissive volumes are among them.
    pub volumes: bool,
    /// How one is chosen.
    pub by: By,
}

/// How a light is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum By {
    /// By what the hierarchy thinks it may bring.
    Hierarchy,
    /// Each has the same probability, wherever it is.
    Uniform,
    /// By what is known of the place. They hold for one receiver.
    Shares(LightProbabilities),
}

/// A light that was chosen.
#[derive(Clone, Copy, Debug)]
pub struct ChosenLight<'s> {
    /// Its index in the scene.
    pub index: u32,
    /// The light.
    pub light: &'s Light,
    /// With which probability.
    pub probability: f32,
}

/// All lights of a scene.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    /// Radiance from everywhere, met by chance only.
    pub environment: Rgb,
    lights: Vec<Light>,
    light_of_surface: Vec<Option<u32>>,
    light_of_instance: Vec<Option<u32>>,
    all: Selector,
    without_volumes: Selector,
}

impl Lights {
    /// Gathers the lights; every emitting surface of finite area and every emissive volume that
    /// ends somewhere becomes one.
    pub fn new(
        environment: Rgb,
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
        let without_volumes = Selector::new(&lights, world);
        let mut light_of_instance = vec![None; world.instances().len()];
        for &instance in world.emissive() {
            light_of_instance[instance as usize] = Some(lights.len() as u32);
            lights.push(Light::Volume(instance));
        }
        let all = Selector::new(&lights, world);
        Self { environment, lights, light_of_surface, light_of_instance, all, without_volumes }
    }

    /// The light that `pick`, in [0, 1), chooses for a receiver; `None` where no light can bring
    /// anything.
    pub fn choose(
        &self,
        to: &Receiver,
        choice: &LightChoice,
        pick: f64,
    ) -> Option<ChosenLight<'_>> {
        let (index, probability) = self.selector(choice.volumes).choose(to, &choice.by, pick)?;
        Some(ChosenLight { index, light: self.lights.get(index as usize)?, probability })
    }

    /// Probability with which [`Lights::choose`] draws a light, by its index in the scene.
    pub fn probability(&self, light: u32, to: &Receiver, choice: &LightChoice) -> f32 {
        self.selector(choice.volumes).probability(light, to, &choice.by)
    }

    /// Number of lights to choose from, with or without emissive volumes.
    pub fn len(&self, volumes: bool) -> usize {
        self.selector(volumes).len()
    }

    /// Rough irradiance of a light at the receiver, if nothing is in the way.
    pub fn irradiance(&self, light: u32, to: &Receiver) -> f32 {
        self.all.guess(light, to).map_or(0.0, |guess| guess.0)
    }

    /// The choice by `scores` at a receiver that passes on light from a unit direction by a
    /// `value`; a rough one will do.
    pub fn choice_by(
        &self,
        scores: &Scores,
        to: &Receiver,
        volumes: bool,
        value: impl Fn(Vec3A) -> f32,
    ) -> LightChoice {
        let selector = self.selector(volumes);
        let shares = scores.at(|light| {
            let guess = selector.guess(light, to);
            guess.map_or(0.0, |(irradiance, direction)| irradiance * value(direction))
        });
        LightChoice { volumes, by: By::Shares(shares) }
    }

    /// Density over solid angle with which, from a receiver, the direction is drawn that ended at
    /// `hit` on the surface `index`, the choice of the light included; 0 where it cannot be.
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
            Some(Some(light)) => self.selector(choice.volumes).probability(*light, to, &choice.by),
            _ => 0.0,
        }
    }

    /// Radiance of every sun's disk seen along the unit `direction`, each with the density of
    /// looking there from a receiver by a choice.
    pub fn suns_behind(
        &self,
        from: Option<(&Receiver, &LightChoice)>,
        direction: Vec3A,
    ) -> impl Iterator<Item = (&Sun, f32)> {
        self.all.suns().filter_map(move |index| match &self.lights[index as usize] {
            Light::Sun(sun) if sun.shows_along(direction) => {
                let pdf = from.map_or(0.0, |(to, choice)| {
                    self.probability(index, to, choice) * sun.pdf_solid_angle()
                });
                Some((sun, pdf))
            }
            _ => None,
        })
    }

    /// All lights that are somewhere.
    pub fn emitters(&self, world: &World) -> Vec<Emitter> {
        self.lights.iter().filter_map(|light| light.emitter(world)).collect()
    }

    fn selector(&self, volumes: bool) -> &Selector {
        if volumes { &self.all } else { &self.without_volumes }
    }
}

impl Light {
    /// Draws a direction from `from` towards it, its density without the choice of the light;
    /// `None` for volumes, whose light comes from all along the line of sight.
    pub fn sample(&self, from: Vec3A, rng: &mut PathRng) -> Option<LightSample> {
        let mut u = || Vec2::new(rng.at(Slot::LightX), rng.at(Slot::LightY));
        match self {
            Self::Sun(sun) => Some(sun.sample(u())),
            Self::Point(point) => point.sample(from),
            Self::Spot(spot) => spot.sample(from),
            Self::Surface { shape, radiance, .. } | Self::Invisible { shape, radiance } => {
                let u = u();
                let point = shape.sample(from, rng.at(Slot::LightCell), u)?;
                Some(LightSample {
                    direction: point.direction,
                    distance: point.distance,
                    radiance: *radiance,
                    pdf: point.pdf_solid_angle,
                    can_be_met: matches!(self, Self::Surface { .. }),
                })
            }
            Self::Volume(_) => None,
        }
    }

    /// How the hierarchy sees it; `None` for a sun, which is nowhere.
    fn emitter(&self, world: &World) -> Option<Emitter> {
        match self {
            Self::Sun(_) => None,
            Self::Point(point) => Some(point.emitter()),
            Self::Spot(spot) => Some(spot.emitter()),
            Self::Surface { shape, radiance, .. } | Self::Invisible { shape, radiance } => {
                // A quarter of its area is the mean of what a convex shape shows.
                let intensity = luminance(*radiance) * 0.25 * shape.area()?;
                Some(Emitter { bounds: shape.bounds()?, intensity, cone: None })
            }
            Self::Volume(instance) => {
                let instance = world.instances().get(*instance as usize)?;
                let intensity = instance.emitted_power();
                Some(Emitter { bounds: instance.emission_bounds(), intensity, cone: None })
            }
        }
    }
}
