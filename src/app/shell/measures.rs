//! Figures, region and reference of the picture, as the window shows them.

use std::path::PathBuf;
use std::sync::Arc;

use egui::{Context, Ui};

use super::app::App;
use crate::app::compare::reference::ReferenceOrigin;
use crate::app::compare::rows;
use crate::app::compare::rows::Asked;
use crate::app::jobs::dialogs::Purpose;
use crate::app::ui::words::samples;
use crate::render::Picture;

impl App {
    /// Pictures that the figures are of: those of A and B, or the one in the viewport.
    pub(super) fn looked_at(&self) -> Vec<Arc<Picture>> {
        match self.compare.second_side.pictures(&self.live_render) {
            Some(pictures) => pictures.to_vec(),
            None => self.shown_picture().cloned().into_iter().collect(),
        }
    }

    /// Brings figures, errors and maps in line with what is looked at.
    pub(super) fn update_measures(&mut self, ctx: &Context) {
        if let Err(error) = self.compare.reference.poll() {
            self.notices.failed(format!("The reference could not be used. {error}"));
        }
        let pictures = self.looked_at();
        let compare = &mut self.compare;
        let has_region = !pictures.is_empty() && compare.region.is_set();
        self.live_render.set_shows_variance(compare.second_side.is_on() || has_region);
        let tone = self.editor.document.tone;
        compare.update(ctx, pictures, tone, self.snapshots.picture().is_some());
    }

    /// Shows the rows of A and B, the region and the reference.
    pub(super) fn measure_rows(&mut self, ui: &mut Ui) {
        let (pictures, document) = (self.looked_at(), &self.editor.document);
        match rows::show(ui, &mut self.compare, document, &pictures, self.live_render.picture()) {
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

    /// Takes a reference from there.
    pub(super) fn take_reference(&mut self, ctx: &Context, origin: ReferenceOrigin) {
        if let Err(error) = self.compare.reference.load(ctx, origin) {
            self.notices.failed(error.to_string());
        }
    }

    /// Makes the picture shown the reference: a snapshot, or the live one of the edited side.
    pub(super) fn take_picture(&mut self, ctx: &Context) {
        let snapshot = self.snapshots.strip.shown_item();
        let snapshot = snapshot.map(|item| (item.record.name.clone(), self.snapshots.file(item)));
        let live_render = self.compare.second_side.edited(&self.live_render);
        let origin = match (snapshot, live_render.rendered(), live_render.picture()) {
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
        self.compare.second_side.layout =
            self.compare.second_side.layout.next(&self.compare.layouts());
    }

    /// Renders the region only, or all pixels again. Without a region the next drag draws one.
    pub(super) fn toggle_region_only(&mut self) {
        self.compare.region.is_alone = !self.compare.region.is_alone;
        if !self.compare.region.is_set() {
            self.compare.region.arm();
            self.compare.region.is_alone = true;
        }
    }

    /// Asks where to save the comparison, if there is one.
    pub(super) fn ask_to_save_comparison(&mut self, ctx: &Context) {
        if self.compare.second_side.is_on() || self.compare.reference.loaded().is_some() {
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
