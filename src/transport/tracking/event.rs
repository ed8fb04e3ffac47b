//! How a flight through the medium ends, and what it brings.

use crate::math::Rgb;
use crate::transport::strategy::Strategy;
use crate::volume::phase::PhaseMix;

/// Where the scattering walk gathers emission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmissionGathering {
    /// On absorption, which ends the path (the baseline).
    Absorption,
    /// At every tentative collision (decoupled).
    EveryCollision,
    /// Nowhere: the emission has its own walk.
    Nothing,
}

impl EmissionGathering {
    /// The toggles' choice for the scattering walk; ratio tracking overrides decoupling.
    pub fn of(strategy: &Strategy) -> Self {
        if strategy.emission_ratio_tracking {
            Self::Nothing
        } else if strategy.emission_decoupling {
            Self::EveryCollision
        } else {
            Self::Absorption
        }
    }
}

/// How a flight through the medium ended.
#[derive(Clone, Debug)]
pub enum Event {
    /// It reached the end of the ray.
    Reached,
    /// It was absorbed.
    Absorbed {
        /// Ray parameter of the collision.
        t: f32,
        /// True where the medium absorbs; false where the event only shows emission that comes
        /// without absorption, and where nothing is left to follow.
        real: bool,
    },
    /// It scatters.
    Scattered {
        /// Ray parameter of the collision.
        t: f32,
        /// Phase function there.
        phase: PhaseMix,
    },
}

/// One flight: from a vertex to the next event on a ray.
#[derive(Clone, Debug)]
pub struct Flight {
    /// How it ended.
    pub event: Event,
    /// Factor of the path's throughput up to and including the event, over the density of the
    /// scattering walk.
    pub weight: Rgb,
    /// Emission gathered on the way, as [`EmissionGathering`] says.
    pub emission: Rgb,
    /// Density, 1/length, with which the scattering walk scatters at the event, given the tentative
    /// collisions before it and apart from their own density: Π P_n · μ̄ P_s. 0 from decomposition
    /// tracking, which does not know it.
    pub pdf_null: f32,
    /// Tentative collisions on the way.
    pub collisions: u32,
}
