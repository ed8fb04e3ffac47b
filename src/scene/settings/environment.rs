//! `[environment]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::or_default::is_default;
use super::{Color, SkySettings};

/// The sky: light from all directions. At most one of its sources is given; none is black.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct EnvironmentSettings {
    /// The radiance of the sky, the same from every direction.
    #[schemars(extend("unit" = "radiance"))]
    pub radiance: Color,
    /// A picture of everything around in latitude and longitude, `.hdr` or `.exr`. Its middle
    /// column looks along +z where +y is up and along -y where +z is up, its left quarter along +x.
    #[schemars(extend("default" = null))]
    #[serde(skip_serializing_if = "is_default")]
    pub file: Option<String>,
    /// A sky by elevation: the radiance straight down, at the horizon and straight up, linear in
    /// the sine of the elevation in between. A plane that faces up has the irradiance
    /// π (horizon + 2/3 (top - horizon)).
    #[schemars(extend("unit" = "radiance", "default" = null))]
    #[schemars(extend("label" = "[bottom, horizon, top], each a number or [r, g, b]"))]
    #[serde(skip_serializing_if = "is_default")]
    pub gradient: Option<[Color; 3]>,
    /// A clear sky with its sun.
    #[serde(skip_serializing_if = "is_default")]
    pub sky: Option<SkySettings>,
    /// The angle that the sky is turned about the world's up, counter-clockwise seen from above.
    #[schemars(extend("unit" = "degrees", "default" = 0.0))]
    #[schemars(range(min = -36_000.0, max = 36_000.0))]
    #[serde(skip_serializing_if = "is_default")]
    pub rotation: f32,
    /// The exposure of the sky: each stop doubles its light.
    #[schemars(extend("unit" = "stops", "default" = 0.0), range(min = -32.0, max = 32.0))]
    #[serde(skip_serializing_if = "is_default")]
    pub exposure: f32,
    /// A color that the light of the sky is multiplied by.
    #[schemars(extend("default" = 1.0))]
    #[serde(skip_serializing_if = "is_one")]
    pub tint: Color,
    /// Whether the camera sees the sky. Otherwise it sees black in its place, with the same alpha;
    /// the sky lights the scene all the same.
    #[schemars(extend("default" = true))]
    #[serde(skip_serializing_if = "is_true")]
    pub visible: bool,
}

impl Default for EnvironmentSettings {
    fn default() -> Self {
        Self {
            radiance: Color::default(),
            file: None,
            gradient: None,
            sky: None,
            rotation: 0.0,
            exposure: 0.0,
            tint: Color::Gray(1.0),
            visible: true,
        }
    }
}

fn is_one(color: &Color) -> bool {
    *color == Color::Gray(1.0)
}

fn is_true(flag: &bool) -> bool {
    *flag
}
