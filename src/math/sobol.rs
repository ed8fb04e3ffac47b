//! A four-dimensional Sobol sequence with Owen scrambling: points that fill a square evenly
//! however many of them are taken.
//!
//! The scrambling is a hash that lets every digit depend on the digits above it only (Laine and
//! Karras 2011, *Stratified sampling for stochastic transparency*; Burley 2020, *Practical
//! hash-based Owen scrambling*). It works on numbers whose bits are reversed, where "above" means
//! "towards the low end", the direction of carries. More than four dimensions come from several
//! such sequences, each with its own scrambling and its own order of points.

/// Dimensions of the sequence.
pub const DIMENSIONS: usize = 4;

/// Bits of an index that one table lookup takes in.
const CHUNK: u32 = 4;

/// Direction numbers of each dimension over what one chunk of the index adds to a point, with the
/// bits of the point reversed: `[dimension][chunk][bits of the chunk]`.
static POINTS: [[[u32; 1 << CHUNK]; (u32::BITS / CHUNK) as usize]; DIMENSIONS] = tables();

/// Coordinate `dimension` of point `index`, its bits reversed: bit 0 tells the halves apart.
#[inline]
pub fn reversed_point(mut index: u32, dimension: usize) -> u32 {
    if dimension == 0 {
        return index;
    }
    let mut point = 0;
    for chunk in &POINTS[dimension] {
        point ^= chunk[(index % (1 << CHUNK)) as usize];
        index >>= CHUNK;
        if index == 0 {
            break;
        }
    }
    point
}

/// Coordinate `dimension` of point `index` under the Owen scrambling that `key` stands for, in
/// units of 2⁻³².
#[inline]
pub fn scrambled_point(index: u32, dimension: usize, key: u64) -> u32 {
    scramble_reversed(reversed_point(index, dimension), key).reverse_bits()
}

/// Point `index` in the order that `key` stands for. Every aligned block of a power of two of
/// indices keeps its points among each other, and so does every run [2ᵏ, 2ᵏ⁺¹): that an index
/// grows no longer than it was costs nothing, as exchanging a block with its neighbor does no more
/// to scrambled points than another scrambling.
#[inline]
pub fn shuffled_index(index: u32, key: u64) -> u32 {
    if index < 2 {
        return index;
    }
    let leading = 1 << index.ilog2();
    let shuffled = scramble_reversed(index.reverse_bits(), key).reverse_bits();
    leading | (shuffled & (leading - 1))
}

/// Flips every bit or not, by `key` and the bits below it.
#[inline]
fn scramble_reversed(mut bits: u32, key: u64) -> u32 {
    let (low, high) = (key as u32, (key >> 32) as u32);
    bits = bits.wrapping_add(low);
    bits ^= bits.wrapping_mul(0x0d0e_f106);
    bits = bits.wrapping_mul(high | 1);
    bits ^= bits.wrapping_mul(0x4e96_bc80);
    bits = bits.wrapping_add(high.rotate_left(16));
    bits ^ bits.wrapping_mul(0x9f02_bdf6)
}

/// Primitive polynomials over GF(2) without their first and last term, degrees, and the first
/// direction numbers (Joe and Kuo 2008, *Constructing Sobol sequences with better two-dimensional
/// projections*) of the dimensions after the first.
const POLYNOMIALS: [(u32, usize, [u32; 3]); DIMENSIONS - 1] =
    [(0, 1, [1, 0, 0]), (1, 2, [1, 3, 0]), (1, 3, [1, 3, 1])];

/// Direction numbers of a dimension, the first in the highest bit.
const fn directions(dimension: usize) -> [u32; 32] {
    let mut v = [0; 32];
    let mut k = 0;
    while k < 32 {
        v[k] = if dimension == 0 {
            1 << (31 - k)
        } else {
            let (polynomial, degree, first) = POLYNOMIALS[dimension - 1];
            if k < degree {
                first[k] << (31 - k)
            } else {
                let mut next = v[k - degree] ^ (v[k - degree] >> degree);
                let mut term = 1;
                while term < degree {
                    if polynomial >> (degree - 1 - term) & 1 == 1 {
                        next ^= v[k - term];
                    }
                    term += 1;
                }
                next
            }
        };
        k += 1;
    }
    v
}

const fn tables() -> [[[u32; 1 << CHUNK]; (u32::BITS / CHUNK) as usize]; DIMENSIONS] {
    let mut tables = [[[0; 1 << CHUNK]; (u32::BITS / CHUNK) as usize]; DIMENSIONS];
    let mut dimension = 0;
    while dimension < DIMENSIONS {
        let v = directions(dimension);
        let mut bit = 0;
        while bit < 32 {
            let mut index = 0;
            while index < 1 << CHUNK {
                if index >> (bit % CHUNK as usize) & 1 == 1 {
                    tables[dimension][bit / CHUNK as usize][index] ^= v[bit].reverse_bits();
                }
                index += 1;
            }
            bit += 1;
        }
        dimension += 1;
    }
    tables
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every aligned run of 2ᵏ scrambled points has one point in each of the 2ᵏ equal parts of
    /// each axis and, in the first two dimensions, in each box of 2ⁱ × 2ᵏ⁻ⁱ.
    #[test]
    fn aligned_runs_are_nets() {
        let point = |index: u32, dimension: usize, key: u64| {
            scrambled_point(shuffled_index(index, !key), dimension, key + dimension as u64)
        };
        for k in 1..=10 {
            for run in [0, 1, 2, 5, 13, (1 << (31 - k)) + 3] {
                let key = 0x1234_5678_9abc_def0u64.wrapping_mul(u64::from(run) + 7);
                let indices = (run << k)..((run + 1) << k);
                for dimension in 0..DIMENSIONS {
                    let parts = indices.clone().map(|i| point(i, dimension, key) >> (32 - k));
                    assert_all_different(parts, 1 << k);
                }
                for i in 1..k {
                    let boxes = indices.clone().map(|index| {
                        let (x, y) = (point(index, 0, key), point(index, 1, key));
                        (x >> (32 - i)) << (k - i) | y >> (32 - (k - i))
                    });
                    assert_all_different(boxes, 1 << k);
                }
            }
        }
    }

    fn assert_all_different(parts: impl Iterator<Item = u32>, count: usize) {
        let mut seen = vec![false; count];
        for part in parts {
            assert!(!std::mem::replace(&mut seen[part as usize], true), "twice in part {part}");
        }
    }

    /// The first points of the published sequence, in binary order.
    #[test]
    fn points_are_those_of_the_sequence() {
        let point = |index, dimension| {
            f64::from(reversed_point(index, dimension).reverse_bits()) / 2f64.powi(32)
        };
        let expected = [
            [0.0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875],
            [0.0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875],
            [0.0, 0.5, 0.75, 0.25, 0.375, 0.875, 0.625, 0.125],
            [0.0, 0.5, 0.75, 0.25, 0.125, 0.625, 0.875, 0.375],
        ];
        for (dimension, expected) in expected.iter().enumerate() {
            let points: Vec<f64> = (0..8).map(|index| point(index, dimension)).collect();
            assert_eq!(points, expected);
        }
    }

    #[test]
    fn shuffling_keeps_runs_and_depends_on_the_key() {
        let order = |key| (0..1024).map(|i| shuffled_index(i, key)).collect::<Vec<_>>();
        for key in [0, 1, 2].map(|k: u64| (k + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15)) {
            let order = order(key);
            for k in 0..10 {
                let mut run = order[1 << k..1 << (k + 1)].to_vec();
                run.sort_unstable();
                assert!(run.into_iter().eq(1 << k..1 << (k + 1)));
            }
        }
        assert_ne!(order(3 << 40 | 5), order(4 << 40 | 9));
    }
}
