//! What is where: bars, the panel column, the picture with what comes and goes at its edges.

use std::path::PathBuf;

use egui::{Context, Frame, Margin, Rect, Ui};
use glam::UVec2;

use super::App;
use crate::app::command::Command;
use crate::app::diagnostics::show_legends;
use crate::app::jobs::dialogs::typed;
use crate::app::panels::{self, Panel};
use crate::app::picture::display::Look;
use crate::app::picture::viewport::Shown;
use crate::app::shell::bars;
use crate::app::shell::bars::{Dropped, Typed};
use crate::app::shell::palette;
use crate::app::shell::preferences::Preferences;
use crate::app::shell::start::StartChoice;
use crate::app::ui::theme;
use crate::app::ui::theme::{color, space};
use crate::render::Picture;

impl App {
    /// Shows everything and gathers the commands that it is asked for.
    pub(super) fn layout(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let mark = if self.has_unsaved_changes() { "* " } else { "" };
        let title = format!("{mark}{}", self.title());
        let plain = self.panel_frame();
        let grids = self.engine.grids().clone();
        let edited = self.second_side.edited(&self.engine);
        let mut reopened = None;
        let bounds = self.subject_bounds();
        let mut panel = Panel {
            editor: &mut self.editor,
            grids: &grids,
            notes: &self.notes,
            bounds,
            selected_light: &mut self.gizmo.selected,
            guided_flights: edited.picture().and_then(|picture| picture.stats.guided_flights),
            second_side: &self.second_side,
            turns: self.second_side.turns(&self.engine),
            reference: &mut self.reference,
            wanted: &mut self.diagnostics.wanted,
            recent: &self.preferences.recent,
            reopened: &mut reopened,
            commands,
        };
        if !self.full_screen {
            let bar = plain.inner_margin(Margin::symmetric(8, 3));
            egui::Panel::top("menu").frame(bar).show(ui, |ui| {
                crate::app::shell::menu::show(ui, &mut panel, &title);
            });
            let bar = plain.inner_margin(Margin::symmetric(8, 0));
            egui::Panel::bottom("status").exact_size(space::STATUS).frame(bar).show(ui, |ui| {
                crate::app::shell::status::show(
                    ui,
                    &mut panel,
                    edited,
                    &self.viewport,
                    &self.snapshots,
                );
            });
        }
        if !self.folded && !self.full_screen {
            let film = self.viewport.film_size();
            panels::column::show(ui, &mut panel, plain, (film, self.largest), &self.sections);
        }
        let area = egui::CentralPanel::no_frame().show(ui, |ui| self.picture_area(ui)).inner;
        crate::app::shell::help::show(ui.ctx(), &mut self.help);
        self.palette_window(ui, commands);
        if let Some(path) = reopened {
            self.open_unless_lost(&path);
        }
        self.sweep_window(ui.ctx(), area, commands);
    }

    /// What fixed panels lie on. A window that is cleared to their color spares the painting,
    /// which a software driver feels.
    fn panel_frame(&self) -> Frame {
        if self.cleared { Frame::new() } else { Frame::new().fill(color::PANEL) }
    }

    /// The picture with the bars that come and go at its edges. The film takes the whole area, so
    /// that a bar never restarts the render. What the bars leave of it.
    fn picture_area(&mut self, ui: &mut Ui) -> Rect {
        let area = ui.available_size() * ui.pixels_per_point();
        let area = UVec2::new(area.x.round() as u32, area.y.round() as u32);
        if let Some(wait) = self.viewport.resize(area, self.largest) {
            ui.ctx().request_repaint_after(wait);
        }
        if !self.full_screen {
            self.start_row(ui);
            self.strip_row(ui);
        }
        self.path_bar_row(ui);
        drop_row(ui);
        self.dropped_row(ui);
        self.progress_row(ui);
        self.unsaved_row(ui);
        self.sweep_row(ui);
        if !self.full_screen {
            self.measure_rows(ui);
        }
        if !self.notices.list().is_empty() {
            egui::Panel::bottom("notices")
                .frame(theme::panel_frame())
                .show(ui, |ui| self.notices.show(ui));
        }
        let shown = self.shown(ui.ctx());
        let is_live = self.snapshots.picture().is_none() || self.versus.is_some();
        let is_plain = self.map().is_none();
        let legend = self.legend(&shown);
        egui::CentralPanel::no_frame()
            .show(ui, |ui| {
                let rect = ui.available_rect_before_wrap();
                let views = self.viewport.show(ui, &mut self.editor, &shown, &mut self.region);
                let first = views.first().copied();
                // What is drawn over the picture is about the live one.
                match (first, legend) {
                    (Some(view), legend) if is_live => {
                        self.diagnostics.show(ui, view, &self.editor.document.settings, legend);
                    }
                    (Some(view), Some(legend)) => show_legends(ui, view.rect, &[legend]),
                    _ => {}
                }
                views.iter().for_each(|view| self.region.paint(ui, view));
                if is_live {
                    self.compare_marks(ui, rect);
                }
                let clicked = first.is_some_and(|view| view.clicked.is_some());
                if clicked && !self.diagnostics.wanted.ray && !self.region.remove() {
                    self.gizmo.selected = None;
                }
                if let Some(view) = first.filter(|_| is_live && is_plain && !self.full_screen) {
                    let pivot = self.subject_bounds().center();
                    self.gizmo.show(ui, view, &mut self.editor, pivot);
                }
                rect
            })
            .inner
    }

    /// What the picture area shows.
    pub(super) fn shown(&self, ctx: &Context) -> Shown {
        let tone = self.editor.document.tone;
        let look = Look::Picture(tone);
        let map = self.map();
        if self.versus.is_none()
            && let Some(stored) = self.snapshots.picture()
        {
            return match map {
                Some(map) => Shown::One(map.picture.clone(), map.look),
                None => Shown::One(stored.clone(), look),
            };
        }
        let Some(picture) = self.engine.picture() else { return Shown::Nothing };
        let layer = |pictures: &[&Picture]| self.diagnostics.look(pictures, tone).unwrap_or(look);
        let pictures = self.second_side.pictures(&self.engine);
        if let Some((active, pictures)) = self.active_side().zip(pictures) {
            let look = layer(&pictures.each_ref().map(|picture| &**picture));
            return self.second_side.shown(ctx, pictures, (look, active), map);
        }
        match map.filter(|_| !self.second_side.is_on()) {
            Some(map) => Shown::One(map.picture.clone(), map.look),
            None => Shown::One(picture.clone(), layer(&[picture])),
        }
    }

    /// Asks what a dropped picture is for.
    fn dropped_row(&mut self, ui: &mut Ui) {
        let Some(path) = self.dropped.clone() else { return };
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let row = egui::Panel::bottom("dropped").frame(theme::panel_frame());
        let Some(choice) = row.show(ui, |ui| bars::dropped(ui, &name)).inner else { return };
        self.dropped = None;
        match choice {
            Dropped::Open => self.open_unless_lost(&path.to_string_lossy()),
            Dropped::Reference => self.load_reference(&ui.ctx().clone(), path),
            Dropped::Cancelled => {}
        }
    }

    /// What to begin with, where it is wanted.
    fn start_row(&mut self, ui: &mut Ui) {
        let Some(start) = &mut self.start else { return };
        let row = egui::Panel::bottom("start").frame(theme::panel_frame());
        let Preferences { recent, start: again, .. } = &mut self.preferences;
        match row.show(ui, |ui| start.show(ui, recent, again)).inner {
            Some(StartChoice::Open(source)) => self.open_unless_lost(&source),
            Some(StartChoice::Command(command)) => self.execute(&ui.ctx().clone(), command),
            Some(StartChoice::Close) => self.start = None,
            None => {}
        }
    }

    fn palette_window(&mut self, ui: &Ui, commands: &mut Vec<Command>) {
        let Some(palette) = &mut self.palette else { return };
        match palette.show(ui.ctx()) {
            palette::PaletteChoice::Pending => return,
            palette::PaletteChoice::Done(command) => commands.push(command),
            palette::PaletteChoice::Left => {}
        }
        self.palette = None;
    }

    fn path_bar_row(&mut self, ui: &mut Ui) {
        let Some(bar) = &mut self.path_bar else { return };
        let purpose = bar.purpose;
        let frame = theme::panel_frame();
        let typing = egui::Panel::top("path").frame(frame).show(ui, |ui| bar.show(ui)).inner;
        match typing {
            Typed::Pending => {}
            Typed::Cancelled => self.path_bar = None,
            Typed::Done(text) => {
                self.path_bar = None;
                self.take_path(ui.ctx(), purpose, PathBuf::from(typed(&text)));
            }
        }
    }

    fn progress_row(&mut self, ui: &mut Ui) {
        let Some(fraction) = self.engine.progress() else { return };
        let what = match self.engine.opening() {
            Some(source) => format!("Loading {}", self.name_of(source.to_owned())),
            None => "Building the scene".to_owned(),
        };
        let frame = theme::panel_frame();
        let row = egui::Panel::bottom("progress").frame(frame);
        let help = "Stop loading and keep the current scene.";
        if row.show(ui, |ui| bars::progress(ui, &what, fraction, help)).inner {
            self.engine.cancel();
        }
    }
}

/// Says what a file that hovers above the window would do.
fn drop_row(ui: &mut Ui) {
    let hovered = ui.input(|input| input.raw.hovered_files.last().cloned());
    let Some(path) = hovered.and_then(|file| file.path) else { return };
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let frame = theme::panel_frame();
    egui::Panel::bottom("drop").frame(frame).show(ui, |ui| bars::drop_hint(ui, &name));
}
