//! Blocks of pixels: which pixel stands for a block, and which block shows at a pixel without
//! samples.

use glam::UVec2;

use super::film::Film;

/// The coarsest stride: 510 paths for 960 × 540 pixels.
pub const COARSEST_STRIDE: u32 = 32;

/// The pixel that stands for the block of `stride`² pixels around `pixel`; strides are powers of 2.
pub fn representative(pixel: UVec2, stride: u32, size: UVec2) -> UVec2 {
    debug_assert!(stride.is_power_of_two());
    // Divisions would be felt: every picture asks this of every pixel.
    let corner = pixel & UVec2::splat(!(stride - 1));
    (corner + stride / 2).min(size - UVec2::ONE)
}

/// The pixel to read in place of `pixel`: itself once it has a sample, or the one that stands for
/// the smallest sampled block around it.
pub fn shown_pixel(film: &Film, pixel: UVec2) -> UVec2 {
    (0..=COARSEST_STRIDE.ilog2())
        .map(|power| 1 << power)
        .map(|stride| representative(pixel, stride, film.size()))
        .find(|&candidate| film.samples(candidate) > 0)
        .unwrap_or(pixel)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::film::TILE;

    /// Width and height that no block fits into a whole number of times.
    const SIZE: UVec2 = UVec2::new(100, 50);

    #[test]
    fn representatives_lie_in_their_blocks_and_on_the_film() {
        for stride in [32, 16, 8, 4, 2, 1] {
            for y in 0..SIZE.y {
                for x in 0..SIZE.x {
                    let pixel = UVec2::new(x, y);
                    let middle = representative(pixel, stride, SIZE);
                    assert_eq!(middle / stride, pixel / stride);
                    assert!(middle.x < SIZE.x && middle.y < SIZE.y);
                    assert_eq!(representative(middle, stride, SIZE), middle);
                    assert!(stride > TILE || middle / TILE == pixel / TILE);
                }
            }
        }
        let first = representative(UVec2::ZERO, 8, SIZE);
        assert_eq!(first, UVec2::new(4, 4));
    }
}
