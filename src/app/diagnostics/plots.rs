//! The curves along a ray: densities in one plot, shares in another below it.

use egui::{RichText, Stroke, Ui};
use egui_plot::{GridMark, Line, Plot, PlotPoints, PlotUi, VLine, uniform_grid_spacer};

use super::curves::{DENSITIES, RayCurve, SHARES};
use crate::app::ui::theme::color;
use crate::app::ui::widgets::significant;
use crate::transport::profile::ProfileRow;

/// Width of a plot in points, and its height without the axis below.
const SIZE: egui::Vec2 = egui::vec2(240.0, 112.0);
/// Room for the numbers beside a plot.
const AXIS: f32 = 52.0;
/// Room for the numbers below a plot, and for the name below those.
const BELOW: [f32; 2] = [18.0, 20.0];
/// Distances of grid lines in points, from where they begin to show to where they do in full.
const GRID: std::ops::RangeInclusive<f32> = 12.0..=30.0;
/// Grid lines across a plot, about.
const LINES: f64 = 5.0;

/// Shows both with a mark at distance `at`; gives the distance under the pointer.
pub fn show(ui: &mut Ui, rows: &[ProfileRow], at: f32) -> Option<f32> {
    let densities = plot(ui, "Densities along the ray", ["", "1/length"], at, |plot| {
        for curve in &DENSITIES {
            plot.line(line(curve, rows, 1.0));
        }
    });
    let peak = rows.iter().map(|row| row.emission).fold(0.0, f32::max);
    let axes = ["Distance from the camera", "fraction"];
    let shares = plot(ui, "Fractions along the ray", axes, at, |plot| {
        for curve in &SHARES {
            let scale = if curve.unit.is_empty() || peak <= 0.0 { 1.0 } else { 1.0 / peak };
            plot.line(line(curve, rows, scale));
        }
    });
    densities.or(shares)
}

fn line<'a>(curve: &RayCurve, rows: &[ProfileRow], scale: f32) -> Line<'a> {
    let point = |row: &ProfileRow| [f64::from(row.t), f64::from(scale * (curve.value)(row))];
    let points: PlotPoints<'a> = rows.iter().map(point).collect();
    Line::new(curve.name, points).color(curve.color).width(1.6).allow_hover(false)
}

/// The step between grid lines, 1, 2 or 5 times a power of ten, and multiples of it.
fn steps((low, high): (f64, f64), lines: f64) -> [f64; 3] {
    let least = ((high - low) / lines).max(1e-12);
    let decade = 10_f64.powf(least.log10().floor());
    let round = [1.0, 2.0, 5.0].map(|step| step * decade).into_iter().find(|&step| step >= least);
    let step = round.unwrap_or(10.0 * decade);
    [step, 10.0 * step, 100.0 * step]
}

/// A number at a grid line, a multiple of its step.
fn number(mark: GridMark) -> String {
    // Adding zero takes the sign off it.
    significant((mark.value / mark.step_size).round() * mark.step_size + 0.0)
}

fn small(text: &str) -> RichText {
    RichText::new(text).small().color(color::TEXT_DIM)
}

fn plot(
    ui: &mut Ui,
    name: &str,
    [below, beside]: [&str; 2],
    at: f32,
    curves: impl FnOnce(&mut PlotUi<'_>),
) -> Option<f32> {
    let below_it = if below.is_empty() { BELOW[0] } else { BELOW[0] + BELOW[1] };
    let shown = Plot::new(name)
        .width(SIZE.x)
        .height(SIZE.y + below_it)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_double_click_reset(false)
        .show_x(false)
        .show_y(false)
        .show_crosshair(false)
        .set_margin_fraction(egui::vec2(0.0, 0.06))
        .include_y(0.0)
        .x_axis_label(small(below))
        .y_axis_label(small(beside))
        .grid_spacing(GRID)
        .x_grid_spacer(uniform_grid_spacer(|input| steps(input.bounds, LINES)))
        .y_grid_spacer(uniform_grid_spacer(|input| steps(input.bounds, 0.6 * LINES)))
        .y_axis_min_width(AXIS)
        .x_axis_formatter(|mark, _| number(mark))
        .y_axis_formatter(|mark, _| number(mark))
        .grid_color(color::LINE)
        .show(ui, |plot| {
            let mark = VLine::new("", f64::from(at));
            plot.vline(mark.stroke(Stroke::new(1.0, color::TEXT_DIM)).allow_hover(false));
            curves(plot);
        });
    let label = format!("{name}, {beside}");
    shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &label));
    let pointer = shown.response.hover_pos()?;
    Some(shown.transform.value_from_position(pointer).x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        let first = |low, high| steps((low, high), 5.0)[0];
        for (high, step) in [(1.0, 0.2), (12.0, 5.0), (3.0, 1.0), (40.0, 10.0)] {
            assert!((first(0.0, high) / step - 1.0).abs() < 1e-9, "{high}");
        }
        assert!(first(2.0, 2.0) > 0.0);
        let texts =
            [-1e-17, 0.5, 3.5, 12.0].map(|value| number(GridMark { value, step_size: 0.5 }));
        assert_eq!(texts, ["0", "0.5", "3.5", "12"]);
    }
}
