//! Henyey–Greenstein phase functions and their mixture where volumes overlap.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3A};
use smallvec::SmallVec;

use crate::{
    math::{OrthonormalBasis, Rgb, mean},
    sampling::warp::about_axis,
};

/// Henyey–Greenstein (1941) density over solid angle for unit directions of propagation before and
/// after. `g` in (−1, 1); positive scatters forward.
///
/// The denominator 1 + g² − 2 g cos θ is written as (1 − |g|)² + |g| d² with d the distance of
/// the two directions (of their opposites for g < 0), which keeps its digits in narrow lobes.
#[inline]
pub fn henyey_greenstein(g: f32, forward: Vec3A, scattered: Vec3A) -> f32 {
    let strength = g.abs();
    let apart = if g < 0.0 { forward + scattered } else { forward - scattered };
    let denominator = (1.0 - strength).powi(2) + strength * apart.length_squared();
    (1.0 - strength) * (1.0 + strength) / (4.0 * PI * denominator * denominator.sqrt())
}

/// Draws a direction of propagation with density [`henyey_greenstein`] about the unit `forward`.
///
/// The inverse of the distribution is written for 1 − cos θ, which a narrow lobe needs.
#[inline]
pub fn sample_henyey_greenstein(g: f32, forward: Vec3A, u: Vec2) -> Vec3A {
    let strength = g.abs();
    let below = 1.0 - strength;
    let inverse = 1.0 / (1.0 + strength - 2.0 * strength * u.x);
    let one_minus_cos = below * u.x * inverse * (below * (1.0 + strength) * inverse + below);
    let lobe = if g < 0.0 { -forward } else { forward };
    OrthonormalBasis::around(lobe).world_from_local(about_axis(one_minus_cos, TAU * u.y))
}

/// The phase function of a medium: one Henyey–Greenstein lobe or two.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Phase {
    /// Mean cosine of the first lobe, −1 to 1.
    pub g: f32,
    /// Mean cosine of the second lobe, −1 to 1.
    pub g2: f32,
    /// Share of the second lobe, 0 to 1.
    pub mix: f32,
}

impl Phase {
    /// A single lobe of that mean cosine.
    pub fn of(g: f32) -> Self {
        Self { g, ..Self::default() }
    }
}

/// The phase function at a point: the overlapping volumes' lobes, weighted by their μ_s.
#[derive(Clone, Debug, Default)]
pub struct PhaseMix {
    lobes: SmallVec<[HenyeyGreensteinLobe; 2]>,
}

#[derive(Clone, Copy, Debug)]
struct HenyeyGreensteinLobe {
    g: f32,
    mu_s: Rgb,
}

impl PhaseMix {
    /// Adds the lobes of a volume that scatters `mu_s` here.
    #[inline]
    pub fn add(&mut self, phase: &Phase, mu_s: Rgb) {
        if phase.mix < 1.0 {
            self.add_lobe(phase.g, (1.0 - phase.mix) * mu_s);
        }
        if phase.mix > 0.0 {
            self.add_lobe(phase.g2, phase.mix * mu_s);
        }
    }

    fn add_lobe(&mut self, g: f32, mu_s: Rgb) {
        match self.lobes.iter_mut().find(|lobe| lobe.g == g) {
            Some(lobe) => lobe.mu_s += mu_s,
            None => self.lobes.push(HenyeyGreensteinLobe { g, mu_s }),
        }
    }

    /// Mean cosine of the scattering angle.
    pub fn mean_cosine(&self) -> f32 {
        let (sum, total) = self.lobes.iter().fold((0.0, 0.0), |(sum, total), lobe| {
            let mu_s = mean(lobe.mu_s);
            (sum + mu_s * lobe.g, total + mu_s)
        });
        if total > 0.0 { sum / total } else { 0.0 }
    }

    /// Value per channel (1/sr) and the density that [`PhaseMix::sample`] draws with, for unit
    /// directions of propagation before and after.
    #[inline]
    pub fn eval(&self, forward: Vec3A, scattered: Vec3A) -> (Rgb, f32) {
        if let [lobe] = self.lobes.as_slice() {
            let value = henyey_greenstein(lobe.g, forward, scattered);
            return (Rgb::splat(value), value);
        }
        let (mut sum, mut total) = (Rgb::ZERO, Rgb::ZERO);
        for lobe in &self.lobes {
            sum += lobe.mu_s * henyey_greenstein(lobe.g, forward, scattered);
            total += lobe.mu_s;
        }
        if mean(total) <= 0.0 {
            return (Rgb::ZERO, 0.0);
        }
        (sum / total.max(Rgb::splat(f32::MIN_POSITIVE)), mean(sum) / mean(total))
    }

    /// Draws a direction of propagation, a lobe first by its share of the mean μ_s.
    pub fn sample(&self, forward: Vec3A, pick: f32, u: Vec2) -> Vec3A {
        let total: f32 = self.lobes.iter().map(|lobe| mean(lobe.mu_s)).sum();
        let mut left = pick * total;
        let mut g = 0.0;
        for lobe in &self.lobes {
            g = lobe.g;
            left -= mean(lobe.mu_s);
            if left < 0.0 {
                break;
            }
        }
        sample_henyey_greenstein(g, forward, u)
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::{
        math::PathRng,
        sampling::{chi2::Sphere, warp::spherical},
    };

    #[test]
    fn sampled_cosine_has_mean_g() {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        for g in [-0.9, -0.3, 0.0, 5e-4, 0.5, 0.95] {
            let n = 200_000;
            let sum: f64 = (0..n)
                .map(|_| {
                    let u = Vec2::new(rng.uniform(), rng.uniform());
                    f64::from(sample_henyey_greenstein(g, Vec3A::X, u).x)
                })
                .sum();
            // The cosine's standard deviation is at most 0.58, so 5 standard errors are 0.0065.
            assert!((sum / f64::from(n) - f64::from(g)).abs() < 6.5e-3, "g {g}");
        }
    }

    /// A narrow lobe has its digits: the density, integrated over ever larger cones about its
    /// axis, follows the closed form of its distribution.
    #[test]
    fn narrow_lobes_integrate_to_their_distribution() {
        for g in [0.99_f32, 0.999, -0.999] {
            let axis = if g < 0.0 { -Vec3A::Z } else { Vec3A::Z };
            let strength = f64::from(g.abs());
            let (widest, n) = (1e-4_f64, 20_000);
            let mut sum = 0.0;
            for i in 0..n {
                let one_minus_cos = widest * (f64::from(i) + 0.5) / f64::from(n);
                let mut direction = about_axis(one_minus_cos as f32, 0.7);
                direction.z *= axis.z;
                sum += f64::from(henyey_greenstein(g, Vec3A::Z, direction));
            }
            let measured = sum * widest / f64::from(n) * f64::from(TAU);
            let root = ((1.0 - strength).powi(2) + 2.0 * strength * widest).sqrt();
            let expected = (1.0 - strength * strength) / (2.0 * strength)
                * (1.0 / (1.0 - strength) - 1.0 / root);
            assert!((measured / expected - 1.0).abs() < 2e-3, "g {g}: {measured} {expected}");
        }
    }

    #[test]
    fn the_mixture_integrates_to_one_in_each_channel() {
        let mut mix = PhaseMix::default();
        mix.add(&Phase::of(0.7), Rgb::new(1.0, 0.2, 0.0));
        mix.add(&Phase { g: -0.4, g2: 0.9, mix: 0.3 }, Rgb::new(0.5, 0.5, 2.0));
        let n = 4000;
        let (mut value, mut pdf) = (Rgb::ZERO, 0.0);
        for i in 0..n {
            let cos_theta = -1.0 + 2.0 * (i as f32 + 0.5) / n as f32;
            let (v, p) = mix.eval(Vec3A::Z, spherical(cos_theta, 0.3));
            value += v * (TAU * 2.0 / n as f32);
            pdf += p * TAU * 2.0 / n as f32;
        }
        assert!((value - Rgb::ONE).abs().max_element() < 1e-3 && (pdf - 1.0).abs() < 1e-3);
    }

    /// The mean cosine of two lobes is the mean of theirs, and a share of 0 or 1 leaves one.
    #[test]
    fn shares_of_lobes_are_those_of_their_light() {
        let mix_of = |phase: Phase| {
            let mut mix = PhaseMix::default();
            mix.add(&phase, Rgb::ONE);
            mix
        };
        let two = mix_of(Phase { g: 0.8, g2: -0.4, mix: 0.25 });
        assert!((two.mean_cosine() - 0.5).abs() < 1e-6);
        let (forward, aside) = (Vec3A::Z, Vec3A::new(0.6, 0.0, 0.8));
        for (mix, left) in [(0.0, 0.8), (1.0, -0.4)] {
            let one = mix_of(Phase { g: 0.8, g2: -0.4, mix });
            assert_eq!(one.eval(forward, aside), mix_of(Phase::of(left)).eval(forward, aside));
        }
    }

    #[test]
    fn counts_follow_the_density() {
        let forward = Vec3A::new(-0.3, 0.8, 0.1).normalize();
        let check = |name: &str, mix: &PhaseMix, least: f64| {
            let sample = |rng: &mut PathRng| {
                let (pick, u) = (rng.uniform(), Vec2::new(rng.uniform(), rng.uniform()));
                Some(mix.sample(forward, pick, u))
            };
            let bins = Sphere::narrow(forward, least);
            bins.assert_follows(name, sample, |direction| mix.eval(forward, direction).1);
        };
        for g in [0.0, 0.5, 0.9, 0.99, -0.3] {
            let mut lobe = PhaseMix::default();
            lobe.add(&Phase::of(g), Rgb::ONE);
            check(&format!("g {g}"), &lobe, 1e-3);
        }
        let mut mix = PhaseMix::default();
        mix.add(&Phase { g: 0.8, g2: -0.7, mix: 0.4 }, Rgb::new(1.0, 0.2, 0.0));
        mix.add(&Phase::of(-0.4), Rgb::new(0.5, 0.5, 2.0));
        check("mixture", &mix, 1e-2);
    }
}
