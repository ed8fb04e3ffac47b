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

/// One solid thing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct SurfaceSettings {
    /// What it looks like from afar.
    pub shape: SurfaceShape,
    /// A point of the plane; the middle of the square if `half_size` is given.
    #[schemars(extend("unit" = "length", "default" = POINT))]
    #[schemars(extend("only" = {"shape": ["plane"]}))]
    pub point: Option<[f32; 3]>,
    /// The direction the plane faces.
    #[schemars(extend("default" = NORMAL, "only" = {"shape": ["plane"]}))]
    pub normal: Option<[f32; 3]>,
    /// Half the edges of a box, or of the square that is left of a plane; a plane without it goes
    /// on for ever.
    #[schemars(extend("unit" = "length", "exclusiveMinimum" = 0.0, "default" = null))]
    #[schemars(extend("only" = {"shape": ["plane", "box"]}))]
    pub half_size: Option<Extent>,
    /// The middle of the quad, sphere or box.
    #[schemars(extend("unit" = "length", "default" = CENTER))]
    #[schemars(extend("only" = {"shape": ["quad", "sphere", "box"]}))]
    pub center: Option<[f32; 3]>,
    /// From the quad's middle to the middle of one edge.
    #[schemars(extend("unit" = "length", "default" = HALF_U))]
    #[schemars(extend("only" = {"shape": ["quad"]}))]
    pub half_u: Option<[f32; 3]>,
    /// From the quad's middle to the middle of the next edge.
    #[schemars(extend("unit" = "length", "default" = HALF_V))]
    #[schemars(extend("only" = {"shape": ["quad"]}))]
    pub half_v: Option<[f32; 3]>,
    /// The sphere's radius.
    #[schemars(extend("unit" = "length", "exclusiveMinimum" = 0.0, "default" = RADIUS))]
    #[schemars(extend("only" = {"shape": ["sphere"]}))]
    pub radius: Option<f32>,
    /// What it is made of. Without it, a surface that emits is black and any other one diffuse.
    pub material: Option<MaterialSettings>,
    /// The radiance it emits to both sides.
    #[schemars(extend("unit" = "radiance"))]
    pub emission: Color,
}

/// The shapes of surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceShape {
    /// A plane, or a square cut from it.
    #[default]
    Plane,
    /// A parallelogram.
    Quad,
    /// A sphere.
    Sphere,
    /// A box along the axes.
    Box,
}

/// What a surface is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct MaterialSettings {
    /// How it reflects.
    #[serde(rename = "type")]
    pub kind: MaterialKind,
    /// The share of light that comes back; for a conductor from every microfacet, without Fresnel.
    #[schemars(extend("maximum" = 1.0, "default" = REFLECTANCE))]
    #[schemars(extend("only" = {"type": ["diffuse", "conductor"]}))]
    pub reflectance: Option<Color>,
    /// How rough the conductor is (GGX): small is a mirror, 1 is dull.
    #[schemars(extend("minimum" = 0.001, "maximum" = 1.0, "default" = ALPHA))]
    #[schemars(extend("only" = {"type": ["conductor"]}))]
    pub alpha: Option<f32>,
}

/// The ways a surface reflects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MaterialKind {
    /// Evenly to all sides, like chalk.
    #[default]
    Diffuse,
    /// Like rough metal.
    Conductor,
    /// Not at all.
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
