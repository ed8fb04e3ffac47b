//! What the window edits, and the record of edits for undo and redo.

use std::time::{Duration, Instant};

use super::history::{Gesture, History};
use crate::image::tone::Tone;
use crate::scene::Settings;
use crate::transport::strategy::Tracker;

/// Everything that an edit changes and undo brings back.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The scene, as a scene file holds it.
    pub settings: Settings,
    /// How the picture is shown.
    pub tone: Tone,
    /// Whether the film keeps `settings.film.size` instead of the viewport's own size.
    pub keep_size: bool,
}

/// The document, as it was opened and as it is, with the edits between.
#[derive(Debug, Default)]
pub struct Editor {
    /// The document as it is. Change it at will during a frame; [`Self::end_frame`] records it.
    pub document: Document,
    opened: Document,
    before: Document,
    history: History<Document>,
    name: Option<String>,
    gesture: u64,
    last_wheel: Option<Instant>,
}

/// Turns of the wheel that follow one another within this time are one edit.
const WHEEL_PAUSE: Duration = Duration::from_millis(600);

impl Editor {
    /// Starts over with `settings`, on a film of their own size if `keep_size`, keeping how the
    /// picture is shown.
    pub fn open(&mut self, settings: Settings, keep_size: bool) {
        let tone = self.document.tone;
        self.document = Document { settings, tone, keep_size };
        self.opened = self.document.clone();
        self.before = self.document.clone();
        self.history = History::default();
        self.name = None;
    }

    /// The document as it was opened: what a double click on a setting goes back to.
    pub fn opened(&self) -> &Document {
        &self.opened
    }

    /// Starts a frame, before anything may change the document. While the pointer is held or the
    /// wheel keeps turning, changes belong to one gesture.
    pub fn begin_frame(&mut self, ctx: &egui::Context) {
        let (held, wheel) = ctx.input(|input| {
            let wheel = input.smooth_scroll_delta() != egui::Vec2::ZERO;
            (input.pointer.any_down() || input.pointer.any_released(), wheel)
        });
        let now = Instant::now();
        if wheel {
            let paused = self.last_wheel.is_none_or(|last| now - last > WHEEL_PAUSE);
            self.gesture += u64::from(paused && !held);
            self.last_wheel = Some(now);
        } else if !held {
            self.gesture += 1;
        }
        self.before.clone_from(&self.document);
        self.name = None;
    }

    /// Says what the change of this frame is called.
    pub fn name_edit(&mut self, name: impl Into<String>) {
        self.name = Some(name.into());
    }

    /// Ends a frame: records what changed. Whether anything did. A tracker that the edit leaves
    /// without what it needs gives way to the plain one.
    pub fn end_frame(&mut self) -> bool {
        if self.document == self.before {
            return false;
        }
        let strategy = &mut self.document.settings.strategy;
        if strategy.tracker_refusal().is_some() {
            strategy.advanced.tracker = Tracker::default();
        }
        let name = self.name.take().unwrap_or_else(|| "edit".to_owned());
        self.history.record(self.before.clone(), &name, Gesture(self.gesture));
        true
    }

    /// Takes the last edit back.
    pub fn undo(&mut self) {
        self.travel(History::undo);
    }

    /// Makes the last edit taken back again.
    pub fn redo(&mut self) {
        self.travel(History::redo);
    }

    fn travel(&mut self, step: fn(&mut History<Document>, Document) -> Result<Document, Document>) {
        let present = std::mem::take(&mut self.document);
        let (Ok(state) | Err(state)) = step(&mut self.history, present);
        self.document = state;
        self.before.clone_from(&self.document);
        self.gesture += 1;
    }

    /// The name of the edit that would be taken back.
    pub fn undo_name(&self) -> Option<&str> {
        self.history.undo_name()
    }

    /// The name of the edit that would be made again.
    pub fn redo_name(&self) -> Option<&str> {
        self.history.redo_name()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undo_brings_back_the_document_and_redo_the_edit() {
        let ctx = egui::Context::default();
        let mut editor = Editor::default();
        editor.begin_frame(&ctx);
        editor.document.tone.exposure = 2.0;
        editor.name_edit("exposure");
        assert!(editor.end_frame());
        editor.begin_frame(&ctx);
        assert!(!editor.end_frame());
        assert_eq!(editor.undo_name(), Some("exposure"));
        editor.undo();
        assert_eq!(editor.document.tone.exposure, 0.0);
        assert_eq!(editor.undo_name(), None);
        editor.redo();
        assert_eq!(editor.document.tone.exposure, 2.0);
        editor.redo();
        assert_eq!(editor.document.tone.exposure, 2.0);
    }
}
