//! Takes in what threads and the desktop have brought since the last frame.

use std::path::Path;

use egui::Context;

use super::app::App;
use super::preferences::full_name;
use crate::app::jobs::dialogs::DialogAnswer;
use crate::app::jobs::live_render::News;
use crate::app::picture::gizmo::Gizmo;
use crate::app::ui::notices::{Level, Notice, Notices};
use crate::scene;
use crate::scene::sequence::Pattern;

impl App {
    pub(super) fn take_in(&mut self, ctx: &Context, news: Vec<News>) {
        for item in news {
            match item {
                News::Opened { source, settings, notes, reopened } => {
                    self.opened.notes = notes;
                    self.unsaved.opened(&source, &settings);
                    self.changed_scene.forget();
                    self.gizmo = Gizmo::default();
                    self.editor.open(*settings, reopened.is_some());
                    self.viewport.zoom = Default::default();
                    self.sweep.forget();
                    self.notices = Notices::default();
                    self.note_opened_file(&source);
                    // A sequence goes by the name of all its files.
                    let file = self.editor.document.settings.volume.first();
                    let file = file.and_then(|volume| volume.file.as_deref());
                    let pattern = file.filter(|file| Pattern::spelled(file).is_some());
                    let is_bare = !scene::is_scene(&source) && reopened.is_none();
                    self.opened.source = match pattern.filter(|_| is_bare) {
                        Some(pattern) => pattern.to_owned(),
                        None => self.name_of(source),
                    };
                    self.compare.versus = None;
                    self.compare.region.remove();
                    self.watch_files();
                    if let Err(error) =
                        self.compare.reference.open(ctx, &full_name(&self.opened.source))
                    {
                        self.notices.failed(error.to_string());
                    }
                    if let Some(Notice { level, text }) = reopened {
                        let text = format!("{}: {text}", self.opened.title());
                        self.notices.push(Notice { level, text });
                    }
                }
                News::Failed(text) => self.notices.failed(text),
                News::Refused(text) => self.notices.refused(text),
                News::Accepted => {
                    self.notices.clear(Level::Refused);
                    self.watch_files();
                }
                News::Started(generation) => self.note_start(generation),
            }
        }
    }

    /// Takes in what other threads and the desktop have brought since the last frame.
    pub(super) fn take_in_arrivals(&mut self, ctx: &Context) {
        if let (Some(stats), Some(picture)) = (&mut self.stats, self.live_render.picture()) {
            stats.shown(picture.generation);
        }
        for (path, result) in self.files.saver.poll() {
            self.unsaved.written(&path, result.is_ok());
            let scene = std::path::absolute(&path).ok().filter(|_| result.is_ok());
            if let Some(scene) = scene.filter(|path| self.scene_file().as_ref() == Some(path)) {
                self.file_watch.know(&scene);
                self.changed_scene.forget();
            }
            match result {
                Ok(()) => self.notices.done(format!("Saved {}", path.display())),
                Err(error) => self.notices.failed(error.to_string()),
            }
        }
        if let Some(answer) = self.files.poll() {
            match answer {
                DialogAnswer::Chosen(purpose, path) => self.take_path(ctx, purpose, path),
                DialogAnswer::Unavailable(purpose) => self.ask_typed(purpose),
                DialogAnswer::Cancelled => {}
            }
        }
        // Of several files the first by name: of a numbered set that is its first frame.
        let dropped = ctx.input(|input| {
            let files = input.raw.dropped_files.iter();
            files.map(|file| file.path().to_owned()).min()
        });
        if let Some(path) = dropped {
            self.take_dropped(ctx, &path);
        }
    }

    /// Watches the file of the scene, those that it reads, and the folders of its sequences.
    fn watch_files(&mut self) {
        let settings = &self.editor.document.settings;
        // What cannot be listed is reported where the scene is built.
        let mut paths = scene::files_on_disk(settings).unwrap_or_default();
        let sequences = settings.volume.iter().filter_map(|volume| volume.file.as_deref());
        let folders = sequences.filter_map(Pattern::spelled).map(|set| set.folder().to_owned());
        paths.extend(folders);
        paths.extend(self.scene_file());
        self.file_watch.watch(paths);
    }

    /// Reads files of the scene again that have changed on the disk, with the look as it is.
    pub(super) fn reload_changed_files(&mut self, ctx: &Context) {
        let mut changed = self.file_watch.changed();
        if let Some(scene) = self.scene_file().filter(|scene| changed.contains(scene)) {
            changed.retain(|path| *path != scene);
            self.read_scene_again(ctx, &scene);
        }
        if !changed.is_empty() {
            self.time_line.look_again();
            self.live_render.reload();
            self.compare.second_side.reload();
            self.notices.done("Files of the scene have changed on the disk and are read again.");
        }
    }

    /// Notes the file that was opened, for the next run too. Snapshots have their strip.
    fn note_opened_file(&mut self, source: &str) {
        if self.snapshots.name_of(Path::new(source)).is_some() {
            return;
        }
        self.preferences.note(source);
        if let Err(error) = self.write_preferences() {
            self.notices.failed(error.to_string());
        }
    }

    fn note_start(&mut self, generation: u64) {
        if let Some(stats) = &mut self.stats {
            stats.started(generation);
        }
        // Whoever asks for another picture wants to see it; beside a snapshot it is seen already.
        if self.compare.versus.is_none() {
            self.snapshots.strip.show(None);
        }
    }
}
