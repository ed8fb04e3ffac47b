//! Writing the displayed picture as a PNG.

use std::io::{BufWriter, Write};
use std::path::Path;

use glam::UVec2;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::tone::Tone;
use crate::error::{Error, Result};
use crate::files;
use crate::math::Rgb;

/// Writes linear `pixels`, row 0 on top, as 8-bit sRGB.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, size: UVec2, pixels: &[[f32; 4]], tone: Tone) -> Result<()> {
    let encoder = tone.encoder();
    let codes: Vec<u8> =
        pixels.iter().flat_map(|&[r, g, b, _]| encoder.encode(Rgb::new(r, g, b))).collect();
    write_codes(path, size, &codes)
}

/// Writes 8-bit sRGB `codes`, three a pixel, row 0 on top.
///
/// # Errors
/// When the system refuses to write.
pub fn write_codes(path: &Path, size: UVec2, codes: &[u8]) -> Result<()> {
    files::replace(path, |file| {
        let mut writer = BufWriter::new(file);
        PngEncoder::new(&mut writer)
            .write_image(codes, size.x, size.y, ExtendedColorType::Rgb8)
            .map_err(|e| match e {
                image::ImageError::IoError(e) => Error::io(path, e),
                other => Error::invalid(path.display().to_string(), "", other.to_string()),
            })?;
        writer.flush().map_err(|e| Error::io(path, e))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::tone::ToneCurve;

    #[test]
    fn written_codes_are_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.png");
        let pixels = [[0.0, 0.5, 1.0, 1.0], [2.0, 0.0, 0.002, 0.0]];
        let tone = Tone { curve: ToneCurve::Linear, ..Tone::default() };
        write(&path, UVec2::new(2, 1), &pixels, tone).unwrap();
        let read = image::open(&path).unwrap().into_rgb8();
        assert_eq!(read.dimensions(), (2, 1));
        assert_eq!(read.into_raw(), [0, 188, 255, 255, 0, 7]);
        let names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
        assert_eq!(names.len(), 1, "a temporary file was left behind");
    }

    #[test]
    fn a_missing_folder_is_named() {
        let path = Path::new("/nonexistent/folder/out.png");
        let error = write(path, UVec2::ONE, &[[0.0; 4]], Tone::default()).unwrap_err();
        assert!(error.to_string().contains("/nonexistent/folder/out.png"), "{error}");
    }
}
