//! `[film]` and `[path]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The largest seed: up to here whole numbers survive programs that read all numbers as `f64`.
pub const MAX_SEED: u64 = (1 << 53) - 1;

/// The film: render size, seed and samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct FilmSettings {
    /// Render size: width and height. The window renders at its own size unless told to keep this
    /// one.
    #[schemars(extend("unit" = "pixels", "minimum" = 1, "maximum" = 16384))]
    pub size: [u32; 2],
    /// The random seed. Another seed gives the same picture with other noise.
    #[schemars(range(min = 0, max = MAX_SEED))]
    pub seed: u64,
    /// Max samples per pixel, after which the picture is finished; 0 is no limit.
    #[schemars(extend("unit" = "samples"), range(min = 0, max = 4_294_967_295_u32))]
    pub spp: u32,
    /// Whether each frame of a sequence has random numbers of its own (seed + number of the frame
    /// on the time line). Otherwise the noise stays where it is from frame to frame.
    pub animate_seed: bool,
}

impl Default for FilmSettings {
    fn default() -> Self {
        Self { size: [960, 540], seed: 0, spp: 0, animate_seed: true }
    }
}

/// The length of paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct PathSettings {
    /// Max bounces: the number of scattering events and reflections after which a path ends; 0 is
    /// no limit (a guard at 100 000 is counted and shown).
    #[schemars(extend("unit" = "events"), range(min = 0, max = 100_000))]
    pub max_scatters: u32,
}
