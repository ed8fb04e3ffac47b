//! The preferences, stored between runs: the layout of the window, the display of pictures, recent
//! files. Never the scene or the strategy.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::files;
use crate::image::tone::{Tone, ToneCurve};

/// The file, in the folder of the program's data.
const FILE: &str = "window.json";
/// The variable of the environment that names the data folder.
const DATA: &str = "FLAMBEAU_DATA";
/// Largest number of recent files.
const RECENT: usize = 10;
/// Largest number of scenes whose references are stored.
const REFERENCES: usize = 20;

/// The preferences of the window.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Files that were open, the last one first.
    pub recent: Vec<String>,
    /// The files of the references of scenes, the one that was loaded last first.
    pub references: Vec<(String, PathBuf)>,
    /// Whether the panels are folded.
    pub folded: bool,
    /// Parts of the panel column that are open or folded against what they were at the first start.
    pub sections: BTreeMap<String, bool>,
    /// Scale of text and controls relative to that of the screen; 0 where none was chosen.
    pub scale: f32,
    /// Whether a start without a file shows what to begin with.
    pub start: bool,
    /// The tone curve, by its name.
    curve: String,
    /// Exposure in stops.
    exposure: f32,
    /// White balance in kelvin; 0 where none was chosen.
    white: f32,
    /// Tint of the white point.
    tint: f32,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            recent: Vec::new(),
            references: Vec::new(),
            folded: false,
            sections: BTreeMap::new(),
            scale: 0.0,
            start: true,
            curve: String::new(),
            exposure: 0.0,
            white: 0.0,
            tint: 0.0,
        }
    }
}

impl Preferences {
    /// The preferences in the data folder. A file that cannot be read is as good as none: no
    /// setting of the window is worth a complaint at its start.
    pub fn read(data: &Path) -> Self {
        let text = std::fs::read_to_string(data.join(FILE)).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    }

    /// Writes the preferences to `data`.
    ///
    /// # Errors
    /// When the system refuses; names the file.
    pub fn write(&self, data: &Path) -> Result<()> {
        let path = data.join(FILE);
        let text = serde_json::to_vec_pretty(self)
            .map_err(|error| Error::invalid(path.display().to_string(), "", error.to_string()))?;
        std::fs::create_dir_all(data).map_err(|error| Error::io(data, error))?;
        files::replace(&path, |file| file.write_all(&text).map_err(|error| Error::io(&path, error)))
    }

    /// Adds `source` to the recent files. Embedded scenes are always offered and need no entry.
    pub fn note(&mut self, source: &str) {
        if source.starts_with("builtin:") {
            return;
        }
        let path = full_name(source);
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
    }

    /// Notes the files of the references of scenes.
    pub fn note_references(&mut self, references: &[(String, PathBuf)]) {
        self.references = references.iter().take(REFERENCES).cloned().collect();
    }

    /// Tone mapping of pictures at the start.
    pub fn tone(&self) -> Tone {
        let plain = Tone::default();
        let curve = ToneCurve::ALL.into_iter().find(|curve| curve.name() == self.curve);
        Tone {
            curve: curve.unwrap_or_default(),
            exposure: sane(self.exposure, 0.0).clamp(-20.0, 20.0),
            white: sane(self.white, plain.white),
            tint: sane(self.tint, plain.tint),
            ..plain
        }
    }

    /// Scale of text and controls relative to that of the screen, where one was chosen.
    pub fn scale(&self) -> Option<f32> {
        let scale = sane(self.scale, 1.0).clamp(0.5, 3.0);
        (scale != 1.0).then_some(scale)
    }

    /// Notes how pictures are shown. Which channel is looked at passes.
    pub fn note_tone(&mut self, tone: Tone) {
        self.curve = tone.curve.name().to_owned();
        self.exposure = tone.exposure;
        self.white = tone.white;
        self.tint = tone.tint;
    }
}

/// A number that was chosen, or else `or`.
fn sane(value: f32, or: f32) -> f32 {
    if value.is_finite() && value != 0.0 { value } else { or }
}

/// The folder of what outlasts a run: `chosen`, or what `FLAMBEAU_DATA` says, or where the system
/// keeps the data of the user's programs; `None` where there is no such place.
pub fn data_folder(chosen: Option<PathBuf>) -> Option<PathBuf> {
    let named = || std::env::var_os(DATA).filter(|name| !name.is_empty()).map(PathBuf::from);
    chosen.or_else(named).or_else(|| eframe::storage_dir("flambeau"))
}

/// Full name of a source, the same from every folder.
pub fn full_name(source: &str) -> String {
    if source.starts_with("builtin:") {
        return source.to_owned();
    }
    let path = std::path::absolute(source).unwrap_or_else(|_| PathBuf::from(source));
    path.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::tone::Channel;

    #[test]
    fn preferences_are_read_as_written_and_nonsense_is_the_default() {
        let folder = tempfile::tempdir().unwrap();
        let data = folder.path().join("data");
        assert_eq!(Preferences::read(&data), Preferences::default());
        assert_eq!(Preferences::default().tone(), Tone::default());
        let (white, tint, curve) = (3200.0, 12.0, ToneCurve::Agx);
        let tone = Tone { exposure: -1.5, white, tint, curve, ..Tone::default() };
        let mut preferences = Preferences { folded: true, ..Preferences::default() };
        preferences.note_tone(Tone { channel: Channel::FalseColor, ..tone });
        preferences.note("/shots/torch.toml");
        preferences.write(&data).unwrap();
        let again = Preferences::read(&data);
        assert_eq!((again.tone(), &again), (tone, &preferences));
        std::fs::write(data.join(FILE), "{ \"folded\": 7 }").unwrap();
        assert_eq!(Preferences::read(&data), Preferences::default());
    }

    #[test]
    fn the_last_file_comes_first_and_each_once() {
        let mut preferences = Preferences::default();
        for index in 0..12 {
            preferences.note(&format!("/shots/{index}.toml"));
        }
        preferences.note("/shots/5.toml");
        preferences.note("builtin:torch");
        assert_eq!(preferences.recent.len(), RECENT);
        assert_eq!(preferences.recent[..2], ["/shots/5.toml", "/shots/11.toml"]);
        assert_eq!(preferences.recent.iter().filter(|path| path.contains("/5.")).count(), 1);
    }
}
