//! Diagnostics of a render: cells over the picture, maps in its place, and the ray of a pixel. None
//! of it belongs to the scene, the strategy or the record of edits.
//!
//! - `cells`, `overlay`: the strongest cells of the volumes, gathered and drawn.
//! - `ray`, `curves`, `plots`: the ray of a pixel, and its curves.
//! - `legend`: the meaning of colors; `panel`: what is to be shown.
//! - `spending`: the time by kind of work.

mod cells;
mod curves;
mod legend;
mod overlay;
pub mod panel;
mod plots;
mod ray;
mod spending;

use egui::{Context, Ui};

use super::jobs::background::BackgroundPool;
use super::jobs::live_render::LiveRender;
use super::picture::look::Look;
use super::picture::view::View;
use crate::image::ramp::Scale;
use crate::image::tone::Tone;
use crate::render::{Layer, Picture};
use crate::scene::{self, Settings};
use cells::{CellSource, CellValue, Gathering};
pub use legend::{Legend, show as show_legends};
use ray::Inspector;

/// The diagnostics that the user asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// The cells over the picture.
    pub cells: Option<CellValue>,
    /// The layer that takes the place of the picture.
    pub layer: Option<Layer>,
    /// Whether a click on the picture picks a pixel whose ray is looked into.
    pub ray: bool,
}

/// The diagnostics asked for, and the data to show them.
pub struct Diagnostics {
    /// The diagnostics that the user asked for.
    pub wanted: Wanted,
    gathering: Gathering,
    inspector: Inspector,
}

impl Diagnostics {
    /// Diagnostics without anything wanted; `pool` will gather cells and compute profiles of rays.
    pub fn new(pool: &BackgroundPool) -> Self {
        let (gathering, inspector) = (Gathering::new(pool), Inspector::new(pool));
        Self { wanted: Wanted::default(), gathering, inspector }
    }

    /// Brings session and cells in line with what is wanted. Called once a frame.
    pub fn update(&mut self, ctx: &Context, live_render: &mut LiveRender) {
        live_render.set_layer(self.wanted.layer);
        let scene = live_render.built().map(|built| built.scene.clone());
        let cells = self.wanted.cells.zip(scene.clone()).map(|(value, scene)| {
            let probes = (value == CellValue::Probes).then(|| live_render.probes()).flatten();
            let probes = probes.map(|probes| probes.best().clone());
            CellSource { value, scene, probes }
        });
        let wake = ctx.clone();
        self.gathering.update(cells, move || wake.request_repaint());
        self.inspector.update(ctx, self.wanted.ray, live_render);
    }

    /// Look of the layer that is wanted in place of `pictures`, once it is there in all of them;
    /// light as `tone` says.
    pub fn look(&self, pictures: &[&Picture], tone: Tone) -> Option<Look> {
        let layer = self.wanted.layer?;
        if pictures.iter().any(|picture| picture.layer.layer != Some(layer)) {
            return None;
        }
        if layer.is_light() {
            return Some(Look::Light(tone));
        }
        let ranges = pictures.iter().filter_map(|picture| picture.layer.range);
        let range = ranges.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
        Some(Look::Numbers(Scale::rounded(range)))
    }

    /// Legend of `look`, where its colors are the numbers of the layer.
    pub fn legend(&self, look: Option<Look>) -> Option<Legend> {
        match look? {
            Look::Numbers(scale) => self.wanted.layer.map(|layer| Legend::of_layer(layer, scale)),
            _ => None,
        }
    }

    /// Draws over the picture that lies in `view`, the legends in a corner, `legend` that of what
    /// takes its place, and what lies along the ray of a pixel that was picked.
    pub fn show(&mut self, ui: &mut Ui, view: View, settings: &Settings, legend: Option<Legend>) {
        let mut legends: Vec<Legend> = legend.into_iter().collect();
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
