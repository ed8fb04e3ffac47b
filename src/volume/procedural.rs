//! Fields from formulas: ramps and noise, each with bounds over boxes beside its value.

use glam::{IVec3, Vec3A};

use crate::math::Aabb;

/// Function of a [`Ramp`] along its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RampKind {
    /// a + b · coordinate.
    Linear {
        /// Value at the low face.
        a: f32,
        /// Slope per length.
        b: f32,
    },
    /// a · exp(−coordinate / h).
    Exponential {
        /// Value at the low face.
        a: f32,
        /// Length over which it falls to 1/e.
        h: f32,
    },
}

/// A gradient along one axis, its coordinate measured from the low face; never below zero.
#[derive(Clone, Copy, Debug)]
pub struct Ramp {
    /// Index of the axis: 0, 1 or 2.
    pub axis: usize,
    /// Position on the axis at which the coordinate is zero.
    pub low: f32,
    /// The formula.
    pub kind: RampKind,
}

impl Ramp {
    /// The value at a point.
    pub fn at(&self, p: Vec3A) -> f32 {
        self.along(p[self.axis] - self.low)
    }

    /// Bounds over a box: both kinds are monotone.
    pub fn range(&self, region: &Aabb) -> (f32, f32) {
        let (a, b) = (self.at(region.min), self.at(region.max));
        (a.min(b), a.max(b))
    }

    fn along(&self, coordinate: f32) -> f32 {
        match self.kind {
            RampKind::Linear { a, b } => (a + b * coordinate).max(0.0),
            RampKind::Exponential { a, h } => a * (-coordinate / h).exp(),
        }
    }
}

/// Fractal value noise in [0, 1]: octaves of a smoothly interpolated random lattice, each twice as
/// fine and half as strong, then spread about its middle by `contrast`.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    /// Lattice points per length in the first octave.
    pub frequency: f32,
    /// Number of octaves, 1 to 16.
    pub octaves: u32,
    /// Contrast factor: 1 leaves the noise as it is, larger values push it towards 0 and 1.
    pub contrast: f32,
    /// Seed of the lattice.
    pub seed: u32,
}

impl Noise {
    /// The value at a point.
    pub fn at(&self, p: Vec3A) -> f32 {
        let (mut sum, mut total) = (0.0, 0.0);
        for Octave { index, scale, weight } in self.octaves() {
            sum += weight * self.lattice_noise(index, scale * p);
            total += weight;
        }
        self.shaped(sum / total)
    }

    /// Bounds over a box, from the lattice values around it.
    pub fn range(&self, region: &Aabb) -> (f32, f32) {
        let (mut low, mut high, mut total) = (0.0, 0.0, 0.0);
        for Octave { index, scale, weight } in self.octaves() {
            let (min, max) = self.lattice_range(index, scale * region.min, scale * region.max);
            low += weight * min;
            high += weight * max;
            total += weight;
        }
        (self.shaped(low / total), self.shaped(high / total))
    }

    fn octaves(&self) -> impl Iterator<Item = Octave> {
        let first = Octave { index: 0, scale: self.frequency, weight: 1.0 };
        let finer = |&Octave { index, scale, weight }: &Octave| {
            Some(Octave { index: index + 1, scale: 2.0 * scale, weight: 0.5 * weight })
        };
        std::iter::successors(Some(first), finer).take(self.octaves as usize)
    }

    fn shaped(&self, value: f32) -> f32 {
        ((value - 0.5) * self.contrast + 0.5).clamp(0.0, 1.0)
    }

    fn lattice_noise(&self, octave: u32, p: Vec3A) -> f32 {
        let floor = p.floor();
        self.lattice_cell(octave, floor.as_ivec3()).at(p - floor)
    }

    /// Within a lattice cell the noise is affine in the eased coordinate of each axis, so that its
    /// extremes over a box lie at the box's corners. A box wider than a few cells meets nearly
    /// every value; to bound it tightly would cost much and gain little.
    fn lattice_range(&self, octave: u32, min: Vec3A, max: Vec3A) -> (f32, f32) {
        const WIDEST: i32 = 3;
        let (low, high) = (min.floor().as_ivec3(), max.floor().as_ivec3());
        if high.saturating_sub(low).max_element() > WIDEST {
            return (0.0, 1.0);
        }
        let mut range = (1.0_f32, 0.0_f32);
        for z in low.z..=high.z {
            for y in low.y..=high.y {
                for x in low.x..=high.x {
                    let cell = IVec3::new(x, y, z);
                    let noise = self.lattice_cell(octave, cell);
                    let corner = cell.as_vec3a();
                    let inside =
                        Aabb::new(min.max(corner) - corner, max.min(corner + 1.0) - corner);
                    for offset in inside.corners() {
                        let value = noise.at(offset);
                        range = (range.0.min(value), range.1.max(value));
                    }
                }
            }
        }
        range
    }

    /// The cell of an octave's lattice with `low` as its low corner. Corners share what they have
    /// in common of their coordinates, as far as it is hashed first.
    fn lattice_cell(&self, octave: u32, low: IVec3) -> LatticeCell {
        let hash = self.seed ^ octave.wrapping_mul(0x9e37_79b9);
        let both = |hash, low: i32| [low, low.wrapping_add(1)].map(|at| hashed(hash, at as u32));
        let corners = both(hash, low.x).map(|hash| {
            both(hash, low.y)
                .map(|hash| both(hash, low.z).map(|hash| (hash >> 8) as f32 / (1 << 24) as f32))
        });
        LatticeCell { corners }
    }
}

/// One octave of a [`Noise`].
struct Octave {
    index: u32,
    /// Lattice points per length.
    scale: f32,
    weight: f32,
}

/// A cell of a random lattice.
struct LatticeCell {
    /// Values at the cell's corners by x, y and z.
    corners: [[[f32; 2]; 2]; 2],
}

impl LatticeCell {
    /// The noise at offset `f` in [0, 1]³ from the low corner.
    fn at(&self, f: Vec3A) -> f32 {
        let s = f * f * (Vec3A::splat(3.0) - 2.0 * f);
        let [low, high] = &self.corners;
        let along_x = |y: usize, z: usize| lerp(low[y][z], high[y][z], s.x);
        lerp(lerp(along_x(0, 0), along_x(1, 0), s.y), lerp(along_x(0, 1), along_x(1, 1), s.y), s.z)
    }
}

/// Mixes one more coordinate into a hash.
fn hashed(hash: u32, coordinate: u32) -> u32 {
    let hash = (hash ^ coordinate).wrapping_mul(0x85eb_ca6b);
    let hash = (hash ^ (hash >> 15)).wrapping_mul(0xc2b2_ae35);
    hash ^ (hash >> 13)
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + t * (b - a)
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::math::PathRng;

    fn point(rng: &mut PathRng, scale: f32) -> Vec3A {
        scale * Vec3A::new(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5)
    }

    #[test]
    fn ranges_hold_every_value_inside_and_are_tight_enough_to_matter() {
        let noise = Noise { frequency: 2.0, octaves: 4, contrast: 2.5, seed: 7 };
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let mut narrower = 0;
        for _ in 0..300 {
            let min = point(&mut rng, 8.0);
            let region = Aabb::new(min, min + Vec3A::splat(0.1));
            let (low, high) = noise.range(&region);
            narrower += usize::from(high - low < 0.9);
            for _ in 0..30 {
                let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
                let value = noise.at(region.min + u * region.size());
                assert!(value >= low - 1e-5 && value <= high + 1e-5);
            }
        }
        assert!(narrower > 150, "{narrower} of 300 ranges narrower than the whole");
    }

    /// Agrees with the lattice hashed corner by corner: pictures must not change from version to
    /// version.
    #[test]
    fn noise_interpolates_a_lattice_of_hashes() {
        let noise = Noise { frequency: 1.7, octaves: 3, contrast: 1.0, seed: 7 };
        let value = |octave: u32, p: IVec3| {
            let mut hash = noise.seed ^ octave.wrapping_mul(0x9e37_79b9);
            for coordinate in p.to_array() {
                hash = (hash ^ coordinate as u32).wrapping_mul(0x85eb_ca6b);
                hash = (hash ^ (hash >> 15)).wrapping_mul(0xc2b2_ae35);
                hash ^= hash >> 13;
            }
            f64::from(hash >> 8) / f64::from(1 << 24)
        };
        let mut rng = PathRng::new(1, UVec2::ZERO, 0);
        for _ in 0..100 {
            let p = point(&mut rng, 20.0);
            let mut sum = 0.0;
            for octave in 0..3 {
                let at = 1.7 * (1 << octave) as f32 * p;
                let f = (at - at.floor()).as_dvec3();
                let s = f * f * (3.0 - 2.0 * f);
                for corner in 0..8 {
                    let offset = glam::IVec3::new(corner & 1, (corner >> 1) & 1, corner >> 2);
                    let near = offset.as_dvec3();
                    let weight = near * s + (1.0 - near) * (1.0 - s);
                    let value = value(octave, at.floor().as_ivec3() + offset);
                    sum += weight.element_product() * value * 0.5_f64.powi(octave as i32);
                }
            }
            let error = f64::from(noise.at(p)) - sum / 1.75;
            assert!(error.abs() < 1e-6, "{p}: off by {error}");
        }
    }

    #[test]
    fn ramps_start_at_the_low_face() {
        let ramp = Ramp { axis: 2, low: -1.5, kind: RampKind::Linear { a: 0.2, b: 0.3 } };
        assert!((ramp.at(Vec3A::new(0.0, 0.0, 1.5)) - 1.1).abs() < 1e-6);
        let kind = RampKind::Exponential { a: 2.0, h: 0.5 };
        let ramp = Ramp { kind, ..ramp };
        assert!((ramp.at(Vec3A::new(9.0, 0.0, -1.0)) - 2.0 / 1.0_f32.exp()).abs() < 1e-6);
    }
}
