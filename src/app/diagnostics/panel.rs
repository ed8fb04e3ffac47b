//! The panel of diagnostics.

use egui::Ui;

use super::Wanted;
use super::cells::CellValue;
use crate::app::ui::sections::folded_section;
use crate::app::ui::theme::space;
use crate::app::ui::widgets::{explain, row_label, segments};
use crate::render::Layer;

const CELLS: [(Option<CellValue>, &str, &str); 4] = [
    (None, "Off", "Only the picture."),
    (
        Some(CellValue::Majorant),
        "Majorants",
        "The largest extinction in each cell: how many steps per length a ray takes there at most, \
         the boost apart. Tight where cells follow the smoke.",
    ),
    (
        Some(CellValue::Energy),
        "Energy",
        "The power that each cell emits: how often fire as a light looks towards it.",
    ),
    (
        Some(CellValue::Probes),
        "Probes",
        "What each light probe thinks is scattered towards the camera: where on a ray scattering \
         pays.",
    ),
];

/// Shows the section.
pub fn show(ui: &mut Ui, wanted: &mut Wanted) {
    folded_section(ui, "Diagnostics", |ui| {
        let choices = CELLS.map(|(_, name, help)| (name, help));
        let chosen = CELLS.iter().position(|(cells, ..)| *cells == wanted.cells);
        let help = "Draws the cells that the volumes are divided into over the picture.";
        row_label(ui, "Cells", help);
        let clicked = ui.name_inputs("Cells", |ui| segments(ui, &choices, chosen));
        if let Some((cells, ..)) = clicked.and_then(|index| CELLS.get(index)) {
            wanted.cells = *cells;
        }
        ui.add_space(space::TIGHT);
        let help = "Steps through the volume, real and null, averaged over the samples of each \
                    pixel. Saved in an EXR as the channel steps.";
        let mut steps = wanted.layer == Some(Layer::Steps);
        if ui.checkbox(&mut steps, "Map of tracking steps").on_hover_text(help).changed() {
            wanted.layer = steps.then_some(Layer::Steps);
        }
        explain(ui, "Shows what each pixel costs in place of the picture.");
        ui.add_space(space::TIGHT);
        let help = "What lies along the ray of a pixel, and where on it the strategies scatter, \
                    with which MIS weights.";
        ui.checkbox(&mut wanted.ray, "Inspect a ray").on_hover_text(help);
        explain(ui, "Click a pixel of the picture to look into its ray.");
    });
}
