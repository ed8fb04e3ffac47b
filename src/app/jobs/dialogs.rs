//! Choosing and writing files, all off the window's thread.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use crate::app::command::Command;
use crate::volume::file::EXTENSIONS;

/// Purpose of a path that the user is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A scene, a volume or a snapshot to open.
    Open,
    /// A file for the linear picture with its layers.
    SaveExr,
    /// A file for the picture as shown.
    SavePng,
    /// A file for the settings.
    SaveScene,
    /// A reference to measure against.
    Reference,
    /// A picture for the environment.
    Environment,
    /// A file for a comparison as shown, with its figures.
    SaveComparison,
    /// Files for the frames of the flipbook as shown.
    SaveFlipbook,
}

impl Purpose {
    /// Command with this purpose, whose text is the title of the dialog.
    pub fn command(self) -> Command {
        match self {
            Self::Open => Command::Open,
            Self::SaveExr => Command::SaveExr,
            Self::SavePng => Command::SavePng,
            Self::SaveScene => Command::SaveScene,
            Self::Reference => Command::LoadReference,
            Self::Environment => Command::LoadEnvironment,
            Self::SaveComparison => Command::SaveComparison,
            Self::SaveFlipbook => Command::SaveFlipbook,
        }
    }

    /// Whether a file is to be there already.
    pub fn reads(self) -> bool {
        matches!(self, Self::Open | Self::Reference | Self::Environment)
    }

    /// The endings that what is saved may have, the usual one first; none for what is read.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Open | Self::Reference | Self::Environment => &[],
            Self::SaveExr => &["exr"],
            Self::SavePng | Self::SaveComparison => &["png"],
            Self::SaveFlipbook => &["png", "exr"],
            Self::SaveScene => &["toml"],
        }
    }

    /// `path` with an ending that belongs to it, which tells what is in it; of a folder the file
    /// called `name` there.
    pub fn complete(self, path: PathBuf, name: &Path) -> PathBuf {
        let Some(usual) = self.extensions().first() else { return path };
        let mut path = if path.is_dir() { path.join(name) } else { path };
        let belongs = |present: &OsStr| {
            self.extensions().iter().any(|known| present.eq_ignore_ascii_case(known))
        };
        if !path.extension().is_some_and(belongs) {
            path.as_mut_os_string().push(format!(".{usual}"));
        }
        path
    }
}

/// Kind of the dialogs that ask for paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dialogs {
    /// Dialogs of the desktop; typed paths where there are none.
    #[default]
    System,
    /// Typed in the window.
    Typed,
}

/// The answer of a system dialog.
#[derive(Debug, PartialEq, Eq)]
pub enum DialogAnswer {
    /// A path was chosen.
    Chosen(Purpose, PathBuf),
    /// The dialog could not be shown, so the path has to be typed.
    Unavailable(Purpose),
    /// The dialog was closed without a choice.
    Cancelled,
}

/// A dialog that answers sooner than this without a choice was never seen by anybody.
const UNSEEN: Duration = Duration::from_millis(400);

/// A system dialog under way.
#[derive(Debug)]
pub struct Dialog {
    answer: mpsc::Receiver<DialogAnswer>,
}

impl Dialog {
    /// Opens the desktop's dialog. `suggested` is a folder and name to start from; `on_answer` is
    /// called once there is an answer.
    pub fn open(
        purpose: Purpose,
        suggested: &Path,
        on_answer: impl FnOnce() + Send + 'static,
    ) -> std::io::Result<Self> {
        let dialog = describe(purpose, suggested);
        let name = PathBuf::from(suggested.file_name().unwrap_or_default());
        let (sender, answer) = mpsc::channel();
        std::thread::Builder::new().name("dialog".to_owned()).spawn(move || {
            let asked = Instant::now();
            let choice = match purpose.reads() {
                true => dialog.pick_file(),
                false => dialog.save_file(),
            };
            let answer = match choice {
                Some(path) => DialogAnswer::Chosen(purpose, purpose.complete(path, &name)),
                None if asked.elapsed() < UNSEEN => DialogAnswer::Unavailable(purpose),
                None => DialogAnswer::Cancelled,
            };
            // Nobody listens any more where the window was closed meanwhile.
            let _ = sender.send(answer);
            on_answer();
        })?;
        Ok(Self { answer })
    }

    /// The answer, once there is one.
    pub fn poll(&self) -> Option<DialogAnswer> {
        match self.answer.try_recv() {
            Ok(answer) => Some(answer),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(DialogAnswer::Cancelled),
        }
    }
}

fn describe(purpose: Purpose, suggested: &Path) -> rfd::FileDialog {
    let dialog = rfd::FileDialog::new().set_title(purpose.command().text());
    let dialog = match suggested.parent() {
        Some(folder) if folder.is_dir() => dialog.set_directory(folder),
        _ => dialog,
    };
    match purpose {
        Purpose::Open => {
            let endings = [&["toml", "exr"][..], &EXTENSIONS].concat();
            return dialog
                .add_filter("Scenes, volumes and snapshots", &endings[..])
                .add_filter("All files", &["*"]);
        }
        Purpose::Reference => {
            return dialog.add_filter("Converged pictures", &["exr", "npy"]);
        }
        Purpose::Environment => {
            return dialog.add_filter("Pictures of everything around", &["hdr", "exr"]);
        }
        Purpose::SaveExr => dialog.add_filter("OpenEXR", &["exr"]),
        Purpose::SavePng | Purpose::SaveComparison => dialog.add_filter("PNG", &["png"]),
        Purpose::SaveFlipbook => dialog.add_filter("PNG", &["png"]).add_filter("OpenEXR", &["exr"]),
        Purpose::SaveScene => dialog.add_filter("Scene", &["toml"]),
    }
    .set_file_name(suggested.file_name().unwrap_or_default().to_string_lossy())
}

/// A path as typed: without the quotes and blanks that come along when it is pasted, and with `~`
/// for the home folder.
pub fn typed(text: &str) -> String {
    let text = text.trim().trim_matches(['"', '\'']);
    let text = text.strip_prefix("file://").unwrap_or(text);
    match (text.strip_prefix("~/"), std::env::home_dir()) {
        (Some(rest), Some(home)) => home.join(rest).to_string_lossy().into_owned(),
        _ => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typed_paths_are_cleaned() {
        assert_eq!(typed("  \"a b/c.vdb\" \n"), "a b/c.vdb");
        assert_eq!(typed("file:///tmp/x.toml"), "/tmp/x.toml");
        assert_eq!(typed("builtin:torch"), "builtin:torch");
    }

    #[test]
    fn saved_files_get_their_ending() {
        let complete =
            |purpose: Purpose, path: &Path| purpose.complete(path.into(), "n.x".as_ref());
        let of =
            |purpose, path: &str| complete(purpose, path.as_ref()).to_string_lossy().into_owned();
        assert_eq!(of(Purpose::SaveExr, "a/b"), "a/b.exr");
        assert_eq!(of(Purpose::SavePng, "a/b.PNG"), "a/b.PNG");
        assert_eq!(of(Purpose::SavePng, "a/b.png2"), "a/b.png2.png");
        assert_eq!(of(Purpose::SavePng, "a/b.exr"), "a/b.exr.png");
        assert_eq!(of(Purpose::SaveFlipbook, "a/b.####.EXR"), "a/b.####.EXR");
        assert_eq!(of(Purpose::SaveFlipbook, "a/b"), "a/b.png");
        assert_eq!(of(Purpose::SaveScene, "shot.v2"), "shot.v2.toml");
        assert_eq!(of(Purpose::Open, "a/b"), "a/b");
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(complete(Purpose::SaveExr, folder.path()), folder.path().join("n.x.exr"));
    }
}
