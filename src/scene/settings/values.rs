//! Values that a scene may write in more than one way.

use glam::Vec3A;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A gray value or a linear Rec.709 color: `0.5` or `[0.5, 0.4, 0.3]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(extend("label" = "number or [r, g, b]", "minimum" = 0.0))]
pub enum Color {
    /// The same for every channel.
    Gray(f32),
    /// Linear red, green and blue.
    Rgb([f32; 3]),
}

/// A length for all axes or one each: `2.0` or `[2.0, 1.0, 3.0]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(extend("label" = "number or [x, y, z]"))]
pub enum Extent {
    /// The same along every axis.
    Uniform(f32),
    /// One along each axis.
    Axes([f32; 3]),
}

/// The fraction of light that a collision scatters instead of absorbing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(extend("label" = "number, [r, g, b] or { grid = \"name\" }"))]
#[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
pub enum Albedo {
    /// The same for every channel.
    Gray(f32),
    /// Linear red, green and blue.
    Rgb([f32; 3]),
    /// Read from a grid of the volume's file.
    Grid(GridKey),
}

/// `{ grid = "name" }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GridKey {
    /// The grid that the albedo is read from, clamped to 0..1.
    pub grid: String,
}

/// One of the three axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// The first axis.
    X,
    /// The second axis.
    Y,
    /// The third axis.
    #[default]
    Z,
}

impl Color {
    /// Linear red, green and blue.
    pub fn rgb(self) -> Vec3A {
        match self {
            Self::Gray(value) => Vec3A::splat(value),
            Self::Rgb(rgb) => Vec3A::from_array(rgb),
        }
    }

    /// The one value of all channels, or `None` where they differ.
    pub fn gray(self) -> Option<f32> {
        match self {
            Self::Gray(value) => Some(value),
            Self::Rgb([r, g, b]) => (r == g && g == b).then_some(r),
        }
    }

    /// Whether all channels are zero.
    pub fn is_black(self) -> bool {
        self.gray() == Some(0.0)
    }
}

impl Default for Color {
    fn default() -> Self {
        Self::Gray(0.0)
    }
}

impl Extent {
    /// One length along each axis.
    pub fn axes(self) -> [f32; 3] {
        match self {
            Self::Uniform(value) => [value; 3],
            Self::Axes(axes) => axes,
        }
    }
}

impl Default for Extent {
    fn default() -> Self {
        Self::Uniform(1.0)
    }
}

impl Default for Albedo {
    fn default() -> Self {
        Self::Gray(0.0)
    }
}

impl Axis {
    /// 0 for x, 1 for y, 2 for z.
    pub fn index(self) -> usize {
        self as usize
    }
}
