//! Small pictures of snapshots.

use std::ops::Range;
use std::path::Path;

use egui::ColorImage;
use glam::{UVec2, Vec4};

use crate::render::Picture;

/// Width and height that a thumbnail may have, in its own pixels. It is drawn at half this size in
/// points, so that it is sharp on fine screens too.
pub const LARGEST: UVec2 = UVec2::new(240, 136);

/// A small linear picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Thumbnail {
    /// Width and height.
    pub size: UVec2,
    /// Linear RGBA before exposure, row 0 on top.
    pub pixels: Vec<[f32; 4]>,
}

impl Thumbnail {
    /// The means of `picture` over the pixels of a smaller one.
    pub fn of(picture: &Picture) -> Self {
        let size = fitting(picture.size);
        let mut pixels = Vec::with_capacity(size.x as usize * size.y as usize);
        for y in 0..size.y {
            let rows = covered(y, picture.size.y, size.y);
            for x in 0..size.x {
                pixels.push(mean(picture, covered(x, picture.size.x, size.x), rows.clone()));
            }
        }
        Self { size, pixels }
    }
}

/// Range of the `whole` pixels in a line that the `index`-th of `parts` larger ones touches.
fn covered(index: u32, whole: u32, parts: u32) -> Range<usize> {
    let at = |index: u32| u64::from(index) * u64::from(whole);
    let parts = u64::from(parts);
    (at(index) / parts) as usize..at(index + 1).div_ceil(parts) as usize
}

fn mean(picture: &Picture, columns: Range<usize>, rows: Range<usize>) -> [f32; 4] {
    let count = (columns.len() * rows.len()) as f32;
    let width = picture.size.x as usize;
    let lines =
        rows.filter_map(|y| picture.pixels.get(y * width + columns.start..y * width + columns.end));
    let sum = lines.flatten().fold(Vec4::ZERO, |sum, &pixel| sum + Vec4::from_array(pixel));
    (sum / count).to_array()
}

/// The size of a thumbnail of a picture of `size`: as large as fits, never larger than itself.
fn fitting(size: UVec2) -> UVec2 {
    let ratio = LARGEST.as_vec2() / size.as_vec2();
    let scale = ratio.min_element().min(1.0);
    (size.as_vec2() * scale).round().as_uvec2().max(UVec2::ONE)
}

/// Reads a thumbnail as it was written; none where there is no such picture.
pub fn read(path: &Path) -> Option<ColorImage> {
    let mut reader = image::ImageReader::open(path).ok()?;
    reader.set_format(image::ImageFormat::Png);
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(2 * LARGEST.x);
    limits.max_image_height = Some(2 * LARGEST.y);
    reader.limits(limits);
    let picture = reader.decode().ok()?.into_rgb8();
    let size = [picture.width() as usize, picture.height() as usize];
    Some(ColorImage::from_rgb(size, picture.as_raw()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(size: UVec2) -> Picture {
        let row = |y: u32| (0..size.x).map(move |x| [(x % 2) as f32, y as f32, 0.5, 1.0]);
        Picture {
            size,
            pixels: (0..size.y).flat_map(row).collect(),
            complete: true,
            ..Picture::default()
        }
    }

    #[test]
    fn thumbnails_are_means_in_the_shape_of_the_picture() {
        let small = Thumbnail::of(&picture(UVec2::new(480, 100)));
        assert_eq!(small.size, UVec2::new(240, 50));
        for (index, pixel) in small.pixels.iter().enumerate() {
            let row = (index / 240) as f32;
            let expected = [0.5, 2.0 * row + 0.5, 0.5, 1.0];
            let off = std::iter::zip(pixel, expected).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f32::max) < 1e-3, "{index}: {pixel:?} for {expected:?}");
        }
        let own = picture(UVec2::new(5, 3));
        assert_eq!(Thumbnail::of(&own).pixels, own.pixels);
        assert_eq!(fitting(UVec2::new(10_000, 3)), UVec2::new(240, 1));
    }

    #[test]
    fn what_is_no_small_picture_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.png");
        assert!(read(&path).is_none());
        std::fs::write(&path, b"no picture").unwrap();
        assert!(read(&path).is_none());
        let write = |size: UVec2| {
            let pixels = vec![[0.5; 4]; size.x as usize * size.y as usize];
            crate::image::png::write(&path, size, &pixels, Default::default()).unwrap();
        };
        write(UVec2::new(600, 1));
        assert!(read(&path).is_none(), "too wide for a thumbnail");
        write(UVec2::new(6, 4));
        assert_eq!(read(&path).unwrap().size, [6, 4]);
    }
}
