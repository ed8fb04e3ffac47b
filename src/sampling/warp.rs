//! Directions on spheres, hemispheres and cones. Local directions are about +z.

use std::f32::consts::{FRAC_1_PI, TAU};

use glam::{Vec2, Vec3A};

/// A unit vector from its cosine to +z and its azimuth.
#[inline]
pub fn spherical(cos_theta: f32, phi: f32) -> Vec3A {
    let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
    let (sin_phi, cos_phi) = phi.sin_cos();
    Vec3A::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

/// A unit vector from 1 − cos of its angle to +z and its azimuth; narrow angles keep their digits.
#[inline]
pub fn about_axis(one_minus_cos: f32, phi: f32) -> Vec3A {
    let sin_theta = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = phi.sin_cos();
    Vec3A::new(sin_theta * cos_phi, sin_theta * sin_phi, 1.0 - one_minus_cos)
}

/// A direction uniform over the sphere; its density is [`UNIFORM_SPHERE_PDF`].
#[inline]
pub fn uniform_sphere(u: Vec2) -> Vec3A {
    spherical(1.0 - 2.0 * u.x, TAU * u.y)
}

/// Density of [`uniform_sphere`] over solid angle, 1/(4π).
pub const UNIFORM_SPHERE_PDF: f32 = 0.25 * FRAC_1_PI;

/// A direction on the upper hemisphere with density [`cosine_hemisphere_pdf`].
#[inline]
pub fn cosine_hemisphere(u: Vec2) -> Vec3A {
    spherical((1.0 - u.x).sqrt(), TAU * u.y)
}

/// Density of [`cosine_hemisphere`] over solid angle, cos θ / π.
#[inline]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// A direction uniform over the cone about +z with `one_minus_cos` = 1 − cos of its half angle,
/// given so because narrow cones would lose it to rounding.
#[inline]
pub fn uniform_cone(u: Vec2, one_minus_cos: f32) -> Vec3A {
    about_axis(u.x * one_minus_cos, TAU * u.y)
}

/// Density of [`uniform_cone`] over solid angle inside the cone.
#[inline]
pub fn uniform_cone_pdf(one_minus_cos: f32) -> f32 {
    1.0 / (TAU * one_minus_cos)
}

/// A point uniform on the unit disk.
#[inline]
pub fn uniform_disk(u: Vec2) -> Vec2 {
    let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
    u.x.sqrt() * Vec2::new(cos_phi, sin_phi)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{math::PathRng, sampling::chi2::Sphere};

    fn pair(rng: &mut PathRng) -> Vec2 {
        Vec2::new(rng.uniform(), rng.uniform())
    }

    #[test]
    fn directions_follow_their_densities() {
        let even = Sphere::even(Vec3A::Z);
        let sphere = |rng: &mut PathRng| Some(uniform_sphere(pair(rng)));
        even.assert_follows("sphere", sphere, |_| UNIFORM_SPHERE_PDF);
        let cosine = |rng: &mut PathRng| Some(cosine_hemisphere(pair(rng)));
        even.assert_follows("cosine", cosine, |direction| cosine_hemisphere_pdf(direction.z));
    }

    /// The innermost rings of the bins are the cone's, so that its rim lies between two of them.
    #[test]
    fn cones_are_filled_evenly() {
        for half_angle in [0.001_f64, 0.1, 2.0] {
            let one_minus_cos = (1.0 - half_angle.cos()) as f32;
            let within = |direction: Vec3A| direction.truncate().length().atan2(direction.z);
            let pdf = |direction: Vec3A| match f64::from(within(direction)) < half_angle {
                true => uniform_cone_pdf(one_minus_cos),
                false => 0.0,
            };
            let cone = |rng: &mut PathRng| Some(uniform_cone(pair(rng), one_minus_cos));
            let name = format!("cone of {half_angle}");
            Sphere::narrow(Vec3A::Z, half_angle).assert_follows(&name, cone, pdf);
        }
    }
}
