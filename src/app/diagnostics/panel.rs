//! The section of diagnostics: cells over the picture, the step map, the ray inspector, and how the
//! time is spent.

use egui::Ui;

use super::Wanted;
use super::cells::CellValue;
use super::spending;
use crate::app::ui::sections::folded_section;
use crate::app::ui::theme::space;
use crate::app::ui::widgets::{explain, row_label, segments};
use crate::render::Layer;
use crate::transport::spending::Spending;

const CELLS: [(Option<CellValue>, &str, &str); 4] = [
    (None, "Off", "Show only the picture."),
    (
        Some(CellValue::Majorant),
        "Majorants",
        "The majorant of each cell: its largest extinction, and so the number of tracking steps \
         per unit length without the boost.",
    ),
    (
        Some(CellValue::Energy),
        "Energy",
        "The power that each cell emits: how often fire as a light samples it.",
    ),
    (
        Some(CellValue::Probes),
        "Probes",
        "The light that each probe estimates to be scattered towards the camera: where along a ray \
         paths are guided to scatter.",
    ),
];

/// Shows the section.
pub fn show(ui: &mut Ui, wanted: &mut Wanted, spending: Option<&Spending>) {
    folded_section(ui, "Diagnostics", |ui| {
        let choices = CELLS.map(|(_, name, help)| (name, help));
        let chosen = CELLS.iter().position(|(cells, ..)| *cells == wanted.cells);
        let help = "Draw the cells of the volumes, or the light probes, over the picture.";
        row_label(ui, "Cells", help);
        let clicked = ui.name_inputs("Cells", |ui| segments(ui, &choices, chosen));
        if let Some((cells, ..)) = clicked.and_then(|index| CELLS.get(index)) {
            wanted.cells = *cells;
        }
        ui.add_space(space::TIGHT);
        let help = "Tracking steps (real and null collisions) per sample of each pixel. An EXR has \
                    them as the channel steps.";
        let mut steps = wanted.layer == Some(Layer::Steps);
        if ui.checkbox(&mut steps, "Map of tracking steps").on_hover_text(help).changed() {
            wanted.layer = steps.then_some(Layer::Steps);
        }
        explain(ui, "Show the cost of each pixel in place of the picture.");
        ui.add_space(space::TIGHT);
        let help = "Plot extinction, emission and transmittance along the ray of a pixel, the pdfs \
                    of scattering there and their MIS weights.";
        ui.checkbox(&mut wanted.ray, "Inspect a ray").on_hover_text(help);
        explain(ui, "Click a pixel of the picture to plot its ray.");
        if let Some(spending) = spending {
            spending::show(ui, spending);
        }
    });
}
