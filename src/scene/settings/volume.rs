//! `[[volume]]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::or_default::{is_default, or_default};
use super::{Albedo, Axis, Color, EmissionSettings, Extent, MAX_FRAME, VelocitySettings};

const HALF_SIZE: Extent = Extent::Uniform(1.0);
const RADIUS: f32 = 1.0;
const AXIS: Axis = Axis::Z;
const KIND: RampKind = RampKind::Linear;
const A: f32 = 1.0;
const B: f32 = 0.0;
const H: f32 = 1.0;
const FREQUENCY: f32 = 1.0;
const OCTAVES: u32 = 4;
const CONTRAST: f32 = 1.0;
const SEED: u32 = 0;

/// One volume: a file or a shape, with its placement, medium and emission.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct VolumeSettings {
    /// A name to tell volumes apart; no effect on the picture.
    #[serde(skip_serializing_if = "String::is_empty")]
    #[schemars(extend("default" = ""))]
    pub name: String,
    /// A volume file, relative to the scene file, or `builtin:NAME` for one that comes with
    /// Flambeau. `fire_####.vdb` or `fire_%04d.vdb` is a sequence, one file a frame.
    pub file: Option<String>,
    /// The file's frame less that of the scene.
    #[schemars(extend("unit" = "frames", "default" = 0), range(min = -MAX_FRAME, max = MAX_FRAME))]
    #[serde(skip_serializing_if = "is_default")]
    pub frame_offset: i32,
    /// The first and the last frame of the files that are shown; absent, those on the disk.
    #[schemars(extend("unit" = "frames", "default" = null))]
    #[schemars(extend("minimum" = -MAX_FRAME, "maximum" = MAX_FRAME))]
    pub frame_range: Option<[i32; 2]>,
    /// What is shown before the first frame of the files and after the last.
    #[schemars(extend("default" = "hold"))]
    #[serde(skip_serializing_if = "is_default")]
    pub outside: Outside,
    /// A shape instead of a file, filled with the value 1 unless said otherwise.
    pub shape: Option<VolumeShape>,

    /// Translation of the volume; applied after `rotate`.
    #[schemars(extend("unit" = "length", "default" = [0.0, 0.0, 0.0]))]
    #[serde(skip_serializing_if = "is_default")]
    pub translate: [f32; 3],
    /// Rotation about the x, then the y, then the z axis; applied after `scale`.
    #[schemars(extend("unit" = "degrees", "default" = [0.0, 0.0, 0.0]))]
    #[serde(skip_serializing_if = "is_default")]
    pub rotate: [f32; 3],
    /// Scale of the volume. Density does not change with it.
    #[schemars(extend("nonzero" = true, "default" = 1.0))]
    #[serde(skip_serializing_if = "is_default")]
    pub scale: Extent,
    /// The placement as a matrix of 3 rows of 4, in place of `scale`, `rotate` and `translate`.
    #[schemars(extend("default" = null))]
    pub matrix: Option<[[f32; 4]; 3]>,

    /// The density of the volume.
    pub density: DensitySettings,
    /// The fraction of light that a collision scatters instead of absorbing: 0 is soot, 1 is cloud.
    pub albedo: Albedo,
    /// The phase function.
    #[serde(skip_serializing_if = "is_default")]
    pub phase: PhaseSettings,
    /// The emission of the volume.
    #[serde(skip_serializing_if = "is_default")]
    pub emission: EmissionSettings,
    /// The velocity that the volume moves by while the shutter is open.
    #[serde(skip_serializing_if = "is_default")]
    pub velocity: VelocitySettings,

    /// Half the size of the box that is filled, about the volume's own origin.
    #[schemars(extend("unit" = "length", "exclusiveMinimum" = 0.0, "default" = HALF_SIZE))]
    #[schemars(extend("only" = {"shape": ["box", "ramp", "noise"]}))]
    pub half_size: Option<Extent>,
    /// The radius of the sphere that is filled, about the volume's own origin.
    #[schemars(extend("unit" = "length", "exclusiveMinimum" = 0.0, "default" = RADIUS))]
    #[schemars(extend("only" = {"shape": ["sphere"]}))]
    pub radius: Option<f32>,
    /// The axis along which the ramp changes. Its coordinate starts at the box's low face.
    #[schemars(extend("default" = AXIS, "only" = {"shape": ["ramp"]}))]
    pub axis: Option<Axis>,
    /// `linear`: a + b * coordinate; `exponential`: a * exp(-coordinate / h).
    #[schemars(extend("default" = KIND, "only" = {"shape": ["ramp"]}))]
    pub kind: Option<RampKind>,
    /// The value of the ramp at the low face.
    #[schemars(extend("minimum" = 0.0, "default" = A, "only" = {"shape": ["ramp"]}))]
    pub a: Option<f32>,
    /// The slope of the linear ramp: its change per unit length.
    #[schemars(extend("unit" = "1/length", "default" = B))]
    #[schemars(extend("only" = {"shape": ["ramp"], "kind": ["linear"]}))]
    pub b: Option<f32>,
    /// The falloff length of the exponential ramp, over which it falls to 37 percent.
    #[schemars(extend("unit" = "length", "exclusiveMinimum" = 0.0, "default" = H))]
    #[schemars(extend("only" = {"shape": ["ramp"], "kind": ["exponential"]}))]
    pub h: Option<f32>,
    /// The frequency of the noise: large puffs per unit length.
    #[schemars(extend("unit" = "1/length", "exclusiveMinimum" = 0.0, "default" = FREQUENCY))]
    #[schemars(extend("only" = {"shape": ["noise"]}))]
    pub frequency: Option<f32>,
    /// The number of octaves of ever finer detail.
    #[schemars(extend("minimum" = 1, "maximum" = 12, "default" = OCTAVES))]
    #[schemars(extend("only" = {"shape": ["noise"]}))]
    pub octaves: Option<u32>,
    /// The contrast of the noise: 0 is an even fog; larger values leave puffs with clear air
    /// between.
    #[schemars(extend("minimum" = 0.0, "maximum" = 100.0, "default" = CONTRAST))]
    #[schemars(extend("only" = {"shape": ["noise"]}))]
    pub contrast: Option<f32>,
    /// The seed of the noise. Another seed gives other puffs.
    #[schemars(extend("minimum" = 0, "maximum" = 4_294_967_295_u32, "default" = SEED))]
    #[schemars(extend("only" = {"shape": ["noise"]}))]
    pub seed: Option<u32>,
}

/// Content of the frames before the first file of a sequence and after its last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outside {
    /// The nearest frame.
    #[default]
    Hold,
    /// The frames over and over.
    Loop,
    /// Nothing.
    None,
}

/// A shape that is filled in place of the grids of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum VolumeShape {
    /// A box.
    Box,
    /// A sphere.
    Sphere,
    /// All of space.
    Everywhere,
    /// A box whose value changes along one axis.
    Ramp,
    /// A box of procedural puffs.
    Noise,
}

/// How the value of a ramp changes along its axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RampKind {
    /// a + b * coordinate.
    #[default]
    Linear,
    /// a * exp(-coordinate / h).
    Exponential,
}

/// The density of a volume.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct DensitySettings {
    /// The grid that density is read from. Of several grids of one name, `density[1]` is the
    /// second.
    #[schemars(extend("default" = "density"))]
    pub grid: Option<String>,
    /// Whether the grid is a level set (signed distances to a surface, negative inside) that is
    /// shown as fog: its value is 0 outside, rises from 0 at the surface to 1 at the largest
    /// distance that is stored, and is 1 further inside.
    #[schemars(extend("default" = false))]
    #[serde(skip_serializing_if = "is_default")]
    pub level_set: bool,
    /// Extinction per unit length = scale * value of the grid. 0 makes the smoke invisible.
    #[schemars(extend("unit" = "1/length"))]
    pub scale: Color,
    /// Points [value of the grid, density] in ascending order, by which the interpolated value is
    /// mapped before it is scaled: linear between them, constant beyond the ends. It acts in the
    /// whole box of the grid, also where nothing is stored.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("label" = "[[value, density], ...]", "default" = []))]
    pub curve: Vec<[f32; 2]>,
}

/// The phase function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct PhaseSettings {
    /// Anisotropy of the phase function (Henyey-Greenstein): 0 is isotropic, towards 1 light
    /// scatters forward, towards -1 backward.
    #[schemars(range(min = -0.999, max = 0.999))]
    pub g: f32,
    /// Anisotropy of a second lobe, such as the light that clouds send back.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("default" = 0.0), range(min = -0.999, max = 0.999))]
    pub g2: f32,
    /// The share of light that scatters by the second lobe.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(extend("default" = 0.0), range(min = 0.0, max = 1.0))]
    pub mix: f32,
}

impl Default for DensitySettings {
    fn default() -> Self {
        let (grid, scale) = (None, Color::Gray(1.0));
        Self { grid, level_set: false, scale, curve: Vec::new() }
    }
}

impl VolumeSettings {
    /// The one grid of a shape, and the grid that density is read from unless said otherwise.
    pub const DENSITY: &'static str = "density";

    /// The grid that density is read from.
    pub fn density_grid(&self) -> &str {
        self.density.grid.as_deref().unwrap_or(Self::DENSITY)
    }

    /// The grid that emission is read from, if its mode reads one.
    pub fn emission_grid(&self) -> Option<&str> {
        let default = if self.file.is_some() {
            self.emission.mode.default_grid()?
        } else {
            self.emission.mode.default_grid().map(|_| Self::DENSITY)?
        };
        Some(self.emission.grid.as_deref().unwrap_or(default))
    }
}

or_default! {
    impl VolumeSettings {
        half_size: Extent = HALF_SIZE;
        radius: f32 = RADIUS;
        axis: Axis = AXIS;
        kind: RampKind = KIND;
        a: f32 = A;
        b: f32 = B;
        h: f32 = H;
        frequency: f32 = FREQUENCY;
        octaves: u32 = OCTAVES;
        contrast: f32 = CONTRAST;
        seed: u32 = SEED;
    }
}
