//! Light from all around, behind everything else: the sky.
//!
//! A varying environment is a light among others: light samples draw directions by its radiance,
//! and scattered rays that leave the scene meet it. An even one is no light to draw samples of:
//! BSDF and phase sampling are ideal for it, since nothing but BSDF or phase function varies over
//! the directions.

mod drawn;
mod gradient;
mod orientation;
mod radiance_map;
mod sky;
mod texel_choice;

use std::sync::Arc;

use glam::Vec3A;

use super::sample::LightSample;
use crate::math::Rgb;
pub use gradient::Gradient;
pub use orientation::{Orientation, Up};
pub use radiance_map::RadianceMap;
pub use sky::ClearSky;

/// Radiance from all directions, infinitely far away.
#[derive(Clone, Debug, Default)]
pub struct Environment {
    radiance: Radiance,
    /// Factor of the radiance: tint and exposure.
    scale: Rgb,
    orientation: Orientation,
    is_hidden: bool,
}

/// Radiance by direction.
#[derive(Clone, Debug)]
pub enum Radiance {
    /// One radiance from all directions.
    Even(Rgb),
    /// Radiance that changes with the elevation only.
    Gradient(Gradient),
    /// Radiance by texels.
    Map(Arc<RadianceMap>),
}

impl Default for Radiance {
    fn default() -> Self {
        Self::Even(Rgb::ZERO)
    }
}

impl Environment {
    /// Light of the `radiance` times a `scale`, turned by `orientation`. Camera rays see a hidden
    /// one as black; all other rays see it as it is.
    pub fn new(radiance: Radiance, scale: Rgb, orientation: Orientation, is_hidden: bool) -> Self {
        let even = match &radiance {
            Radiance::Even(radiance) => Some(*radiance),
            Radiance::Gradient(gradient) => gradient.even(),
            Radiance::Map(map) => map.even(),
        };
        let radiance = even.map_or(radiance, Radiance::Even);
        let mut environment = Self { radiance, scale, orientation, is_hidden };
        if environment.fluence() == Rgb::ZERO {
            environment.radiance = Radiance::default();
        }
        environment
    }

    /// Light of one radiance from all directions.
    pub fn even(radiance: Rgb) -> Self {
        Self::new(Radiance::Even(radiance), Rgb::ONE, Orientation::default(), false)
    }

    /// Whether the radiance varies over the directions, so that light samples of it pay.
    pub fn varies(&self) -> bool {
        !matches!(self.radiance, Radiance::Even(_))
    }

    /// Whether no light comes from anywhere.
    pub fn is_black(&self) -> bool {
        self.fluence().max_element() <= 0.0
    }

    /// Whether camera rays see black in its place.
    pub fn is_hidden(&self) -> bool {
        self.is_hidden
    }

    /// Radiance from the unit `direction`, which points away from the viewer.
    pub fn radiance(&self, direction: Vec3A) -> Rgb {
        let local = || self.orientation.local_from_world(direction);
        self.scale
            * match &self.radiance {
                Radiance::Even(radiance) => *radiance,
                Radiance::Gradient(gradient) => gradient.radiance(local().z),
                Radiance::Map(map) => map.radiance(local()),
            }
    }

    /// Density over solid angle with which [`Environment::sample`] draws the unit `direction`.
    pub fn pdf_solid_angle(&self, direction: Vec3A) -> f32 {
        let local = || self.orientation.local_from_world(direction);
        match &self.radiance {
            Radiance::Even(_) => 0.0,
            Radiance::Gradient(gradient) => gradient.pdf_solid_angle(local().z),
            Radiance::Map(map) => map.pdf_solid_angle(local()),
        }
    }

    /// Draws a direction about in proportion to the luminance of its radiance; `None` where the
    /// environment does not vary.
    pub fn sample(&self, u: [f64; 2]) -> Option<LightSample> {
        let drawn = match &self.radiance {
            Radiance::Even(_) => return None,
            Radiance::Gradient(gradient) => gradient.sample(u),
            Radiance::Map(map) => map.sample(u),
        };
        Some(LightSample {
            direction: self.orientation.world_from_local(drawn.direction),
            distance: f32::INFINITY,
            radiance: self.scale * drawn.radiance,
            pdf: drawn.pdf_solid_angle,
            can_be_met: true,
        })
    }

    /// ∫ L dω over all directions.
    pub fn fluence(&self) -> Rgb {
        self.scale
            * match &self.radiance {
                Radiance::Even(radiance) => 4.0 * std::f32::consts::PI * *radiance,
                Radiance::Gradient(gradient) => gradient.fluence(),
                Radiance::Map(map) => map.fluence(),
            }
    }

    /// Unit direction towards the middle of the light, or up where it has none.
    pub fn middle(&self) -> Vec3A {
        let local = match &self.radiance {
            Radiance::Even(_) => Vec3A::Z,
            Radiance::Gradient(gradient) => gradient.middle(),
            Radiance::Map(map) => map.middle(),
        };
        self.orientation.world_from_local(local)
    }
}

#[cfg(test)]
mod tests;
