//! Mixture of guided directions: airlight and caustics, to be drawn beside those of BSDF or phase
//! sampling.

use glam::{Vec2, Vec3A};
use smallvec::SmallVec;

use super::airlight::Airlight;
use super::von_mises_fisher::VonMisesFisher;

/// Lobes stored without an allocation.
const FEW: usize = 5;

/// A lobe of guided directions.
#[derive(Clone, Copy, Debug)]
pub enum GuidingLobe {
    /// Airlight around a light.
    Airlight(Airlight),
    /// A caustic.
    Caustic(VonMisesFisher),
}

/// Lobes of directions, each with the share of all directions that it is drawn with. The rest, one
/// minus the sum of the shares, is left to BSDF or phase sampling.
#[derive(Clone, Debug, Default)]
pub struct GuidingMixture {
    lobes: SmallVec<[(f32, GuidingLobe); FEW]>,
}

impl GuidingMixture {
    /// Adds a lobe with a share, 0 to 1, of all directions.
    pub fn add(&mut self, share: f32, lobe: GuidingLobe) {
        if share > 0.0 {
            self.lobes.push((share, lobe));
        }
    }

    /// Sum of the shares.
    pub fn share(&self) -> f32 {
        self.lobes.iter().map(|(share, _)| share).sum()
    }

    /// A unit direction of the lobe that `pick`, in [0, share), chooses, from `u` in [0, 1)²;
    /// `None` only without lobes.
    pub fn sample(&self, pick: f32, u: Vec2) -> Option<Vec3A> {
        let mut left = pick;
        let chosen = self.lobes.iter().find(|(share, _)| {
            left -= share;
            left < 0.0
        });
        let (_, lobe) = chosen.or(self.lobes.last())?;
        Some(match lobe {
            GuidingLobe::Airlight(airlight) => airlight.sample(u),
            GuidingLobe::Caustic(caustic) => caustic.sample(u),
        })
    }

    /// Density over solid angle of a unit direction, which integrates to the sum of the shares.
    pub fn pdf_times_share(&self, direction: Vec3A) -> f32 {
        let of = |(share, lobe): &(f32, GuidingLobe)| {
            let pdf = match lobe {
                GuidingLobe::Airlight(airlight) => airlight.pdf(direction),
                GuidingLobe::Caustic(caustic) => caustic.pdf(direction),
            };
            share * pdf
        };
        self.lobes.iter().map(of).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{math::PathRng, sampling::chi2::Sphere};

    /// The density times the shares integrates to their sum, and the kinds are drawn by them.
    #[test]
    fn counts_follow_the_mixture() {
        let axis = Vec3A::new(0.2, 1.0, 0.3).normalize();
        let mut towards = GuidingMixture::default();
        towards.add(0.3, GuidingLobe::Airlight(Airlight::new(axis, 0.5)));
        towards.add(0.2, GuidingLobe::Caustic(VonMisesFisher::new(axis, 40.0)));
        towards.add(0.25, GuidingLobe::Caustic(VonMisesFisher::new(-axis, 5.0)));
        towards.add(0.0, GuidingLobe::Caustic(VonMisesFisher::new(Vec3A::X, 100.0)));
        let share = towards.share();
        assert_eq!(share, 0.75);
        let sample = |rng: &mut PathRng| {
            let pick = rng.uniform();
            let u = Vec2::new(rng.uniform(), rng.uniform());
            (pick < share).then(|| towards.sample(pick, u).unwrap())
        };
        let bins = Sphere::narrow(axis, 0.01);
        bins.assert_follows("mixture", sample, |d| towards.pdf_times_share(d));
        assert!(GuidingMixture::default().sample(0.0, Vec2::ZERO).is_none());
    }
}
