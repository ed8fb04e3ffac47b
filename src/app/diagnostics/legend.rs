//! What the colors mean, in a corner of the picture.

use egui::{Align, Frame, Label, Layout, Margin, Rect, RichText, Ui, UiBuilder, pos2, vec2};

use super::cells::Cells;
use super::{CellValue, Scale, overlay};
use crate::app::theme::{color, space};
use crate::app::widgets::significant;

/// Room that a legend takes.
const SIZE: egui::Vec2 = vec2(236.0, 82.0);
/// Height of the ramp.
const BAR: f32 = 8.0;
/// How much of the picture shows through.
const OPACITY: f32 = 0.85;

/// One ramp with its numbers.
pub struct Legend {
    title: &'static str,
    scale: Option<Scale>,
    note: String,
}

impl Legend {
    /// Of the map of tracking steps.
    pub fn of_steps(scale: Scale) -> Self {
        let note = "Black: no steps at all".to_owned();
        Self { title: "Tracking steps per sample", scale: Some(scale), note }
    }

    /// Of the cells over the picture.
    pub fn of_cells(value: CellValue, cells: &Cells) -> Self {
        let (title, none, what) = match value {
            CellValue::Majorant => ("Majorant, 1/length", "No volume here has borders.", "cell"),
            CellValue::Energy => ("Emitted power per cell", "No volume here emits light.", "cell"),
            CellValue::Probes => {
                ("Scattered light, radiance/length", "No probe here has light.", "probe")
            }
        };
        let (shown, total) = (cells.strongest.len(), cells.total);
        let note = match (shown, total) {
            (0, _) => none.to_owned(),
            (1, 1) => format!("One {what}"),
            _ if shown == total => format!("All {total} {what}s"),
            _ => format!("The strongest {shown} of {total} {what}s"),
        };
        Self { title, scale: cells.scale(), note }
    }
}

/// Shows the legends above one another in the lower left corner of `area`, as many as it has room
/// for.
pub fn show(ui: &mut Ui, area: Rect, legends: &[Legend]) {
    let margin = f32::from(space::PANEL);
    let mut bottom = area.bottom() - margin;
    for legend in legends {
        let rect = Rect::from_min_size(pos2(area.left() + margin, bottom - SIZE.y), SIZE);
        if !area.contains_rect(rect) {
            return;
        }
        let mut ui = ui.new_child(UiBuilder::new().max_rect(rect).layout(Layout::default()));
        ui.shrink_clip_rect(rect);
        let frame = Frame::new()
            .fill(color::PANEL.gamma_multiply(OPACITY))
            .corner_radius(space::RADIUS)
            .inner_margin(Margin::symmetric(space::PANEL, 8));
        frame.show(&mut ui, |ui| {
            ui.set_min_size(ui.available_size());
            contents(ui, legend);
        });
        bottom = rect.top() - space::ROW;
    }
}

fn contents(ui: &mut Ui, legend: &Legend) {
    ui.spacing_mut().item_spacing.y = space::TIGHT;
    ui.label(RichText::new(legend.title).color(color::TEXT_STRONG));
    if let Some(scale) = legend.scale {
        let (bar, _) =
            ui.allocate_exact_size(vec2(ui.available_width(), BAR), egui::Sense::empty());
        ui.painter().add(overlay::bar(bar));
        numbers(ui, scale);
    }
    ui.label(RichText::new(&legend.note).small().color(color::TEXT_DIM));
}

/// The ends of the scale and its middle.
fn numbers(ui: &mut Ui, scale: Scale) {
    let number = |value: f32| {
        let text = RichText::new(significant(f64::from(value))).small().color(color::TEXT);
        Label::new(text)
    };
    ui.columns(3, |columns| {
        columns[0].add(number(scale.low));
        columns[1].vertical_centered(|ui| ui.add(number(scale.middle())));
        columns[2].with_layout(Layout::right_to_left(Align::Min), |ui| {
            ui.add(number(scale.high));
        });
    });
}
