//! The document that the window edits, and the record of edits for undo and redo.

use std::time::{Duration, Instant};

use super::undo::{Gesture, History};
use crate::image::tone::Tone;
use crate::render::turns::Share;
use crate::scene::{Settings, tidy};
use crate::transport::strategy::{Preset, Strategy, Tracker};

/// The document: everything that an edit changes and undo brings back.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The scene, as a scene file holds it.
    pub settings: Settings,
    /// Tone mapping of the picture.
    pub tone: Tone,
    /// Whether the film keeps `settings.film.size` instead of the viewport's own size.
    pub keep_size: bool,
    /// Another strategy beside that of `settings`, if two are compared.
    pub compared: Option<Compared>,
}

/// Side of a comparison of two strategies on the same scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The left one.
    #[default]
    A,
    /// The right one.
    B,
}

impl Side {
    /// The other side.
    pub fn other(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B => Self::A,
        }
    }
}

/// Another strategy beside the one being edited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// The side that is edited: the strategy of the document's settings.
    pub active: Side,
    /// The side that renders where the one strategy did before there were two.
    pub main: Side,
    /// The strategy of the other side.
    pub other: Strategy,
    /// Whether B draws other random numbers than A.
    pub own_seed: bool,
    /// Whether both sides get equal CPU time or equal samples.
    pub share: Share,
}

impl Document {
    /// Sets the strategy being edited against what artists ask of it first: everything off, or
    /// everything on where that is off already. No-op where there are two already.
    pub fn compare(&mut self) {
        let strategy = self.settings.strategy;
        let plain = strategy.with_toggles_of(Preset::Baseline);
        let (active, other) = if strategy == plain {
            (Side::A, strategy.with_toggles_of(Preset::Full))
        } else {
            (Side::B, plain)
        };
        let share = Share::default();
        let begun = Compared { active, main: active, other, own_seed: false, share };
        self.compared.get_or_insert(begun);
    }

    /// Edits the other side from now on.
    pub fn switch_side(&mut self) {
        if let Some(compared) = &mut self.compared {
            compared.active = compared.active.other();
            std::mem::swap(&mut compared.other, &mut self.settings.strategy);
        }
    }

    /// Exchanges A and B; the strategy that is edited stays the one that is edited, and both go on
    /// rendering.
    pub fn swap_sides(&mut self) {
        if let Some(compared) = &mut self.compared {
            compared.active = compared.active.other();
            compared.main = compared.main.other();
        }
    }

    /// Gives the other side the strategy of the side that is edited.
    pub fn copy_to_other_side(&mut self) {
        if let Some(compared) = &mut self.compared {
            compared.other = self.settings.strategy;
        }
    }

    /// The strategy of a side.
    pub fn strategy_of(&self, side: Side) -> Strategy {
        match self.compared {
            Some(Compared { active, other, .. }) if active != side => other,
            _ => self.settings.strategy,
        }
    }

    /// The settings that a side renders.
    pub fn settings_of(&self, side: Side) -> Settings {
        let mut settings = self.settings.clone();
        settings.strategy = self.strategy_of(side);
        if side == Side::B && self.compared.is_some_and(|compared| compared.own_seed) {
            settings.film.seed = settings.film.seed.wrapping_add(OTHER_SEED);
        }
        settings
    }
}

/// Offset from the seed of A to that of B, where B has its own.
const OTHER_SEED: u64 = 1 << 32;

/// The name of a strategy.
pub fn strategy_name(strategy: &Strategy) -> &'static str {
    match strategy.preset() {
        _ if strategy.is_biased() => "ray marching",
        Some(preset) => preset.name(),
        None => "custom",
    }
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
    /// Whether a choice has changed, which leaves keys behind that belonged to another.
    chose: bool,
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
        self.document = Document { settings, tone, keep_size, compared: None };
        self.opened = self.document.clone();
        self.before = self.document.clone();
        self.history = History::default();
        self.name = None;
    }

    /// Puts `settings` in place of those of the document, as an edit, and has those `of_file` be
    /// what was opened.
    pub fn reload(&mut self, settings: Settings, of_file: &Settings) {
        self.document.settings = settings;
        self.opened.settings.clone_from(of_file);
        self.name_edit("reload of the scene");
    }

    /// The document as it was opened: what a double click on a setting goes back to.
    pub fn opened(&self) -> &Document {
        &self.opened
    }

    /// Starts a frame, before anything may change the document. While the pointer is held or the
    /// wheel moves on, changes belong to one gesture.
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
        self.chose = false;
    }

    /// The document as it was when this frame began.
    pub fn frame_start(&self) -> &Document {
        &self.before
    }

    /// Says that a choice such as a mode or a shape was made in this frame. Keys that belonged to
    /// another go.
    pub fn choose(&mut self) {
        self.chose = true;
    }

    /// Says what the change of this frame is called.
    pub fn name_edit(&mut self, name: impl Into<String>) {
        self.name = Some(name.into());
    }

    /// Ends a frame of the window: records what changed. Whether anything did. The frame of the
    /// scene is where one looks, not what one makes: going to another is no edit. A tracker that
    /// the edit leaves without what it needs gives way to the plain one.
    pub fn end_frame(&mut self) -> bool {
        let is_elsewhere = self.document.settings.time.frame != self.before.settings.time.frame;
        self.before.settings.time.frame = self.document.settings.time.frame;
        if self.document == self.before {
            return is_elsewhere;
        }
        let strategy = &mut self.document.settings.strategy;
        if strategy.tracker_refusal().is_some() {
            strategy.advanced.tracker = Tracker::default();
        }
        if self.chose
            && let Ok(tidied) = tidy(&self.document.settings)
        {
            self.document.settings = tidied;
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
        let frame = present.settings.time.frame;
        let (Ok(state) | Err(state)) = step(&mut self.history, present);
        self.document = state;
        self.document.settings.time.frame = frame;
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
    fn sides_keep_their_strategies_whichever_is_edited() {
        let full = Preset::Full.strategy();
        let baseline = Preset::Baseline.strategy();
        let mut document = Document::default();
        document.compare();
        let sides = |document: &Document| [Side::A, Side::B].map(|side| document.strategy_of(side));
        assert_eq!(sides(&document), [baseline, full]);
        assert_eq!(document.settings.strategy, full, "what was edited still is");
        document.switch_side();
        assert_eq!(sides(&document), [baseline, full]);
        assert_eq!(document.settings.strategy, baseline);
        document.settings.strategy.nee = true;
        assert!(document.strategy_of(Side::A).nee);
        document.swap_sides();
        assert_eq!(document.strategy_of(Side::A), full);
        assert!(document.settings.strategy.nee && document.strategy_of(Side::B).nee);
        document.copy_to_other_side();
        assert_eq!(document.strategy_of(Side::A), document.strategy_of(Side::B));
        document.compared.as_mut().unwrap().own_seed = true;
        let [a, b] = [Side::A, Side::B].map(|side| document.settings_of(side).film.seed);
        assert_ne!(a, b);
    }

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
