//! Lines and letters on a picture of 8-bit sRGB codes, without a window or fonts of the system.

use std::path::Path;
use std::sync::Once;

use glam::UVec2;
use plotters::backend::BitMapBackend;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Drawable, PathElement, PointCollection, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontStyle, IntoFont, RGBColor, ShapeStyle, register_font};

use super::png;
use crate::error::{Error, Result};

/// The name under which the font is known to `plotters`.
const FONT: &str = "flambeau";

/// Height of the letters in pixels.
const LETTERS: f64 = 16.0;

/// Place of a pixel, from the upper left corner.
pub(super) type PixelPosition = (i32, i32);

/// Horizontal alignment of a text to its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    /// The text begins at its position.
    Left,
    /// The text is centered on its position.
    Center,
    /// The text ends at its position.
    Right,
}

/// Colors of all drawings.
pub(super) mod color {
    /// Behind everything.
    pub const BACKGROUND: [u8; 3] = [24, 24, 26];
    /// Letters.
    pub const TEXT: [u8; 3] = [225, 225, 228];
    /// Letters that explain.
    pub const DIM: [u8; 3] = [160, 160, 165];
    /// Lines of a grid.
    pub const GRID: [u8; 3] = [58, 58, 62];
}

/// A picture to draw on.
pub(super) struct Canvas {
    size: UVec2,
    codes: Vec<u8>,
}

impl Canvas {
    /// An empty canvas of `size` pixels.
    pub fn new(size: UVec2) -> Self {
        let pixels = size.x as usize * size.y as usize;
        Self { size, codes: color::BACKGROUND.repeat(pixels) }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The width of a line of text in pixels.
    pub fn width_of(text: &str) -> Result<i32> {
        load_font()?;
        let (width, _) =
            (FONT, LETTERS).into_font().box_size(text).map_err(|e| failed(&e.to_string()))?;
        Ok(width as i32)
    }

    /// Sets the color of one pixel; does nothing off the canvas.
    pub fn put(&mut self, at: UVec2, color: [u8; 3]) {
        if at.cmplt(self.size).all() {
            let index = 3 * (at.y as usize * self.size.x as usize + at.x as usize);
            self.codes[index..index + 3].copy_from_slice(&color);
        }
    }

    /// Fills the box of pixels between two corners, both of them included.
    pub fn fill(&mut self, [first, last]: [PixelPosition; 2], color: [u8; 3]) -> Result<()> {
        // `plotters` leaves the last row and column out.
        let end = (last.0 + 1, last.1 + 1);
        self.draw(&Rectangle::new([first, end], style(color, 1).filled()))
    }

    /// Joins places by straight lines, `width` pixels wide.
    pub fn line(&mut self, places: Vec<PixelPosition>, color: [u8; 3], width: u32) -> Result<()> {
        self.draw(&PathElement::new(places, style(color, width)))
    }

    /// Writes a line of text whose middle is at the height of `at`.
    pub fn text(
        &mut self,
        at: PixelPosition,
        align: Align,
        color: [u8; 3],
        text: &str,
    ) -> Result<()> {
        load_font()?;
        let across = match align {
            Align::Left => HPos::Left,
            Align::Center => HPos::Center,
            Align::Right => HPos::Right,
        };
        let [r, g, b] = color;
        let font = (FONT, LETTERS).into_font().color(&RGBColor(r, g, b));
        self.draw(&Text::new(text.to_owned(), at, font.pos(Pos::new(across, VPos::Center))))
    }

    /// Writes the canvas as a PNG.
    ///
    /// # Errors
    /// When the system refuses to.
    pub fn write(&self, path: &Path) -> Result<()> {
        png::write_codes(path, self.size, &self.codes)
    }

    fn draw<E>(&mut self, element: &E) -> Result<()>
    where
        for<'a> &'a E: PointCollection<'a, PixelPosition>,
        for<'a> E: Drawable<BitMapBackend<'a>>,
    {
        let size = (self.size.x, self.size.y);
        let area: DrawingArea<_, _> =
            BitMapBackend::with_buffer(&mut self.codes, size).into_drawing_area();
        area.draw(element).map_err(|e: DrawingAreaErrorKind<_>| failed(&e.to_string()))
    }
}

fn style([r, g, b]: [u8; 3], width: u32) -> ShapeStyle {
    RGBColor(r, g, b).stroke_width(width)
}

/// Makes the font known, once.
fn load_font() -> Result<()> {
    static LOADED: Once = Once::new();
    let mut result = Ok(());
    LOADED.call_once(|| {
        let bytes = epaint_default_fonts::UBUNTU_LIGHT;
        result = register_font(FONT, FontStyle::Normal, bytes)
            .map_err(|_| failed("the font cannot be read"));
    });
    result
}

fn failed(reason: &str) -> Error {
    Error::invalid("", "drawing", reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_and_lines_leave_marks_where_they_should() {
        let mut canvas = Canvas::new(UVec2::new(60, 40));
        canvas.text((30, 12), Align::Center, color::TEXT, "A ±").unwrap();
        canvas.line(vec![(5, 35), (55, 35)], [255, 0, 0], 1).unwrap();
        canvas.put(UVec2::new(99, 99), [1, 2, 3]);
        let marked = |x: usize, y: usize| {
            let index = 3 * (y * 60 + x);
            canvas.codes[index..index + 3] != color::BACKGROUND
        };
        let in_box = |xs: std::ops::Range<usize>, ys: std::ops::Range<usize>| {
            ys.flat_map(|y| xs.clone().map(move |x| (x, y))).filter(|&(x, y)| marked(x, y)).count()
        };
        assert!(in_box(15..45, 2..22) > 10, "no letters");
        assert_eq!(in_box(0..60, 22..34), 0);
        assert!(in_box(0..60, 34..37) >= 50, "no line");
    }
}
