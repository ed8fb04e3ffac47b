//! `[camera]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A pinhole camera that looks at a target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct CameraSettings {
    /// Where the camera stands, in world space.
    #[schemars(extend("unit" = "length"))]
    pub position: [f32; 3],
    /// The point in the middle of the picture, in world space.
    #[schemars(extend("unit" = "length"))]
    pub target: [f32; 3],
    /// The direction that points up in the picture.
    pub up: [f32; 3],
    /// The full horizontal angle of view.
    #[schemars(extend("unit" = "degrees", "exclusiveMinimum" = 0.0, "maximum" = 179.9))]
    pub fov_x: f32,
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self { position: [0.0, -6.0, 0.0], target: [0.0; 3], up: [0.0, 0.0, 1.0], fov_x: 36.0 }
    }
}
