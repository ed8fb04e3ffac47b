//! Bars that tell how many times as fast as the baseline a strategy is, on a logarithmic axis.

use egui::{Align2, Rect, Response, Sense, Stroke, TextStyle, Ui, lerp, pos2, vec2};

use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::significant;
use crate::format::rounded;
use crate::render::compare::SpeedUp;
use crate::render::sweep::{RankedTrial, Ranking};

/// Width of the bars and height of one.
const SIZE: egui::Vec2 = vec2(190.0, 12.0);
/// Width of a number on the axis.
const LABEL: f32 = 48.0;
/// The least that the axis spans, in powers of ten.
const LEAST_SPAN: f64 = 0.5;

/// The axis of all bars of a ranking, in powers of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarAxis {
    low: f64,
    high: f64,
}

impl BarAxis {
    /// An axis that covers all of a ranking with its errors, and 1, where bars begin.
    pub fn over(ranking: &Ranking) -> Self {
        let known = ranking.entries.iter().filter_map(|entry| entry.over_baseline);
        let ends = known.flat_map(|speed_up| speed_up.interval()).map(f64::log10);
        let (low, high) = ends.fold((0.0_f64, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
        let margin = 0.02 * (high - low);
        Self { low: low - margin, high: (high + margin).max(low + LEAST_SPAN) }
    }

    /// Position of a number in `rect`.
    fn x(&self, rect: Rect, value: f64) -> f32 {
        let share = (value.log10() - self.low) / (self.high - self.low);
        lerp(rect.x_range(), share as f32)
    }

    /// The powers of ten on the axis.
    fn powers(&self) -> impl Iterator<Item = f64> {
        (self.low.ceil() as i32..=self.high.floor() as i32).map(|power| 10_f64.powi(power))
    }

    /// The powers of ten that there is room to write, 1 among them.
    fn labeled_powers(&self) -> impl Iterator<Item = f64> {
        let decade = f64::from(SIZE.x) / (self.high - self.low);
        let every = (f64::from(LABEL) / decade).ceil().max(1.0) as i32;
        self.powers().filter(move |power| power.log10().round() as i32 % every == 0)
    }

    /// Numbers of the axis above the bars.
    pub fn heading(&self, ui: &mut Ui) {
        let size = vec2(SIZE.x, space::ROW_HEIGHT);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        let font = TextStyle::Small.resolve(ui.style());
        for power in self.labeled_powers() {
            let x = self.x(rect, power).clamp(rect.left() + 8.0, rect.right() - 12.0);
            let text = format!("{} ×", significant(power));
            let at = pos2(x, rect.center().y);
            ui.painter().text(at, Align2::CENTER_CENTER, text, font.clone(), color::TEXT_DIM);
        }
        response.on_hover_text(
            "Speed relative to baseline: how many times sooner the same noise is reached.",
        );
    }

    /// The bar of an entry.
    pub fn bar(&self, ui: &mut Ui, entry: &RankedTrial, is_best: bool) -> Response {
        let (rect, response) = ui.allocate_exact_size(SIZE, Sense::hover());
        let painter = ui.painter();
        for power in self.powers() {
            let x = self.x(rect, power).round();
            painter.vline(x, rect.expand(2.0).y_range(), Stroke::new(1.0, color::LINE));
        }
        let Some(speed_up) = entry.over_baseline else { return response };
        let fill = match entry.is_rendered() {
            _ if is_best => color::ACCENT,
            true if entry.is_as_good_as_best() => color::ACCENT.gamma_multiply(0.7),
            true => color::CURVE_CHANCE.gamma_multiply(0.7),
            false => color::RAISED,
        };
        let [one, end] = [1.0, speed_up.ratio].map(|value| self.x(rect, value));
        let bar = Rect::from_x_y_ranges(one.min(end)..=one.max(end), rect.y_range());
        painter.rect_filled(bar, 1.0, fill);
        if entry.is_rendered() {
            let [low, high] = speed_up.interval().map(|value| self.x(rect, value));
            let stroke = Stroke::new(1.0, color::TEXT_STRONG);
            painter.hline(low..=high, rect.center().y, stroke);
        }
        let spoken = spoken(&speed_up);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &spoken));
        response.on_hover_text(spoken)
    }
}

/// The bar in words, for tooltips and screen readers.
fn spoken(speed_up: &SpeedUp) -> String {
    let [low, high] = speed_up.interval().map(|end| rounded(end, 2));
    let ratio = rounded(speed_up.ratio, 2);
    format!("{ratio} times as fast as baseline (95 % confidence: {low} to {high})")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_covers_everything_and_one() {
        let entry = |ratio| RankedTrial {
            trial: crate::render::sweep::plan(&Default::default(), &|_, _| None)[0],
            side: None,
            over_baseline: Some(SpeedUp { ratio, log_error: 0.05 }),
            over_best: None,
        };
        let entries = vec![entry(40.0), entry(3.0)];
        let axis = BarAxis::over(&Ranking { entries, leave_on: None, worths: Vec::new() });
        let rect = Rect::from_min_size(pos2(10.0, 0.0), vec2(100.0, 10.0));
        for value in [1.0, 3.0, 44.0] {
            assert!(rect.x_range().contains(axis.x(rect, value)), "{value}");
        }
        assert!(axis.powers().eq([1.0, 10.0]) && axis.labeled_powers().eq([1.0, 10.0]));
        let wide = BarAxis { low: -1.1, high: 4.4 };
        assert!(wide.labeled_powers().eq([1.0, 100.0, 10_000.0]));
        let empty = Ranking { entries: Vec::new(), leave_on: None, worths: Vec::new() };
        assert!(BarAxis::over(&empty).high > 0.3);
    }
}
