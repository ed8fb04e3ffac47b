//! The time line in the window: its row, its commands, and the pictures that it keeps and shows.

use std::sync::Arc;
use std::time::Instant;

use egui::{Context, Ui};

use super::app::App;
use super::export::SavedView;
use super::save::Content;
use crate::app::command::Command;
use crate::app::compare::second_side::CompareLayout;
use crate::app::jobs::dialogs::Purpose;
use crate::app::jobs::live_render::LiveRender;
use crate::app::picture::look::Look;
use crate::app::picture::viewport::Shown;
use crate::app::time_line::Turn;
use crate::app::time_line::bar::{self, TimeBar};
use crate::app::time_line::flipbook::{FramePictures, Take};
use crate::app::ui::theme;
use crate::render::Picture;
use crate::scene::Settings;

impl App {
    /// Keeps what was rendered, and goes on with what is played.
    pub(super) fn update_time_line(&mut self, ctx: &Context) {
        let Some(size) = self.film_size() else { return };
        let document = &self.editor.document;
        let take = Take::new(document, size, self.diagnostics.wanted.layer);
        self.time_line.update(&document.settings, &take);
        if self.time_line.range().is_none() {
            return;
        }
        let time = document.settings.time;
        let done = self.done_pictures().map(|pictures| {
            self.time_line.keep(time.whole_frame(), pictures);
            time.whole_frame()
        });
        match self.time_line.turn(Instant::now(), time.fps, done) {
            Some(Turn::Wait(wait)) => ctx.request_repaint_after(wait),
            Some(Turn::GoTo(frame)) => self.editor.document.settings.time.frame = f64::from(frame),
            None => {}
        }
    }

    /// The live pictures of the scene's frame, once each has the samples that the flipbook asks
    /// for.
    fn done_pictures(&self) -> Option<FramePictures> {
        let document = &self.editor.document;
        if self.compare.second_side.stored.is_some() {
            return None;
        }
        let is_done = |render: &LiveRender, settings: &Settings| {
            let is_enough = |picture: &Arc<Picture>| {
                picture.fewest_samples >= self.time_line.samples || picture.stats.finished
            };
            let is_current = render.is_current() && !render.is_building();
            is_current && render.renders(settings) && render.picture().is_some_and(is_enough)
        };
        let Some(compared) = document.compared else {
            let is_done = is_done(&self.live_render, &document.settings);
            return self.live_render.picture().filter(|_| is_done).map(|one| vec![one.clone()]);
        };
        let second_side = &self.compare.second_side;
        let other = second_side.second_render()?;
        let are_done = is_done(&self.live_render, &document.settings_of(compared.main))
            && is_done(other, &document.settings_of(compared.main.other()));
        let pictures = second_side.pictures(&self.live_render).filter(|_| are_done)?;
        Some(pictures.to_vec())
    }

    /// The pictures of the flipbook that are shown in place of the live ones: those of a frame that
    /// plays, or of the scene's frame until the live picture is as good.
    pub(super) fn flipbook_shown(&self, ctx: &Context) -> Option<Shown> {
        let document = &self.editor.document;
        self.time_line.range()?;
        let frame = self.time_line.shown(document.settings.time.whole_frame());
        let pictures = self.time_line.flipbook.get(frame)?;
        if !self.time_line.is_passing() && self.done_pictures().is_some() {
            return None;
        }
        self.frame_shown(ctx, pictures)
    }

    /// The view of the pictures of a frame; `None` for maps, which are made of live ones only.
    fn frame_shown(&self, ctx: &Context, pictures: &[Arc<Picture>]) -> Option<Shown> {
        let document = &self.editor.document;
        let tone = document.tone;
        let second_side = &self.compare.second_side;
        match pictures {
            [picture] if document.compared.is_none() => {
                let look = self.diagnostics.look(&[picture], tone);
                Some(Shown::One(picture.clone(), look.unwrap_or(Look::Picture(tone))))
            }
            [a, b] if matches!(second_side.layout, CompareLayout::Wipe | CompareLayout::Beside) => {
                let look = self.diagnostics.look(&[a, b], tone);
                let active = self.compare.active_side(document)?;
                let look = (look.unwrap_or(Look::Picture(tone)), active);
                Some(second_side.shown(ctx, [a.clone(), b.clone()], look, None))
            }
            _ => None,
        }
    }

    /// Asks for a name for the frames of the flipbook, if there are any.
    pub(super) fn ask_to_save_flipbook(&mut self, ctx: &Context) {
        match self.time_line.flipbook.len() {
            0 => self.notices.done("The flipbook is empty. Play a sequence to fill it."),
            _ => self.ask(ctx, Purpose::SaveFlipbook),
        }
    }

    /// The frames of the flipbook as they are shown; `None` where it is empty.
    pub(super) fn flipbook_content(&self, ctx: &Context) -> Option<Content> {
        let frames = self.time_line.flipbook.frames().filter_map(|(frame, pictures)| {
            let shown = self.frame_shown(ctx, pictures)?;
            let (names, legend) = (self.names_of(&shown), self.legend(&shown));
            let (words, tables) = (Vec::new(), Vec::new());
            Some((frame, SavedView { shown, names, legend, area: None, words, tables }))
        });
        Some(frames.collect::<Vec<_>>()).filter(|frames| !frames.is_empty()).map(Content::Frames)
    }

    /// The row of the time line, where the scene has one.
    pub(super) fn time_row(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        if self.time_line.range().is_none() {
            return;
        }
        let gaps = self.live_render.built().map_or_else(Vec::new, |built| {
            let is_here = built.settings.time.frame == self.editor.document.settings.time.frame;
            built.gaps.iter().filter(|_| is_here).map(|gap| gap.to_string()).collect()
        });
        let cache = self.live_render.cache();
        let volumes = [cache.bytes(), cache.room()];
        let time = &mut self.editor.document.settings.time;
        let mut bar = TimeBar {
            time_line: &mut self.time_line,
            frame: &mut time.frame,
            fps: &mut time.fps,
            volumes,
            gaps,
            commands,
        };
        let row = egui::Panel::bottom("time line").frame(theme::panel_frame());
        if row.show(ui, |ui| bar::show(ui, &mut bar)).inner {
            self.editor.name_edit("frames per second");
        }
    }

    /// Plays the frames, or stops where they are.
    pub(super) fn play_or_stop(&mut self) {
        let frame = self.editor.document.settings.time.whole_frame();
        if self.time_line.range().is_none() {
            self.say_that_nothing_moves();
        } else if self.time_line.is_playing() {
            let shown = self.time_line.stop();
            self.editor.document.settings.time.frame = f64::from(shown.unwrap_or(frame));
        } else {
            self.time_line.play(frame);
        }
    }

    /// Goes so many frames on, around the ends.
    pub(super) fn step_frame(&mut self, steps: i32) {
        let frame = self.editor.document.settings.time.whole_frame();
        let from = self.time_line.shown(frame);
        match self.time_line.step(from, steps) {
            Some(frame) => {
                self.time_line.stop();
                self.editor.document.settings.time.frame = f64::from(frame);
            }
            None => self.say_that_nothing_moves(),
        }
    }

    fn say_that_nothing_moves(&mut self) {
        self.notices.done(
            "This scene has one frame. A numbered set of volumes (fire_0001.vdb, …) or its folder \
             opens as a sequence.",
        );
    }
}
