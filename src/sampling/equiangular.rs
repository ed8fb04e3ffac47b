//! Equiangular sampling: distances along a ray with evenly spread angles to a point, or with more
//! of the angles by which light from the point is scattered forward.

use glam::Vec3A;

use crate::math::Ray;

/// A density over the parameter of a ray for light from a point beside it (Kulla and Fajardo 2012).
///
/// With b the point's distance from the ray and φ the angle by which its light is scattered into
/// the ray's back direction, dt = (b²+x²)/b dφ takes the light's 1/d² away. For a medium that
/// scatters forward, φ has density ∝ (a² + φ²)^(-3/2) with a = (1−g)/√g, which is
/// Henyey–Greenstein's for small angles; otherwise it is uniform.
#[derive(Clone, Copy, Debug)]
pub struct Equiangular {
    t0: f32,
    t1: f32,
    /// Ray parameter of the place nearest to the point.
    nearest: f32,
    /// Distance b of the point from the ray.
    aside: f32,
    /// The width a of the density of φ; infinite where φ is uniform.
    spread: f32,
    /// Distribution function of φ at both ends of the range.
    low: f32,
    high: f32,
}

/// Least distance of the point from the ray, relative to its distance from the origin.
const LEAST_ASIDE: f32 = 1e-4;
/// Mean cosines below this count as none.
const LEAST_COSINE: f32 = 0.05;

impl Equiangular {
    /// The density between the parameters `t0` and `t1`, which may be infinite, of `ray` for light
    /// from `point` in a medium of mean cosine `g`; `None` where there is no distance to draw.
    pub fn new(ray: &Ray, point: Vec3A, g: f32, t0: f32, t1: f32) -> Option<Self> {
        let nearest = (point - ray.origin).dot(ray.direction);
        let away = (point - ray.at(nearest)).length();
        let aside = away.max(LEAST_ASIDE * nearest.abs()).max(f32::MIN_POSITIVE);
        let spread = if g > LEAST_COSINE { (1.0 - g) / g.sqrt() } else { f32::INFINITY };
        let mut all = Self { t0, t1, nearest, aside, spread, low: 0.0, high: 0.0 };
        (all.low, all.high) = (all.distribution(all.angle(t0)), all.distribution(all.angle(t1)));
        let drawable = t0 < t1 && all.high - all.low > 8.0 * f32::EPSILON * all.high;
        (drawable && t0.is_finite() && nearest.is_finite() && aside.is_finite()).then_some(all)
    }

    /// A parameter with density [`Equiangular::pdf`], from `u` in [0, 1).
    pub fn sample(&self, u: f32) -> f32 {
        let value = self.low + u * (self.high - self.low);
        let angle = if self.spread.is_infinite() {
            value
        } else {
            self.spread * value / (1.0 - value * value).max(f32::MIN_POSITIVE).sqrt()
        };
        let (sin, cos) = angle.sin_cos();
        let t = self.nearest - self.aside * cos / sin.max(f32::MIN_POSITIVE);
        t.clamp(self.t0, self.t1.min(f32::MAX))
    }

    /// Density at parameter `t`, 1/length.
    pub fn pdf(&self, t: f32) -> f32 {
        if t < self.t0 || t > self.t1 {
            return 0.0;
        }
        let x = t - self.nearest;
        let along = self.aside / (self.aside * self.aside + x * x);
        self.slope(self.angle(t)) / (self.high - self.low) * along
    }

    /// φ at parameter `t`: 0 far before the point, π far behind it.
    fn angle(&self, t: f32) -> f32 {
        self.aside.atan2(self.nearest - t)
    }

    fn distribution(&self, angle: f32) -> f32 {
        if self.spread.is_infinite() {
            return angle;
        }
        angle / (self.spread * self.spread + angle * angle).sqrt()
    }

    /// Density of φ: the derivative of its distribution function.
    fn slope(&self, angle: f32) -> f32 {
        if self.spread.is_infinite() {
            return 1.0;
        }
        let square = self.spread * self.spread;
        let sum = square + angle * angle;
        square / (sum * sum.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{math::PathRng, sampling::chi2::assert_numbers_follow};

    const RAY: Ray = Ray { origin: Vec3A::ZERO, direction: Vec3A::X, time: 0.0 };

    /// The share of samples below t is the integral of the density up to t, whatever the phase
    /// function, for points beside, before and behind the range and next to the ray.
    #[test]
    fn samples_follow_the_density() {
        for g in [-0.5, 0.0, 0.5, 0.9] {
            for point in [
                Vec3A::new(2.0, 0.3, 0.0),
                Vec3A::new(-1.0, 0.5, 0.2),
                Vec3A::new(9.0, 0.0, 2.0),
                Vec3A::new(2.5, 0.02, 0.0),
            ] {
                let (t0, t1) = (0.5, 4.0);
                let all = Equiangular::new(&RAY, point, g, t0, t1).unwrap();
                let n = 200_000;
                let step = (t1 - t0) / n as f32;
                let mut integral = 0.0_f64;
                for i in 0..n {
                    let t = t0 + (i as f32 + 0.5) * step;
                    integral += f64::from(all.pdf(t)) * f64::from(step);
                    if i % 20_000 == 10_000 {
                        let (mut low, mut high) = (0.0_f32, 1.0_f32);
                        for _ in 0..24 {
                            let middle = 0.5 * (low + high);
                            if all.sample(middle) <= t { low = middle } else { high = middle }
                        }
                        let error = (f64::from(low) - integral).abs();
                        assert!(error < 1e-3, "g {g}, {point}: {low} for {integral} at {t}");
                    }
                }
                assert!((integral - 1.0).abs() < 1e-3, "g {g}, {point}: {integral}");
            }
        }
    }

    #[test]
    fn ranges_without_end_and_points_on_the_ray_have_finite_samples() {
        for point in [Vec3A::new(3.0, 0.0, 0.0), Vec3A::new(3.0, 1.0, 0.0), Vec3A::ZERO] {
            for g in [0.0, 0.8] {
                let Some(all) = Equiangular::new(&RAY, point, g, 0.0, f32::INFINITY) else {
                    continue;
                };
                for i in 0..10_000 {
                    let t = all.sample(i as f32 / 10_000.0);
                    assert!(t >= 0.0 && t.is_finite() && all.pdf(t) >= 0.0, "{point}: {t}");
                }
            }
        }
        assert!(Equiangular::new(&RAY, Vec3A::Y, 0.0, 2.0, 2.0).is_none());
        assert!(Equiangular::new(&RAY, Vec3A::NAN, 0.0, 0.0, 1.0).is_none());
    }

    /// Beside, before and behind the stretch, and of a stretch without end as far as most draws go.
    /// Behind the stretch a narrow lobe leaves single precision two thousand distances to draw,
    /// which bins as fine as these would tell.
    #[test]
    fn counts_follow_the_density() {
        let [beside, before, behind] =
            [[2.0, 0.3, 0.0], [9.0, 0.0, 2.0], [-1.0, 0.5, 0.2]].map(Vec3A::from);
        let edges: Vec<f32> = (0..=200).map(|i| 0.5 + i as f32 * 3.5 / 200.0).collect();
        for (point, g) in [
            (beside, 0.0),
            (beside, 0.5),
            (beside, 0.9),
            (before, 0.0),
            (before, 0.5),
            (before, 0.9),
            (behind, 0.0),
            (behind, 0.5),
        ] {
            for t1 in [4.0, f32::INFINITY] {
                let all = Equiangular::new(&RAY, point, g, 0.5, t1).unwrap();
                let sample = |rng: &mut PathRng| Some(all.sample(rng.uniform()));
                let sample = |rng: &mut PathRng| sample(rng).filter(|t| *t < 4.0);
                let name = format!("g {g}, {point}, to {t1}");
                assert_numbers_follow(&name, &edges, sample, |t| all.pdf(t));
            }
        }
    }
}
