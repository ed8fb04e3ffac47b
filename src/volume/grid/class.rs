//! Class of a grid: the meaning of its values.

use std::fmt;

/// Class of a grid: the quantity that its values stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridClass {
    /// No class given.
    Unknown,
    /// Signed distances to a surface near it, and constants elsewhere; not a density.
    LevelSet,
    /// A density.
    FogVolume,
    /// A vector whose components are samples at the faces of the voxels.
    Staggered,
}

impl fmt::Display for GridClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unknown => "unknown",
            Self::LevelSet => "level set",
            Self::FogVolume => "fog volume",
            Self::Staggered => "staggered",
        })
    }
}
