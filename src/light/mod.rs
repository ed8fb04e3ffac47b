//! Lights: what can be sampled from a point, what is met by chance, and with which densities.

mod local;
mod sun;
mod tree;

pub use local::{Point, Spot};
pub use sun::Sun;
pub use tree::{Emitter, LightTree, Receiver};

use glam::{Vec2, Vec3A};

use crate::{
    math::{PathRng, Rgb, Slot, luminance},
    surface::{Hit, Shape, Surface},
};

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
    /// Density over solid angle, the choice of the light included; for a light of a single
    /// direction the probability of the choice.
    pub pdf: f32,
    /// Whether a scattered ray can meet the light too, so that MIS must share.
    pub can_be_met: bool,
}

/// All lights of a scene but the emissive volumes.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    /// Radiance from everywhere, met by chance only.
    pub environment: Rgb,
    /// The lights that are sampled.
    pub lights: Vec<Light>,
    light_of_surface: Vec<Option<usize>>,
}

impl Lights {
    /// Gathers the lights; every emitting surface of finite area becomes one.
    pub fn new(environment: Rgb, mut lights: Vec<Light>, surfaces: &[Surface]) -> Self {
        let light_of_surface = surfaces.iter().enumerate().map(|(index, surface)| {
            let samplable = surface.emits() && surface.shape.area().is_some();
            samplable.then(|| {
                let (shape, radiance) = (surface.shape.clone(), surface.emission);
                lights.push(Light::Surface { index, shape, radiance });
                lights.len() - 1
            })
        });
        let light_of_surface = light_of_surface.collect();
        Self { environment, lights, light_of_surface }
    }

    /// Draws a light by its estimated irradiance at `from`, then a direction towards it.
    pub fn sample(&self, from: Vec3A, rng: &mut PathRng) -> Option<LightSample> {
        let total: f32 = self.lights.iter().map(|light| light.importance(from)).sum();
        let mut left = rng.at(Slot::LightPick) * total;
        let u = Vec2::new(rng.at(Slot::LightX), rng.at(Slot::LightY));
        let pick = rng.at(Slot::LightCell);
        let chosen =
            self.lights.iter().map(|light| (light, light.importance(from))).find(|choice| {
                left -= choice.1;
                left < 0.0
            });
        let (light, importance) = chosen.or_else(|| {
            // Rounding may leave a little over after the last light.
            let light = self.lights.last()?;
            Some((light, light.importance(from)))
        })?;
        let mut sample = light.sample(from, pick, u)?;
        sample.pdf *= importance / total;
        (sample.pdf > 0.0).then_some(sample)
    }

    /// Density with which [`Lights::sample`] draws, from `from`, the direction that ended at `hit`
    /// on the surface `index`; 0 where it cannot.
    pub fn pdf_of_surface(&self, index: usize, from: Vec3A, hit: &Hit) -> f32 {
        let Some(Some(light)) = self.light_of_surface.get(index) else { return 0.0 };
        match &self.lights[*light] {
            light @ Light::Surface { shape, .. } => {
                self.probability(light, from) * shape.pdf_solid_angle(from, hit)
            }
            _ => 0.0,
        }
    }

    /// Radiance of every sun's disk seen along the unit `direction`, each with the density of
    /// sampling it from `from`.
    pub fn suns_behind(&self, from: Vec3A, direction: Vec3A) -> impl Iterator<Item = (&Sun, f32)> {
        self.lights.iter().filter_map(move |light| match light {
            Light::Sun(sun) if sun.shows_along(direction) => {
                Some((sun, self.probability(light, from) * sun.pdf_solid_angle()))
            }
            _ => None,
        })
    }

    fn probability(&self, light: &Light, from: Vec3A) -> f32 {
        let total: f32 = self.lights.iter().map(|light| light.importance(from)).sum();
        if total > 0.0 { light.importance(from) / total } else { 0.0 }
    }
}

impl Light {
    /// A rough irradiance at `from`, all of its light assumed to arrive; above zero wherever the
    /// light can bring anything, and finite, so that no light drowns the others.
    fn importance(&self, from: Vec3A) -> f32 {
        let irradiance = self.rough_irradiance(from);
        if irradiance.is_nan() { 0.0 } else { irradiance.min(MOST_IMPORTANT) }
    }

    fn rough_irradiance(&self, from: Vec3A) -> f32 {
        match self {
            Self::Sun(sun) => luminance(sun.irradiance()),
            Self::Point(point) => point.importance(from),
            Self::Spot(spot) => spot.importance(from),
            Self::Surface { shape, radiance, .. } | Self::Invisible { shape, radiance } => {
                let (Some((center, radius)), Some(area)) = (shape.bounding_sphere(), shape.area())
                else {
                    return 0.0;
                };
                let squared = (center - from).length_squared().max(radius * radius);
                luminance(*radiance) * area / squared
            }
        }
    }

    fn sample(&self, from: Vec3A, pick: f32, u: Vec2) -> Option<LightSample> {
        match self {
            Self::Sun(sun) => Some(sun.sample(u)),
            Self::Point(point) => point.sample(from),
            Self::Spot(spot) => spot.sample(from),
            Self::Surface { shape, radiance, .. } | Self::Invisible { shape, radiance } => {
                let point = shape.sample(from, pick, u)?;
                Some(LightSample {
                    direction: point.direction,
                    distance: point.distance,
                    radiance: *radiance,
                    pdf: point.pdf_solid_angle,
                    can_be_met: matches!(self, Self::Surface { .. }),
                })
            }
        }
    }
}
