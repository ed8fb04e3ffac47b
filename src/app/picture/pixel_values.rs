//! Values written into the pixels of a picture that is zoomed far enough.

use egui::{Align2, Color32, FontId, Painter, Rect, vec2};
use glam::{UVec2, Vec2};

use super::look::Look;
use super::ramp_color;
use super::zoom::Placement;
use crate::app::ui::theme::{color, size};
use crate::image::ramp::Scale;
use crate::image::tone::{Encoder, linear_from_srgb};
use crate::math::{Rgb, luminance};
use crate::render::Picture;

/// Points that a pixel has to span for its values to be written into it.
const ROOM: f32 = 46.0;

/// Writes the values of the pixels of `picture` that are seen in `clip` into them, where they are
/// large enough: red, green and blue, or the number of a layer. `area` is what it is laid out in,
/// `factor` framebuffer pixels per point.
pub fn paint(
    painter: &Painter,
    [area, clip]: [Rect; 2],
    (picture, look): (&Picture, Look),
    placement: Placement,
    factor: f32,
) {
    let side = placement.scale / factor;
    if side < ROOM {
        return;
    }
    let painter = painter.with_clip_rect(clip);
    let seen = |at: egui::Pos2| {
        let at = (at - area.min) * factor;
        placement.picture_from_viewport(Vec2::new(at.x, at.y)).max(Vec2::ZERO).as_uvec2()
    };
    let ink = Ink::of(look);
    let (low, high) = (seen(clip.min), seen(clip.max).min(picture.size.saturating_sub(UVec2::ONE)));
    for y in low.y..=high.y {
        for x in low.x..=high.x {
            let corner =
                (placement.corner + Vec2::new(x as f32, y as f32) * placement.scale) / factor;
            let middle = area.min + vec2(corner.x, corner.y) + vec2(0.5 * side, 0.5 * side);
            let pixel = UVec2::new(x, y);
            write(&painter, middle, &lines(picture, look, pixel), ink.on(picture, pixel));
        }
    }
}

/// The text written into a pixel, line by line.
fn lines(picture: &Picture, look: Look, pixel: UVec2) -> Vec<String> {
    let index = pixel.y as usize * picture.size.x as usize + pixel.x as usize;
    let light = match look {
        Look::Picture(_) => picture.pixels.get(index),
        Look::Light(_) => picture.layer.light.get(index),
        Look::Numbers(_) => None,
    };
    let number = picture.layer.numbers.get(index).filter(|_| matches!(look, Look::Numbers(_)));
    match (light, number) {
        (Some([r, g, b, _]), _) => [r, g, b].map(|value| short(*value)).to_vec(),
        (None, Some(number)) => vec![short(*number)],
        (None, None) => Vec::new(),
    }
}

/// A number in at most six letters.
fn short(value: f32) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        small if small < 1.0e-3 => format!("{value:.0e}"),
        small if small < 10.0 => format!("{value:.3}"),
        middle if middle < 1000.0 => format!("{value:.1}"),
        large if large < 10_000.0 => format!("{value:.0}"),
        _ => format!("{value:.0e}"),
    }
}

/// Color of text that can be read on a pixel.
enum Ink {
    /// Text on light, as a tone shows it; of the layer or of the picture itself.
    Light(Encoder, bool),
    /// Text on the color of a number.
    Number(Scale),
}

/// Relative luminance from which black has more contrast than white (WCAG 2.1).
const BRIGHT: f32 = 0.179;

impl Ink {
    fn of(look: Look) -> Self {
        match look {
            Look::Picture(tone) => Self::Light(tone.encoder(), false),
            Look::Light(tone) => Self::Light(tone.encoder(), true),
            Look::Numbers(scale) => Self::Number(scale),
        }
    }

    fn on(&self, picture: &Picture, pixel: UVec2) -> Color32 {
        let index = pixel.y as usize * picture.size.x as usize + pixel.x as usize;
        let code = match self {
            Self::Light(encoder, of_layer) => {
                let light = if *of_layer { &picture.layer.light } else { &picture.pixels };
                let light = light.get(index).map(|[r, g, b, _]| Rgb::new(*r, *g, *b));
                encoder.encode(light.unwrap_or(Rgb::ZERO))
            }
            Self::Number(scale) => {
                let number = picture.layer.numbers.get(index).copied().unwrap_or(0.0);
                let [r, g, b, _] = ramp_color::color(scale.place(number)).to_array();
                [r, g, b]
            }
        };
        let shown =
            luminance(Rgb::from(code.map(|code| linear_from_srgb(f32::from(code) / 255.0))));
        color::ON_PICTURE[usize::from(shown < BRIGHT)]
    }
}

/// Writes lines around the middle of a pixel.
fn write(painter: &Painter, middle: egui::Pos2, lines: &[String], ink: Color32) {
    let font = FontId::proportional(size::SMALL);
    let height = size::SMALL + 1.0;
    let top = middle.y - 0.5 * height * (lines.len() as f32 - 1.0);
    for (index, line) in lines.iter().enumerate() {
        let at = egui::pos2(middle.x, top + height * index as f32);
        painter.text(at, Align2::CENTER_CENTER, line, font.clone(), ink);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::tone::Tone;
    use crate::render::LayerMap;

    #[test]
    fn numbers_fit_into_a_pixel() {
        let texts = [0.0, 0.001_24, 1.5, 99.96, 1234.5, 1.0e9, 4.0e-9, -0.25].map(short);
        assert_eq!(texts, ["0", "0.001", "1.500", "100.0", "1234", "1e9", "4e-9", "-0.250"]);
    }

    #[test]
    fn black_is_written_on_bright_pixels_and_white_on_dark_ones() {
        let picture = Picture {
            size: UVec2::new(2, 1),
            pixels: vec![[0.02; 4], [0.9; 4]],
            layer: LayerMap { numbers: vec![9.0, 0.0], ..LayerMap::default() },
            ..Picture::default()
        };
        let on = |look| [0, 1].map(|x| Ink::of(look).on(&picture, UVec2::new(x, 0)));
        let [black, white] = color::ON_PICTURE;
        assert_eq!(on(Look::Picture(Tone::default())), [white, black]);
        let stops = Tone { exposure: 6.0, ..Tone::default() };
        assert_eq!(on(Look::Picture(stops)), [black, black], "as it is shown");
        assert_eq!(on(Look::Numbers(Scale::rounded([0.0, 9.0]))), [black, white]);
    }

    #[test]
    fn what_is_shown_is_what_is_written() {
        let picture = Picture {
            size: UVec2::new(2, 1),
            pixels: vec![[0.0; 4], [1.0, 2.0, 3.0, 1.0]],
            layer: LayerMap { numbers: vec![7.0, 8.0], ..LayerMap::default() },
            ..Picture::default()
        };
        let written = |look| lines(&picture, look, UVec2::X);
        assert_eq!(written(Look::Picture(Tone::default())), ["1.000", "2.000", "3.000"]);
        assert_eq!(written(Look::Numbers(Scale::rounded([7.0, 8.0]))), ["8.000"]);
        assert!(written(Look::Light(Tone::default())).is_empty(), "not there yet");
    }
}
