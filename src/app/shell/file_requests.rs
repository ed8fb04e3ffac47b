//! Paths that the user is asked for, and files that are being written.

use std::path::{Path, PathBuf};

use egui::Context;

use super::bars::PathBar;
use super::save::Saver;
use crate::app::jobs::dialogs::{Dialog, DialogAnswer, Dialogs, Purpose};

/// Paths that are asked for, files that were dropped, and saves under way.
pub struct FileRequests {
    /// Kind of the dialogs that ask for paths.
    dialogs: Dialogs,
    /// The system dialog, while it is open.
    dialog: Option<Dialog>,
    /// The bar to type a path in, while it is open.
    pub path_bar: Option<PathBar>,
    /// The saves that wait until the scene is built.
    pub waiting: Vec<(Purpose, PathBuf)>,
    /// The snapshot that a path is being asked for, where one was shown.
    pub subject: Option<String>,
    /// A dropped picture, until the user says whether to open it or measure against it.
    pub dropped: Option<PathBuf>,
    /// The saves under way.
    pub saver: Saver,
}

impl FileRequests {
    /// No requests yet; `dialogs` will ask for paths.
    pub fn new(dialogs: Dialogs) -> Self {
        Self {
            dialogs,
            dialog: None,
            path_bar: None,
            waiting: Vec::new(),
            subject: None,
            dropped: None,
            saver: Saver::default(),
        }
    }

    /// Asks for a path, `suggested` at first: by the system's dialog, or typed where there is none.
    pub fn ask(&mut self, ctx: &Context, purpose: Purpose, suggested: &Path) {
        if self.dialogs == Dialogs::Typed {
            self.ask_typed(purpose, suggested.to_owned());
        } else if self.dialog.is_none() {
            let wake = ctx.clone();
            match Dialog::open(purpose, suggested, move || wake.request_repaint()) {
                Ok(dialog) => self.dialog = Some(dialog),
                Err(_) => self.ask_typed(purpose, suggested.to_owned()),
            }
        }
    }

    /// Shows the bar to type a path in, `suggested` at first.
    pub fn ask_typed(&mut self, purpose: Purpose, suggested: PathBuf) {
        self.path_bar = Some(PathBar::new(purpose, suggested));
    }

    /// The answer of the system's dialog, once there is one.
    pub fn poll(&mut self) -> Option<DialogAnswer> {
        let answer = self.dialog.as_ref().and_then(Dialog::poll)?;
        self.dialog = None;
        Some(answer)
    }
}
