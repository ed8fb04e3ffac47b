//! Header of a snapshot: the attributes of its EXR file, in one list for writing and reading.
//!
//! Names that the documentation promises to other programs are plain; those that only serve to
//! continue a render begin with `flambeau.`. The version stands in `software` as
//! `Flambeau 1.2.3`: OpenEXR reserves `version` for a number, so that readers lose or refuse a text
//! of that name.

use std::path::Path;

use exr::meta::attribute::AttributeValue;
use exr::prelude::{LayerAttributes, Text};

use crate::error::{Error, Result};
use crate::files::Fingerprint;
use crate::render::estimate::samples_per_pixel;
use crate::render::film::{Film, Totals};

/// Header of a snapshot: how its picture was rendered.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SnapshotHeader {
    /// All settings as a scene file, with absolute file names. `strategy` and `seed` repeat parts
    /// of it for other programs.
    pub scene: String,
    /// The sampling strategy as TOML.
    pub strategy: String,
    /// The seed of all samples.
    pub seed: u64,
    /// Version of Flambeau that wrote the snapshot.
    pub version: String,
    /// Version of the paths of the snapshot, [`PATH_VERSION`](crate::transport::PATH_VERSION) of
    /// the Flambeau that wrote it.
    pub path_version: u64,
    /// Wall-clock seconds spent on the picture, over all its sessions.
    pub wall_seconds: f64,
    /// CPU seconds spent on building the scene.
    pub cpu_seconds_setup: f64,
    /// CPU seconds spent on rendering.
    pub cpu_seconds_render: f64,
    /// Files that the scene names, as they were when the snapshot was rendered; empty if unknown.
    pub files: Vec<Fingerprint>,
}

const SOFTWARE: &str = "software";
const SOFTWARE_PREFIX: &str = "Flambeau ";
const SCENE: &str = "scene";
const STRATEGY: &str = "strategy";
const SEED: &str = "seed";
const SAMPLES_PER_PIXEL: &str = "samples";
const WALL_SECONDS: &str = "wall_seconds";
/// Setup and rendering together.
const CPU_SECONDS: &str = "cpu_seconds";
const CPU_SECONDS_SETUP: &str = "flambeau.cpu_seconds_setup";
const PATH_VERSION: &str = "flambeau.path_version";
const FILES: &str = "flambeau.files";
const PATHS: &str = "flambeau.paths";
const TRACKING_STEPS: &str = "flambeau.tracking_steps";
const NON_FINITE: &str = "flambeau.non_finite_samples";
const GUARD_HITS: &str = "flambeau.guard_hits";

/// Path version of snapshots that state none, which are those of Flambeau 0.1.0.
const FIRST_PATH_VERSION: u64 = 1;

/// The attributes of a snapshot of `film`.
///
/// # Errors
/// A name of a file that cannot be written down; none of those that a scene can have.
pub fn attributes(film: &Film, header: &SnapshotHeader) -> Result<LayerAttributes> {
    let words = |value: &str| AttributeValue::Text(text(value));
    // As text, for OpenEXR's whole numbers end at 2³¹.
    let count = |value: u64| AttributeValue::Text(text(&value.to_string()));
    let files = serde_json::to_string(&header.files)
        .map_err(|e| Error::invalid("", FILES, e.to_string()))?;
    let cpu_seconds = header.cpu_seconds_setup + header.cpu_seconds_render;
    let entries = [
        (SCENE, words(&header.scene)),
        (STRATEGY, words(&header.strategy)),
        (SEED, count(header.seed)),
        (SAMPLES_PER_PIXEL, AttributeValue::F64(samples_per_pixel(film))),
        (WALL_SECONDS, AttributeValue::F64(header.wall_seconds)),
        (CPU_SECONDS, AttributeValue::F64(cpu_seconds)),
        (CPU_SECONDS_SETUP, AttributeValue::F64(header.cpu_seconds_setup)),
        (PATH_VERSION, count(header.path_version)),
        (FILES, words(&files)),
        (PATHS, count(film.totals.paths)),
        (TRACKING_STEPS, count(film.totals.tracking_steps)),
        (NON_FINITE, count(film.totals.non_finite)),
        (GUARD_HITS, count(film.totals.guard_hits)),
    ];
    let mut attributes = LayerAttributes {
        software_name: Some(text(&format!("{SOFTWARE_PREFIX}{}", header.version))),
        ..LayerAttributes::default()
    };
    attributes.other.extend(entries.into_iter().map(|(name, value)| (text(name), value)));
    Ok(attributes)
}

/// EXR text is bytes; ours are UTF-8.
fn text(value: &str) -> Text {
    Text::from_slice_unchecked(value.as_bytes())
}

/// The attributes of a file.
pub struct Attributes<'a> {
    path: &'a Path,
    all: &'a LayerAttributes,
}

impl<'a> Attributes<'a> {
    /// Attributes of the file at `path`.
    pub fn new(path: &'a Path, all: &'a LayerAttributes) -> Self {
        Self { path, all }
    }

    /// Whether Flambeau wrote the file; other programs have scenes too.
    pub fn are_ours(&self) -> bool {
        self.get(SCENE).is_some() && self.get(PATHS).is_some()
    }

    /// Reads the header of the snapshot from the attributes.
    pub fn header(&self) -> Result<SnapshotHeader> {
        let cpu_seconds_setup = self.number(CPU_SECONDS_SETUP)?;
        Ok(SnapshotHeader {
            scene: self.text(SCENE)?,
            strategy: self.text(STRATEGY)?,
            seed: self.count(SEED)?,
            version: self.version()?,
            path_version: self.path_version()?,
            wall_seconds: self.number(WALL_SECONDS)?,
            cpu_seconds_setup,
            cpu_seconds_render: (self.number(CPU_SECONDS)? - cpu_seconds_setup).max(0.0),
            files: serde_json::from_str(&self.text(FILES)?)
                .map_err(|e| self.invalid(FILES, e.to_string()))?,
        })
    }

    /// Counts over the whole film.
    pub fn totals(&self) -> Result<Totals> {
        Ok(Totals {
            paths: self.count(PATHS)?,
            tracking_steps: self.count(TRACKING_STEPS)?,
            non_finite: self.count(NON_FINITE)?,
            guard_hits: self.count(GUARD_HITS)?,
        })
    }

    /// Mean samples of a pixel.
    pub fn samples(&self) -> Result<f64> {
        self.number(SAMPLES_PER_PIXEL)
    }

    fn version(&self) -> Result<String> {
        let Some(software) = &self.all.software_name else { return Err(self.missing(SOFTWARE)) };
        let software = software.to_string();
        Ok(software.strip_prefix(SOFTWARE_PREFIX).unwrap_or(&software).to_owned())
    }

    fn path_version(&self) -> Result<u64> {
        match self.get(PATH_VERSION) {
            Some(_) => self.count(PATH_VERSION),
            None => Ok(FIRST_PATH_VERSION),
        }
    }

    fn get(&self, name: &str) -> Option<&AttributeValue> {
        self.all.other.get(text(name).as_slice())
    }

    fn text(&self, name: &str) -> Result<String> {
        match self.get(name) {
            Some(AttributeValue::Text(value)) => String::from_utf8(value.as_slice().to_vec())
                .map_err(|_| self.invalid(name, "is not UTF-8 text")),
            _ => Err(self.missing(name)),
        }
    }

    fn count(&self, name: &str) -> Result<u64> {
        let value = self.text(name)?;
        value.parse().map_err(|_| self.invalid(name, format!("{value:?} is not a count")))
    }

    /// A number that is not negative.
    fn number(&self, name: &str) -> Result<f64> {
        match self.get(name) {
            Some(AttributeValue::F64(value)) if value.is_finite() && *value >= 0.0 => Ok(*value),
            Some(AttributeValue::F64(value)) => {
                Err(self.invalid(name, format!("{value} is out of range")))
            }
            _ => Err(self.missing(name)),
        }
    }

    fn missing(&self, name: &str) -> Error {
        self.invalid(name, "this attribute is missing or of another type")
    }

    fn invalid(&self, name: &str, reason: impl Into<String>) -> Error {
        Error::invalid(self.path.display().to_string(), name, reason)
    }
}
