//! `[[surface]]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::or_default::or_default;
use super::{Color, Extent};

const POINT: [f32; 3] = [0.0; 3];
const NORMAL: [f32; 3] = [0.0, 0.0, 1.0];
const CENTER: [f32; 3] = [0.0; 3];
const HALF_U: [f32; 3] = [1.0, 0.0, 0.0];
const HALF_V: [f32; 3] = [0.0, 1.0, 0.0];
const RADIUS: f32 = 1.0;
const REFLECTANCE: Color = Color::Gray(0.5);
const ALPHA: f32 = 0.2;

/// One surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct SurfaceSettings {
    /// A name to tell surfaces apart; no effect on the picture.
    #[schemars(extend("default" = ""))]
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The shape of the surface.
    pub shape: SurfaceShape,
    /// A point of the plane; the center of the square if `half_size` is given.
    #[schemars(extend("unit" = "length", "default" = POINT))]
    #[schemars(extend("only" = {"shape": ["plane"]}))]
    pub point: Option<[f32; 3]>,
    /// The normal of the plane.
    #[schemars(extend("default" = NORMAL, "only" = {"shape": ["plane"]}))]
    pub normal: Option<[f32; 3]>,
    /// Half the size of a box, or of the square that a finite plane is; a plane without it is
    /// infinite.
    #[schemars(extend("unit" = "length", "exclusiveMinimum" = 0.0, "default" = null))]
    #[schemars(extend("only" = {"shape": ["plane", "box"]}))]
    pub half_size: Option<Extent>,
    /// The center of the quad, sphere or box.
    #[schemars(extend("unit" = "length", "default" = CENTER))]
    #[schemars(extend("only" = {"shape": ["quad", "sphere", "box"]}))]
    pub center: Option<[f32; 3]>,
    /// Half of one edge of the quad, as a vector from its center to the middle of a side.
    #[schemars(extend("unit" = "length", "default" = HALF_U))]
    #[schemars(extend("only" = {"shape": ["quad"]}))]
    pub half_u: Option<[f32; 3]>,
    /// Half of the other edge of the quad, as a vector from its center to the middle of a side.
    #[schemars(extend("unit" = "length", "default" = HALF_V))]
    #[schemars(extend("only" = {"shape": ["quad"]}))]
    pub half_v: Option<[f32; 3]>,
    /// The radius of the sphere.
    #[schemars(extend("unit" = "length", "exclusiveMinimum" = 0.0, "default" = RADIUS))]
    #[schemars(extend("only" = {"shape": ["sphere"]}))]
    pub radius: Option<f32>,
    /// The material. Without it, a surface that emits is black and any other one diffuse.
    pub material: Option<MaterialSettings>,
    /// The radiance that the surface emits to both sides.
    #[schemars(extend("unit" = "radiance"))]
    pub emission: Color,
}

/// The shapes of surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceShape {
    /// An infinite plane, or a square.
    #[default]
    Plane,
    /// A parallelogram.
    Quad,
    /// A sphere.
    Sphere,
    /// An axis-aligned box.
    Box,
}

/// The material of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct MaterialSettings {
    /// The type of material.
    #[serde(rename = "type")]
    pub kind: MaterialKind,
    /// The fraction of light that is reflected; for a conductor by every microfacet, without
    /// Fresnel.
    #[schemars(extend("maximum" = 1.0, "default" = REFLECTANCE))]
    #[schemars(extend("only" = {"type": ["diffuse", "conductor"]}))]
    pub reflectance: Option<Color>,
    /// The roughness alpha of the conductor (GGX): small is a mirror, 1 is dull.
    #[schemars(extend("minimum" = 0.001, "maximum" = 1.0, "default" = ALPHA))]
    #[schemars(extend("only" = {"type": ["conductor"]}))]
    pub alpha: Option<f32>,
}

/// The types of material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MaterialKind {
    /// Reflects evenly in all directions, like chalk.
    #[default]
    Diffuse,
    /// Reflects like rough metal.
    Conductor,
    /// Reflects nothing.
    Black,
}

or_default! {
    impl SurfaceSettings {
        point: [f32; 3] = POINT;
        normal: [f32; 3] = NORMAL;
        center: [f32; 3] = CENTER;
        half_u: [f32; 3] = HALF_U;
        half_v: [f32; 3] = HALF_V;
        radius: f32 = RADIUS;
    }
}

or_default! {
    impl MaterialSettings {
        reflectance: Color = REFLECTANCE;
        alpha: f32 = ALPHA;
    }
}
