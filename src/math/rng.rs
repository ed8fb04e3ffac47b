//! The random numbers of one path.

use std::convert::Infallible;

use glam::UVec2;
use rand::{SeedableRng, TryRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use super::{blue_noise, sobol};

/// Independent randomizations of a pixel: sample `s` belongs to number `s % ACCUMULATORS`, and the
/// film keeps their sums apart. Samples of one randomization are spread evenly and depend on each
/// other; noise is measured between the randomizations, which don't.
pub const ACCUMULATORS: usize = 8;

/// Vertices of a branch whose slots are spread evenly. Later ones add up over so many dimensions
/// that there is nothing left to gain.
const STRATIFIED_VERTICES: u32 = 4;
/// Rows of slots of a vertex, see [`Slot`].
const ROWS: u32 = 5;
/// Rows of slots of all stratified vertices of both branches.
const ALL_ROWS: u32 = 2 * STRATIFIED_VERTICES * ROWS;

/// Use of a random number. Slots that shape the same part of a path share a Sobol sequence; those
/// of different rows are independent:
///
/// | | | | |
/// |---|---|---|---|
/// | `PixelX`, `DirectionX` | `PixelY`, `DirectionY` | `Emission` | `TransmittanceA` |
/// | `Distance` | `GuidedDistance` | `Time`, `DirectionPick` | `TransmittanceB` |
/// | `LensX`, `LightX` | `LensY`, `LightY` | `LightCell` | `LightPick` |
/// | `LightEmission` | `LightTransmittanceA` | `LightZ` | `LightTransmittanceB` |
/// | `FireCount` | `LampCount` | `WalkCount` | `GuidedCount` |
///
/// The first number of a row and the second make up the best pair. The camera has the slots
/// `Pixel*` and `Time`, every other vertex the slots `Direction*` in their place: both choose the
/// ray that leaves. The camera has no light samples, so `Lens*` take their place there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// Horizontal position of a camera ray in its pixel, from left to right; at vertex 0 only.
    PixelX,
    /// Vertical position of a camera ray in its pixel, from top to bottom; at vertex 0 only.
    PixelY,
    /// Time of the path within the shutter; at vertex 0 only.
    Time,
    /// First coordinate of the point on the lens; at vertex 0 only.
    LensX,
    /// Second coordinate of the point on the lens; at vertex 0 only.
    LensY,
    /// Jitter of the emission walk's reads along the ray that leaves the vertex.
    Emission,
    /// Jitter of the transmittance estimate along the ray that leaves the vertex.
    TransmittanceA,
    /// Second jitter of the transmittance estimate along the ray that leaves the vertex.
    TransmittanceB,
    /// First distance of the scattering walk along the ray that leaves the vertex.
    Distance,
    /// First guided distance along the ray that leaves the vertex, where it has a guided and an
    /// unguided flight.
    GuidedDistance,
    /// Choice of a light for next-event estimation.
    LightPick,
    /// Choice of a part of that light, such as a cell of a volume.
    LightCell,
    /// First coordinate of the point on or in that part.
    LightX,
    /// Second coordinate of the point on or in that part.
    LightY,
    /// Third coordinate of the point in that part.
    LightZ,
    /// Jitter of the emission walk's reads along the shadow ray.
    LightEmission,
    /// Jitter of the transmittance estimate along the shadow ray.
    LightTransmittanceA,
    /// Second jitter of the transmittance estimate along the shadow ray.
    LightTransmittanceB,
    /// Rounding of the number of light samples of fires.
    FireCount,
    /// Rounding of the number of light samples of other lights.
    LampCount,
    /// Rounding of the number of emission walks along the ray that leaves the vertex.
    WalkCount,
    /// Rounding of the number of guided flights along the ray that leaves the vertex.
    GuidedCount,
    /// Choice of a lobe of the phase function or material to scatter by; not at vertex 0.
    DirectionPick,
    /// First coordinate of the scattered direction; not at vertex 0.
    DirectionX,
    /// Second coordinate of the scattered direction; not at vertex 0.
    DirectionY,
}

impl Slot {
    /// The row of the table above and the place in it.
    const fn place(self) -> (u32, usize) {
        match self {
            Self::PixelX | Self::DirectionX => (0, 0),
            Self::PixelY | Self::DirectionY => (0, 1),
            Self::Emission => (0, 2),
            Self::TransmittanceA => (0, 3),
            Self::Distance => (1, 0),
            Self::GuidedDistance => (1, 1),
            Self::Time | Self::DirectionPick => (1, 2),
            Self::TransmittanceB => (1, 3),
            Self::LensX | Self::LightX => (2, 0),
            Self::LensY | Self::LightY => (2, 1),
            Self::LightCell => (2, 2),
            Self::LightPick => (2, 3),
            Self::LightEmission => (3, 0),
            Self::LightTransmittanceA => (3, 1),
            Self::LightZ => (3, 2),
            Self::LightTransmittanceB => (3, 3),
            Self::FireCount => (4, 0),
            Self::LampCount => (4, 1),
            Self::WalkCount => (4, 2),
            Self::GuidedCount => (4, 3),
        }
    }
}

/// The random numbers of one path: (seed, pixel, sample) fixes them all, so that any path can be
/// walked again and the number of threads changes nothing.
///
/// Most are independent. Those asked for by [`Slot`] are, in the first vertices of a
/// [`PathRng::stratified`] path, spread evenly over the samples of the pixel: each is uniform and
/// independent of everything else of the same path, but the samples of one randomization of the
/// pixel ([`ACCUMULATORS`]) make room for each other. The camera ray's `Emission` of neighboring
/// pixels makes room as well, so that the noise of few samples is fine grain (after Georgiev and
/// Fajardo 2016, *Blue-noise dithered sampling*).
#[derive(Clone, Debug)]
pub struct PathRng {
    random: Xoshiro128PlusPlus,
    /// Key of the scrambling of all slots: (seed, pixel, randomization).
    key: u64,
    /// Number of the sample among those of its randomization.
    index: u32,
    /// Number of the vertex that the slots belong to.
    vertex: u32,
    /// Number of the light sample that the slots `Light*` belong to.
    light_sample: u32,
    /// Number of vertices with stratified slots, both branches counted.
    stratified_vertices: u32,
    /// The row that `shuffled` is for, by vertex; none yet where it is the largest number.
    shuffled_row: u32,
    /// `index` in the order of that row.
    shuffled: u32,
    /// The pixel on the tile of blue noise, which lies elsewhere in every randomization.
    tile_position: UVec2,
}

impl PathRng {
    /// The generator of one sample of one pixel, everything random.
    pub fn new(seed: u64, pixel: UVec2, sample: u32) -> Self {
        Self::with_key(pixel_key(seed, pixel), sample)
    }

    /// The generator of one sample of one pixel with the slots of the first vertices spread evenly
    /// over the samples.
    pub fn stratified(seed: u64, pixel: UVec2, sample: u32) -> Self {
        const RANDOMIZATIONS: u32 = ACCUMULATORS as u32;
        let randomization = sample % RANDOMIZATIONS;
        let key = pixel_key(seed, pixel);
        Self {
            // The complement keeps clear of the keys of single samples.
            key: mix(!key ^ u64::from(randomization)),
            index: sample / RANDOMIZATIONS,
            stratified_vertices: 2 * STRATIFIED_VERTICES,
            tile_position: pixel.wrapping_add(tile_offset(seed, randomization)),
            ..Self::with_key(key, sample)
        }
    }

    fn with_key(key: u64, sample: u32) -> Self {
        Self {
            random: Xoshiro128PlusPlus::seed_from_u64(mix(key ^ u64::from(sample))),
            key: 0,
            index: 0,
            vertex: 0,
            light_sample: 0,
            stratified_vertices: 0,
            shuffled_row: u32::MAX,
            shuffled: 0,
            tile_position: UVec2::ZERO,
        }
    }

    /// Enters vertex `index` of the path (0: the camera): slots mean that vertex's from now on.
    #[inline]
    pub fn enter_vertex(&mut self, index: u32) {
        self.vertex = if index < STRATIFIED_VERTICES { index } else { u32::MAX };
    }

    /// Enters vertex `index`, counted from the camera, of the path's second branch.
    #[inline]
    pub fn enter_vertex_of_branch(&mut self, index: u32) {
        let stratified = index < STRATIFIED_VERTICES;
        self.vertex = if stratified { STRATIFIED_VERTICES + index } else { u32::MAX };
    }

    /// Begins light sample `index` of the present vertex: the slots `Light*` mean that sample's
    /// from now on. Each sample has numbers of its own, whichever others are drawn.
    #[inline]
    pub fn enter_light_sample(&mut self, index: u32) {
        self.light_sample = index;
    }

    /// The number in [0, 1) for `slot` of the present vertex, in steps of 2⁻²⁴. Ask for it at most
    /// once a vertex, or once a light sample: in the first vertices it would be the same number
    /// again.
    #[inline]
    pub fn at(&mut self, slot: Slot) -> f32 {
        if self.vertex < self.stratified_vertices {
            unit(self.stratified_bits(slot))
        } else {
            self.uniform()
        }
    }

    /// [`PathRng::at`] in steps of 2⁻⁵³, for picks among millions.
    #[inline]
    pub fn at64(&mut self, slot: Slot) -> f64 {
        const SCALE: f64 = 1.0 / (1u64 << 53) as f64;
        let low = u64::from(self.bits());
        let high = if self.vertex < self.stratified_vertices {
            self.stratified_bits(slot)
        } else {
            self.bits()
        };
        ((u64::from(high) << 21) | (low >> 11)) as f64 * SCALE
    }

    /// A number uniform in [0, 1).
    #[inline]
    pub fn uniform(&mut self) -> f32 {
        unit(self.bits())
    }

    /// A number with density exp(-x), x >= 0: the optical distance to a collision.
    #[inline]
    pub fn exponential(&mut self) -> f32 {
        -(1.0 - self.uniform()).ln()
    }

    /// [`PathRng::exponential`] from the number for `slot`.
    #[inline]
    pub fn exponential_at(&mut self, slot: Slot) -> f32 {
        -(1.0 - self.at(slot)).ln()
    }

    #[inline]
    fn bits(&mut self) -> u32 {
        match self.random.try_next_u32() {
            Ok(bits) => bits,
        }
    }

    #[inline]
    fn stratified_bits(&mut self, slot: Slot) -> u32 {
        let (row, dimension) = slot.place();
        let row = match row {
            // A light sample has rows of its own.
            2 | 3 => self.vertex * ROWS + row + ALL_ROWS * self.light_sample,
            _ => self.vertex * ROWS + row,
        };
        if row != self.shuffled_row {
            self.shuffled_row = row;
            self.shuffled = match self.index {
                index @ 0..2 => index,
                index => sobol::shuffled_index(index, self.key_of(row, sobol::DIMENSIONS)),
            };
        }
        let key = self.key_of(row, dimension);
        let bits = sobol::scrambled_point(self.shuffled, dimension, key);
        if slot == Slot::Emission && self.vertex == 0 {
            bits ^ sobol::scrambled_point(0, dimension, key) ^ self.first_bits(key)
        } else {
            bits
        }
    }

    /// Key that scrambles a dimension of a row, or after the last dimension its order.
    #[inline]
    fn key_of(&self, row: u32, dimension: usize) -> u64 {
        // Odd multiples of 2⁶⁴ over the golden ratio never meet for different small factors.
        let number = u64::from(row) * 8 + dimension as u64;
        mix(self.key ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// The first number of the camera ray's `Emission` in this pixel and randomization, of which
    /// the bits below the rank are random. Flipping all later numbers alike leaves them the Owen
    /// scrambling they were.
    fn first_bits(&self, key: u64) -> u32 {
        let rank = blue_noise::rank(self.tile_position);
        (rank << (u32::BITS - blue_noise::RANK_BITS))
            | (mix(key) >> 32) as u32 >> blue_noise::RANK_BITS
    }
}

/// The highest 24 bits as a number in [0, 1).
#[inline]
fn unit(bits: u32) -> f32 {
    const SCALE: f32 = 1.0 / (1 << 24) as f32;
    (bits >> 8) as f32 * SCALE
}

/// Offset of the tile of blue noise in a randomization: random by the seed, and for those of one
/// seed far from each other, so that no two of them ever agree.
fn tile_offset(seed: u64, randomization: u32) -> UVec2 {
    let place = mix(!mix(seed)) as u32;
    // A lattice whose nearest points of eight are 22 pixels apart on a tile of 64.
    let step = UVec2::new(8, 24) * randomization;
    UVec2::new(place % blue_noise::SIDE, (place >> 16) % blue_noise::SIDE) + step
}

fn pixel_key(seed: u64, pixel: UVec2) -> u64 {
    let place = (u64::from(pixel.y) << 32) | u64::from(pixel.x);
    mix(mix(seed) ^ place)
}

impl TryRng for PathRng {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        self.random.try_next_u32()
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        self.random.try_next_u64()
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        self.random.try_fill_bytes(bytes)
    }
}

/// The finalizer of SplitMix64: every input bit reaches every output bit.
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seed_pixel_and_sample_each_change_the_numbers() {
        let first = |seed, x, y, sample| PathRng::new(seed, UVec2::new(x, y), sample).uniform();
        let base = first(0, 1, 2, 3);
        assert_eq!(base, first(0, 1, 2, 3));
        for other in [first(1, 1, 2, 3), first(0, 2, 1, 3), first(0, 1, 2, 4)] {
            assert_ne!(base, other);
        }
    }

    #[test]
    fn the_exponential_is_finite_and_has_mean_one() {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let n = 1 << 20;
        let sum: f64 = (0..n).map(|_| f64::from(rng.exponential())).sum();
        // Standard error 1e-3; five of them.
        assert!((sum / f64::from(n) - 1.0).abs() < 5e-3);
    }

    /// The first slots, which the camera alone has.
    const AT_CAMERA: usize = 5;
    const SLOTS: [Slot; 25] = [
        Slot::PixelX,
        Slot::PixelY,
        Slot::Time,
        Slot::LensX,
        Slot::LensY,
        Slot::Emission,
        Slot::TransmittanceA,
        Slot::TransmittanceB,
        Slot::Distance,
        Slot::GuidedDistance,
        Slot::LightPick,
        Slot::LightCell,
        Slot::LightX,
        Slot::LightY,
        Slot::LightZ,
        Slot::LightEmission,
        Slot::LightTransmittanceA,
        Slot::LightTransmittanceB,
        Slot::DirectionPick,
        Slot::DirectionX,
        Slot::DirectionY,
        Slot::FireCount,
        Slot::LampCount,
        Slot::WalkCount,
        Slot::GuidedCount,
    ];

    /// The number of a slot, at a vertex that has it.
    fn number(seed: u64, pixel: UVec2, sample: u32, slot: Slot, vertex: u32) -> f64 {
        let mut rng = PathRng::stratified(seed, pixel, sample);
        rng.enter_vertex(vertex);
        f64::from(rng.at(slot))
    }

    #[test]
    fn slots_share_numbers_only_between_the_camera_and_later_vertices() {
        for (i, a) in SLOTS.iter().enumerate() {
            for b in &SLOTS[..i] {
                let pixel_and_turn = matches!(b, Slot::PixelX | Slot::PixelY | Slot::Time)
                    && matches!(a, Slot::DirectionX | Slot::DirectionY | Slot::DirectionPick);
                let lens_and_light = matches!(b, Slot::LensX | Slot::LensY)
                    && matches!(a, Slot::LightX | Slot::LightY);
                let at_camera = pixel_and_turn || lens_and_light;
                assert!(a.place() != b.place() || at_camera, "{a:?} and {b:?}");
            }
        }
    }

    /// Sixty-four samples of a randomization have one number in each sixty-fourth, and for the
    /// pairs that matter most one point in each box of each shape; 24 and 53 bits alike.
    #[test]
    fn samples_of_a_randomization_are_spread_evenly() {
        let pixel = UVec2::new(3, 70);
        let randomizations = ACCUMULATORS as u32;
        for randomization in 0..randomizations {
            for (x, y) in [(Slot::PixelX, Slot::PixelY), (Slot::LightX, Slot::LightY)] {
                let points: Vec<[f64; 2]> = (0..64)
                    .map(|i| {
                        let mut rng =
                            PathRng::stratified(1, pixel, i * randomizations + randomization);
                        rng.enter_vertex(STRATIFIED_VERTICES - 1);
                        [f64::from(rng.at(x)), rng.at64(y)]
                    })
                    .collect();
                for across in [1, 2, 4, 8, 16, 32, 64] {
                    let down = 64 / across;
                    let boxes: std::collections::HashSet<u32> = points
                        .iter()
                        .map(|p| {
                            (p[0] * f64::from(across)) as u32 * down
                                + (p[1] * f64::from(down)) as u32
                        })
                        .collect();
                    assert_eq!(boxes.len(), 64, "{x:?} {y:?}: {across} by {down}");
                }
            }
        }
    }

    #[test]
    fn later_vertices_and_plain_paths_are_random() {
        let mut plain = PathRng::new(0, UVec2::ONE, 5);
        let mut stratified = PathRng::stratified(0, UVec2::ONE, 5);
        stratified.enter_vertex(STRATIFIED_VERTICES);
        for slot in SLOTS {
            assert_eq!(plain.at(slot), stratified.at(slot));
            assert_eq!(plain.at64(slot), stratified.at64(slot));
        }
        let drawn = plain.at(Slot::DirectionX);
        assert_ne!(drawn, plain.at(Slot::DirectionX));
    }

    /// z of the correlation of two numbers over the first eight samples of one randomization of
    /// many pixels; sums over a pixel count once, as its samples depend on each other.
    fn correlation(a: impl Fn(UVec2, u32) -> f64, b: impl Fn(UVec2, u32) -> f64) -> f64 {
        let pixels = (0..2048).map(|i| UVec2::new(i % 64, i / 64));
        let sums = pixels.map(|pixel| {
            let samples = (0..8).map(|i| i * ACCUMULATORS as u32);
            samples.map(|s| (a(pixel, s) - 0.5) * (b(pixel, s) - 0.5)).sum::<f64>()
        });
        let (n, sum, squares) = sums.fold((0.0, 0.0, 0.0), |(n, sum, squares), value| {
            (n + 1.0, sum + value, squares + value * value)
        });
        sum / f64::sqrt(squares - sum * sum / n)
    }

    /// Numbers of different slots, vertices, randomizations, pixels and seeds are uncorrelated.
    /// Some 200 comparisons, each with |z| < 5: a false alarm has probability 1e-4, and a
    /// correlation of 0.1 gives z around 13.
    #[test]
    fn numbers_for_different_purposes_are_uncorrelated() {
        let check = |z: f64, what: &str| {
            assert!(z.abs() < 5.0, "{what}: z {z}");
        };
        let of = |slot, vertex| move |pixel, s| number(0, pixel, s, slot, vertex);
        for (i, &a) in SLOTS[AT_CAMERA..].iter().enumerate() {
            for &b in &SLOTS[AT_CAMERA..AT_CAMERA + i] {
                check(correlation(of(a, 1), of(b, 1)), &format!("{a:?} and {b:?}"));
            }
            check(correlation(of(a, 1), of(a, 2)), &format!("{a:?} of two vertices"));
            let other = |pixel, s| number(0, pixel, s + 3, a, 1);
            check(correlation(of(a, 1), other), &format!("{a:?} of two randomizations"));
            let other = |pixel, s| number(1, pixel, s, a, 1);
            check(correlation(of(a, 1), other), &format!("{a:?} of two seeds"));
            for step in [UVec2::X, UVec2::Y, UVec2::ONE] {
                let other = |pixel: UVec2, s| number(0, pixel + step, s, a, 1);
                check(correlation(of(a, 1), other), &format!("{a:?} of pixels {step} apart"));
            }
        }
    }

    /// Integrals over seeds of functions of all slots, with sample counts that are no powers of
    /// two, agree with their values. 60 comparisons with |z| < 5.
    #[test]
    fn means_are_unbiased() {
        for samples in [1, 3, 11, 100] {
            for (k, &slot) in SLOTS[AT_CAMERA..].iter().enumerate() {
                let other = SLOTS[AT_CAMERA + (k + 5) % (SLOTS.len() - AT_CAMERA)];
                // cos(2πk u) + (u < 1/3) v² with mean 1/9.
                let value = |seed, s| {
                    let mut rng = PathRng::stratified(seed, UVec2::new(9, 4), s);
                    rng.enter_vertex(2);
                    let (u, v) = (rng.at64(slot), rng.at64(other));
                    let step = if u < 1.0 / 3.0 { v * v } else { 0.0 };
                    (std::f64::consts::TAU * (k + 1) as f64 * u).cos() + step
                };
                let means = (0..2000).map(|seed| {
                    (0..samples).map(|s| value(seed, s)).sum::<f64>() / f64::from(samples)
                });
                let (n, sum, squares) = means.fold((0.0, 0.0, 0.0), |(n, sum, squares), m| {
                    (n + 1.0, sum + m, squares + m * m)
                });
                let error = f64::sqrt((squares / n - (sum / n) * (sum / n)) / n);
                let z = (sum / n - 1.0 / 9.0) / error;
                assert!(z.abs() < 5.0, "{slot:?}, {samples} samples: {} ± {error}", sum / n);
            }
        }
    }

    /// The camera ray's `Emission` over seeds: uniform, evenly spread in every randomization,
    /// independent of other slots and randomizations.
    #[test]
    fn the_number_on_the_tile_is_a_number_like_any_other() {
        let of = |slot, step| {
            move |at: UVec2, s| {
                number(u64::from(at.x + 64 * at.y), UVec2::new(3, 5), s + step, slot, 0)
            }
        };
        let emission = of(Slot::Emission, 0);
        for slot in [Slot::PixelX, Slot::PixelY, Slot::TransmittanceA, Slot::Distance, Slot::Time] {
            let z = correlation(emission, of(slot, 0));
            assert!(z.abs() < 5.0, "{slot:?}: z {z}");
        }
        for step in 1..ACCUMULATORS as u32 {
            let z = correlation(emission, of(Slot::Emission, step));
            assert!(z.abs() < 5.0, "randomization {step}: z {z}");
        }
        let samples =
            [0, 8, 16, 24].map(|s| move |seed| number(seed, UVec2::ONE, s, Slot::Emission, 0));
        let mut counts = [[0.0; 16]; 4];
        for seed in 0..8000 {
            let quarters = samples.map(|sample| (4.0 * sample(seed)) as u32);
            let mut sorted = quarters;
            sorted.sort_unstable();
            assert_eq!(sorted, [0, 1, 2, 3]);
            for (counts, sample) in counts.iter_mut().zip(samples) {
                counts[(16.0 * sample(seed)) as usize] += 1.0;
            }
        }
        for counts in counts {
            let chi_square: f64 = counts.iter().map(|n| (n - 500.0f64).powi(2) / 500.0).sum();
            // Fifteen degrees of freedom; 1e-5 of all lie above.
            assert!(chi_square < 51.0, "{chi_square}");
        }
    }

    /// Sums over boxes of 8 by 8 pixels of the camera ray's first `Emission` scatter far less than
    /// those of independent numbers (0.05 to 0.08 as much), in one randomization and over all.
    #[test]
    fn neighboring_pixels_make_room_for_each_other() {
        for samples in [1, 2, 8] {
            let mut squares = 0.0;
            for i in 0..256 {
                let corner = UVec2::new(i % 16, i / 16) * 8;
                let pixels = (0..64).map(|k| corner + UVec2::new(k % 8, k / 8));
                let numbers = pixels.flat_map(|pixel| {
                    (0..samples).map(move |s| number(7, pixel, s, Slot::Emission, 0) - 0.5)
                });
                squares += numbers.sum::<f64>().powi(2) / 256.0;
            }
            let independent = f64::from(samples) * 64.0 / 12.0;
            assert!(squares < 0.15 * independent, "{samples} samples: {squares}");
        }
    }
}
