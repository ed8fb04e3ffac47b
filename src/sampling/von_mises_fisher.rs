//! The von Mises-Fisher distribution of directions about an axis.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3A};

use super::warp::about_axis;
use crate::math::OrthonormalBasis;

/// The density κ/(2π (1 − e^−2κ)) exp(−κ (1 − cos θ)) about an axis (Fisher 1953).
#[derive(Clone, Copy, Debug)]
pub struct VonMisesFisher {
    axis: OrthonormalBasis,
    concentration: f32,
}

impl VonMisesFisher {
    /// The density about the unit `axis`, with `concentration` κ > 0: the mean of 1 − cos θ is
    /// about 1/κ where that is small.
    pub fn new(axis: Vec3A, concentration: f32) -> Self {
        Self { axis: OrthonormalBasis::around(axis), concentration }
    }

    /// A unit direction with density [`VonMisesFisher::pdf`], from `u` in [0, 1)².
    pub fn sample(&self, u: Vec2) -> Vec3A {
        let kept = u.x * (-2.0 * self.concentration).exp_m1();
        let one_minus_cos = (-kept.ln_1p() / self.concentration).min(2.0);
        self.axis.world_from_local(about_axis(one_minus_cos, TAU * u.y))
    }

    /// Density over solid angle of a unit direction.
    pub fn pdf(&self, direction: Vec3A) -> f32 {
        // 1 − cos from the difference, which keeps its digits near the axis.
        let one_minus_cos = 0.5 * (direction - self.axis.normal).length_squared();
        let norm = TAU * -(-2.0 * self.concentration).exp_m1() / self.concentration;
        (-self.concentration * one_minus_cos).exp() / norm
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;
    use crate::{math::PathRng, sampling::chi2::Sphere};

    /// The density integrates to one and the share of samples in a cone is its integral.
    #[test]
    fn samples_follow_the_density() {
        let axis = Vec3A::new(-1.0, 0.3, -2.0).normalize();
        let frame = OrthonormalBasis::around(axis);
        for concentration in [0.1, 2.0, 50.0, 1e4] {
            let fisher = VonMisesFisher::new(axis, concentration);
            let reach = (20.0 / concentration).sqrt().min(PI);
            let (n, mut integral) = (40_000, 0.0_f64);
            for i in 0..n {
                let theta = reach * (i as f32 + 0.5) / n as f32;
                let direction = frame.world_from_local(Vec3A::new(0.0, theta.sin(), theta.cos()));
                let band = TAU * theta.sin() * reach / n as f32;
                integral += f64::from(fisher.pdf(direction) * band);
                if i % 4000 == 2000 {
                    let chord = 2.0 - 2.0 * theta.cos();
                    let inside = (0..2000)
                        .filter(|k| {
                            let u = Vec2::new((*k as f32 + 0.5) / 2000.0, 0.81);
                            (fisher.sample(u) - axis).length_squared() < chord
                        })
                        .count();
                    let share = inside as f64 / 2000.0;
                    assert!((share - integral).abs() < 4e-3, "{concentration}: {share} {integral}");
                }
            }
            assert!((integral - 1.0).abs() < 2e-3, "{concentration}: {integral}");
        }
    }

    #[test]
    fn counts_follow_the_density() {
        let axis = Vec3A::new(-1.0, 0.3, -2.0).normalize();
        for concentration in [0.1, 2.0, 50.0, 1e4] {
            let fisher = VonMisesFisher::new(axis, concentration);
            let sample =
                |rng: &mut PathRng| Some(fisher.sample(Vec2::new(rng.uniform(), rng.uniform())));
            let bins = Sphere::narrow(axis, 1e-3);
            bins.assert_follows(&format!("κ {concentration}"), sample, |d| fisher.pdf(d));
        }
    }
}
