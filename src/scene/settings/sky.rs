//! `sky` of `[environment]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A clear sky (Hosek and Wilkie 2012) with its sun. Radiance 1 is 20 000 cd/m²; a noon sun has an
/// irradiance of about 5.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct SkySettings {
    /// The elevation of the sun above the horizon.
    #[schemars(extend("unit" = "degrees"), range(min = 0.0, max = 90.0))]
    pub sun_elevation: f32,
    /// The direction of the sun, counter-clockwise seen from above; 0 is that of the middle column
    /// of a picture.
    #[schemars(extend("unit" = "degrees"), range(min = -36_000.0, max = 36_000.0))]
    pub sun_azimuth: f32,
    /// The haze of the air: 2 is very clear, 3 clear, 6 hazy.
    #[schemars(range(min = 1.0, max = 10.0))]
    pub turbidity: f32,
    /// The fraction of light that the ground gives back; below the horizon the sky is that gray.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub ground_albedo: f32,
    /// Whether the sun itself shines: a disk of 0.53 degrees behind the same air.
    pub sun: bool,
}

impl Default for SkySettings {
    fn default() -> Self {
        Self {
            sun_elevation: 30.0,
            sun_azimuth: 0.0,
            turbidity: 3.0,
            ground_albedo: 0.3,
            sun: true,
        }
    }
}
