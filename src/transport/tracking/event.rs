//! The event at the end of a flight through the medium, and the flight's contribution.

use crate::math::Rgb;
use crate::transport::strategy::Strategy;
use crate::volume::phase::PhaseMix;

/// Events at which the scattering walk gathers emission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmissionGathering {
    /// Absorption, which ends the path (the baseline).
    Absorption,
    /// Every tentative collision (decoupled).
    EveryCollision,
    /// None: the emission has its own walk.
    Nothing,
}

impl EmissionGathering {
    /// The events that the toggles choose; ratio tracking overrides decoupling.
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

/// Event at the end of a flight through the medium.
#[derive(Clone, Debug)]
pub enum Event {
    /// The flight reached the end of the ray.
    Reached,
    /// The path was absorbed.
    Absorbed {
        /// Ray parameter of the collision.
        t: f32,
        /// True where the medium absorbs; false where the event only gathers emission that comes
        /// without absorption, and where nothing is left to follow.
        real: bool,
    },
    /// The path scatters.
    Scattered {
        /// Ray parameter of the collision.
        t: f32,
        /// Phase function at the collision.
        phase: PhaseMix,
    },
}

/// One flight: from a vertex to the next event on a ray.
#[derive(Clone, Debug)]
pub struct Flight {
    /// Event at the end of the flight.
    pub event: Event,
    /// Factor of the path's throughput up to and including the event, over the density of the
    /// scattering walk.
    pub weight: Rgb,
    /// Emission gathered along the flight, at the events of [`EmissionGathering`].
    pub emission: Rgb,
    /// Density, 1/length, with which the scattering walk scatters at the event, given the tentative
    /// collisions before it and apart from their own density: Π P_n · μ̄ P_s. 0 from decomposition
    /// tracking, for which it is unknown.
    pub pdf_null: f32,
    /// Tentative collisions of the flight.
    pub collisions: u32,
}
