//! Pearson's χ² test of samplers against the densities that stand beside them, for tests alone.
//!
//! Draws are counted in bins, over which the density is integrated; bins that expect fewer than five
//! are joined. All tests of this kind together raise a false alarm with a probability of [`ALPHA`]:
//! each has the share of it that Šidák's correction gives one of [`TESTS`]. With [`DRAWS`] draws a
//! density that is off by 5 % over half of its mass fails nearly surely. The density's integral is
//! held against the share of the draws that bring anything, to [`MASS`].

use std::f64::consts::{PI, TAU};

use glam::{UVec2, Vec3A};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::math::{OrthonormalBasis, PathRng};

/// Probability of a false alarm, of all tests together.
const ALPHA: f64 = 1e-3;
/// As many tests as there may be.
const TESTS: f64 = 200.0;
/// Draws of a test.
const DRAWS: u32 = 200_000;
/// Largest error of the density's integral, five standard errors of a share of the draws at most.
const MASS: f64 = 2e-3;
/// Fewest draws that a bin expects.
const FEWEST: f64 = 5.0;
/// Most draws that rounding puts where nearly none are expected.
const MOST_STRAY: f64 = 20.0;
/// Bins around the axis.
const SECTORS: usize = 16;
/// Bins of the sphere: rings about an axis, cut into sectors.
pub(crate) struct Sphere {
    frame: OrthonormalBasis,
    /// Angles between the rings, from 0 to π.
    edges: Vec<f64>,
    /// Points at which the density is read along each edge of a bin.
    points: usize,
}

impl Sphere {
    /// Rings of the same width; a horizon across the axis lies between two of them. Lobes that are
    /// some hundredths wide may lie anywhere.
    pub(crate) fn even(axis: Vec3A) -> Self {
        const RINGS: usize = 48;
        let edges = (0..=RINGS).map(|ring| PI * ring as f64 / RINGS as f64).collect();
        Self { frame: OrthonormalBasis::around(axis), edges, points: 32 }
    }

    /// Rings of ever smaller width around the axis, the innermost of them `least` wide.
    pub(crate) fn narrow(axis: Vec3A, least: f64) -> Self {
        const RINGS: usize = 40;
        let growth = (PI / least).powf(1.0 / (RINGS as f64 - 1.0));
        let edges = (0..RINGS).map(|ring| (least * growth.powi(ring as i32)).min(PI));
        let edges = std::iter::once(0.0).chain(edges).collect();
        Self { frame: OrthonormalBasis::around(axis), edges, points: 12 }
    }

    fn direction(&self, theta: f64, phi: f64) -> Vec3A {
        let local = Vec3A::new(
            (theta.sin() * phi.cos()) as f32,
            (theta.sin() * phi.sin()) as f32,
            theta.cos() as f32,
        );
        self.frame.world_from_local(local)
    }

    fn bin(&self, direction: Vec3A) -> usize {
        let local = self.frame.local_from_world(direction);
        let theta = f64::from(local.truncate().length()).atan2(f64::from(local.z));
        let phi = f64::from(local.y).atan2(f64::from(local.x)).rem_euclid(TAU);
        let rings = self.edges.len() - 1;
        let ring = self.edges.partition_point(|edge| *edge <= theta).clamp(1, rings) - 1;
        ring * SECTORS + ((phi / TAU * SECTORS as f64) as usize).min(SECTORS - 1)
    }

    /// ∫ of a density over each bin.
    fn integrals(&self, pdf: impl Fn(Vec3A) -> f32) -> Vec<f64> {
        let mut integrals = Vec::new();
        for ring in self.edges.windows(2) {
            let step = (ring[1] - ring[0]) / self.points as f64;
            for sector in 0..SECTORS {
                let mut sum = 0.0;
                for i in 0..self.points * self.points {
                    let theta = ring[0] + ((i / self.points) as f64 + 0.5) * step;
                    let part = ((i % self.points) as f64 + 0.5) / self.points as f64;
                    let phi = TAU * (sector as f64 + part) / SECTORS as f64;
                    sum += f64::from(pdf(self.direction(theta, phi))) * theta.sin();
                }
                integrals.push(sum * step * TAU / (SECTORS * self.points) as f64);
            }
        }
        integrals
    }

    /// Asserts that what `sample` draws, where it draws anything, has density `pdf` over solid angle.
    pub(crate) fn assert_follows(
        &self,
        name: &str,
        mut sample: impl FnMut(&mut PathRng) -> Option<Vec3A>,
        pdf: impl Fn(Vec3A) -> f32,
    ) {
        let integrals = self.integrals(pdf);
        assert_counts(name, &integrals, |rng| sample(rng).map(|direction| self.bin(direction)));
    }
}

/// Asserts that the numbers that `sample` draws have density `pdf`, in bins between `edges`, which
/// ascend. The density is smooth in each.
pub(crate) fn assert_numbers_follow(
    name: &str,
    edges: &[f32],
    mut sample: impl FnMut(&mut PathRng) -> Option<f32>,
    pdf: impl Fn(f32) -> f32,
) {
    const STEPS: usize = 200;
    let integral = |ends: &[f32]| {
        let step = (ends[1] - ends[0]) / STEPS as f32;
        let values = (0..STEPS).map(|i| f64::from(pdf(ends[0] + (i as f32 + 0.5) * step)));
        values.sum::<f64>() * f64::from(step)
    };
    let integrals: Vec<f64> = edges.windows(2).map(integral).collect();
    let bin = |t: f32| edges.partition_point(|edge| *edge <= t).clamp(1, integrals.len()) - 1;
    assert_counts(name, &integrals, |rng| sample(rng).map(bin));
}

fn assert_counts(
    name: &str,
    integrals: &[f64],
    mut bin: impl FnMut(&mut PathRng) -> Option<usize>,
) {
    let mut rng = PathRng::new(0, UVec2::ZERO, 0);
    let mut counts = vec![0_u32; integrals.len()];
    (0..DRAWS).filter_map(|_| bin(&mut rng)).for_each(|bin| counts[bin] += 1);
    let drawn = f64::from(counts.iter().sum::<u32>()) / f64::from(DRAWS);
    let mass: f64 = integrals.iter().sum();
    let spread = (drawn * (1.0 - drawn) / f64::from(DRAWS)).sqrt();
    let error = (mass - drawn).abs();
    assert!(error <= MASS.max(5.0 * spread), "{name}: integral {mass}, {drawn} is drawn");
    // What draws nothing is the last bin.
    counts.push(DRAWS - counts.iter().sum::<u32>());
    let rest = (1.0 - mass).max(0.0);
    let (chi_square, degrees) = chi_square(&counts, integrals.iter().copied().chain([rest]));
    let p = 1.0 - ChiSquared::new(degrees).unwrap().cdf(chi_square);
    let least = 1.0 - (1.0 - ALPHA).powf(1.0 / TESTS);
    assert!(p >= least, "{name}: χ² {chi_square:.1} of {degrees} degrees, p {p:.1e}");
}

/// χ² and its degrees of freedom, of bins joined until each expects enough.
fn chi_square(counts: &[u32], integrals: impl Iterator<Item = f64>) -> (f64, f64) {
    let mut joined: Vec<(f64, f64)> = Vec::new();
    let (mut count, mut expected) = (0.0, 0.0);
    for (drawn, integral) in counts.iter().zip(integrals) {
        count += f64::from(*drawn);
        expected += integral * f64::from(DRAWS);
        if expected >= FEWEST {
            joined.push((count, expected));
            (count, expected) = (0.0, 0.0);
        }
    }
    // What is left expects too few for a bin of its own; rounding may put some draws there.
    match joined.last_mut() {
        Some(last) if count <= MOST_STRAY => *last = (last.0 + count, last.1 + expected),
        _ => joined.push((count, expected.max(FEWEST))),
    }
    let terms = joined.iter().map(|(count, expected)| (count - expected).powi(2) / expected);
    (terms.sum(), (joined.len() as f64 - 1.0).max(1.0))
}

/// A density that is off by a twentieth in one half fails, one whose mass is off by a hundredth too.
#[test]
fn wrong_densities_are_found() {
    use crate::sampling::warp::uniform_sphere;
    let check = |pdf: fn(Vec3A) -> f32| {
        let sample =
            |rng: &mut PathRng| Some(uniform_sphere(glam::Vec2::new(rng.uniform(), rng.uniform())));
        let test = || Sphere::even(Vec3A::Y).assert_follows("planted", sample, pdf);
        std::panic::catch_unwind(test).is_ok()
    };
    const EVEN: f32 = crate::sampling::warp::UNIFORM_SPHERE_PDF;
    assert!(check(|_| EVEN));
    assert!(!check(|d| EVEN * if d.x > 0.0 { 1.05 } else { 0.95 }));
    assert!(!check(|_| 1.01 * EVEN));
}
