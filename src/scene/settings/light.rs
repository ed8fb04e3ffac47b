//! `[[light]]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;
use super::or_default::or_default;

const POSITION: [f32; 3] = [0.0, 0.0, 2.0];
const TARGET: [f32; 3] = [0.0; 3];
const CONE: f32 = 45.0;
const BLEND: f32 = 0.15;
const DIRECTION: [f32; 3] = [0.0, 0.0, -1.0];
const ANGLE: f32 = 0.53;
const CENTER: [f32; 3] = [0.0, 0.0, 2.0];
const RADIUS: f32 = 0.1;
const HALF_U: [f32; 3] = [0.5, 0.0, 0.0];
const HALF_V: [f32; 3] = [0.0, 0.5, 0.0];

/// One light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct LightSettings {
    /// A name to tell lights apart; no effect on the picture.
    #[schemars(extend("default" = ""))]
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The type of light. The window calls `sphere` sphere light and `quad` area light.
    #[serde(rename = "type")]
    pub kind: LightKind,
    /// The brightness: radiant intensity in W/sr for point and spot, irradiance for sun
    /// (`irradiance` means the same there), radiance for sphere and quad (`radiance` there).
    #[schemars(extend("default" = 1.0))]
    pub intensity: Color,
    /// Whether the light is visible to the camera. Points and spots have no size and never are.
    pub visible: bool,
    /// The position of the light.
    #[schemars(extend("unit" = "length", "default" = POSITION))]
    #[schemars(extend("only" = {"type": ["point", "spot"]}))]
    pub position: Option<[f32; 3]>,
    /// The point that the spot light is aimed at.
    #[schemars(extend("unit" = "length", "default" = TARGET))]
    #[schemars(extend("only" = {"type": ["spot"]}))]
    pub target: Option<[f32; 3]>,
    /// The full angle of the cone of the spot light.
    #[schemars(extend("unit" = "degrees", "minimum" = 0.1, "maximum" = 180.0, "default" = CONE))]
    #[schemars(extend("only" = {"type": ["spot"]}))]
    pub cone: Option<f32>,
    /// The fraction of the cone over which the spot light fades out at its edge.
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0, "default" = BLEND))]
    #[schemars(extend("only" = {"type": ["spot"]}))]
    pub blend: Option<f32>,
    /// The direction in which sunlight travels.
    #[schemars(extend("default" = DIRECTION, "only" = {"type": ["sun"]}))]
    pub direction: Option<[f32; 3]>,
    /// The angular diameter of the sun; 0 gives hard shadows.
    #[schemars(extend("unit" = "degrees", "minimum" = 0.0, "maximum" = 180.0, "default" = ANGLE))]
    #[schemars(extend("only" = {"type": ["sun"]}))]
    pub angle: Option<f32>,
    /// The center of the sphere light or area light.
    #[schemars(extend("unit" = "length", "default" = CENTER))]
    #[schemars(extend("only" = {"type": ["sphere", "quad"]}))]
    pub center: Option<[f32; 3]>,
    /// The radius of the sphere light.
    #[schemars(extend("unit" = "length", "exclusiveMinimum" = 0.0, "default" = RADIUS))]
    #[schemars(extend("only" = {"type": ["sphere"]}))]
    pub radius: Option<f32>,
    /// Half of one edge of the area light, as a vector from its center to the middle of a side.
    #[schemars(extend("unit" = "length", "default" = HALF_U))]
    #[schemars(extend("only" = {"type": ["quad"]}))]
    pub half_u: Option<[f32; 3]>,
    /// Half of the other edge of the area light, as a vector from its center to the middle of a
    /// side.
    #[schemars(extend("unit" = "length", "default" = HALF_V))]
    #[schemars(extend("only" = {"type": ["quad"]}))]
    pub half_v: Option<[f32; 3]>,
}

/// The kinds of light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LightKind {
    /// A distant light from one direction.
    Sun,
    /// A point that shines in all directions.
    #[default]
    Point,
    /// A point that shines into a cone.
    Spot,
    /// An emitting sphere.
    Sphere,
    /// An emitting parallelogram (area light); shines to both sides.
    Quad,
}

impl Default for LightSettings {
    fn default() -> Self {
        Self {
            name: String::new(),
            kind: LightKind::default(),
            intensity: Color::Gray(1.0),
            visible: true,
            position: None,
            target: None,
            cone: None,
            blend: None,
            direction: None,
            angle: None,
            center: None,
            radius: None,
            half_u: None,
            half_v: None,
        }
    }
}

or_default! {
    impl LightSettings {
        position: [f32; 3] = POSITION;
        target: [f32; 3] = TARGET;
        cone: f32 = CONE;
        blend: f32 = BLEND;
        direction: [f32; 3] = DIRECTION;
        angle: f32 = ANGLE;
        center: [f32; 3] = CENTER;
        radius: f32 = RADIUS;
        half_u: [f32; 3] = HALF_U;
        half_v: [f32; 3] = HALF_V;
    }
}
