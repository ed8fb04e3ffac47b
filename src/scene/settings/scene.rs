//! `[scene]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct SceneSettings {
    /// The direction that is up in the world: the one that the sky is above. The camera has an up
    /// of its own.
    pub up: WorldUp,
}

/// The direction that is up in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WorldUp {
    /// +z is up.
    #[default]
    Z,
    /// +y is up.
    Y,
}
