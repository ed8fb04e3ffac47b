//! Directions about the direction to a light, with a density that follows airlight: the glow of a
//! medium around a light.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3A};

use super::warp::spherical;
use crate::math::OrthonormalBasis;

/// A density over directions that peaks towards a light.
///
/// Light from a point in a medium, scattered once, is seen at the angle θ from it with a radiance
/// ∝ (1/sin θ) ∫_θ^π ρ(φ) dφ (the airlight integral, Sun et al. 2005, T left out). The integral is
/// flat up to about 1 − g and falls as θ⁻² from there, for which a Cauchy density of θ stands.
#[derive(Clone, Copy, Debug)]
pub struct Airlight {
    axis: OrthonormalBasis,
    /// Half width of the density of θ.
    spread: f32,
    /// atan(π / spread).
    reach: f32,
}

/// Least half width of the density of θ, radians.
const LEAST_SPREAD: f32 = 0.02;
/// Least sine of the angle that densities are formed with.
const LEAST_SINE: f32 = 1e-6;

impl Airlight {
    /// The density about the unit `axis`, towards the light, in a medium of mean cosine `g`.
    pub fn new(axis: Vec3A, g: f32) -> Self {
        let spread = (1.0 - g.abs()).max(LEAST_SPREAD);
        Self { axis: OrthonormalBasis::around(axis), spread, reach: (PI / spread).atan() }
    }

    /// A unit direction with density [`Airlight::pdf`], from `u` in [0, 1)².
    pub fn sample(&self, u: Vec2) -> Vec3A {
        let theta = self.spread * (u.x * self.reach).tan();
        let (sin, cos) = theta.min(PI).sin_cos();
        let around = spherical(0.0, TAU * u.y);
        self.axis.world_from_local(Vec3A::new(sin * around.x, sin * around.y, cos))
    }

    /// Density over solid angle of a unit direction.
    pub fn pdf(&self, direction: Vec3A) -> f32 {
        let local = self.axis.local_from_world(direction);
        let sin = local.truncate().length();
        let theta = sin.atan2(local.z);
        let density = self.spread / (self.reach * (self.spread * self.spread + theta * theta));
        density / (TAU * sin.max(LEAST_SINE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{math::PathRng, sampling::chi2::Sphere};

    /// The density integrates to one and the share of samples in a cone is its integral.
    #[test]
    fn samples_follow_the_density() {
        let axis = Vec3A::new(1.0, -2.0, 0.5).normalize();
        let frame = OrthonormalBasis::around(axis);
        for g in [-0.7, 0.0, 0.6, 0.95] {
            let airlight = Airlight::new(axis, g);
            let (n, mut integral) = (40_000, 0.0_f64);
            for i in 0..n {
                let theta = PI * (i as f32 + 0.5) / n as f32;
                let direction = frame.world_from_local(Vec3A::new(theta.sin(), 0.0, theta.cos()));
                let band = TAU * theta.sin() * PI / n as f32;
                integral += f64::from(airlight.pdf(direction) * band);
                if i % 8000 == 4000 {
                    let inside = (0..2000)
                        .filter(|k| {
                            let u = Vec2::new((*k as f32 + 0.5) / 2000.0, 0.37);
                            airlight.sample(u).dot(axis) > theta.cos()
                        })
                        .count();
                    let share = inside as f64 / 2000.0;
                    assert!((share - integral).abs() < 2e-3, "g {g}: {share} for {integral}");
                }
            }
            assert!((integral - 1.0).abs() < 1e-3, "g {g}: {integral}");
        }
    }

    #[test]
    fn directions_are_unit_vectors_all_around() {
        let airlight = Airlight::new(Vec3A::Z, 0.3);
        let mut sum = Vec3A::ZERO;
        for i in 0..1000 {
            let u = Vec2::new(0.999, i as f32 / 1000.0);
            let direction = airlight.sample(u);
            assert!((direction.length() - 1.0).abs() < 1e-5 && airlight.pdf(direction) > 0.0);
            sum += direction;
        }
        assert!(sum.truncate().length() < 1.0);
    }

    #[test]
    fn counts_follow_the_density() {
        let axis = Vec3A::new(1.0, -2.0, 0.5).normalize();
        for g in [-0.7, 0.0, 0.6, 0.95] {
            let airlight = Airlight::new(axis, g);
            let sample =
                |rng: &mut PathRng| Some(airlight.sample(Vec2::new(rng.uniform(), rng.uniform())));
            let bins = Sphere::narrow(axis, 0.01);
            bins.assert_follows(&format!("halo of g {g}"), sample, |d| airlight.pdf(d));
        }
    }
}
