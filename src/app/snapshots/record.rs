//! The record beside a snapshot: name, note and figures.

use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::render::RenderStats;
use crate::scene::Settings;

/// The most letters of a name.
pub const LONGEST_NAME: usize = 80;
/// The most letters of a note.
pub const LONGEST_NOTE: usize = 400;

/// The record beside a snapshot, for the strip to show without reading the picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The user's name for the snapshot.
    pub name: String,
    /// The user's note about the snapshot; one with a note is kept longer.
    #[serde(default)]
    pub note: String,
    /// Time of the snapshot, in milliseconds since the beginning of 1970.
    pub kept: u64,
    /// Mean samples of a pixel.
    pub spp: f64,
    /// Seconds of rendering that they took.
    pub seconds: f64,
    /// Relative standard error of the picture, if it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
    /// Preset of the strategy, in words.
    pub strategy: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl Record {
    /// The record of a snapshot of `settings` that is taken now.
    pub fn new(name: String, settings: &Settings, stats: &RenderStats) -> Self {
        Self {
            name,
            note: String::new(),
            kept: now(),
            spp: stats.samples_per_pixel,
            seconds: stats.seconds,
            noise: stats.noise,
            strategy: strategy(settings),
            size: settings.film.size,
        }
    }
}

/// The strategy in a word or two.
pub fn strategy(settings: &Settings) -> String {
    let preset = settings.strategy.preset().map_or("custom", |preset| preset.name());
    match settings.strategy.is_biased() {
        true => format!("{preset}, biased"),
        false => preset.to_owned(),
    }
}

/// Milliseconds since the beginning of 1970.
pub fn now() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since.as_millis()).unwrap_or(u64::MAX)
}
