//! Latitude-longitude pictures of everything around, as environments: `.hdr` and `.exr`.

use std::path::Path;

use glam::{Mat3A, UVec2, Vec3A};

use super::{exr_color, radiance_hdr};
use crate::error::{Error, Progress, Result};
use crate::files::{first_bytes, read_whole, reserve};

/// The first bytes of every EXR.
const EXR_MAGIC: &[u8] = &[0x76, 0x2f, 0x31, 0x01];
/// Largest number of pixels.
const MOST_PIXELS: u64 = 1 << 28;

/// A picture in linear Rec.709, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Panorama {
    /// Width and height in pixels, at least 1.
    pub size: UVec2,
    /// Radiance of the pixels as the file has it: values may be negative or no numbers.
    pub pixels: Vec<[f32; 3]>,
}

/// Whether a file that starts so may be read as a panorama.
pub fn is_panorama(start: &[u8]) -> bool {
    start.starts_with(EXR_MAGIC) || radiance_hdr::is_radiance(start)
}

/// Reads a picture. `bytes_of_pixel` is the memory that a pixel takes once more, when it is used.
///
/// # Errors
/// The file cannot be read, is of another kind, is damaged, or does not fit the memory; names it.
pub fn read(path: &Path, bytes_of_pixel: u64, progress: Progress) -> Result<Panorama> {
    let start = first_bytes(path)?;
    if start.starts_with(EXR_MAGIC) {
        return read_exr(path, bytes_of_pixel);
    }
    let refused = |reason: String| Error::invalid(path.display().to_string(), "", reason);
    if !radiance_hdr::is_radiance(&start) {
        let reason = "it is neither an .exr nor an .hdr file; convert the picture to one of them";
        return Err(Error::unsupported(path.display().to_string(), "", reason));
    }
    let check = |start: &[u8]| match radiance_hdr::is_radiance(start) {
        true => Ok(()),
        false => Err("it has changed while it was read".to_owned()),
    };
    let bytes = read_whole(path, check, progress)?;
    let header = radiance_hdr::header(&bytes).map_err(refused)?;
    check_memory(header.size, bytes_of_pixel + size_of::<[f32; 3]>() as u64).map_err(refused)?;
    let mut pixels = radiance_hdr::pixels(&bytes, &header).map_err(refused)?;
    let matrix = header.primaries.map(|primaries| primaries.rec_709_from_rgb());
    let unknown = || "its PRIMARIES span no colors; leave them out".to_owned();
    convert(&mut pixels, matrix.map(|m| m.ok_or_else(unknown)).transpose().map_err(refused)?);
    Ok(Panorama { size: header.size, pixels })
}

fn read_exr(path: &Path, bytes_of_pixel: u64) -> Result<Panorama> {
    let refused = |field, reason: String| Error::invalid(path.display().to_string(), field, reason);
    let (size, primaries) = exr_color::size_and_primaries(path)?;
    let in_file = (size_of::<[f32; 4]>() + size_of::<[f32; 3]>()) as u64;
    check_memory(size, bytes_of_pixel + in_file).map_err(|reason| refused("dataWindow", reason))?;
    let (size, pixels) = exr_color::read(path)?;
    let mut pixels: Vec<[f32; 3]> = pixels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect();
    let matrix = primaries.map(|primaries| primaries.rec_709_from_rgb());
    let unknown = || refused("chromaticities", "they span no colors; leave them out".to_owned());
    convert(&mut pixels, matrix.map(|m| m.ok_or_else(unknown)).transpose()?);
    Ok(Panorama { size, pixels })
}

/// Finds out whether a picture fits the memory, before any is taken.
fn check_memory(size: UVec2, bytes_of_pixel: u64) -> Result<(), String> {
    let count = u64::from(size.x) * u64::from(size.y);
    if count > MOST_PIXELS {
        return Err(format!("{} x {} pixels are too many; make it smaller", size.x, size.y));
    }
    let bytes = usize::try_from(count.saturating_mul(bytes_of_pixel)).unwrap_or(usize::MAX);
    reserve(bytes).map(drop)
}

fn convert(pixels: &mut [[f32; 3]], rec_709_from_rgb: Option<Mat3A>) {
    let Some(matrix) = rec_709_from_rgb.filter(|matrix| *matrix != Mat3A::IDENTITY) else { return };
    for pixel in pixels {
        *pixel = (matrix * Vec3A::from_array(*pixel)).to_array();
    }
}

#[cfg(test)]
mod tests;
