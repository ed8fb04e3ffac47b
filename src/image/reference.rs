//! References: pictures that others are compared with.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use glam::UVec2;

use super::{exr_color, npy, npy_header};
use crate::error::{Error, Result};

/// The first bytes of every EXR.
const EXR_MAGIC: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

/// A reference: a picture that others are compared with, all of it finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    name: String,
    size: UVec2,
    pixels: Vec<[f32; 4]>,
}

impl Reference {
    /// Reads an EXR, by Flambeau or others, or a numpy array of linear R, G and B, told apart by
    /// their first bytes.
    ///
    /// Of an EXR it takes R, G and B of the first layer that has them. An array is of float32 or
    /// float64 and of shape height × width (gray), height × width × 3 or, with an alpha that is
    /// left out, height × width × 4, row 0 on top, as `flambeau render -o out.npy` and `numpy.save`
    /// write it.
    ///
    /// # Errors
    /// When the file cannot be read, is of another kind, is damaged, or holds a pixel that is not
    /// finite.
    pub fn load(path: &Path) -> Result<Self> {
        let mut start = Vec::new();
        let file = File::open(path).map_err(|e| Error::io(path, e))?;
        file.take(8).read_to_end(&mut start).map_err(|e| Error::io(path, e))?;
        let name = path.display().to_string();
        let (size, pixels) = if start.starts_with(npy_header::MAGIC) {
            npy::read(path)?
        } else if start.starts_with(EXR_MAGIC) {
            exr_color::read(path)?
        } else {
            let reason = "a reference has to be an .exr or an .npy file";
            return Err(Error::unsupported(name, "", reason));
        };
        Self::new(&name, size, pixels)
    }

    /// Linear `pixels`, row 0 on top, as a reference; `name` is for messages. Alpha counts for
    /// nothing.
    ///
    /// # Errors
    /// When there are not as many pixels as the size says, none, or one that is not finite.
    pub fn new(name: &str, size: UVec2, pixels: Vec<[f32; 4]>) -> Result<Self> {
        if pixels.is_empty() || pixels.len() as u64 != u64::from(size.x) * u64::from(size.y) {
            let reason = format!("{} pixels are not {} x {}", pixels.len(), size.x, size.y);
            return Err(Error::invalid(name, "", reason));
        }
        let finite = |[r, g, b, _]: &[f32; 4]| r.is_finite() && g.is_finite() && b.is_finite();
        if let Some(index) = pixels.iter().position(|pixel| !finite(pixel)) {
            let (x, y) = (index % size.x as usize, index / size.x as usize);
            let reason = format!(
                "pixel {x},{y} is not finite, so that nothing can be compared with it; mend the \
                 picture or choose another one"
            );
            return Err(Error::invalid(name, "", reason));
        }
        Ok(Self { name: name.to_owned(), size, pixels })
    }

    /// Width and height in pixels, at least 1.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Linear R, G and B, and an alpha that counts for nothing; row 0 on top.
    pub fn pixels(&self) -> &[[f32; 4]] {
        &self.pixels
    }

    /// Checks that pictures of `size` can be compared with the reference.
    ///
    /// # Errors
    /// When it is of another size; names both.
    pub fn matches(&self, size: UVec2) -> Result<()> {
        if self.size == size {
            return Ok(());
        }
        let reason = format!(
            "the reference has {} x {} pixels and the picture {} x {}; render with --size {}x{} or \
             choose another reference",
            self.size.x, self.size.y, size.x, size.y, self.size.x, self.size.y
        );
        Err(Error::invalid(&self.name, "", reason))
    }

    /// Checks that `picture` has as many pixels.
    pub(super) fn check_pixels(&self, picture: &[[f32; 4]]) -> Result<()> {
        if picture.len() == self.pixels.len() {
            return Ok(());
        }
        let (size, count) = (self.size, picture.len());
        let reason = format!(
            "the reference has {} x {} pixels and the picture {count}; both have to be of one size",
            size.x, size.y
        );
        Err(Error::invalid(&self.name, "", reason))
    }
}

#[cfg(test)]
mod tests;
