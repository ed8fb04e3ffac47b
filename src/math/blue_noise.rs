//! A tile of ranks in blue noise order: pixels near each other have ranks far apart, so that
//! errors which follow the ranks cancel between neighbors and show as fine grain.
//!
//! Made by void and cluster (Ulichney 1993, *The void-and-cluster method for dither array
//! generation*): points are taken out where they crowd and put in where there is most room, and
//! the order in which that happens is the rank.

use std::sync::LazyLock;

use glam::UVec2;

/// Pixels along the side of the tile.
pub const SIDE: u32 = 64;
/// Bits of a rank; every rank belongs to one pixel.
pub const RANK_BITS: u32 = 12;

const PIXELS: usize = (SIDE * SIDE) as usize;
const _: () = assert!(PIXELS == 1 << RANK_BITS);

static RANKS: LazyLock<Vec<u16>> = LazyLock::new(ranks);

/// The rank of a pixel, 0 to 2¹² − 1; the tile repeats in both directions.
#[inline]
pub fn rank(pixel: UVec2) -> u32 {
    u32::from(RANKS[((pixel.y % SIDE) * SIDE + pixel.x % SIDE) as usize])
}

/// Radius in pixels beyond which a point's Gaussian is next to nothing.
const REACH: i32 = 9;
/// Standard deviation of a point's Gaussian, in pixels (Ulichney's 1.5, and some more as the ranks
/// are many).
const WIDTH: f64 = 1.9;

/// Points on the tile and the sum of their Gaussians at each pixel, in whole numbers so that the
/// tile is the same wherever it is made.
#[derive(Clone)]
struct Pattern {
    occupied: Vec<bool>,
    crowding: Vec<i64>,
}

impl Pattern {
    fn toggle(&mut self, at: usize, kernel: &[i64]) {
        let sign = if self.occupied[at] { -1 } else { 1 };
        self.occupied[at] = !self.occupied[at];
        let (x, y) = ((at as u32 % SIDE) as i32, (at as u32 / SIDE) as i32);
        let wrap = |value: i32| value.rem_euclid(SIDE as i32) as usize;
        let mut kernel = kernel.iter();
        for dy in -REACH..=REACH {
            for dx in -REACH..=REACH {
                let amount = kernel.next().copied().unwrap_or(0);
                self.crowding[wrap(y + dy) * SIDE as usize + wrap(x + dx)] += sign * amount;
            }
        }
    }

    /// The point that crowds most.
    fn cluster(&self) -> usize {
        let points = (0..PIXELS).filter(|&i| self.occupied[i]);
        points.max_by_key(|&i| self.crowding[i]).unwrap_or(0)
    }

    /// The empty pixel with most room.
    fn void(&self) -> usize {
        let empty = (0..PIXELS).filter(|&i| !self.occupied[i]);
        empty.min_by_key(|&i| self.crowding[i]).unwrap_or(0)
    }
}

fn kernel() -> Vec<i64> {
    let reach = -REACH..=REACH;
    let weight = |dx: i32, dy: i32| {
        let squared = f64::from(dx * dx + dy * dy);
        ((-squared / (2.0 * WIDTH * WIDTH)).exp() * f64::from(1 << 24)).round() as i64
    };
    reach.clone().flat_map(|dy| reach.clone().map(move |dx| weight(dx, dy))).collect()
}

fn ranks() -> Vec<u16> {
    let kernel = kernel();
    let mut pattern = Pattern { occupied: vec![false; PIXELS], crowding: vec![0; PIXELS] };
    // Any points will do to start from; this polynomial visits every pixel once (Rivest 2001).
    let first = PIXELS / 10;
    (0..first).for_each(|i| pattern.toggle((2530 * i * i + 1031 * i) % PIXELS, &kernel));
    loop {
        let cluster = pattern.cluster();
        pattern.toggle(cluster, &kernel);
        let void = pattern.void();
        if pattern.crowding[void] == pattern.crowding[cluster] {
            pattern.toggle(cluster, &kernel);
            break;
        }
        pattern.toggle(void, &kernel);
    }
    let mut ranks = vec![0; PIXELS];
    let mut thinning = pattern.clone();
    for rank in (0..first).rev() {
        let cluster = thinning.cluster();
        thinning.toggle(cluster, &kernel);
        ranks[cluster] = rank as u16;
    }
    for rank in first..PIXELS {
        let void = pattern.void();
        pattern.toggle(void, &kernel);
        ranks[void] = rank as u16;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rank_has_a_pixel() {
        let mut ranks = RANKS.clone();
        ranks.sort_unstable();
        assert!(ranks.into_iter().eq(0..PIXELS as u16));
        assert_eq!(rank(UVec2::new(5 + SIDE, 7 + 3 * SIDE)), rank(UVec2::new(5, 7)));
    }

    /// Means over boxes of 8 by 8 pixels scatter far less than those of 64 independent ranks: by
    /// 0.10 of their variance, the boxes' sharp edges being what is left.
    #[test]
    fn ranks_even_out_over_small_boxes() {
        let mut squares = 0.0;
        for y in 0..SIDE {
            for x in 0..SIDE {
                let inside = (0..64).map(|i| rank(UVec2::new(x + i % 8, y + i / 8)));
                let mean = f64::from(inside.sum::<u32>()) / 64.0 / PIXELS as f64;
                squares += (mean - 0.5).powi(2) / PIXELS as f64;
            }
        }
        let independent = 1.0 / 12.0 / 64.0;
        assert!(squares < 0.15 * independent, "{squares}");
    }
}
