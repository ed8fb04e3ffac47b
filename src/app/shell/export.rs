//! The view on the screen with names, legend and figures, to be written to a file.

use std::path::Path;
use std::sync::Arc;

use glam::UVec2;
use rayon::prelude::*;

use crate::app::diagnostics::Legend;
use crate::app::picture::look::Look;
use crate::app::picture::viewport::Shown;
use crate::app::ui::widgets::significant;
use crate::error::{Error, Result};
use crate::image::export;
use crate::image::export::{Export, FigureTable, Pane};
use crate::image::exr;
use crate::image::legend;
use crate::image::ramp;
use crate::image::tone::Tone;
use crate::math::Rgb;
use crate::render::Area;
use crate::render::Picture;

/// The view with its figures, as written to a file.
pub struct SavedView {
    /// The pictures, as the viewport shows them.
    pub shown: Shown,
    /// Names of the pictures, from left to right.
    pub names: Vec<String>,
    /// The legend of a map.
    pub legend: Option<Legend>,
    /// Region that the figures are of.
    pub area: Option<Area>,
    /// Sentences below.
    pub words: Vec<String>,
    /// Figures below.
    pub tables: Vec<FigureTable>,
}

impl SavedView {
    /// Writes the view: to a file that ends in `.exr` its linear light, else a PNG as shown.
    ///
    /// # Errors
    /// When there is no picture, or none of light for an EXR, or the system refuses to write.
    pub fn write(self, path: &Path) -> Result<()> {
        match path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr")) {
            true => self.write_linear(path),
            false => self.write_shown(path),
        }
    }

    fn write_shown(self, path: &Path) -> Result<()> {
        let panes = self.panes();
        if panes.is_empty() {
            let name = path.display().to_string();
            return Err(Error::invalid(name, "", "there is no picture to save yet"));
        }
        let colors = self.legend.as_ref().and_then(|legend| Some((legend, legend.colors?)));
        let color = |place| colors.map_or([0; 3], |(_, colors)| colors.color(place));
        let legend = colors.map(|(legend, colors)| legend::Legend {
            title: legend.title,
            note: &legend.note,
            color: &color,
            ends: colors.ends().map(|end| significant(f64::from(end))),
        });
        let export = Export { panes, legend, words: self.words, tables: self.tables };
        export::write(path, &export)
    }

    /// Writes the light before exposure; that of pictures beside each other without a gap.
    fn write_linear(&self, path: &Path) -> Result<()> {
        let refuse = |reason| Err(Error::invalid(path.display().to_string(), "", reason));
        let (pictures, look, column) = match &self.shown {
            Shown::Nothing => return refuse("there is no picture to save yet"),
            Shown::One(picture, look) => (vec![picture], look, None),
            Shown::Wipe([a, b], look, share) if a.size == b.size => {
                (vec![a, b], look, Some((share * a.size.x as f32).round() as usize))
            }
            Shown::Wipe([a, b], look, _) | Shown::Beside([a, b], look) => (vec![a, b], look, None),
        };
        let lights: Option<Vec<_>> = pictures.iter().map(|one| light_of(one, *look)).collect();
        let Some(lights) = lights else {
            return refuse("a map has no light; save it as a PNG, or show the picture");
        };
        let size = pictures.first().map_or(UVec2::ZERO, |first| first.size);
        if pictures.iter().any(|one| one.size != size) {
            return refuse("both sides must have the same size");
        }
        match (&lights[..], column) {
            ([a, b], Some(column)) => exr::write_picture(path, size, &wiped(a, b, size, column)),
            ([a, b], None) => {
                exr::write_picture(path, size * UVec2::new(2, 1), &beside(a, b, size))
            }
            _ => exr::write_picture(path, size, lights.first().copied().unwrap_or_default()),
        }
    }

    /// The pictures, those of a wipe as one.
    fn panes(&self) -> Vec<Pane> {
        let name = |index: usize| self.names.get(index).cloned().into_iter().collect();
        match &self.shown {
            Shown::Nothing => Vec::new(),
            Shown::One(picture, look) => vec![self.pane(picture, *look, name(0))],
            Shown::Beside([a, b], look) => {
                vec![self.pane(a, *look, name(0)), self.pane(b, *look, name(1))]
            }
            Shown::Wipe([a, b], look, share) if a.size == b.size => {
                let column = (share * a.size.x as f32).round() as u32;
                let mut pane = self.pane(a, *look, self.names.clone());
                let right = codes(b, *look);
                for (index, code) in pane.codes.iter_mut().enumerate() {
                    if index as u32 % a.size.x >= column {
                        *code = right[index];
                    }
                }
                pane.divider = Some(column.min(a.size.x.saturating_sub(1)));
                vec![pane]
            }
            // Two sizes have no place to be parted at.
            Shown::Wipe([a, b], look, _) => {
                vec![self.pane(a, *look, name(0)), self.pane(b, *look, name(1))]
            }
        }
    }

    fn pane(&self, picture: &Arc<Picture>, look: Look, names: Vec<String>) -> Pane {
        let region: Option<[UVec2; 2]> = self.area.map(|area| [area.first, area.first + area.size]);
        Pane { size: picture.size, codes: codes(picture, look), names, divider: None, region }
    }
}

/// The light that a picture shows; `None` of a map of numbers.
fn light_of(picture: &Picture, look: Look) -> Option<&[[f32; 4]]> {
    match look {
        Look::Picture(_) => Some(&picture.pixels),
        Look::Light(_) => Some(&picture.layer.light),
        Look::Numbers(_) => None,
    }
}

/// The first columns of `a` and the others of `b`.
fn wiped(a: &[[f32; 4]], b: &[[f32; 4]], size: UVec2, column: usize) -> Vec<[f32; 4]> {
    let width = (size.x as usize).max(1);
    let column = column.min(width);
    let lines = std::iter::zip(a.chunks_exact(width), b.chunks_exact(width));
    lines.flat_map(|(a, b)| [&a[..column], &b[column..]].concat()).collect()
}

/// `a` with `b` to its right.
fn beside(a: &[[f32; 4]], b: &[[f32; 4]], size: UVec2) -> Vec<[f32; 4]> {
    let width = (size.x as usize).max(1);
    let lines = std::iter::zip(a.chunks_exact(width), b.chunks_exact(width));
    lines.flat_map(|(a, b)| [a, b].concat()).collect()
}

/// The pixels of a picture as the screen shows them, as 8-bit sRGB.
fn codes(picture: &Picture, look: Look) -> Vec<[u8; 3]> {
    match look {
        Look::Picture(tone) => light_codes(&picture.pixels, tone),
        Look::Light(tone) => light_codes(&picture.layer.light, tone),
        Look::Numbers(scale) => {
            let code = |&value: &f32| match value > 0.0 {
                true => ramp::color(scale.place(value)),
                false => [0; 3],
            };
            picture.layer.numbers.par_iter().map(code).collect()
        }
    }
}

fn light_codes(pixels: &[[f32; 4]], tone: Tone) -> Vec<[u8; 3]> {
    let encoder = tone.encoder();
    pixels.par_iter().map(|&[r, g, b, _]| encoder.encode(Rgb::new(r, g, b))).collect()
}
