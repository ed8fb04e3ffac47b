//! The layout: bars, the panel column, the picture with the rows that come and go at its edges.

use std::path::PathBuf;

use egui::{Context, Frame, Margin, Rect, Ui};
use glam::UVec2;

use super::app::App;
use super::menu::MenuItems;
use super::status::StatusLine;
use super::{help, menu, status};
use crate::app::command::Command;
use crate::app::compare::marks;
use crate::app::diagnostics::show_legends;
use crate::app::jobs::dialogs::typed;
use crate::app::panels::{self, Panel};
use crate::app::picture::look::Look;
use crate::app::picture::viewport::Shown;
use crate::app::shell::bars;
use crate::app::shell::bars::{Dropped, Typed};
use crate::app::shell::palette;
use crate::app::shell::preferences::Preferences;
use crate::app::shell::start::StartChoice;
use crate::app::ui::theme;
use crate::app::ui::theme::space;
use crate::render::Picture;

impl App {
    /// Shows everything and gathers the commands that it is asked for.
    pub(super) fn layout(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let title = self.marked_title();
        let plain = self.chrome.panel_frame();
        let mut reopened = None;
        if !self.chrome.full_screen {
            self.menu_and_status(ui, (plain, &title), &mut reopened, commands);
        }
        if !self.chrome.folded && !self.chrome.full_screen {
            self.panel_column(ui, plain, commands);
        }
        let area =
            egui::CentralPanel::no_frame().show(ui, |ui| self.picture_area(ui, commands)).inner;
        help::show(ui.ctx(), &mut self.chrome.help);
        self.palette_window(ui, commands);
        if let Some(path) = reopened {
            self.open_or_ask(&path);
        }
        self.sweep_window(ui.ctx(), area, commands);
    }

    /// Shows the menu bar with the `title` and the status line, on `plain` ground.
    fn menu_and_status(
        &mut self,
        ui: &mut Ui,
        (plain, title): (Frame, &str),
        reopened: &mut Option<String>,
        commands: &mut Vec<Command>,
    ) {
        let (editor, recent) = (&self.editor, &self.preferences.recent);
        let mut items = MenuItems { editor, recent, reopened, commands };
        let bar = plain.inner_margin(Margin::symmetric(8, 3));
        egui::Panel::top("menu").frame(bar).show(ui, |ui| menu::show(ui, &mut items, title));
        let second_side = &self.compare.second_side;
        let mut line = StatusLine {
            editor: &mut self.editor,
            live_render: second_side.edited(&self.live_render),
            second_side,
            turns: second_side.turns(&self.live_render),
            viewport: &self.viewport,
            snapshots: &self.snapshots,
            layer: self.diagnostics.wanted.layer,
            commands,
        };
        let bar = plain.inner_margin(Margin::symmetric(8, 0));
        let bar = egui::Panel::bottom("status").exact_size(space::STATUS).frame(bar);
        bar.show(ui, |ui| status::show(ui, &mut line));
    }

    /// Shows the column of panels on `plain` ground.
    fn panel_column(&mut self, ui: &mut Ui, plain: Frame, commands: &mut Vec<Command>) {
        let edited = self.compare.second_side.edited(&self.live_render);
        let guided_flights = edited.picture().and_then(|picture| picture.stats.guided_flights);
        let spending = edited.picture().and_then(|picture| picture.stats.spending);
        let bounds = self.subject_bounds();
        let mut panel = Panel {
            editor: &mut self.editor,
            grids: self.live_render.grids(),
            notes: &self.opened.notes,
            frames: self.time_line.range(),
            bounds,
            selected_light: &mut self.gizmo.selected,
            guided_flights,
            spending,
            second_side: &self.compare.second_side,
            reference: &mut self.compare.reference,
            wanted: &mut self.diagnostics.wanted,
            commands,
        };
        let film = self.viewport.film_size();
        let sections = &self.chrome.sections;
        panels::column::show(ui, &mut panel, plain, (film, self.largest), sections);
    }

    /// The picture with the bars that come and go at its edges. The film takes the whole area, so
    /// that a bar never restarts the render. What the bars leave of it.
    fn picture_area(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) -> Rect {
        let area = ui.available_size() * ui.pixels_per_point();
        let area = UVec2::new(area.x.round() as u32, area.y.round() as u32);
        if let Some(wait) = self.viewport.resize(area, self.largest) {
            ui.ctx().request_repaint_after(wait);
        }
        self.rows(ui, commands);
        let shown = self.shown(ui.ctx());
        let is_live = self.snapshots.picture().is_none() || self.compare.versus.is_some();
        let is_plain = self.compare.map().is_none();
        let legend = self.legend(&shown);
        egui::CentralPanel::no_frame()
            .show(ui, |ui| {
                let rect = ui.available_rect_before_wrap();
                let views =
                    self.viewport.show(ui, &mut self.editor, &shown, &mut self.compare.region);
                let first = views.first().copied();
                // What is drawn over the picture is about the live one.
                match (first, legend) {
                    (Some(view), legend) if is_live => {
                        self.diagnostics.show(ui, view, &self.editor.document.settings, legend);
                    }
                    (Some(view), Some(legend)) => show_legends(ui, view.rect, &[legend]),
                    _ => {}
                }
                views.iter().for_each(|view| self.compare.region.paint(ui, view));
                if is_live {
                    marks::show(ui, rect, &mut self.compare, &self.editor.document);
                }
                if let Some(pixel) = first.and_then(|view| view.clicked) {
                    self.clicked(pixel);
                }
                if let Some(view) =
                    first.filter(|_| is_live && is_plain && !self.chrome.full_screen)
                {
                    let pivot = self.subject_bounds().center();
                    self.gizmo.show(ui, view, &mut self.editor, pivot);
                }
                rect
            })
            .inner
    }

    /// The rows that come and go below the picture.
    fn rows(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        if !self.chrome.full_screen {
            self.start_row(ui);
            self.strip_row(ui);
            self.time_row(ui, commands);
        }
        self.path_bar_row(ui);
        drop_row(ui);
        self.dropped_row(ui);
        self.progress_row(ui);
        self.unsaved_row(ui);
        self.changed_scene_row(ui);
        self.sweep_row(ui);
        if !self.chrome.full_screen {
            self.measure_rows(ui);
        }
        if !self.notices.list().is_empty() {
            egui::Panel::bottom("notices")
                .frame(theme::panel_frame())
                .show(ui, |ui| self.notices.show(ui));
        }
    }

    /// Takes a click on a pixel of the picture.
    fn clicked(&mut self, pixel: UVec2) {
        if self.viewport.picks_focus {
            self.focus_on(pixel);
        } else if !self.diagnostics.wanted.ray && !self.compare.region.remove() {
            self.gizmo.selected = None;
        }
    }

    /// The pictures that the picture area shows.
    pub(super) fn shown(&self, ctx: &Context) -> Shown {
        let tone = self.editor.document.tone;
        let look = Look::Picture(tone);
        let map = self.compare.map();
        if self.compare.versus.is_none()
            && let Some(snapshot) = self.snapshots.picture()
        {
            return match map {
                Some(map) => Shown::One(map.picture.clone(), map.look),
                None => Shown::One(snapshot.clone(), look),
            };
        }
        if let Some(shown) = self.flipbook_shown(ctx) {
            return shown;
        }
        let Some(picture) = self.live_render.picture() else { return Shown::Nothing };
        let layer = |pictures: &[&Picture]| self.diagnostics.look(pictures, tone).unwrap_or(look);
        let pictures = self.compare.second_side.pictures(&self.live_render);
        if let Some((active, pictures)) =
            self.compare.active_side(&self.editor.document).zip(pictures)
        {
            let look = layer(&pictures.each_ref().map(|picture| &**picture));
            return self.compare.second_side.shown(ctx, pictures, (look, active), map);
        }
        match map.filter(|_| !self.compare.second_side.is_on()) {
            Some(map) => Shown::One(map.picture.clone(), map.look),
            None => Shown::One(picture.clone(), layer(&[picture])),
        }
    }

    /// Asks what a dropped picture is for.
    fn dropped_row(&mut self, ui: &mut Ui) {
        let Some(path) = self.files.dropped.clone() else { return };
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let row = egui::Panel::bottom("dropped").frame(theme::panel_frame());
        let Some(choice) = row.show(ui, |ui| bars::dropped(ui, &name)).inner else { return };
        self.files.dropped = None;
        match choice {
            Dropped::Open => self.open_or_ask(&crate::files::name_of(&path)),
            Dropped::Reference => self.load_reference(&ui.ctx().clone(), path),
            Dropped::Environment => self.load_environment(&path),
            Dropped::Cancelled => {}
        }
    }

    /// Shows the start row, where it is wanted.
    fn start_row(&mut self, ui: &mut Ui) {
        let Some(start) = &mut self.chrome.start else { return };
        let row = egui::Panel::bottom("start").frame(theme::panel_frame());
        let Preferences { recent, start: again, .. } = &mut self.preferences;
        match row.show(ui, |ui| start.show(ui, recent, again)).inner {
            Some(StartChoice::Open(source)) => self.open_or_ask(&source),
            Some(StartChoice::Command(command)) => self.execute(&ui.ctx().clone(), command),
            Some(StartChoice::Close) => self.chrome.start = None,
            None => {}
        }
    }

    fn palette_window(&mut self, ui: &Ui, commands: &mut Vec<Command>) {
        let Some(palette) = &mut self.chrome.palette else { return };
        match palette.show(ui.ctx()) {
            palette::PaletteChoice::Pending => return,
            palette::PaletteChoice::Done(command) => commands.push(command),
            palette::PaletteChoice::Left => {}
        }
        self.chrome.palette = None;
    }

    fn path_bar_row(&mut self, ui: &mut Ui) {
        let Some(bar) = &mut self.files.path_bar else { return };
        let purpose = bar.purpose;
        let frame = theme::panel_frame();
        let typing = egui::Panel::top("path").frame(frame).show(ui, |ui| bar.show(ui)).inner;
        match typing {
            Typed::Pending => {}
            Typed::Cancelled => self.files.path_bar = None,
            Typed::Done(text) => {
                self.files.path_bar = None;
                self.take_path(ui.ctx(), purpose, PathBuf::from(typed(&text)));
            }
        }
    }

    fn progress_row(&mut self, ui: &mut Ui) {
        let Some(fraction) = self.live_render.progress() else { return };
        let what = match self.live_render.opening() {
            Some(source) => format!("Loading {}", self.name_of(source.to_owned())),
            None => "Building the scene".to_owned(),
        };
        let frame = theme::panel_frame();
        let row = egui::Panel::bottom("progress").frame(frame);
        let help = "Stop loading and keep the current scene.";
        if row.show(ui, |ui| bars::progress(ui, &what, fraction, help)).inner {
            self.live_render.cancel();
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
