//! A ratio of times to the same noise, as tables in JSON have it.

use serde::Serialize;

use crate::render::compare::SpeedUp;

/// Speed-up of B over A at the same noise.
#[derive(Debug, Serialize)]
pub struct SpeedUpRow {
    /// A's time over B's.
    pub ratio: f64,
    standard_error: f64,
    /// The lower end of the interval that holds the ratio with 95 %.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl From<&SpeedUp> for SpeedUpRow {
    fn from(speed_up: &SpeedUp) -> Self {
        let [low, high] = speed_up.interval();
        Self { ratio: speed_up.ratio, standard_error: speed_up.standard_error(), low, high }
    }
}
