//! `emission` of a `[[volume]]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;
use super::or_default::{is_default, or_default};

const SCALE: f32 = 1.0;
const COLOR: Color = Color::Gray(1.0);
const VALUE: Color = Color::Gray(1.0);
const LE: Color = Color::Gray(1.0);
const KELVIN_OFFSET: f32 = 0.0;
const KELVIN_SCALE: f32 = 1.0;
const INTENSITY: f32 = 1.0;
const TIMES_DENSITY: bool = false;
const NORMALIZE: Normalize = Normalize::Peak;
const STOPS: [[f32; 4]; 2] = [[0.0; 4], [1.0; 4]];
const REFERENCE_KELVIN: f32 = 1500.0;

/// The emission of a volume.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct EmissionSettings {
    /// The source of the emission.
    pub mode: EmissionMode,
    /// The grid that emission is read from: by default `emission` for mode grid, `temperature` for
    /// blackbody, `flame` for ramp.
    #[schemars(extend("default" = null, "only" = {"mode": ["grid", "blackbody", "ramp"]}))]
    pub grid: Option<String>,
    /// Points [value of the grid, mapped value] in ascending order, by which the interpolated value
    /// is mapped before anything else: linear between them, constant beyond the ends.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("label" = "[[value, value], ...]", "default" = []))]
    #[schemars(extend("only" = {"mode": ["grid", "blackbody", "ramp"]}))]
    pub curve: Vec<[f32; 2]>,
    /// A second grid, whose value multiplies the emission: with mode blackbody, color comes from
    /// the temperature and intensity from the flame.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("default" = null))]
    #[schemars(extend("only" = {"mode": ["grid", "constant", "source", "blackbody", "ramp"]}))]
    pub intensity_grid: Option<String>,
    /// Points [value of the intensity grid, multiplier] in ascending order: linear between them,
    /// constant beyond the ends.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("label" = "[[value, multiplier], ...]", "default" = []))]
    #[schemars(extend("only" = {"mode": ["grid", "constant", "source", "blackbody", "ramp"]}))]
    pub intensity_curve: Vec<[f32; 2]>,
    /// Emitted radiance per unit length = scale * value of the grid.
    #[schemars(extend("unit" = "radiance/length", "minimum" = 0.0, "default" = SCALE))]
    #[schemars(extend("only" = {"mode": ["grid"]}))]
    pub scale: Option<f32>,
    /// A color that the emission is multiplied by.
    #[schemars(extend("default" = COLOR))]
    #[schemars(extend("only" = {"mode": ["grid", "constant", "source", "blackbody", "ramp"]}))]
    pub color: Option<Color>,
    /// Emitted radiance per unit length, the same everywhere in the volume.
    #[schemars(extend("unit" = "radiance/length", "default" = VALUE))]
    #[schemars(extend("only" = {"mode": ["constant"]}))]
    pub value: Option<Color>,
    /// Source radiance: the radiance of an optically thick layer of the volume.
    #[schemars(extend("unit" = "radiance", "default" = LE, "only" = {"mode": ["source"]}))]
    pub le: Option<Color>,
    /// Subtracted from the value of the grid before it is scaled to kelvin.
    #[schemars(extend("default" = KELVIN_OFFSET, "only" = {"mode": ["blackbody"]}))]
    pub kelvin_offset: Option<f32>,
    /// Temperature in kelvin = (value - kelvin_offset) * kelvin_scale. Files in kelvin need 1;
    /// Blender's temperatures of 0 to 3 need about 1000.
    #[schemars(extend("unit" = "kelvin", "minimum" = 0.0, "default" = KELVIN_SCALE))]
    #[schemars(extend("only" = {"mode": ["blackbody"]}))]
    pub kelvin_scale: Option<f32>,
    /// The intensity of the emission.
    #[schemars(extend("unit" = "radiance/length", "minimum" = 0.0, "default" = INTENSITY))]
    #[schemars(extend("only" = {"mode": ["blackbody", "ramp"]}))]
    pub intensity: Option<f32>,
    /// Whether emission is multiplied by the density grid, so that thin smoke emits less.
    #[schemars(extend("default" = TIMES_DENSITY, "only" = {"mode": ["blackbody", "ramp"]}))]
    pub times_density: Option<bool>,
    /// How brightness depends on temperature. `peak` (constant): every temperature is equally
    /// bright and only its color changes; `t4` (physical): brightness grows with the fourth power
    /// of the temperature.
    #[schemars(extend("default" = NORMALIZE, "only" = {"mode": ["blackbody"]}))]
    pub normalize: Option<Normalize>,
    /// With `normalize = "t4"`: the temperature whose brightness is that of `peak`.
    #[schemars(extend("unit" = "kelvin", "exclusiveMinimum" = 0.0, "default" = REFERENCE_KELVIN))]
    #[schemars(extend("only" = {"mode": ["blackbody"]}))]
    pub reference_kelvin: Option<f32>,
    /// Color stops [value, r, g, b] in ascending order of value; linear between them, constant
    /// beyond the ends.
    #[schemars(extend("label" = "[[value, r, g, b], ...]", "unit" = "radiance/length"))]
    #[schemars(extend("default" = STOPS))]
    #[schemars(extend("only" = {"mode": ["ramp"]}))]
    pub stops: Option<Vec<[f32; 4]>>,
}

/// The source of a volume's emission.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EmissionMode {
    /// No emission.
    #[default]
    None,
    /// Read from a grid, independent of density and albedo.
    Grid,
    /// The same everywhere in the volume.
    Constant,
    /// Proportional to the absorption.
    Source,
    /// Blackbody emission from a temperature grid.
    Blackbody,
    /// A grid mapped through a color ramp.
    Ramp,
}

/// How the brightness of a black body depends on its temperature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Normalize {
    /// Constant: every temperature has the same peak.
    #[default]
    Peak,
    /// Physical: proportional to (T / reference_kelvin)^4.
    T4,
}

impl EmissionMode {
    /// The grid of a file that the mode reads unless said otherwise; `None` if it reads none.
    pub fn default_grid(self) -> Option<&'static str> {
        match self {
            Self::Grid => Some("emission"),
            Self::Blackbody => Some("temperature"),
            Self::Ramp => Some("flame"),
            Self::None | Self::Constant | Self::Source => None,
        }
    }
}

or_default! {
    impl EmissionSettings {
        scale: f32 = SCALE;
        color: Color = COLOR;
        value: Color = VALUE;
        le: Color = LE;
        kelvin_offset: f32 = KELVIN_OFFSET;
        kelvin_scale: f32 = KELVIN_SCALE;
        intensity: f32 = INTENSITY;
        times_density: bool = TIMES_DENSITY;
        normalize: Normalize = NORMALIZE;
        reference_kelvin: f32 = REFERENCE_KELVIN;
    }
}

impl EmissionSettings {
    /// `stops`, or its default.
    pub fn stops(&self) -> &[[f32; 4]] {
        self.stops.as_deref().unwrap_or(&STOPS)
    }
}
