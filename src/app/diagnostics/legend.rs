//! The meaning of colors, in a corner of the picture.

use egui::{Align, Frame, Label, Layout, Margin, Rect, RichText, Ui, UiBuilder, pos2, vec2};

use super::cells::{CellValue, Cells};
use super::overlay;
use crate::app::compare::maps::{ColorKey, Difference, MapKind, Noise};
use crate::app::compare::measure::Measure;
use crate::app::document::Side;
use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::significant;
use crate::image::ramp::Scale;
use crate::image::tone::false_color;
use crate::render::Layer;

/// Room that a legend takes.
const SIZE: egui::Vec2 = vec2(236.0, 82.0);
/// Height of the ramp.
const BAR: f32 = 8.0;
/// Opacity of the background over the picture.
const OPACITY: f32 = 0.85;

/// A legend: a ramp with its numbers.
pub struct Legend {
    /// The quantity, with its unit.
    pub title: &'static str,
    /// Colors of the ramp, where there are any.
    pub colors: Option<ColorKey>,
    /// A remark below the numbers.
    pub note: String,
}

impl Legend {
    /// The legend of a layer of numbers.
    pub fn of_layer(layer: Layer, scale: Scale) -> Self {
        let (title, note) = match layer {
            Layer::Depth => ("Depth, length", "Black: nothing hit"),
            Layer::Noise => ("Noise (luminance)", "Black: none, or unknown"),
            Layer::Steps => ("Tracking steps per sample", "Black: no steps"),
            Layer::Samples => ("Samples", "Per pixel, so far"),
            other => (other.name(), ""),
        };
        Self { title, colors: Some(ColorKey::Ramp(scale)), note: note.to_owned() }
    }

    /// The legend of false color.
    pub fn of_stops() -> Self {
        let note = "Green: middle gray, with exposure".to_owned();
        Self { title: "Stops from middle gray", colors: Some(ColorKey::Stops), note }
    }

    /// The legend of a map of two pictures.
    pub fn of_map(kind: MapKind, colors: ColorKey) -> Self {
        let (title, note) = match kind {
            MapKind::Difference(Difference::Signed) => {
                ("B − A (luminance)", "Blue: B is darker, orange: B is brighter")
            }
            MapKind::Difference(Difference::Absolute) => {
                ("|B − A| (luminance)", "Black: no difference")
            }
            MapKind::Difference(Difference::Relative) => {
                ("|B − A|, relative (luminance)", "Black: no difference")
            }
            MapKind::Noise(Noise::Of(Side::A)) => ("Noise of A (luminance)", "Black: unknown"),
            MapKind::Noise(Noise::Of(Side::B)) => ("Noise of B (luminance)", "Black: unknown"),
            MapKind::Noise(Noise::Ratio) => {
                ("Noise of B / noise of A", "Blue: B is less noisy, orange: B is noisier")
            }
            MapKind::Error(measure, side) => (
                error_title(measure, side),
                match measure {
                    Measure::RelMse => "Black: no error. The mean is relMSE",
                    Measure::Flip => "0: invisible, 1: like green instead of blue",
                },
            ),
        };
        Self { title, colors: Some(colors), note: note.to_owned() }
    }

    /// The legend of the cells over the picture.
    pub fn of_cells(value: CellValue, cells: &Cells) -> Self {
        let (title, none, what) = match value {
            CellValue::Majorant => ("Majorant, 1/length", "No volume has cells.", "cell"),
            CellValue::Energy => ("Emitted power per cell", "No volume emits light.", "cell"),
            CellValue::Probes => {
                ("Scattered light, radiance/length", "No probe receives light.", "probe")
            }
        };
        let (shown, total) = (cells.strongest.len(), cells.total);
        let note = match (shown, total) {
            (0, _) => none.to_owned(),
            (1, 1) => format!("One {what}"),
            _ if shown == total => format!("All {total} {what}s"),
            _ => format!("The strongest {shown} of {total} {what}s"),
        };
        Self { title, colors: cells.scale().map(ColorKey::Ramp), note }
    }
}

fn error_title(measure: Measure, side: Option<Side>) -> &'static str {
    match (measure, side) {
        (Measure::RelMse, None) => "Relative squared error",
        (Measure::RelMse, Some(Side::A)) => "Relative squared error of A",
        (Measure::RelMse, Some(Side::B)) => "Relative squared error of B",
        (Measure::Flip, None) => "FLIP error",
        (Measure::Flip, Some(Side::A)) => "FLIP error of A",
        (Measure::Flip, Some(Side::B)) => "FLIP error of B",
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
    if let Some(colors) = legend.colors {
        let (bar, _) =
            ui.allocate_exact_size(vec2(ui.available_width(), BAR), egui::Sense::empty());
        if colors == ColorKey::Stops {
            return stops(ui, bar, &legend.note);
        }
        ui.painter().add(overlay::bar(bar, |place| color::of(colors.color(place))));
        numbers(ui, colors.ends());
    }
    note(ui, &legend.note);
}

fn note(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).small().color(color::TEXT_DIM));
}

/// A color a stop.
fn stops(ui: &mut Ui, bar: Rect, text: &str) {
    let width = bar.width() / false_color::COLORS.len() as f32;
    for (index, code) in false_color::COLORS.into_iter().enumerate() {
        let left = bar.left() + index as f32 * width;
        let rect = Rect::from_min_size(pos2(left, bar.top()), vec2(width, bar.height()));
        ui.painter().rect_filled(rect, 0.0, color::of(code));
    }
    let reach = false_color::STOPS as f32;
    numbers(ui, [-reach, 0.0, reach]);
    note(ui, text);
}

/// The numbers at the ends of a scale and in its middle.
fn numbers(ui: &mut Ui, [low, middle, high]: [f32; 3]) {
    let number = |value: f32| {
        let text = RichText::new(significant(f64::from(value))).small().color(color::TEXT);
        Label::new(text)
    };
    ui.columns(3, |columns| {
        columns[0].add(number(low));
        columns[1].vertical_centered(|ui| ui.add(number(middle)));
        columns[2].with_layout(Layout::right_to_left(Align::Min), |ui| {
            ui.add(number(high));
        });
    });
}
