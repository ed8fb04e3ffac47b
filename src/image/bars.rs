//! Bar chart of ratios on a logarithmic axis, as a PNG.

use std::path::Path;

use glam::UVec2;

use super::drawing::{Align, Canvas, color};
use super::log_axis::LogAxis;
use crate::error::Result;

/// A named number of a bar chart with its label.
pub struct Bar<'a> {
    /// Name of the bar, left of it.
    pub name: &'a str,
    /// The number, above 0, and the ends of its confidence interval; `None` where it is not known.
    pub value: Option<(f64, [f64; 2])>,
    /// Text at the end of the bar.
    pub label: &'a str,
    /// Whether the bar is drawn in the color that stands out.
    pub stands_out: bool,
}

/// Bars to draw, which begin at 1.
pub struct Bars<'a> {
    /// Sentence above the bars.
    pub title: &'a str,
    /// Quantity of the axis, with its unit.
    pub axis: &'a str,
    /// Bars from top to bottom.
    pub bars: &'a [Bar<'a>],
}

const WIDTH: u32 = 1000;
/// Borders of the bars: left, right.
const FIELD: [i32; 2] = [310, 844];
/// Column where labels end, in pixels.
const LABELS: i32 = 984;
/// Row where the first bar begins, in pixels.
const TOP: i32 = 76;
/// Height of a bar with the gap below it, and of the bar.
const ROW: [i32; 2] = [30, 16];
/// Room below the bars.
const BOTTOM: i32 = 40;
const BAR: [u8; 3] = [92, 120, 158];
const BAR_OUT: [u8; 3] = [255, 159, 67];

/// Draws `bars` and writes them as a PNG.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, bars: &Bars<'_>) -> Result<()> {
    let end = TOP + ROW[0] * bars.bars.len() as i32;
    let mut canvas = Canvas::new(UVec2::new(WIDTH, (end + BOTTOM) as u32));
    canvas.text((16, 22), Align::Left, color::TEXT, bars.title)?;
    canvas.text((FIELD[0], 52), Align::Left, color::DIM, bars.axis)?;
    let known = || bars.bars.iter().filter_map(|bar| bar.value);
    let ends = known().flat_map(|(value, [low, high])| [value, low, high]);
    let axis = LogAxis::over(ends.chain([1.0]), FIELD);
    for tick in axis.ticks() {
        let x = axis.pixel(tick);
        canvas.line(vec![(x, TOP - 6), (x, end)], color::GRID, 1)?;
        canvas.text((x, end + 14), Align::Center, color::TEXT, &tick.to_string())?;
    }
    for (number, bar) in bars.bars.iter().enumerate() {
        draw(&mut canvas, bar, &axis, TOP + ROW[0] * number as i32)?;
    }
    let one = axis.pixel(1.0);
    canvas.line(vec![(one, TOP - 6), (one, end)], color::DIM, 1)?;
    canvas.write(path)
}

fn draw(canvas: &mut Canvas, bar: &Bar<'_>, axis: &LogAxis, top: i32) -> Result<()> {
    let bottom = top + ROW[1];
    let middle = (top + bottom) / 2;
    let (letters, fill) = match bar.stands_out {
        true => (color::TEXT, BAR_OUT),
        false => (color::DIM, BAR),
    };
    canvas.text((FIELD[0] - 12, middle), Align::Right, letters, bar.name)?;
    canvas.text((LABELS, middle), Align::Right, letters, bar.label)?;
    let Some((value, interval)) = bar.value else { return Ok(()) };
    let [one, x] = [1.0, value].map(|value| axis.pixel(value));
    canvas.fill([(one.min(x), top), (one.max(x), bottom)], fill)?;
    let [low, high] = interval.map(|end| axis.pixel(end));
    canvas.line(vec![(low, middle), (high, middle)], color::TEXT, 1)?;
    for x in [low, high] {
        canvas.line(vec![(x, middle - 4), (x, middle + 4)], color::TEXT, 1)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(bars: &[Bar<'_>]) -> image::RgbImage {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bars.png");
        write(&path, &Bars { title: "Leave on full", axis: "times as fast", bars }).unwrap();
        image::open(&path).unwrap().into_rgb8()
    }

    fn bar(value: Option<f64>, stands_out: bool) -> Bar<'static> {
        let value = value.map(|value| (value, [value / 1.1, value * 1.1]));
        Bar { name: "full", value, label: "1/41", stands_out }
    }

    /// Bars begin at 1 and go as far as their numbers, to the left below 1.
    #[test]
    fn bars_go_as_far_as_their_numbers() {
        let values = [41.0, 3.0, 0.5];
        let bars = values.map(|value| bar(Some(value), value == 41.0));
        let picture = drawn(&bars);
        let ends = values.into_iter().flat_map(|value| [value / 1.1, value * 1.1, 1.0]);
        let axis = LogAxis::over(ends, FIELD);
        for (row, (value, fill)) in [(41.0, BAR_OUT), (3.0, BAR), (0.5, BAR)].iter().enumerate() {
            let y = (TOP + ROW[0] * row as i32 + 2) as u32;
            let filled: Vec<i32> = (FIELD[0]..FIELD[1])
                .filter(|&x| picture.get_pixel(x as u32, y).0 == *fill)
                .collect();
            let [one, end] = [1.0, *value].map(|value| axis.pixel(value));
            let (first, last) = (filled[0], filled[filled.len() - 1]);
            assert!((first - one.min(end)).abs() <= 1, "row {row}: from {first}");
            assert!((last - one.max(end)).abs() <= 1, "row {row}: to {last}");
        }
    }

    #[test]
    fn what_is_not_known_has_no_bar() {
        drawn(&[]);
        let picture = drawn(&[bar(None, true), bar(Some(1.0), false)]);
        assert!(picture.pixels().all(|pixel| pixel.0 != BAR_OUT));
    }
}
