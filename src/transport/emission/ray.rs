//! The emission of a whole ray, and the kinds of rays it is gathered along.

use crate::math::Rgb;

/// Collisions or reads along any other ray, relative to those along a camera ray.
const OTHER_SHARE: f32 = 0.25;

/// Emission and transmittance of a whole ray, as an emission walk estimates them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayEmission {
    /// ∫ T ε dt along the ray, radiance.
    pub emission: Rgb,
    /// Transmittance T to the ray's end.
    pub transmittance: Rgb,
    /// Tentative collisions, or reads of the medium, along the ray.
    pub collisions: u32,
}

/// Kind of a ray that emission is gathered along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// A camera ray.
    Camera,
    /// A ray after scattering or reflection.
    Scattered,
    /// A ray to a light, for next-event estimation.
    Light,
}

impl RayKind {
    /// The part of `amount`, collisions or reads along the brightest chord, for a ray of this kind.
    /// Camera rays are sampled closely; any other ray is one of many directions, whose choice is
    /// noisier than a coarse estimate along it.
    pub(in crate::transport) fn share(self, amount: f32) -> f32 {
        match self {
            Self::Camera => amount,
            Self::Scattered | Self::Light => OTHER_SHARE * amount,
        }
    }
}

/// ε ∫₀^length exp(−μ_t t) dt per channel.
pub(in crate::transport) fn attenuated(emission: Rgb, mu_t: Rgb, length: f32) -> Rgb {
    let of = |epsilon: f32, mu: f32| {
        let tau = mu * length;
        match () {
            // No emission even over an infinite length.
            () if epsilon == 0.0 => 0.0,
            () if mu == 0.0 => epsilon * length,
            () if tau < 1e-4 => epsilon * length * (1.0 - 0.5 * tau),
            () => -epsilon * (-tau).exp_m1() / mu,
        }
    };
    Rgb::new(of(emission.x, mu_t.x), of(emission.y, mu_t.y), of(emission.z, mu_t.z))
}
