//! Several kinds of directions that are worth more than chance gives them.

use glam::{Vec2, Vec3A};
use smallvec::SmallVec;

use super::airlight::Airlight;
use super::von_mises_fisher::VonMisesFisher;

/// Kinds that need no memory of their own.
const FEW: usize = 5;

/// One kind of directions.
#[derive(Clone, Copy, Debug)]
pub enum GuidingLobe {
    /// The glow about a light.
    Airlight(Airlight),
    /// A bundle of light.
    Caustic(VonMisesFisher),
}

/// Kinds of directions, each with the share of all directions that it is drawn with. What the
/// shares leave of one is drawn otherwise.
#[derive(Clone, Debug, Default)]
pub struct GuidingMixture {
    lobes: SmallVec<[(f32, GuidingLobe); FEW]>,
}

impl GuidingMixture {
    /// Adds a kind with a share of all directions.
    pub fn add(&mut self, share: f32, lobe: GuidingLobe) {
        if share > 0.0 {
            self.lobes.push((share, lobe));
        }
    }

    /// Sum of the shares.
    pub fn share(&self) -> f32 {
        self.lobes.iter().map(|(share, _)| share).sum()
    }

    /// A unit direction of the kind that `pick`, in [0, share), chooses, from `u` in [0, 1)²;
    /// `None` only where there is no kind.
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
