//! Unsaved changes of the scene: told apart from the scene as it was opened or saved last.

use std::path::{Path, PathBuf};

use super::unsaved_bar::PendingAction;
use crate::app::jobs::live_render::same_matter;
use crate::scene::Settings;

/// The scene as it is on the disk, or on its way there.
#[derive(Debug, Default)]
pub(super) struct UnsavedChanges {
    /// The scene as it was opened or saved last.
    saved: Settings,
    /// Scenes that are being written.
    writing: Vec<(PathBuf, Settings)>,
    /// The action that would lose changes, while the user is asked about it.
    pub(super) pending: Option<PendingAction>,
    /// Whether the keyboard is still to go to the bar that asks.
    pub(super) is_fresh: bool,
    /// Whether the action goes on as soon as the changes are saved.
    pub(super) saves_first: bool,
    /// Whether the changes may be lost, or the window close.
    pub(super) allowed: bool,
    /// The title of the window.
    pub(super) title: String,
    /// Whether the scene is a file of the user's, whose camera is part of the work.
    is_own: bool,
}

impl UnsavedChanges {
    /// A scene was opened from `source`.
    pub(super) fn opened(&mut self, source: &str, settings: &Settings) {
        self.saved = settings.clone();
        (self.pending, self.saves_first, self.allowed) = (None, false, false);
        let ending = Path::new(source).extension();
        self.is_own = ending.is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    }

    /// Asks about unsaved changes before `action` is carried out.
    pub(super) fn ask(&mut self, action: PendingAction) {
        (self.pending, self.is_fresh) = (Some(action), true);
    }

    /// A scene is being written to `path`.
    pub(super) fn writes(&mut self, path: &Path, settings: Settings) {
        self.writing.push((path.to_owned(), settings));
    }

    /// `path` was written, or could not be.
    pub(super) fn written(&mut self, path: &Path, is_there: bool) {
        if let Some(index) = self.writing.iter().position(|(writing, _)| writing == path) {
            let (_, settings) = self.writing.remove(index);
            if is_there {
                (self.saved, self.is_own) = (settings, true);
            }
        }
    }

    /// Whether `settings` are those that were opened or saved last.
    pub(super) fn is_saved(&self, settings: &Settings) -> bool {
        self.saved == *settings
    }

    /// The scene's file has these settings now.
    pub(super) fn changed_on_disk(&mut self, settings: Settings) {
        self.saved = settings;
    }

    /// The settings of the scene's file as it is now, with the `present` strategy and frame where
    /// the file does not change them, since one tries them on and off all the time.
    pub(super) fn reloaded(&self, of_file: &Settings, present: &Settings) -> Settings {
        let mut settings = of_file.clone();
        if settings.strategy == self.saved.strategy {
            settings.strategy = present.strategy;
        }
        if settings.time.frame == self.saved.time.frame {
            settings.time.frame = present.time.frame;
        }
        settings
    }

    /// Whether `settings` have changes that no file has. Strategies are tried on and off all the
    /// time and change no picture, and a film that follows the window has no size of its own.
    /// Moving the camera in an embedded scene, or in a bare volume, is no change to save yet, nor
    /// is another frame of the time line.
    pub(super) fn differs_from(&self, settings: &Settings, keep_size: bool) -> bool {
        let mut film = self.saved.film;
        if !keep_size {
            film.size = settings.film.size;
        }
        let is_moved = self.is_own && self.saved.camera != settings.camera;
        let mut saved = self.saved.clone();
        saved.time.frame = settings.time.frame;
        film != settings.film
            || is_moved
            || saved.time != settings.time
            || !same_matter(&saved, settings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::strategy::Preset;

    #[test]
    fn changes_are_what_no_file_has() {
        let mut settings = Settings::default();
        let mut unsaved = UnsavedChanges::default();
        unsaved.opened("torch.toml", &settings);
        settings.strategy = Preset::Baseline.strategy();
        settings.film.size = [7, 7];
        assert!(
            !unsaved.differs_from(&settings, false),
            "strategies and the window's size are none"
        );
        assert!(unsaved.differs_from(&settings, true));
        settings.time.frame = 7.0;
        assert!(!unsaved.differs_from(&settings, false), "nor is another frame");
        settings.camera.fov_x += 1.0;
        assert!(unsaved.differs_from(&settings, false));
        let path = Path::new("torch.toml");
        unsaved.writes(path, settings.clone());
        assert!(unsaved.differs_from(&settings, false), "not there yet");
        unsaved.written(path, false);
        assert!(unsaved.differs_from(&settings, false), "it failed");
        unsaved.writes(path, settings.clone());
        unsaved.written(path, true);
        assert!(!unsaved.differs_from(&settings, false));
    }

    #[test]
    fn looking_around_in_what_is_nobodys_own_is_no_change() {
        let mut settings = Settings::default();
        let mut unsaved = UnsavedChanges::default();
        for (source, is_own) in [("builtin:torch", false), ("smoke.vdb", false), ("a.toml", true)] {
            unsaved.opened(source, &settings);
            settings.camera.fov_x += 1.0;
            assert_eq!(unsaved.differs_from(&settings, false), is_own, "{source}");
            settings.path.max_scatters += 1;
            assert!(unsaved.differs_from(&settings, false), "{source}");
        }
        unsaved.opened("builtin:torch", &settings);
        unsaved.writes(Path::new("a.toml"), settings.clone());
        unsaved.written(Path::new("a.toml"), true);
        settings.camera.fov_x += 1.0;
        assert!(unsaved.differs_from(&settings, false), "a file of one's own by now");
    }
}
