//! The emission of a whole ray, and the kinds of rays it is gathered along.

use crate::math::Rgb;

/// The share of the looks along a camera ray that any other ray gets.
const OTHER_LOOKS: f32 = 0.25;

/// The emission of a ray and what it is seen through, as an emission walk estimates them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayEmission {
    /// ∫ T ε dt along the ray.
    pub emission: Rgb,
    /// T to the ray's end.
    pub transmittance: Rgb,
    /// Tentative collisions, or places looked at, on the way.
    pub collisions: u32,
}

/// Which ray of a path the emission is gathered along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// A camera ray.
    Camera,
    /// A ray that scattering or reflection sent.
    Scattered,
    /// A ray to a light, for next-event estimation.
    Light,
}

impl RayKind {
    /// The part of `looks` that a ray of this kind is worth. Camera rays are looked at closely; any
    /// other ray is one of many directions, whose choice is noisier than a coarse estimate along it.
    pub(in crate::transport) fn share(self, looks: f32) -> f32 {
        match self {
            Self::Camera => looks,
            Self::Scattered | Self::Light => OTHER_LOOKS * looks,
        }
    }
}

/// ε ∫₀^length exp(−μ_t t) dt per channel.
pub(in crate::transport) fn attenuated(emission: Rgb, mu_t: Rgb, length: f32) -> Rgb {
    let of = |epsilon: f32, mu: f32| {
        let tau = mu * length;
        match () {
            // Not even an infinite length of nothing glows.
            () if epsilon == 0.0 => 0.0,
            () if mu == 0.0 => epsilon * length,
            () if tau < 1e-4 => epsilon * length * (1.0 - 0.5 * tau),
            () => -epsilon * (-tau).exp_m1() / mu,
        }
    };
    Rgb::new(of(emission.x, mu_t.x), of(emission.y, mu_t.y), of(emission.z, mu_t.z))
}
