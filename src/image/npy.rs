//! Pictures as numpy arrays, from and for scripts.

use std::io::{BufWriter, Write};
use std::path::Path;

use glam::UVec2;

use super::npy_header::{NpyHeader, float_header, split};
use crate::error::{Error, Result};
use crate::files;

/// Writes linear `pixels` as little-endian float32 of shape height × width × 3, row 0 on top.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, size: UVec2, pixels: &[[f32; 4]]) -> Result<()> {
    files::replace(path, |file| {
        let write = || -> std::io::Result<()> {
            let mut writer = BufWriter::new(file);
            writer.write_all(&float_header([size.y, size.x, 3]))?;
            for value in pixels.iter().flat_map(|[r, g, b, _]| [r, g, b]) {
                writer.write_all(&value.to_le_bytes())?;
            }
            writer.flush()
        };
        write().map_err(|e| Error::io(path, e))
    })
}

/// Reads linear pixels of float32 or float64 and of shape height × width (gray), height × width × 3
/// or height × width × 4 (alpha is left out), row 0 on top; returns their size, and the pixels with
/// an opaque alpha.
///
/// # Errors
/// When the file cannot be read, is damaged, or holds something else.
pub fn read(path: &Path) -> Result<(UVec2, Vec<[f32; 4]>)> {
    let bytes = std::fs::read(path).map_err(|e| Error::io(path, e))?;
    let invalid =
        |field: &str, reason: String| Error::invalid(path.display().to_string(), field, reason);
    let (header, data) = split(&bytes).map_err(|(field, why)| invalid(field, why.to_owned()))?;
    if header.fortran_order {
        let reason = "its columns come first; save numpy.ascontiguousarray of it";
        return Err(invalid("fortran_order", reason.to_owned()));
    }
    let Some((size, channels)) = extent(&header) else {
        let reason = format!(
            "{:?} is no picture; it has to be (height, width), (height, width, 3) or (height, \
             width, 4)",
            header.shape
        );
        return Err(invalid("shape", reason));
    };
    let Some((value_bytes, decode)) = decoder(&header.descr) else {
        let reason =
            format!("{:?} is not float32 or float64; save .astype('float32')", header.descr);
        return Err(invalid("descr", reason));
    };
    let values = u128::from(size.x) * u128::from(size.y) * channels as u128;
    let expected = values * value_bytes as u128;
    if data.len() as u128 != expected {
        let reason = format!(
            "it asks for {expected} bytes of values, and there are {}; save it again",
            data.len()
        );
        return Err(invalid("shape", reason));
    }
    let pixel = |values: &[f32]| match *values {
        [r, g, b, ..] => [r, g, b, 1.0],
        [gray, ..] => [gray, gray, gray, 1.0],
        [] => [0.0; 4],
    };
    Ok((size, decode(data).chunks_exact(channels).map(pixel).collect()))
}

/// The size and the number of channels, if it is the shape of a picture.
fn extent(header: &NpyHeader) -> Option<(UVec2, usize)> {
    let (height, width, channels) = match header.shape[..] {
        [height, width] => (height, width, 1),
        [height, width, channels @ (3 | 4)] => (height, width, channels),
        _ => return None,
    };
    let size = UVec2::new(u32::try_from(width).ok()?, u32::try_from(height).ok()?);
    (size.min_element() > 0).then_some((size, channels))
}

type Decode = fn(&[u8]) -> Vec<f32>;

/// The bytes of a value and the way to read them, if they are of a known type.
fn decoder(descr: &str) -> Option<(usize, Decode)> {
    match descr {
        "<f4" => Some((4, |data| values(data, f32::from_le_bytes))),
        ">f4" => Some((4, |data| values(data, f32::from_be_bytes))),
        "<f8" => Some((8, |data| values(data, |bytes| f64::from_le_bytes(bytes) as f32))),
        ">f8" => Some((8, |data| values(data, |bytes| f64::from_be_bytes(bytes) as f32))),
        _ => None,
    }
}

fn values<const N: usize>(data: &[u8], value: fn([u8; N]) -> f32) -> Vec<f32> {
    data.as_chunks().0.iter().map(|bytes| value(*bytes)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_values_are_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.npy");
        let pixels: Vec<[f32; 4]> = (0..6).map(|i| [i as f32, 0.5, -1.0e-30, 9.0]).collect();
        write(&path, UVec2::new(3, 2), &pixels).unwrap();
        let opaque: Vec<[f32; 4]> = pixels.iter().map(|&[r, g, b, _]| [r, g, b, 1.0]).collect();
        assert_eq!(read(&path).unwrap(), (UVec2::new(3, 2), opaque));
    }
}
