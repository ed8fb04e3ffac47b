//! The scene that is open, as the user named it.

use std::path::Path;

use crate::scene::Note;

/// The scene that is open.
pub struct Opened {
    /// Path of the scene or `builtin:NAME`; of a snapshot the name in the strip.
    pub source: String,
    /// The guesses made when the scene was opened.
    pub notes: Vec<Note>,
}

impl Opened {
    /// Short name of the scene: the file name, or the name of an embedded scene.
    pub fn title(&self) -> String {
        match self.source.strip_prefix("builtin:") {
            Some(name) => name.to_owned(),
            None => Path::new(&self.source)
                .file_name()
                .map_or_else(|| self.source.clone(), |name| name.to_string_lossy().into_owned()),
        }
    }

    /// The title without the ending of a file.
    pub fn short_title(&self) -> String {
        let title = self.title();
        let stem = title.rsplit_once('.').map(|(stem, _)| stem);
        stem.filter(|stem| !stem.is_empty()).unwrap_or(&title).to_owned()
    }
}
