//! `[time]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The largest number of a frame.
pub const MAX_FRAME: i32 = 9_999_999;

/// The largest number of frames that the shutter is open.
pub const MAX_SHUTTER: f64 = 10.0;

/// Frames: which one is rendered, and those of the time line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct TimeSettings {
    /// Frames per second of the scene.
    #[schemars(extend("unit" = "frames/s", "exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub fps: f64,
    /// The frame that is shown or rendered. Volumes use the nearest whole frame, from which their
    /// velocity moves them on to a fraction.
    #[schemars(extend("unit" = "frames"), range(min = -MAX_FRAME, max = MAX_FRAME))]
    pub frame: f64,
    /// The first and the last frame of the time line; absent, those on the disk.
    #[schemars(extend("unit" = "frames", "default" = null))]
    #[schemars(extend("minimum" = -MAX_FRAME, "maximum" = MAX_FRAME))]
    pub range: Option<[i32; 2]>,
    /// The number of frames that the shutter is open, centered on the frame: 0.5 are 180 degrees.
    /// Volumes with a velocity are blurred by their motion; 0 shows them at one moment.
    #[schemars(extend("unit" = "frames"), range(min = 0.0, max = MAX_SHUTTER))]
    pub shutter: f64,
}

impl Default for TimeSettings {
    fn default() -> Self {
        Self { fps: 24.0, frame: 1.0, range: None, shutter: 0.0 }
    }
}

impl TimeSettings {
    /// The whole frame nearest to [`TimeSettings::frame`].
    pub fn whole_frame(&self) -> i32 {
        self.frame.round() as i32
    }

    /// Frames since [`TimeSettings::whole_frame`], whose files volumes show.
    pub fn since_whole_frame(&self) -> f64 {
        self.frame - f64::from(self.whole_frame())
    }

    /// Number of frames from the beginning of the time line, which is frame 1 unless `range` says
    /// otherwise, to the present one.
    pub fn since_start(&self) -> i64 {
        let first = self.range.map_or(1, |[first, _]| first);
        i64::from(self.whole_frame()) - i64::from(first)
    }
}
