//! Curves on logarithmic axes, as a PNG.

use std::path::Path;

use glam::UVec2;

use super::drawing::{Align, Canvas, PixelPosition, color};
use super::log_axis::LogAxis;
use crate::error::Result;

/// A named curve.
pub struct PlotCurve<'a> {
    /// Name of the curve in the legend.
    pub name: &'a str,
    /// Points from left to right, both coordinates positive.
    pub points: &'a [[f64; 2]],
}

/// An axis.
pub struct PlotAxis<'a> {
    /// Quantity of the axis, with its unit.
    pub name: &'a str,
    /// Formats a number along the axis.
    pub label: fn(f64) -> String,
}

/// Curves to draw.
pub struct Plot<'a> {
    /// A sentence above the curves.
    pub title: &'a str,
    /// Across and up.
    pub axes: [PlotAxis<'a>; 2],
    /// Curves; colors repeat where there are more curves than colors.
    pub curves: &'a [PlotCurve<'a>],
}

const SIZE: UVec2 = UVec2::new(900, 560);
/// Borders of the field of the curves: left, top, right, bottom.
const FIELD: [i32; 4] = [90, 74, 876, 496];
const COLORS: [[u8; 3]; 2] = [[94, 169, 255], [255, 159, 67]];

/// Draws `plot` and writes it as a PNG.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, plot: &Plot<'_>) -> Result<()> {
    let mut canvas = Canvas::new(SIZE);
    let [left, _, right, bottom] = FIELD;
    canvas.text((left, 22), Align::Left, color::TEXT, plot.title)?;
    canvas.text(
        ((left + right) / 2, SIZE.y as i32 - 18),
        Align::Center,
        color::DIM,
        plot.axes[0].name,
    )?;
    canvas.text((left, 52), Align::Left, color::DIM, plot.axes[1].name)?;
    let points = || plot.curves.iter().flat_map(|curve| curve.points);
    if points().next().is_none() {
        let middle = ((left + right) / 2, bottom / 2);
        canvas.text(middle, Align::Center, color::DIM, "There are too few samples for a curve")?;
        return canvas.write(path);
    }
    let scales = [0, 1].map(|axis| axis_over(points().map(|point| point[axis]), axis));
    grid(&mut canvas, plot, &scales)?;
    for (number, curve) in plot.curves.iter().enumerate() {
        let color = COLORS[number % COLORS.len()];
        draw(&mut canvas, curve, &scales, color)?;
        let at = (right - 8, FIELD[1] + 18 + 22 * number as i32);
        canvas.text(at, Align::Right, color, curve.name)?;
    }
    canvas.write(path)
}

/// The axis across (0) or up (1) that covers `values`.
fn axis_over(values: impl Iterator<Item = f64>, axis: usize) -> LogAxis {
    let [left, top, right, bottom] = FIELD;
    LogAxis::over(values, if axis == 0 { [left, right] } else { [bottom, top] })
}

fn grid(canvas: &mut Canvas, plot: &Plot<'_>, scales: &[LogAxis; 2]) -> Result<()> {
    let [left, top, right, bottom] = FIELD;
    for tick in scales[0].ticks() {
        let x = scales[0].pixel(tick);
        canvas.line(vec![(x, top), (x, bottom)], color::GRID, 1)?;
        canvas.text((x, bottom + 18), Align::Center, color::TEXT, &(plot.axes[0].label)(tick))?;
    }
    for tick in scales[1].ticks() {
        let y = scales[1].pixel(tick);
        canvas.line(vec![(left, y), (right, y)], color::GRID, 1)?;
        canvas.text((left - 8, y), Align::Right, color::TEXT, &(plot.axes[1].label)(tick))?;
    }
    Ok(())
}

fn draw(
    canvas: &mut Canvas,
    curve: &PlotCurve<'_>,
    scales: &[LogAxis; 2],
    color: [u8; 3],
) -> Result<()> {
    let place = |point: &[f64; 2]| -> PixelPosition {
        (scales[0].pixel(point[0]), scales[1].pixel(point[1]))
    };
    let places: Vec<PixelPosition> = curve.points.iter().map(place).collect();
    if let Some(&(x, y)) = places.last() {
        // The end is marked, so that a curve of one point shows.
        canvas.fill([(x - 3, y - 3), (x + 3, y + 3)], color)?;
    }
    canvas.line(places, color, 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::percent;

    fn axes() -> [PlotAxis<'static>; 2] {
        [
            PlotAxis { name: "CPU seconds", label: |x| x.to_string() },
            PlotAxis { name: "noise", label: percent },
        ]
    }

    fn drawn(curves: &[PlotCurve<'_>]) -> image::RgbImage {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plot.png");
        write(&path, &Plot { title: "B needs 1/38 of A's time", axes: axes(), curves }).unwrap();
        image::open(&path).unwrap().into_rgb8()
    }

    #[test]
    fn curves_go_where_their_points_are() {
        let points: Vec<[f64; 2]> =
            (0..40).map(|i| 1.25_f64.powi(i)).map(|t| [0.01 * t, 0.3 / t.sqrt()]).collect();
        let picture = drawn(&[
            PlotCurve { name: "A", points: &points },
            PlotCurve { name: "B", points: &[] },
        ]);
        assert_eq!(picture.dimensions(), (SIZE.x, SIZE.y));
        let scales = [0, 1].map(|axis| axis_over(points.iter().map(|point| point[axis]), axis));
        for point in &points[1..39] {
            let [x, y] = [0, 1].map(|axis| scales[axis].pixel(point[axis]) as u32);
            let is_blue = |x: u32, y: u32| {
                let [r, _, b] = picture.get_pixel(x, y).0;
                b > r + 50
            };
            assert!((y - 1..=y + 1).any(|y| is_blue(x, y)), "{point:?}");
        }
    }

    #[test]
    fn few_points_or_none_make_a_plot_too() {
        drawn(&[]);
        drawn(&[PlotCurve { name: "one", points: &[[3.0, 0.1]] }]);
        drawn(&[PlotCurve { name: "flat", points: &[[1e-9, 0.1], [1e9, 0.1]] }]);
    }
}
