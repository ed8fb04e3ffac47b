//! Plot of noise and errors over the time spent, of one picture or of two, on logarithmic axes.

use egui::{Align2, Color32, Pos2, Rect, Sense, Stroke, TextStyle, Ui, pos2, vec2};

use super::measure::Plotted;
use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::significant;
use crate::render::compare::NoiseHistory;

/// Height of the plot.
const HEIGHT: f32 = 150.0;
/// Room for the numbers left of the plot and below it, in points.
const MARGIN: egui::Vec2 = vec2(44.0, 18.0);

/// The colors of A and of B.
pub const COLORS: [Color32; 2] = [color::CURVE_CHANCE, color::ACCENT];

/// The range of the axes, in powers of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Range {
    low: [f64; 2],
    high: [f64; 2],
}

impl Range {
    /// The range of all points, out to whole powers of ten in time; `None` where there is none.
    fn of(histories: [&NoiseHistory; 2]) -> Option<Self> {
        let mut points = histories.into_iter().flat_map(NoiseHistory::points).peekable();
        points.peek()?;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis].log10());
                high[axis] = high[axis].max(point[axis].log10());
            }
        }
        for axis in 0..2 {
            low[axis] = (low[axis] - 0.05).floor();
            high[axis] = (high[axis] + 0.05).ceil();
        }
        Some(Self { low, high })
    }

    /// Position of a point in `rect`.
    fn place(&self, rect: Rect, point: [f64; 2]) -> Pos2 {
        let share = |axis: usize| {
            let span = self.high[axis] - self.low[axis];
            ((point[axis].log10() - self.low[axis]) / span) as f32
        };
        pos2(egui::lerp(rect.x_range(), share(0)), egui::lerp(rect.bottom()..=rect.top(), share(1)))
    }

    /// The powers of ten along an axis.
    fn powers(&self, axis: usize) -> impl Iterator<Item = f64> {
        (self.low[axis] as i32..=self.high[axis] as i32).map(|power| 10_f64.powi(power))
    }
}

/// Shows the plot.
pub fn show(ui: &mut Ui, histories: [&NoiseHistory; 2], plotted: Plotted) {
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let spoken = spoken(histories, plotted);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &spoken));
    response.on_hover_text(plotted.help());
    let Some(range) = Range::of(histories) else { return };
    let plot = Rect::from_min_max(rect.min + vec2(MARGIN.x, 4.0), rect.max - vec2(8.0, MARGIN.y));
    grid(ui, &range, plot, plotted);
    let painter = ui.painter_at(plot);
    if let Some(power) = plotted.power() {
        slope(&painter, &range, plot, (histories, power));
    }
    for (history, color) in histories.into_iter().zip(COLORS) {
        let line: Vec<Pos2> =
            history.points().iter().map(|point| range.place(plot, *point)).collect();
        if let [only] = line[..] {
            painter.circle_filled(only, 2.0, color);
        }
        painter.line(line, Stroke::new(1.5, color));
    }
}

/// The plot in words, for screen readers.
fn spoken(histories: [&NoiseHistory; 2], plotted: Plotted) -> String {
    let last = |history: &NoiseHistory| match history.points().last() {
        Some([_, value]) => plotted.label(*value),
        None => "not known".to_owned(),
    };
    let name = plotted.name();
    match histories {
        [a, b] if b.points().is_empty() => format!("{name} over time: {}", last(a)),
        [a, b] => format!("{name} over time: A {}, B {}", last(a), last(b)),
    }
}

fn grid(ui: &Ui, range: &Range, plot: Rect, plotted: Plotted) {
    let painter = ui.painter();
    painter.rect_filled(plot, 0.0, color::WELL);
    let font = TextStyle::Small.resolve(ui.style());
    let line = Stroke::new(1.0, color::LINE);
    for seconds in range.powers(0) {
        let x = range.place(plot, [seconds, 1.0]).x;
        painter.vline(x, plot.y_range(), line);
        let text = format!("{} s", significant(seconds));
        let anchor = if x > plot.right() - 12.0 { Align2::RIGHT_TOP } else { Align2::CENTER_TOP };
        painter.text(pos2(x, plot.bottom() + 3.0), anchor, text, font.clone(), color::TEXT_DIM);
    }
    for noise in range.powers(1) {
        let y = range.place(plot, [1.0, noise]).y;
        painter.hline(plot.x_range(), y, line);
        let text = plotted.label(noise);
        let at = pos2(plot.left() - space::TIGHT, y.clamp(plot.top() + 5.0, plot.bottom() - 5.0));
        painter.text(at, Align2::RIGHT_CENTER, text, font.clone(), color::TEXT_DIM);
    }
}

/// The slope that noise falls with, through the latest point of the noisier side.
fn slope(
    painter: &egui::Painter,
    range: &Range,
    plot: Rect,
    (histories, power): ([&NoiseHistory; 2], f64),
) {
    let lasts = histories.into_iter().filter_map(|history| history.points().last());
    let Some([seconds, noise]) = lasts.max_by(|a, b| a[1].total_cmp(&b[1])) else { return };
    let at = |decades: f64| {
        let there = 10_f64.powf(decades);
        range.place(plot, [there, noise * (seconds / there).powf(power)])
    };
    let ends = [at(range.low[0]), at(range.high[0])];
    let stroke = Stroke::new(1.0, color::TEXT_DIM);
    painter.extend(egui::Shape::dotted_line(&ends, stroke.color, 5.0, 0.7));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::compare::measure::Measure;

    #[test]
    fn axes_cover_all_points_out_to_powers_of_ten() {
        let mut histories = [NoiseHistory::default(), NoiseHistory::default()];
        assert_eq!(Range::of(histories.each_ref()), None);
        histories[0].push(0.3, 0.5);
        histories[1].push(20.0, 0.02);
        let range = Range::of(histories.each_ref()).unwrap();
        assert_eq!((range.low, range.high), ([-1.0, -2.0], [2.0, 0.0]));
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(300.0, 200.0));
        assert!(range.place(rect, [0.1, 1.0]).distance(Pos2::ZERO) < 1e-3);
        assert!(range.place(rect, [100.0, 0.01]).distance(pos2(300.0, 200.0)) < 1e-3);
        let spoken = |plotted| spoken(histories.each_ref(), plotted);
        assert_eq!(spoken(Plotted::Noise), "Noise over time: A 50 %, B 2 %");
        assert_eq!(spoken(Plotted::Error(Measure::Flip)), "FLIP over time: A 0.5, B 0.02");
        histories[1] = NoiseHistory::default();
        let alone = super::spoken(histories.each_ref(), Plotted::Error(Measure::RelMse));
        assert_eq!(alone, "relMSE over time: 0.5");
    }
}
