//! The beauty as a numpy array, for scripts.

use std::io::BufWriter;
use std::path::Path;

use glam::UVec2;
use npyz::WriterBuilder;

use crate::error::{Error, Result};
use crate::files;

/// Writes linear `pixels` as little-endian float32 of shape height × width × 3, row 0 on top.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, size: UVec2, pixels: &[[f32; 4]]) -> Result<()> {
    let shape = [u64::from(size.y), u64::from(size.x), 3];
    files::replace(path, |file| {
        let write = || -> std::io::Result<()> {
            let mut writer = npyz::WriteOptions::<f32>::new()
                .default_dtype()
                .shape(&shape)
                .writer(BufWriter::new(file))
                .begin_nd()?;
            writer.extend(pixels.iter().flat_map(|&[r, g, b, _]| [r, g, b]))?;
            writer.finish()
        };
        write().map_err(|e| Error::io(path, e))
    })
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
        let bytes = std::fs::read(&path).unwrap();
        let npy = npyz::NpyFile::new(&bytes[..]).unwrap();
        assert_eq!(npy.shape(), [2, 3, 3]);
        assert_eq!(npy.dtype().descr(), "'<f4'");
        let values: Vec<f32> = npy.into_vec().unwrap();
        assert_eq!(values[15..], [5.0, 0.5, -1.0e-30]);
    }
}
