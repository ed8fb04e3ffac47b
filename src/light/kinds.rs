//! The kinds of lights: sampling of each, and its summary for the hierarchy.

use glam::{Vec2, Vec3A};

use super::emitter::Emitter;
use super::environment::Environment;
use super::local::{Point, Spot};
use super::sample::LightSample;
use super::sun::Sun;
use crate::math::{PathRng, Rgb, Slot, luminance};
use crate::surface::Shape;
use crate::volume::world::World;

/// A light that can be sampled.
#[derive(Clone, Debug)]
pub enum Light {
    /// Parallel light.
    Sun(Sun),
    /// An environment whose radiance varies over the directions.
    Environment(Environment),
    /// All directions from a point.
    Point(Point),
    /// A cone from a point.
    Spot(Spot),
    /// The emitting surface of this index among the scene's surfaces.
    Surface {
        /// Index among the scene's surfaces.
        index: usize,
        /// A copy of the surface's shape.
        shape: Shape,
        /// Radiance of the light.
        radiance: Rgb,
    },
    /// The emissive volume of this index among the world's instances.
    Volume(u32),
    /// An emitting shape that no ray meets: it neither shows nor hides anything.
    Invisible {
        /// Shape of the light.
        shape: Shape,
        /// Radiance of the light.
        radiance: Rgb,
    },
}

impl Light {
    /// Draws a direction from `from` towards the light, with a density that excludes the choice of
    /// the light; `None` for volumes, whose light comes from all along the line of sight.
    pub fn sample(&self, from: Vec3A, rng: &mut PathRng) -> Option<LightSample> {
        let mut u = || Vec2::new(rng.at(Slot::LightX), rng.at(Slot::LightY));
        match self {
            Self::Sun(sun) => Some(sun.sample(u())),
            // Picks among millions of texels.
            Self::Environment(environment) => {
                environment.sample([Slot::LightX, Slot::LightY].map(|slot| rng.at64(slot)))
            }
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

    /// The luminance of its irradiance across its own direction, and that direction, of a light
    /// that is infinitely far away. For an environment it is a rough mean over receivers: half of
    /// ∫ L dω, between what a medium scatters and what a plane receives on average.
    pub(super) fn distant(&self) -> Option<(f32, Vec3A)> {
        match self {
            Self::Sun(sun) => Some((luminance(sun.irradiance()), sun.direction())),
            Self::Environment(environment) => {
                Some((0.5 * luminance(environment.fluence()), environment.middle()))
            }
            _ => None,
        }
    }

    /// Summary of the light for the hierarchy; `None` for lights that are infinitely far away.
    pub(super) fn emitter(&self, world: &World) -> Option<Emitter> {
        match self {
            Self::Sun(_) | Self::Environment(_) => None,
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
