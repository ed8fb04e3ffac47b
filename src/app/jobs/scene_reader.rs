//! Reads a scene file again on a thread of its own, since a disk may take its time.

use std::path::{Path, PathBuf};
use std::sync::mpsc;

use crate::error::{Error, Result};
use crate::files::name_of;
use crate::scene::{self, Settings};

/// Reads scene files, one at a time.
#[derive(Debug, Default)]
pub struct SceneReader {
    reading: Option<Reading>,
}

#[derive(Debug)]
struct Reading {
    path: PathBuf,
    result: mpsc::Receiver<Result<Settings>>,
}

impl SceneReader {
    /// Reads the scene file at `path` in place of what is being read. `wake` is called when it is
    /// done.
    ///
    /// # Errors
    /// When the system refuses to start a thread.
    pub fn read(&mut self, path: &Path, wake: impl FnOnce() + Send + 'static) -> Result<()> {
        let (sender, result) = mpsc::channel();
        let name = name_of(path);
        std::thread::Builder::new()
            .name("scene reader".to_owned())
            .spawn(move || {
                // Nobody listens any more where another scene was opened meanwhile.
                let _ = sender.send(scene::load(&name));
                wake();
            })
            .map_err(|error| Error::io(path, error))?;
        self.reading = Some(Reading { path: path.to_owned(), result });
        Ok(())
    }

    /// Forgets what is being read.
    pub fn forget(&mut self) {
        self.reading = None;
    }

    /// The scene that was read, or why it could not be, once that is known.
    pub fn poll(&mut self) -> Option<Result<Settings>> {
        let reading = self.reading.as_ref()?;
        let result = match reading.result.try_recv() {
            Ok(result) => result,
            Err(mpsc::TryRecvError::Empty) => return None,
            Err(mpsc::TryRecvError::Disconnected) => {
                let name = reading.path.display().to_string();
                Err(Error::invalid(name, "", "reading was interrupted; save the file again"))
            }
        };
        self.reading = None;
        Some(result)
    }
}
