//! A rectangle of pixels, such as the region that is measured in the window.

use glam::UVec2;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Area {
    /// First pixel, in the upper left corner.
    pub first: UVec2,
    /// Width and height in pixels.
    pub size: UVec2,
}

/// Blocks along the longer side of an area.
const BLOCKS_ACROSS: u32 = 8;
/// The shortest side of a block, in pixels, where the area has as many.
const SMALLEST_BLOCK: u32 = 16;

impl Area {
    /// The area of a whole film of `size`.
    pub fn of(size: UVec2) -> Self {
        Self { first: UVec2::ZERO, size }
    }

    /// The part of the area that lies on a film of size `film`.
    #[must_use]
    pub fn within(&self, film: UVec2) -> Self {
        let first = self.first.min(film);
        let end = self.first.saturating_add(self.size).min(film);
        Self { first, size: end - first }
    }

    /// Whether a pixel lies in the region.
    pub fn contains(&self, pixel: UVec2) -> bool {
        pixel.cmpge(self.first).all() && (pixel - self.first).cmplt(self.size).all()
    }

    /// Number of pixels.
    pub fn pixels(&self) -> u64 {
        u64::from(self.size.x) * u64::from(self.size.y)
    }

    /// Square blocks that the region is divided into, line by line, those at its far borders cut: 8
    /// along the longer side, fewer where that would leave them less than 16 pixels wide.
    pub(crate) fn blocks(&self) -> Vec<Self> {
        let side = self.size.max_element().div_ceil(BLOCKS_ACROSS).max(SMALLEST_BLOCK);
        let counts = UVec2::new(self.size.x.div_ceil(side), self.size.y.div_ceil(side));
        let numbers = (0..counts.y).flat_map(|y| (0..counts.x).map(move |x| UVec2::new(x, y)));
        let block = |number: UVec2| {
            let start = number * side;
            Self { first: self.first + start, size: (self.size - start).min(UVec2::splat(side)) }
        };
        numbers.map(block).collect()
    }

    /// Pixels of the region, line by line.
    pub(crate) fn iter(&self) -> impl Iterator<Item = UVec2> + use<> {
        let Self { first, size } = *self;
        (0..size.y).flat_map(move |y| (0..size.x).map(move |x| first + UVec2::new(x, y)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_cover_every_pixel_once() {
        for (first, size) in [((0, 0), (960, 540)), ((3, 7), (40, 30)), ((5, 5), (1, 200))] {
            let area = Area { first: first.into(), size: size.into() };
            let blocks = area.blocks();
            assert!(blocks.len() <= 64, "{area:?}: {}", blocks.len());
            let mut pixels: Vec<UVec2> = blocks.iter().flat_map(Area::iter).collect();
            pixels.sort_by_key(|pixel| (pixel.y, pixel.x));
            assert!(pixels.into_iter().eq(area.iter()), "{area:?}");
        }
        assert!(Area::default().blocks().is_empty());
    }

    #[test]
    fn areas_are_cut_at_the_film() {
        let film = UVec2::new(20, 10);
        let area = |x, y, w, h| Area { first: UVec2::new(x, y), size: UVec2::new(w, h) };
        assert_eq!(area(15, 2, 30, 3).within(film), area(15, 2, 5, 3));
        assert_eq!(area(1, 1, u32::MAX, u32::MAX).within(film), area(1, 1, 19, 9));
        assert_eq!(area(25, 2, 5, 5).within(film).pixels(), 0);
        assert_eq!(Area::of(film).within(film), Area::of(film));
    }
}
