//! A number per pixel as a picture in the colors of a ramp, with its legend below, as a PNG.

use std::path::Path;

use glam::UVec2;

use super::drawing::Canvas;
use super::legend::{self, Legend};
use super::ramp::{self, Scale};
use crate::error::Result;

/// Color map of the numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Colors {
    /// Positive numbers on a logarithmic scale; zero and less are black.
    Logarithmic(Scale),
    /// Numbers of either sign, evenly from minus this number to this number.
    Signed(f32),
}

/// A map to draw.
pub struct Map<'a> {
    /// Quantity of the map, with its unit.
    pub title: &'a str,
    /// Further remark on the numbers.
    pub note: &'a str,
    /// Width and height in pixels.
    pub size: UVec2,
    /// The numbers, row 0 on top.
    pub values: &'a [f32],
    /// Color map of the numbers.
    pub colors: Colors,
    /// Formats a number for the legend.
    pub label: fn(f64) -> String,
}

/// The least width of the picture; smaller maps are enlarged, pixel by pixel.
const LEAST_WIDTH: u32 = 640;

impl Colors {
    fn of(&self, value: f32) -> [u8; 3] {
        match *self {
            Self::Logarithmic(scale) if value > 0.0 => ramp::color(scale.place(value)),
            Self::Logarithmic(_) => [0; 3],
            Self::Signed(end) if end > 0.0 => ramp::signed_color(value / end),
            Self::Signed(_) => ramp::signed_color(0.0),
        }
    }

    /// The number at a place in 0..=1 of the legend.
    fn at(&self, place: f32) -> f32 {
        match *self {
            Self::Logarithmic(Scale { low, high }) => low * (high / low).powf(place),
            Self::Signed(end) => end * (2.0 * place - 1.0),
        }
    }
}

/// Draws `map` and writes it as a PNG.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, map: &Map<'_>) -> Result<()> {
    let zoom = LEAST_WIDTH.div_ceil(map.size.x.max(1));
    let shown = map.size * zoom;
    let mut canvas = Canvas::new(shown + UVec2::new(0, legend::HEIGHT));
    for y in 0..shown.y {
        for x in 0..shown.x {
            let index = (y / zoom) as usize * map.size.x as usize + (x / zoom) as usize;
            let value = map.values.get(index).copied().unwrap_or(0.0);
            canvas.put(UVec2::new(x, y), map.colors.of(value));
        }
    }
    let at = |place| map.colors.at(place);
    let legend = Legend {
        title: map.title,
        note: map.note,
        color: &|place| map.colors.of(at(place)),
        ends: [0.0, 0.5, 1.0].map(|place| (map.label)(f64::from(at(place)))),
    };
    legend.draw(&mut canvas, shown.y as i32)?;
    canvas.write(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::percent;

    #[test]
    fn pixels_have_the_colors_of_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.png");
        let scale = Scale { low: 0.01, high: 1.0 };
        let size = UVec2::new(3, 2);
        let draw = |colors: Colors, values: &[f32]| {
            let map = Map { title: "t", note: "n", size, values, colors, label: percent };
            write(&path, &map).unwrap();
            image::open(&path).unwrap().into_rgb8()
        };
        let values = [0.01, 0.1, 1.0, 0.0, 5.0, 0.001];
        let picture = draw(Colors::Logarithmic(scale), &values);
        let zoom = picture.width() / 3;
        assert!(zoom > 200 && picture.height() == 2 * zoom + legend::HEIGHT);
        let at = |picture: &image::RgbImage, x: u32, y: u32| {
            picture.get_pixel(x * zoom + 7, y * zoom + zoom - 1).0
        };
        assert_eq!(at(&picture, 0, 0), ramp::color(0.0));
        assert_eq!(at(&picture, 1, 0), ramp::color(0.5));
        assert_eq!(at(&picture, 2, 0), ramp::color(1.0));
        assert_eq!(at(&picture, 0, 1), [0; 3]);
        assert_eq!(at(&picture, 1, 1), ramp::color(1.0));
        let middle_of_bar = picture.get_pixel(picture.width() / 2, 2 * zoom + 36 + 7).0;
        let differs = |(a, b): (u8, u8)| a.abs_diff(b) > 3;
        let is_other = std::iter::zip(middle_of_bar, ramp::color(0.5)).any(differs);
        assert!(!is_other, "the legend shows {middle_of_bar:?}");
        let picture = draw(Colors::Signed(2.0), &[-2.0, 0.0, 1.0, 9.0, -1.0, 0.5]);
        assert_eq!(at(&picture, 0, 0), ramp::signed_color(-1.0));
        assert_eq!(at(&picture, 2, 0), ramp::signed_color(0.5));
        assert_eq!(at(&picture, 0, 1), ramp::signed_color(1.0));
        draw(Colors::Signed(0.0), &[]);
    }
}
