//! Bars that come and go at the edges of the picture: work in progress, and a path to type.

use std::path::PathBuf;

use egui::{Button, Key, ProgressBar, RichText, TextEdit, Ui};

use crate::app::jobs::dialogs::Purpose;
use crate::app::ui::theme::{color, space};

/// Shows the progress of `what`; whether it should be cancelled, which does what `help` says.
pub fn progress(ui: &mut Ui, what: &str, fraction: f32, help: &str) -> bool {
    ui.horizontal(|ui| {
        ui.label(RichText::new(what).color(color::TEXT_STRONG));
        let bar = ProgressBar::new(fraction)
            .desired_width((ui.available_width() - 90.0).max(60.0))
            .desired_height(8.0)
            .fill(color::ACCENT);
        ui.add(bar);
        ui.button("Cancel").on_hover_text(help).clicked()
    })
    .inner
}

/// Shows that the file above the window can be dropped.
pub fn drop_hint(ui: &mut Ui, name: &str) {
    ui.label(RichText::new(format!("Drop to open {name}")).color(color::ACCENT));
}

/// The use of a dropped picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dropped {
    /// The picture is opened as a snapshot.
    Open,
    /// The picture becomes the reference.
    Reference,
    /// The picture becomes the environment.
    Environment,
    /// The picture is ignored.
    Cancelled,
}

/// Asks what a dropped picture is for, once that is chosen.
pub fn dropped(ui: &mut Ui, name: &str) -> Option<Dropped> {
    ui.horizontal(|ui| {
        ui.label(RichText::new(name).color(color::TEXT_STRONG));
        let open = "Open its scene and resume from its samples.";
        let reference = "Measure the live picture against it: how far off, and where.";
        let environment = "Light the scene by it, as a picture of everything around.";
        let choices = [
            ("Open", open, Dropped::Open),
            ("Use as reference", reference, Dropped::Reference),
            ("Use as environment", environment, Dropped::Environment),
            ("Cancel", "Ignore the file.", Dropped::Cancelled),
        ];
        let mut chosen = None;
        for (text, help, choice) in choices {
            if ui.button(text).on_hover_text(help).clicked() {
                chosen = Some(choice);
            }
        }
        let escaped = ui.input(|input| input.key_pressed(Key::Escape));
        chosen.or(escaped.then_some(Dropped::Cancelled))
    })
    .inner
}

/// A path being typed.
#[derive(Debug)]
pub struct PathBar {
    /// The purpose of the path.
    pub purpose: Purpose,
    /// The text typed so far.
    pub text: String,
    /// The name of a file of which only the folder is typed.
    name: PathBuf,
    fresh: bool,
    /// Whether the user was warned that the file exists and will be replaced.
    warned: bool,
}

/// The state of a path being typed.
pub enum Typed {
    /// The path is still being typed.
    Pending,
    /// The path is complete.
    Done(String),
    /// The path is not wanted any more.
    Cancelled,
}

impl PathBar {
    /// A bar that starts with `suggested`, a file where one is to be saved.
    pub fn new(purpose: Purpose, suggested: PathBuf) -> Self {
        let name = PathBuf::from(suggested.file_name().unwrap_or_default());
        let text = if purpose.reads() { String::new() } else { suggested.display().to_string() };
        Self { purpose, text, name, fresh: true, warned: false }
    }

    /// Shows the bar. A file that would be replaced has to be confirmed twice.
    pub fn show(&mut self, ui: &mut Ui) -> Typed {
        let typed = self.line(ui);
        if self.warned {
            let text = RichText::new("This file exists. Save again to replace it.");
            ui.label(text.color(color::WARNING));
        }
        match typed {
            Typed::Done(text) if !self.warned && self.replaces(&text) => {
                self.warned = true;
                self.fresh = true;
                Typed::Pending
            }
            typed => typed,
        }
    }

    fn replaces(&self, text: &str) -> bool {
        let path = PathBuf::from(crate::app::jobs::dialogs::typed(text));
        !self.purpose.reads() && self.purpose.complete(path, &self.name).exists()
    }

    fn line(&mut self, ui: &mut Ui) -> Typed {
        let (label, hint, confirm) = match self.purpose {
            Purpose::Open => {
                let hint = "path of a .toml, .vdb, .nvdb or .exr, a folder of numbered volumes, or \
                            builtin:NAME";
                ("Open", hint, "Open")
            }
            Purpose::SaveExr => ("Save EXR as", "path of the .exr", "Save"),
            Purpose::SavePng => ("Save PNG as", "path of the .png", "Save"),
            Purpose::SaveScene => ("Save scene as", "path of the .toml", "Save"),
            Purpose::Reference => ("Reference", "path of an .exr or .npy", "Load"),
            Purpose::Environment => ("Environment", "path of an .hdr or .exr", "Load"),
            Purpose::SaveFlipbook => (
                "Save flipbook as",
                "path with #### for the frame, such as fire.####.png or fire.####.exr",
                "Save",
            ),
            Purpose::SaveComparison => ("Save comparison as", "path of the .png", "Save"),
        };
        ui.horizontal(|ui| {
            ui.label(RichText::new(label).color(color::TEXT_STRONG));
            let width = (ui.available_width() - 150.0).max(80.0);
            let edit = TextEdit::singleline(&mut self.text).hint_text(hint).desired_width(width);
            let field = ui.add(edit).accessible_name("Path");
            self.warned &= !field.changed();
            if std::mem::take(&mut self.fresh) {
                field.request_focus();
            }
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let wide = |text| Button::new(text).min_size(egui::vec2(60.0, space::ROW_HEIGHT));
            let confirmed = ui.add(wide(confirm)).clicked() || entered;
            let escaped = ui.input(|input| input.key_pressed(Key::Escape));
            if ui.add(wide("Cancel")).clicked() || escaped {
                Typed::Cancelled
            } else if confirmed && !self.text.trim().is_empty() {
                Typed::Done(self.text.clone())
            } else {
                Typed::Pending
            }
        })
        .inner
    }
}
