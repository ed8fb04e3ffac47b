//! Time of a render by kind of work, and samples by class of bounce.

use super::learned_counts::BounceClass;

/// Kinds of work that paths spend their time on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// The paths themselves: distances, directions, surfaces.
    Paths,
    /// Light samples of fires.
    FireSamples,
    /// Light samples of all other lights.
    LampSamples,
    /// Emission walks along rays.
    Emission,
    /// Transmittance to the end of rays.
    Transmittance,
}

impl Work {
    /// All kinds, in their order.
    pub const ALL: [Self; Self::COUNT] =
        [Self::Paths, Self::FireSamples, Self::LampSamples, Self::Emission, Self::Transmittance];
    /// Number of kinds.
    pub const COUNT: usize = 5;

    /// Name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paths => "scattering and reflection",
            Self::FireSamples => "light samples of fires",
            Self::LampSamples => "light samples of other lights",
            Self::Emission => "emission along rays",
            Self::Transmittance => "transmittance to the background",
        }
    }
}

/// How the time of a picture is spent, by counted steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spending {
    /// Share, 0 to 1, of each kind of work, in the order of [`Work::ALL`].
    pub shares: [f32; Work::COUNT],
    /// Numbers at the vertices of each class, in the order of [`BounceClass::ALL`].
    pub bounces: [BounceCounts; BounceClass::COUNT],
}

/// Mean numbers at the vertices of one class.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BounceCounts {
    /// Vertices of a sample.
    pub vertices: f32,
    /// Light samples of fires, light samples of other lights, and emission walks, of a vertex.
    pub samples: [f32; 3],
}
