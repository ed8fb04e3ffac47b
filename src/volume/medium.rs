//! Interface of a medium to light transport: coefficients at a point of a ray, and segments of the
//! ray with upper bounds. The grids behind them stay hidden.

use crate::math::Rgb;

/// The coefficients of the medium at a point, summed over the volumes that overlap there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coefficients {
    /// Extinction μ_t = μ_a + μ_s, 1/length.
    pub mu_t: Rgb,
    /// Scattering μ_s, 1/length.
    pub mu_s: Rgb,
    /// Emission ε, radiance per length.
    pub emission: Rgb,
}

impl Coefficients {
    /// Absorption μ_a = μ_t − μ_s, 1/length.
    #[inline]
    pub fn mu_a(&self) -> Rgb {
        (self.mu_t - self.mu_s).max(Rgb::ZERO)
    }
}

/// A piece of a ray over which one set of bounds holds. Empty pieces are passed over.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Segment {
    /// Ray parameter at which the segment begins.
    pub t0: f32,
    /// Ray parameter at which the segment ends; may be infinite in a medium without borders.
    pub t1: f32,
    /// Upper bound of every channel of μ_t, 1/length. Summed over overlapping volumes.
    pub majorant: f32,
    /// Upper bound of lum ε over each volume's brightest chord ∫ lum ε dt, 1/length: collisions at
    /// this rate would be one along that chord. Free of exposure and units. Zero only where
    /// nothing emits.
    pub emission_rate: f32,
    /// Rate of one collision per smallest voxel in the segment, 1/length; 0 where nothing has
    /// voxels.
    pub voxel_rate: f32,
    /// Whether the coefficients are the same all along the segment.
    pub uniform: bool,
    /// Whether μ_t and μ_s are the same in all channels.
    pub gray: bool,
}
