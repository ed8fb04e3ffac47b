//! `[camera]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A pinhole camera that looks at a target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct CameraSettings {
    /// The position of the camera, in world space.
    #[schemars(extend("unit" = "length"))]
    pub position: [f32; 3],
    /// The point that the camera looks at, in world space.
    #[schemars(extend("unit" = "length"))]
    pub target: [f32; 3],
    /// The direction that points up in the picture.
    pub up: [f32; 3],
    /// The horizontal field of view.
    #[schemars(extend("unit" = "degrees", "exclusiveMinimum" = 0.0, "maximum" = 179.9))]
    pub fov_x: f32,
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self { position: [0.0, -6.0, 0.0], target: [0.0; 3], up: [0.0, 0.0, 1.0], fov_x: 36.0 }
    }
}
