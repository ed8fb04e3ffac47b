//! Writes pictures and scenes on threads of their own, pictures from a consistent copy of the film.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, mpsc};

use super::export::SavedView;
use crate::app::jobs::film_file::{header, receive};
use crate::error::{Error, Result};
use crate::files;
use crate::image::exr;
use crate::image::png;
use crate::image::tone::Tone;
use crate::render::picture::resolve;
use crate::render::{Film, Picture};
use crate::scene::sequence::Pattern;
use crate::scene::{self, Settings};

/// The content of a file to write.
pub enum Content {
    /// A snapshot: the linear picture with its layers and all that is needed to go on.
    Exr {
        /// The film, once the session has copied it.
        film: mpsc::Receiver<Film>,
        /// The settings of the film, with its size, seed and limit.
        settings: Settings,
        /// Seconds spent on the film, and CPU time.
        seconds: [f64; 2],
    },
    /// The picture as shown.
    Png {
        /// The film, once the session has copied it.
        film: mpsc::Receiver<Film>,
        /// Tone mapping of the picture.
        tone: Tone,
    },
    /// A scene file.
    Scene(Settings),
    /// The content of another file.
    Copy(PathBuf),
    /// A snapshot's picture, as shown.
    Shown {
        /// The picture.
        picture: Arc<Picture>,
        /// Tone mapping of the picture.
        tone: Tone,
    },
    /// A view with its figures.
    View(Box<SavedView>),
    /// Views of frames with their numbers, each to a file of its own.
    Frames(Vec<(i32, SavedView)>),
}

/// A save under way.
struct Save {
    path: PathBuf,
    result: mpsc::Receiver<Result<()>>,
}

/// The saves under way.
#[derive(Default)]
pub struct Saver {
    saves: Vec<Save>,
}

impl Saver {
    /// Starts to write `content` to `path`. `wake` is called when it is done.
    ///
    /// # Errors
    /// When the system refuses to start a thread.
    pub fn start(
        &mut self,
        path: PathBuf,
        content: Content,
        wake: impl FnOnce() + Send + 'static,
    ) -> Result<()> {
        let (sender, result) = mpsc::channel();
        let target = path.clone();
        std::thread::Builder::new()
            .name("save".to_owned())
            .spawn(move || {
                // Nobody listens any more where the window was closed meanwhile.
                let _ = sender.send(write(&target, content));
                wake();
            })
            .map_err(|error| Error::io(&path, error))?;
        self.saves.push(Save { path, result });
        Ok(())
    }

    /// The saves that have ended since, with how.
    pub fn poll(&mut self) -> Vec<(PathBuf, Result<()>)> {
        let mut ended = Vec::new();
        self.saves.retain(|save| match save.result.try_recv() {
            Ok(result) => {
                ended.push((save.path.clone(), result));
                false
            }
            Err(mpsc::TryRecvError::Empty) => true,
            Err(mpsc::TryRecvError::Disconnected) => {
                let name = save.path.display().to_string();
                let reason = "saving was interrupted; try again, or save elsewhere";
                ended.push((save.path.clone(), Err(Error::invalid(name, "", reason))));
                false
            }
        });
        ended
    }

    /// Waits for what is still being written; for the end of the program.
    pub fn finish(&mut self) {
        for save in self.saves.drain(..) {
            if let Ok(Err(error)) = save.result.recv() {
                // Nowhere is left to say it where nobody reads the standard error.
                let _ = writeln!(std::io::stderr(), "{error}");
            }
        }
    }
}

fn write(path: &Path, content: Content) -> Result<()> {
    match content {
        Content::Exr { film, settings, seconds } => {
            let film = receive(path, &film)?;
            exr::write(path, &film, &header(&settings, seconds)?)
        }
        Content::Png { film, tone } => {
            let film = receive(path, &film)?;
            let mut pixels = Vec::new();
            resolve(&film, &mut pixels);
            png::write(path, film.size(), &pixels, tone)
        }
        Content::Scene(settings) => scene::save(&settings, path),
        Content::Copy(from) => {
            let mut source = File::open(&from).map_err(|e| Error::io(&from, e))?;
            files::replace(path, |file| match std::io::copy(&mut source, file) {
                Ok(_) => Ok(()),
                Err(error) => Err(Error::io(path, error)),
            })
        }
        Content::View(view) => view.write(path),
        Content::Frames(frames) => {
            let name = path.to_string_lossy();
            let pattern = Pattern::spelled(&name).or_else(|| Pattern::spelled(&numbered(path)));
            let file = |frame| pattern.as_ref().map_or(path.to_owned(), |set| set.file(frame));
            frames.into_iter().try_for_each(|(frame, view)| view.write(&file(frame)))
        }
        Content::Shown { picture, tone } => png::write(path, picture.size, &picture.pixels, tone),
    }
}

/// The path with a place for the number of a frame before its ending.
fn numbered(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    path.with_extension(format!("####.{ending}")).to_string_lossy().into_owned()
}
