//! The one settings struct. Its fields are the keys of the scene file, of `--set`, of a snapshot's
//! header and of the window; its doc comments are the help that `flambeau keys` prints.
//!
//! What the fields cannot say in Rust is said in their schema: `range`, `minimum` and `maximum`
//! bound every number of a key; `unit` names its unit; `default` is what an absent key means;
//! `only` lists the choices (`shape = "sphere"`) that a key belongs to.

mod camera;
mod emission;
mod environment;
mod film;
mod light;
mod or_default;
mod scene;
mod sky;
mod surface;
mod time;
mod values;
mod velocity;
mod volume;

pub use camera::{CameraKey, CameraSettings, field_of_view, focal_length};
pub use emission::{EmissionMode, EmissionSettings, Normalize};
pub use environment::EnvironmentSettings;
pub use film::{FilmSettings, MAX_SEED, PathSettings};
pub use light::{LightKind, LightSettings};
pub use scene::{SceneSettings, WorldUp};
pub use sky::SkySettings;
pub use surface::{MaterialKind, MaterialSettings, SurfaceSettings, SurfaceShape};
pub use time::{MAX_FRAME, MAX_SHUTTER, TimeSettings};
pub use values::{Albedo, Axis, Color, Extent, GridKey};
pub use velocity::{VelocitySettings, VelocityUnit};
pub use volume::{DensitySettings, Outside, PhaseSettings, RampKind, VolumeSettings, VolumeShape};

use or_default::is_default;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::transport::strategy::Strategy;

/// A whole scene with its camera, film and strategy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Settings {
    /// The world.
    #[serde(skip_serializing_if = "is_default")]
    pub scene: SceneSettings,
    /// The camera.
    pub camera: CameraSettings,
    /// The film: render size, seed and samples.
    pub film: FilmSettings,
    /// Frames: which one is rendered, and those of the time line.
    #[serde(skip_serializing_if = "is_default")]
    pub time: TimeSettings,
    /// The length of paths.
    pub path: PathSettings,
    /// The sky: light from all directions.
    pub environment: EnvironmentSettings,
    /// Fire, smoke, fog and clouds. Where they overlap, they add.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub volume: Vec<VolumeSettings>,
    /// Lights besides the fire itself.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub light: Vec<LightSettings>,
    /// Surfaces: floors, walls, spheres, boxes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub surface: Vec<SurfaceSettings>,
    /// Which sampling strategies are on.
    pub strategy: Strategy,
}

impl Settings {
    /// The camera as it stands in the present frame, without keys.
    pub fn present_camera(&self) -> CameraSettings {
        self.camera.at(self.time.frame)
    }

    /// Makes the camera stand in the present frame as `still` does, by a key if it has any.
    pub fn set_present_camera(&mut self, still: CameraSettings) {
        self.camera.set_at(self.time.frame, still);
    }

    /// The seed of the picture: that of the film, which moves on with the frame where
    /// `film.animate_seed` says so, so that the noise of a sequence does not stick to the screen.
    pub fn picture_seed(&self) -> u64 {
        let moved = if self.film.animate_seed { self.time.since_start() } else { 0 };
        self.film.seed.wrapping_add_signed(moved) & MAX_SEED
    }
}
