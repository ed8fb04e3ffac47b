//! Exported pictures with names, a legend, figures and words, as a PNG.

use std::path::Path;

use glam::UVec2;

use super::drawing::{Align, Canvas, color};
use super::legend::{self, Legend};
use crate::error::Result;

/// Contents of an exported picture, from top to bottom.
#[derive(Default)]
pub struct Export<'a> {
    /// Pictures beside each other, of one size.
    pub panes: Vec<Pane>,
    /// Legend of the colors, where the pictures are maps.
    pub legend: Option<Legend<'a>>,
    /// Sentences.
    pub words: Vec<String>,
    /// Figures.
    pub tables: Vec<FigureTable>,
}

/// A picture with what is drawn over it.
#[derive(Clone, Debug, Default)]
pub struct Pane {
    /// Width and height in pixels.
    pub size: UVec2,
    /// 8-bit sRGB, row 0 on top.
    pub codes: Vec<[u8; 3]>,
    /// Name of the picture; two names where a divider parts it.
    pub names: Vec<String>,
    /// First column right of the divider.
    pub divider: Option<u32>,
    /// Two corners of a region, the second one just outside of it.
    pub region: Option<[UVec2; 2]>,
}

/// Figures in rows and columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigureTable {
    /// Headings above the columns.
    pub headings: Vec<String>,
    /// The rows, of as many cells.
    pub rows: Vec<Vec<String>>,
}

/// The least width; smaller pictures are enlarged, pixel by pixel.
const LEAST_WIDTH: u32 = 640;
/// Pixels between pictures.
const GAP: u32 = 2;
/// Space around words and figures.
const MARGIN: i32 = 16;
/// Height of a line of text.
const LINE: i32 = 22;
/// Width of a column of figures where there is room.
const WIDEST: i32 = 150;
/// Behind names.
const CHIP: [u8; 3] = [30, 30, 30];
/// Around light lines, so that they show on any picture.
const DARK: [u8; 3] = [19, 19, 19];
/// Color of dividers and of the frame of a region, in sRGB codes.
const LIGHT: [u8; 3] = [238, 238, 238];

/// Draws `export` and writes it as a PNG.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, export: &Export<'_>) -> Result<()> {
    let size = export.panes.first().map_or(UVec2::ONE, |pane| pane.size).max(UVec2::ONE);
    let count = export.panes.len().max(1) as u32;
    let width = count * size.x + GAP * (count - 1);
    let zoom = LEAST_WIDTH.div_ceil(width);
    let shown = UVec2::new(count * size.x * zoom + GAP * (count - 1), size.y * zoom);
    let legend = if export.legend.is_some() { legend::HEIGHT } else { 0 };
    let words = wrapped(&export.words, shown.x as i32 - 2 * MARGIN)?;
    let rows: usize = export.tables.iter().map(|table| table.rows.len() + 1).sum();
    let blocks = usize::from(!words.is_empty()) + export.tables.len();
    let margins = if blocks > 0 { blocks as i32 + 1 } else { 0 };
    let text = (words.len() + rows) as i32 * LINE + margins * MARGIN / 2;
    let mut canvas = Canvas::new(shown + UVec2::new(0, legend + text.max(0) as u32));
    for (index, pane) in export.panes.iter().enumerate() {
        let left = index as u32 * (size.x * zoom + GAP);
        pane.draw(&mut canvas, left, zoom)?;
    }
    if let Some(legend) = &export.legend {
        legend.draw(&mut canvas, shown.y as i32)?;
    }
    let mut top = (shown.y + legend) as i32 + MARGIN / 2;
    for line in &words {
        canvas.text((MARGIN, top + LINE / 2), Align::Left, color::TEXT, line)?;
        top += LINE;
    }
    top += if words.is_empty() { 0 } else { MARGIN / 2 };
    let columns = export.tables.iter().map(|table| table.headings.len()).max().unwrap_or(1);
    let step = ((shown.x as i32 - 2 * MARGIN) / columns.max(1) as i32).min(WIDEST);
    for table in &export.tables {
        top = table.draw(&mut canvas, top, step)? + MARGIN / 2;
    }
    canvas.write(path)
}

impl Pane {
    fn draw(&self, canvas: &mut Canvas, left: u32, zoom: u32) -> Result<()> {
        let shown = self.size * zoom;
        for y in 0..shown.y {
            let line = (y / zoom) as usize * self.size.x as usize;
            for x in 0..shown.x {
                let code = self.codes.get(line + (x / zoom) as usize);
                canvas.put(UVec2::new(left + x, y), code.copied().unwrap_or_default());
            }
        }
        if let Some([first, end]) = self.region {
            let corner = |at: UVec2| (at * zoom).as_ivec2() + glam::IVec2::new(left as i32, 0);
            frame(canvas, corner(first), corner(end))?;
        }
        let middle = self.divider.map(|column| (left + column * zoom) as i32);
        if let Some(x) = middle {
            for (beside, color) in [(-1, DARK), (1, DARK), (0, LIGHT)] {
                let x = x + beside;
                canvas.line(vec![(x, 0), (x, shown.y as i32 - 1)], color, 1)?;
            }
        }
        let (low, high) = (left as i32, (left + shown.x) as i32);
        match (&self.names[..], middle) {
            ([a, b], Some(middle)) => {
                chip(canvas, a, (low, middle - 6), Align::Right)?;
                chip(canvas, b, (middle + 6, high), Align::Left)
            }
            ([name, ..], _) => chip(canvas, name, (low + 6, high), Align::Left),
            ([], _) => Ok(()),
        }
    }
}

/// Draws the frame of a region, just outside of it.
fn frame(canvas: &mut Canvas, first: glam::IVec2, end: glam::IVec2) -> Result<()> {
    for (out, color) in [(2, DARK), (1, LIGHT)] {
        let (x0, y0, x1, y1) = (first.x - out, first.y - out, end.x + out - 1, end.y + out - 1);
        canvas.line(vec![(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], color, 1)?;
    }
    Ok(())
}

/// A name on a dark ground at an end of a span; none where it does not fit.
fn chip(canvas: &mut Canvas, text: &str, (low, high): (i32, i32), align: Align) -> Result<()> {
    let width = Canvas::width_of(text)? + 12;
    if text.is_empty() || width > high - low {
        return Ok(());
    }
    let x = if align == Align::Right { high - width } else { low };
    canvas.fill([(x, 6), (x + width - 1, 6 + LINE + 1)], CHIP)?;
    canvas.text((x + 6, 7 + LINE / 2), Align::Left, color::TEXT, text)
}

impl FigureTable {
    /// Draws the table from `top` on down, a column every `step` pixels; returns its end.
    fn draw(&self, canvas: &mut Canvas, top: i32, step: i32) -> Result<i32> {
        let mut y = top + LINE / 2;
        for (row, tint) in std::iter::once((&self.headings, color::DIM))
            .chain(self.rows.iter().map(|row| (row, color::TEXT)))
        {
            for (column, cell) in row.iter().enumerate() {
                canvas.text((MARGIN + column as i32 * step, y), Align::Left, tint, cell)?;
            }
            y += LINE;
        }
        Ok(y - LINE / 2)
    }
}

/// Sentences broken between words into lines of at most `width` pixels.
fn wrapped(sentences: &[String], width: i32) -> Result<Vec<String>> {
    let mut lines = Vec::new();
    for sentence in sentences {
        let mut line = String::new();
        for word in sentence.split_whitespace() {
            let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
            if !line.is_empty() && Canvas::width_of(&longer)? > width {
                lines.push(std::mem::replace(&mut line, word.to_owned()));
            } else {
                line = longer;
            }
        }
        lines.push(line);
    }
    Ok(lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pane(size: UVec2, code: [u8; 3]) -> Pane {
        Pane { size, codes: vec![code; (size.x * size.y) as usize], ..Pane::default() }
    }

    fn drawn(export: &Export<'_>) -> image::RgbImage {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sheet.png");
        write(&path, export).unwrap();
        image::open(&path).unwrap().into_rgb8()
    }

    #[test]
    fn pictures_stand_pixel_for_pixel_beside_each_other() {
        let size = UVec2::new(400, 100);
        let panes = vec![pane(size, [200, 0, 0]), pane(size, [0, 0, 200])];
        let picture = drawn(&Export { panes, ..Export::default() });
        assert_eq!(picture.width(), 2 * 400 + GAP);
        assert_eq!(picture.get_pixel(399, 50).0, [200, 0, 0]);
        assert_eq!(picture.get_pixel(402, 50).0, [0, 0, 200]);
        assert_eq!(picture.get_pixel(401, 50).0, color::BACKGROUND);
    }

    #[test]
    fn small_pictures_are_enlarged_with_what_is_drawn_over_them() {
        let divided = Pane {
            names: vec!["A  Baseline".to_owned(), "B  Full".to_owned()],
            divider: Some(32),
            region: Some([UVec2::new(40, 20), UVec2::new(50, 30)]),
            ..pane(UVec2::new(64, 48), [0, 90, 0])
        };
        let picture = drawn(&Export { panes: vec![divided], ..Export::default() });
        assert_eq!(picture.width(), 640);
        assert_eq!(picture.get_pixel(320, 400).0, LIGHT, "the divider");
        assert_eq!(picture.get_pixel(450, 199).0, LIGHT, "the rectangle's upper side");
        assert_eq!(picture.get_pixel(450, 200).0, [0, 90, 0], "what is inside shows");
        assert_eq!(picture.get_pixel(500, 250).0, LIGHT, "its right side");
        assert_eq!(picture.get_pixel(312, 8).0, CHIP, "A's name ends left of the divider");
        assert_eq!(picture.get_pixel(328, 8).0, CHIP, "B's begins right of it");
    }

    #[test]
    fn words_and_figures_have_room_below() {
        let below = |export: &Export<'_>| drawn(export).height() - 50;
        let with = |words: &[&str], rows: usize| {
            let words = words.iter().map(|&word| word.to_owned()).collect();
            let row = vec!["A".to_owned(), "16".to_owned()];
            let table = FigureTable { headings: row.clone(), rows: vec![row; rows] };
            let panes = vec![pane(UVec2::new(640, 50), [9; 3])];
            below(&Export { panes, words, tables: vec![table], ..Export::default() })
        };
        let one = with(&["B needs 1/4 of A's time"], 2);
        assert_eq!(with(&["B needs 1/4 of A's time"], 3) - one, LINE as u32);
        let long = "word ".repeat(60);
        assert!(with(&[&long], 2) >= one + 2 * LINE as u32, "long sentences are wrapped");
        let wide = wrapped(&[long], 600).unwrap();
        assert!(wide.iter().all(|line| Canvas::width_of(line).unwrap() <= 600));
    }
}
