//! The state of comparison: the second side, the reference and the region.

use std::sync::Arc;

use egui::Context;
use glam::UVec2;

use super::maps::Map;
use super::measure::Measure;
use super::panel;
use super::reference::{MeasureView, MeasuredReference};
use super::second_side::{CompareLayout, SecondSide};
use crate::app::document::{Document, Side};
use crate::app::picture::region::PictureRegion;
use crate::image::tone::Tone;
use crate::render::Picture;

/// The state of comparison and measurement.
pub struct CompareState {
    /// The second side.
    pub second_side: SecondSide,
    /// The reference and the errors against it.
    pub reference: MeasuredReference,
    /// Region that the figures are of.
    pub region: PictureRegion,
    /// The side of the snapshot shown, while that is compared with the live picture.
    pub versus: Option<Side>,
}

impl CompareState {
    /// The side that is edited, where there are two.
    pub fn active_side(&self, document: &Document) -> Option<Side> {
        let versus = self.versus.map(Side::other);
        versus.or(document.compared.map(|compared| compared.active))
    }

    /// Whether A and B are biased.
    pub fn biased(&self, document: &Document) -> [bool; 2] {
        [Side::A, Side::B].map(|side| panel::is_biased(side, document, &self.second_side))
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
    pub fn map(&self) -> Option<&Map> {
        match self.error_view() {
            Some((measure, side)) => self.reference.map(measure, side),
            None => self.second_side.map(),
        }
    }

    /// The kinds of views that there are now.
    pub fn layouts(&self) -> Vec<CompareLayout> {
        CompareLayout::kinds(self.second_side.is_on(), self.reference.loaded().is_some())
    }

    /// The size of the snapshot that is compared, where the `live` picture has another.
    pub fn other_size(&self, live: Option<&Arc<Picture>>) -> Option<UVec2> {
        let size = self.second_side.stored.as_ref()?.picture.as_ref()?.size;
        live.is_some_and(|live| live.size != size).then_some(size)
    }

    /// Brings figures, errors and maps in line with `pictures`: those of A and B, or the one in the
    /// viewport, a snapshot if `is_snapshot`, shown with `tone`.
    pub fn update(
        &mut self,
        ctx: &Context,
        pictures: Vec<Arc<Picture>>,
        tone: Tone,
        is_snapshot: bool,
    ) {
        let area = pictures.first().and_then(|picture| self.region.area(picture.size));
        self.second_side.update_region_figures(ctx, pictures.clone(), area);
        let view = MeasureView {
            tone,
            main: self.second_side.main_side(),
            stored: self.versus,
            is_snapshot: !self.second_side.is_on() && is_snapshot,
        };
        self.reference.update(ctx, pictures, view);
        self.reference.update_map(ctx, self.error_view());
        if matches!(self.second_side.layout, CompareLayout::Error(..))
            && self.reference.loaded().is_none()
        {
            self.second_side.layout = CompareLayout::default();
        }
    }
}
