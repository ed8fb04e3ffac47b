//! What is measured of the picture: rows with how A and B, the rectangle and the reference are
//! looked at and what is known of them.

use std::path::PathBuf;
use std::sync::Arc;

use egui::{Context, Ui};
use glam::UVec2;

use super::App;
use crate::app::compare::maps::Map;
use crate::app::compare::panel;
use crate::app::compare::reference::{Measure, MeasureView, ReferenceOrigin};
use crate::app::compare::rows;
use crate::app::compare::rows::Asked;
use crate::app::compare::second_side::CompareLayout;
use crate::app::document::Side;
use crate::app::jobs::dialogs::Purpose;
use crate::app::shell::status::samples;
use crate::app::ui::theme;
use crate::render::Picture;

impl App {
    /// The pictures that figures are told of: those of A and B, or the one in the viewport.
    pub(super) fn looked_at(&self) -> Vec<Arc<Picture>> {
        match self.second_side.pictures(&self.engine) {
            Some(pictures) => pictures.to_vec(),
            None => self.shown_picture().cloned().into_iter().collect(),
        }
    }

    /// The error that is shown, where one is, and of which side, where there are two.
    fn error_view(&self) -> Option<(Measure, Option<Side>)> {
        match self.second_side.layout {
            CompareLayout::Error(measure, side) => {
                Some((measure, self.second_side.is_on().then_some(side)))
            }
            _ => None,
        }
    }

    /// The map in place of the picture, while one is there.
    pub(super) fn map(&self) -> Option<&Map> {
        match self.error_view() {
            Some((measure, side)) => self.reference.map(measure, side),
            None => self.second_side.map(),
        }
    }

    /// The kinds of views that there are now.
    pub(super) fn layouts(&self) -> Vec<CompareLayout> {
        CompareLayout::kinds(self.second_side.is_on(), self.reference.held().is_some())
    }

    /// Brings figures, errors and maps in line with what is looked at.
    pub(super) fn update_measures(&mut self, ctx: &Context) {
        if let Err(error) = self.reference.poll() {
            self.notices.failed(format!("The reference could not be used. {error}"));
        }
        let pictures = self.looked_at();
        let area = pictures.first().and_then(|picture| self.region.area(picture.size));
        self.engine.set_shows_variance(self.second_side.is_on() || area.is_some());
        self.second_side.update_part(ctx, pictures.clone(), area);
        let seen = MeasureView {
            tone: self.editor.document.tone,
            main: self.second_side.main_side(),
            stored: self.versus,
            is_snapshot: !self.second_side.is_on() && self.snapshots.picture().is_some(),
        };
        self.reference.update(ctx, pictures, seen);
        self.reference.update_map(ctx, self.error_view());
        if matches!(self.second_side.layout, CompareLayout::Error(..))
            && self.reference.held().is_none()
        {
            self.second_side.layout = CompareLayout::default();
        }
    }

    /// Shows how A and B, the rectangle and the reference are looked at and what is known of them.
    pub(super) fn measure_rows(&mut self, ui: &mut Ui) {
        let has_rectangle = self.region.is_armed() || self.region.is_set();
        let has_reference = self.reference.held().is_some() || self.reference.is_loading();
        if !(self.second_side.is_on() || has_rectangle || has_reference) {
            return;
        }
        let panel = egui::Panel::bottom("compare").frame(theme::panel_frame());
        let asked = panel.show(ui, |ui| {
            let view = self.view_row(ui);
            let Some(picture) = self.looked_at().into_iter().next() else { return view };
            if has_rectangle {
                let told = (self.second_side.part(), self.reference.errors(), self.biased());
                let region = &mut self.region;
                ui.horizontal_wrapped(|ui| {
                    rows::region(ui, region, picture.size, told);
                });
            }
            if !has_reference {
                return view;
            }
            let looked_at = (picture.size, &self.editor.document.settings);
            let row = |ui: &mut Ui| rows::reference(ui, &self.reference, looked_at);
            ui.horizontal_wrapped(row).inner.or(view)
        });
        match asked.inner {
            Some(Asked::Command(command)) => self.execute(&ui.ctx().clone(), command),
            Some(Asked::Size(size)) => {
                let document = &mut self.editor.document;
                document.settings.film.size = size.to_array();
                document.keep_size = true;
                self.editor.name_edit("render size");
            }
            None => {}
        }
    }

    /// How it is looked at where there is a choice, and what A and B say about each other.
    fn view_row(&mut self, ui: &mut Ui) -> Option<Asked> {
        let kinds = self.layouts();
        if kinds.len() < 2 {
            return None;
        }
        let of_two = self.second_side.is_on();
        let row = |ui: &mut Ui| {
            panel::layouts(ui, &mut self.second_side.layout, (&kinds, of_two));
            if !of_two {
                return None;
            }
            ui.separator();
            match self.other_size() {
                Some(size) => rows::other_size(ui, size),
                None => {
                    panel::verdict(ui, self.second_side.comparison(), self.biased());
                    None
                }
            }
        };
        ui.horizontal_wrapped(row).inner
    }

    /// The size of the snapshot that is compared, where the live picture has another.
    fn other_size(&self) -> Option<UVec2> {
        let size = self.second_side.stored.as_ref()?.picture.as_ref()?.size;
        self.engine.picture().is_some_and(|live| live.size != size).then_some(size)
    }

    /// Which sides are biased.
    pub(super) fn biased(&self) -> [bool; 2] {
        let document = &self.editor.document;
        [Side::A, Side::B].map(|side| panel::is_biased(side, document, &self.second_side))
    }

    /// Takes a reference from there.
    pub(super) fn take_reference(&mut self, ctx: &Context, origin: ReferenceOrigin) {
        if let Err(error) = self.reference.load(ctx, origin) {
            self.notices.failed(error.to_string());
        }
    }

    /// Makes the picture shown the reference: a snapshot, or the live one of the edited side.
    pub(super) fn take_picture(&mut self, ctx: &Context) {
        let stored = self.snapshots.strip.shown_item();
        let stored = stored.map(|item| (item.record.name.clone(), self.snapshots.file(item)));
        let engine = self.second_side.edited(&self.engine);
        let origin = match (stored, engine.rendered(), engine.picture()) {
            (Some((name, Some(file))), ..) => {
                ReferenceOrigin::File(format!("snapshot {name}"), file)
            }
            (None, Some(settings), Some(picture)) if picture.complete => {
                let spp = samples(picture.stats.samples_per_pixel);
                let name = format!("the picture at {spp} spp");
                ReferenceOrigin::Picture(name, picture.clone(), Box::new(settings.clone()))
            }
            _ => {
                self.notices.failed(
                    "There is no picture to use as a reference yet: every pixel needs a sample.",
                );
                return;
            }
        };
        self.take_reference(ctx, origin);
    }

    /// Switches to the next view that there is.
    pub(super) fn next_layout(&mut self) {
        self.second_side.layout = self.second_side.layout.next(&self.layouts());
    }

    /// Gives the region all samples, or all pixels again. Without a region the next drag draws one.
    pub(super) fn give_region_all_samples(&mut self) {
        self.region.is_alone = !self.region.is_alone;
        if !self.region.is_set() {
            self.region.arm();
            self.region.is_alone = true;
        }
    }

    /// Asks where to save the comparison, if there is one.
    pub(super) fn ask_to_save_comparison(&mut self, ctx: &Context) {
        if self.second_side.is_on() || self.reference.held().is_some() {
            self.ask(ctx, Purpose::SaveComparison);
            return;
        }
        self.notices.failed(
            "Nothing is compared yet. Press C to compare two strategies, or Ctrl+Shift+S to save \
             the picture alone.",
        );
    }

    /// Loads a reference from a path.
    pub(super) fn load_reference(&mut self, ctx: &Context, path: PathBuf) {
        self.take_reference(ctx, ReferenceOrigin::file(path));
    }
}
