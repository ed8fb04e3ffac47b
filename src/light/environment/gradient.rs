//! A sky that changes with the elevation only.
//!
//! With s the sine of the elevation, L(s) = horizon + (top − horizon) s above the horizon and
//! horizon + (bottom − horizon) (−s) below it. A plane that faces up has the irradiance
//! π (horizon + ⅔ (top − horizon)). Solid angle is even in s, so that directions whose density is
//! in proportion to the luminance of L are drawn by inverting a parabola.

use std::f32::consts::{PI, TAU};

use glam::Vec3A;

use super::drawn::DrawnDirection;
use crate::math::{Rgb, luminance};
use crate::sampling::warp::spherical;

/// Radiance that is linear in the sine of the elevation, above the horizon and below it.
#[derive(Clone, Copy, Debug)]
pub struct Gradient {
    bottom: Rgb,
    horizon: Rgb,
    top: Rgb,
    /// Luminance of the three, in the same order.
    luminances: [f32; 3],
}

impl Gradient {
    /// The radiance straight down, at the horizon and straight up.
    pub fn new([bottom, horizon, top]: [Rgb; 3]) -> Self {
        let luminances = [bottom, horizon, top].map(luminance);
        Self { bottom, horizon, top, luminances }
    }

    /// The radiance if it is the same everywhere.
    pub fn even(&self) -> Option<Rgb> {
        (self.bottom == self.horizon && self.horizon == self.top).then_some(self.horizon)
    }

    /// Radiance at a sine of the elevation.
    pub fn radiance(&self, sine: f32) -> Rgb {
        let end = if sine >= 0.0 { self.top } else { self.bottom };
        let share = sine.abs().min(1.0);
        (1.0 - share) * self.horizon + share * end
    }

    /// ∫ L dω.
    pub fn fluence(&self) -> Rgb {
        PI * (self.bottom + 2.0 * self.horizon + self.top)
    }

    /// Density over solid angle of a drawn direction.
    pub fn pdf_solid_angle(&self, sine: f32) -> f32 {
        let [bottom, horizon, top] = self.luminances;
        let end = if sine >= 0.0 { top } else { bottom };
        let share = sine.abs().min(1.0);
        ((1.0 - share) * horizon + share * end) / self.total()
    }

    /// Draws a direction in proportion to the luminance.
    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> DrawnDirection {
        let [bottom, horizon, top] = self.luminances.map(f64::from);
        let (below, above) = (bottom + horizon, horizon + top);
        let pick = u * (below + above);
        let sine = match pick < below {
            true => -linear(horizon, bottom, pick / below),
            false => linear(horizon, top, (pick - below) / above),
        } as f32;
        DrawnDirection {
            direction: spherical(sine, (v as f32) * TAU),
            radiance: self.radiance(sine),
            pdf_solid_angle: self.pdf_solid_angle(sine),
        }
    }

    /// Up or down, whichever is brighter.
    pub fn middle(&self) -> Vec3A {
        let [bottom, _, top] = self.luminances;
        if top >= bottom { Vec3A::Z } else { Vec3A::NEG_Z }
    }

    /// ∫ of the luminance over all directions.
    fn total(&self) -> f32 {
        let [bottom, horizon, top] = self.luminances;
        PI * (bottom + 2.0 * horizon + top)
    }
}

/// A number from 0 to 1 whose density goes linearly from `a` to `b`, up to a factor; `u` is in
/// [0, 1).
fn linear(a: f64, b: f64, u: f64) -> f64 {
    let root = (a * a + u * (b * b - a * a)).max(0.0).sqrt();
    if a + root > 0.0 { (u * (a + b) / (a + root)).clamp(0.0, 1.0) } else { 0.0 }
}
