//! Files that the window opens and saves.

use std::path::{Path, PathBuf};

use egui::Context;

use super::app::App;
use crate::app::jobs::dialogs::Purpose;
use crate::app::panels;
use crate::app::shell::save::Content;
use crate::files::name_of;

impl App {
    /// Opens a path or `builtin:NAME`.
    pub(super) fn open(&mut self, source: &str) {
        self.files.path_bar = None;
        self.live_render.open(source);
    }

    /// Opens a dropped file, measures against it, or lights the scene by it; of a picture that could
    /// be any it asks.
    pub(super) fn take_dropped(&mut self, ctx: &Context, path: &Path) {
        let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
        self.files.dropped = None;
        match extension.as_deref().and_then(std::ffi::OsStr::to_str) {
            Some("npy") => self.load_reference(ctx, path.to_owned()),
            Some("hdr") => self.load_environment(path),
            Some("exr") => self.files.dropped = Some(path.to_owned()),
            _ => self.open_or_ask(&name_of(path)),
        }
    }

    /// Uses a chosen path for its purpose.
    pub(super) fn take_path(&mut self, ctx: &Context, purpose: Purpose, path: PathBuf) {
        if purpose == Purpose::Open {
            self.open_or_ask(&name_of(&path));
        } else if purpose == Purpose::Reference {
            self.load_reference(ctx, path);
        } else if purpose == Purpose::Environment {
            self.load_environment(&path);
        } else if self.live_render.is_building() {
            // The film is about to become that of another scene.
            self.files.waiting.push((purpose, path));
        } else {
            self.save(ctx, purpose, path);
        }
    }

    /// Lights the scene by a picture.
    pub(super) fn load_environment(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let environment = &mut self.editor.document.settings.environment;
        panels::environment::set_image(environment, name_of(&path));
        self.editor.name_edit("environment");
    }

    /// Saves what waited for a build to end.
    pub(super) fn save_waiting(&mut self, ctx: &Context) {
        if !self.live_render.is_building() {
            for (purpose, path) in std::mem::take(&mut self.files.waiting) {
                self.save(ctx, purpose, path);
            }
        }
    }

    fn save(&mut self, ctx: &Context, purpose: Purpose, path: PathBuf) {
        let Some(content) = self.content(ctx, purpose) else {
            self.notices.failed("There is no picture to save yet.");
            return;
        };
        let wake = ctx.clone();
        let path = purpose.complete(path, &self.suggested_name(purpose));
        if let Content::Scene(settings) = &content {
            self.unsaved.writes(&path, settings.clone());
        }
        if let Err(error) = self.files.saver.start(path, content, move || wake.request_repaint()) {
            self.notices.failed(error.to_string());
        }
    }

    /// The content that saving writes at this moment; `None` where there is nothing yet.
    fn content(&self, ctx: &Context, purpose: Purpose) -> Option<Content> {
        if self.files.subject.is_some() && matches!(purpose, Purpose::SaveExr | Purpose::SavePng) {
            return self.snapshot_content(purpose);
        }
        let document = &self.editor.document;
        let live_render = self.compare.second_side.edited(&self.live_render);
        let settings = live_render.rendered()?;
        match purpose {
            Purpose::Open | Purpose::Reference | Purpose::Environment => None,
            Purpose::SaveFlipbook => self.flipbook_content(ctx),
            Purpose::SaveComparison => Some(Content::View(Box::new(self.saved_view(ctx)))),
            Purpose::SaveExr => Some(Content::Exr {
                film: live_render.session().snapshot(),
                settings: settings.clone(),
                seconds: live_render
                    .picture()
                    .map_or([0.0; 2], |picture| [picture.stats.seconds, picture.stats.cpu_seconds]),
            }),
            Purpose::SavePng => {
                Some(Content::Png { film: live_render.session().snapshot(), tone: document.tone })
            }
            Purpose::SaveScene => {
                // A film of the window's size is written as that size, so the picture is the same.
                let mut saved = document.settings.clone();
                saved.film.size = settings.film.size;
                Some(Content::Scene(saved))
            }
        }
    }

    /// Asks for a path in the way that the options say.
    pub(super) fn ask(&mut self, ctx: &Context, purpose: Purpose) {
        // Beside the live picture it is that which is worked on.
        let shown = self.snapshots.strip.shown_item().filter(|_| self.compare.versus.is_none());
        self.files.subject = shown.map(|item| item.entry.id.clone());
        self.files.ask(ctx, purpose, &self.suggested(purpose));
    }

    /// Shows the bar to type a path in.
    pub(super) fn ask_typed(&mut self, purpose: Purpose) {
        self.files.ask_typed(purpose, self.suggested(purpose));
    }

    /// A file beside what is open, or in the present folder.
    fn suggested(&self, purpose: Purpose) -> PathBuf {
        let here = std::env::current_dir().unwrap_or_default();
        let name = self.suggested_name(purpose);
        let folder = Path::new(&self.opened.source).parent().filter(|folder| folder.is_dir());
        folder.map_or_else(|| here.clone(), |folder| here.join(folder)).join(name)
    }
}
