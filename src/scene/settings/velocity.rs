//! `velocity` of a `[[volume]]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The velocity that the volume moves by while the shutter is open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct VelocitySettings {
    /// The grid of vectors that the velocity is read from, in the file's own units of length and
    /// along its own axes. Without one nothing moves.
    #[schemars(extend("default" = null))]
    pub grid: Option<String>,
    /// Three grids of single numbers in place of `grid`: the velocity along x, y and z.
    #[schemars(extend("default" = null))]
    pub grids: Option<[String; 3]>,
    /// The time that the velocity is the way of.
    pub unit: VelocityUnit,
    /// Multiplier of the velocity. Negative values turn it around.
    pub scale: f32,
}

/// The time that a velocity is the way of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VelocityUnit {
    /// A second.
    #[default]
    Second,
    /// A frame.
    Frame,
}

impl Default for VelocitySettings {
    fn default() -> Self {
        Self { grid: None, grids: None, unit: VelocityUnit::default(), scale: 1.0 }
    }
}

impl VelocitySettings {
    /// Whether there is a grid to move by.
    pub fn is_some(&self) -> bool {
        self.grid.is_some() || self.grids.is_some()
    }
}
