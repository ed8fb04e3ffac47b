//! Parallel light from far away.

use std::f32::consts::PI;

use glam::{Vec2, Vec3A};

use super::sample::LightSample;
use crate::{
    math::{OrthonormalBasis, Rgb},
    sampling::warp::{uniform_cone, uniform_cone_pdf},
};

/// Light from far away, from one direction or a disk around it.
#[derive(Clone, Debug)]
pub struct Sun {
    /// Unit direction towards the sun.
    to_sun: Vec3A,
    irradiance: Rgb,
    /// 1 − cos of the disk's half angle; 0 for one direction.
    one_minus_cos: f32,
    visible: bool,
}

impl Sun {
    /// A sun whose light travels along `direction` with `irradiance` on a plane across it. `angle`
    /// is the disk's diameter in degrees, 0 to 180; a `visible` disk can be seen.
    pub fn new(direction: Vec3A, irradiance: Rgb, angle: f32, visible: bool) -> Self {
        let half = 0.5 * angle.to_radians();
        let one_minus_cos = 2.0 * (0.5 * half).sin().powi(2);
        Self { to_sun: -direction.normalize(), irradiance, one_minus_cos, visible }
    }

    /// Unit direction towards the middle of the disk.
    pub fn direction(&self) -> Vec3A {
        self.to_sun
    }

    /// Irradiance on a plane across the sun's direction.
    pub fn irradiance(&self) -> Rgb {
        self.irradiance
    }

    /// Radiance of the disk, uniform: over it the projected solid angle is π sin².
    pub fn radiance(&self) -> Rgb {
        let sin_squared = self.one_minus_cos * (2.0 - self.one_minus_cos);
        self.irradiance / (PI * sin_squared)
    }

    /// Whether the visible disk covers the unit `direction` (away from the viewer).
    pub fn shows_along(&self, direction: Vec3A) -> bool {
        // 1 − cos from the difference, which keeps its digits for small disks.
        let away = 0.5 * (direction - self.to_sun).length_squared();
        self.visible && self.has_disk() && away <= self.one_minus_cos
    }

    /// Density over solid angle of sampling a direction of the disk.
    pub fn pdf_solid_angle(&self) -> f32 {
        uniform_cone_pdf(self.one_minus_cos)
    }

    /// Draws a direction towards the sun's disk.
    pub fn sample(&self, u: Vec2) -> LightSample {
        let distance = f32::INFINITY;
        if !self.has_disk() {
            let (direction, radiance) = (self.to_sun, self.irradiance);
            return LightSample { direction, distance, radiance, pdf: 1.0, can_be_met: false };
        }
        let local = uniform_cone(u, self.one_minus_cos);
        LightSample {
            direction: OrthonormalBasis::around(self.to_sun).world_from_local(local),
            distance,
            radiance: self.radiance(),
            pdf: self.pdf_solid_angle(),
            can_be_met: self.visible,
        }
    }

    fn has_disk(&self) -> bool {
        self.one_minus_cos > 1e-9
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{math::PathRng, sampling::chi2::Sphere};

    /// Directions have the density that is said, and bring the irradiance across the middle one.
    #[test]
    fn counts_follow_the_density_of_the_disk() {
        for degrees in [0.5_f32, 4.0, 60.0] {
            let sun = Sun::new(Vec3A::new(0.3, -0.5, -0.8), Rgb::ONE, degrees, true);
            let sample = |rng: &mut PathRng| {
                Some(sun.sample(Vec2::new(rng.uniform(), rng.uniform())).direction)
            };
            let pdf = |direction| match sun.shows_along(direction) {
                true => sun.pdf_solid_angle(),
                false => 0.0,
            };
            let half_angle = f64::from(0.5 * degrees).to_radians();
            let name = format!("sun of {degrees} degrees");
            Sphere::narrow(sun.direction(), half_angle).assert_follows(&name, sample, pdf);
        }
    }
}
