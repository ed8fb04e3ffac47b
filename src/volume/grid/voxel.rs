//! The two kinds of value a grid can hold.

use glam::Vec3A;

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for glam::Vec3A {}
}

/// Largest magnitude a stored value may have: the difference of two such values is finite, and so
/// is everything interpolated between them.
const MAX_MAGNITUDE: f32 = f32::MAX / 2.0;

/// A voxel value: `f32` for scalar fields, [`Vec3A`] for colors and vectors.
pub trait Voxel:
    Copy + PartialEq + std::fmt::Debug + Send + Sync + sealed::Sealed + 'static
{
    /// The value of empty space when nothing else is known.
    const ZERO: Self;

    /// Number of components: 1 or 3.
    const COMPONENTS: usize;

    /// Linear interpolation: `a` at `t` = 0, `b` at `t` = 1, and exactly `a` when both agree.
    fn lerp(a: Self, b: Self, t: f32) -> Self;

    /// The smaller of each component.
    fn component_min(self, other: Self) -> Self;

    /// The larger of each component.
    fn component_max(self, other: Self) -> Self;

    /// Whether every component is finite, with room to interpolate.
    fn is_usable(self) -> bool;

    /// The bit patterns of the components (the last ones 0 for a scalar), to tell values apart.
    fn bits(self) -> [u32; 3];

    /// The components in double precision (the last ones 0 for a scalar).
    fn to_f64(self) -> [f64; 3];

    /// The component of this number, below [`Voxel::COMPONENTS`].
    fn component(self, number: usize) -> f32;

    /// The value with these components; a scalar takes the first.
    fn from_components(components: [f32; 3]) -> Self;
}

impl Voxel for f32 {
    const ZERO: Self = 0.0;
    const COMPONENTS: usize = 1;

    #[inline(always)]
    fn lerp(a: Self, b: Self, t: f32) -> Self {
        a + (b - a) * t
    }

    #[inline(always)]
    fn component_min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    #[inline(always)]
    fn component_max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    fn is_usable(self) -> bool {
        self.abs() <= MAX_MAGNITUDE
    }

    fn bits(self) -> [u32; 3] {
        [self.to_bits(), 0, 0]
    }

    fn to_f64(self) -> [f64; 3] {
        [self.into(), 0.0, 0.0]
    }

    #[inline(always)]
    fn component(self, _number: usize) -> f32 {
        self
    }

    #[inline(always)]
    fn from_components(components: [f32; 3]) -> Self {
        components[0]
    }
}

impl Voxel for Vec3A {
    const ZERO: Self = Vec3A::ZERO;
    const COMPONENTS: usize = 3;

    #[inline(always)]
    fn lerp(a: Self, b: Self, t: f32) -> Self {
        a + (b - a) * t
    }

    #[inline(always)]
    fn component_min(self, other: Self) -> Self {
        self.min(other)
    }

    #[inline(always)]
    fn component_max(self, other: Self) -> Self {
        self.max(other)
    }

    fn is_usable(self) -> bool {
        self.abs().cmple(Vec3A::splat(MAX_MAGNITUDE)).all()
    }

    fn bits(self) -> [u32; 3] {
        self.to_array().map(f32::to_bits)
    }

    fn to_f64(self) -> [f64; 3] {
        self.to_array().map(f64::from)
    }

    #[inline(always)]
    fn component(self, number: usize) -> f32 {
        self[number]
    }

    #[inline(always)]
    fn from_components(components: [f32; 3]) -> Self {
        Vec3A::from_array(components)
    }
}
