//! What is shown to understand a render: cells drawn over the picture, and maps in its place. None
//! of it belongs to the scene, the strategy or the record of edits.

mod cells;
mod legend;
mod overlay;
mod plots;
mod ramp;
mod ray;

use egui::{Context, Rect, Ui};
use glam::UVec2;

pub use ramp::{STOPS, Scale, color as ramp_color, stops};

use super::engine::Engine;
use super::viewport::View;
use crate::render::Picture;
use crate::scene::{self, Settings};
use cells::{Gathering, Source};
pub use legend::Legend;
use ray::Inspector;

/// What the cells drawn over the picture are colored by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellValue {
    /// The local majorant: the largest extinction in the cell, 1/length.
    Majorant,
    /// The power the cell emits, radiance × length².
    Energy,
    /// What each probe thinks is scattered towards the camera, radiance/length.
    Probes,
}

/// What the user asked to see.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// The cells over the picture.
    pub cells: Option<CellValue>,
    /// Whether tracking steps take the place of the picture.
    pub steps: bool,
    /// Whether a click on the picture picks a pixel whose ray is looked into.
    pub ray: bool,
}

/// What the user asked to see, and what is there to show it.
#[derive(Default)]
pub struct Diagnostics {
    /// What the user asked to see.
    pub wanted: Wanted,
    gathering: Gathering,
    inspector: Inspector,
}

impl Diagnostics {
    /// Brings session and cells in line with what is wanted. Called once a frame.
    pub fn update(&mut self, ctx: &Context, engine: &mut Engine) {
        engine.set_shows_steps(self.wanted.steps);
        let scene = engine.built().map(|built| built.scene.clone());
        let cells = self.wanted.cells.zip(scene.clone()).map(|(value, scene)| {
            let probes = if value == CellValue::Probes { engine.probes() } else { None };
            Source { value, scene, probes }
        });
        let wake = ctx.clone();
        self.gathering.update(cells, move || wake.request_repaint());
        self.inspector.update(ctx, self.wanted.ray, engine);
    }

    /// The scale of the steps of `picture` where they take its place.
    pub fn step_scale(&self, picture: &Picture) -> Option<Scale> {
        let range = picture.steps.range.filter(|_| self.wanted.steps)?;
        Some(Scale::rounded(range))
    }

    /// Draws over the picture that lies in `view`, the legends in a corner, `map` that of a map in
    /// its place, and what lies along the ray of a pixel that was picked.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        view: View,
        picture: &Picture,
        settings: &Settings,
        map: Option<Legend>,
    ) {
        let mut legends: Vec<Legend> = map.into_iter().collect();
        if let Some(scale) = self.step_scale(picture) {
            legends.push(Legend::of_steps(scale));
        }
        if let Some((value, cells)) = self.gathering.cells(self.wanted.cells) {
            if let (Some(scale), Ok(camera)) = (cells.scale(), scene::camera(settings)) {
                overlay::paint(ui, view, &camera, cells, scale);
            }
            legends.push(Legend::of_cells(value, cells));
        }
        legend::show(ui, view.rect, &legends);
        if self.wanted.ray {
            self.wanted.ray = self.inspector.show(ui, &view);
        }
    }
}

/// Where a picture position, in its pixels, lies in the window.
pub(super) fn to_window(view: &View, at: glam::Vec2) -> egui::Pos2 {
    let at = (view.placement.corner + at * view.placement.scale) / view.factor;
    view.rect.min + egui::vec2(at.x, at.y)
}

/// The part of the window that the picture covers.
fn picture_rect(view: &View, size: UVec2) -> Rect {
    let corners = [glam::Vec2::ZERO, size.as_vec2()].map(|corner| to_window(view, corner));
    Rect::from_min_max(corners[0], corners[1]).intersect(view.rect)
}
