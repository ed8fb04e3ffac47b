//! Scalar and color fields in a volume's own space: stored grids and procedural shapes alike.

use std::sync::Arc;

use glam::{Affine3A, Vec3A};

use super::{
    curve::Curve,
    grid::{SparseGrid, Voxel},
    procedural::{Noise, Ramp},
    taper::{Gather, Taper},
};
use crate::math::{Aabb, Rgb};

/// A grid placed in the space of a volume whose first grid may be another one.
#[derive(Clone, Debug)]
pub struct GridField<V: Voxel> {
    grid: Arc<SparseGrid<V>>,
    place: Place,
    /// Box of the grid in its index space, whatever other grids the volume has.
    support: Aabb,
}

/// The way from the volume's space to the grid's index space.
#[derive(Clone, Debug)]
enum Place {
    /// They are one.
    Same,
    Affine(Affine3A),
    /// Through the grid's spread space.
    Tapered(Affine3A, Gather),
}

impl<V: Voxel> GridField<V> {
    /// Places `grid` in a volume's space. An identity placement costs nothing at look-up. With a
    /// `taper`, the transform leads to the grid's spread space, and the grid must lie before the
    /// tip of the frustum ([`Taper::holds`]).
    pub fn new(grid: Arc<SparseGrid<V>>, grid_from_local: Affine3A, taper: Option<&Taper>) -> Self {
        let support = grid_support(&grid);
        let place = match taper {
            Some(taper) => Place::Tapered(grid_from_local, Gather::new(taper)),
            None if grid_from_local.abs_diff_eq(Affine3A::IDENTITY, 1e-6) => Place::Same,
            None => Place::Affine(grid_from_local),
        };
        Self { grid, place, support }
    }

    /// Trilinear value at a point of the volume's space, 0 outside of the grid's box.
    #[inline]
    pub fn at(&self, local: Vec3A) -> V {
        self.inside(local).unwrap_or(V::ZERO)
    }

    /// Trilinear value at a point of the volume's space; `None` outside of the grid's box.
    #[inline]
    fn inside(&self, local: Vec3A) -> Option<V> {
        let index = match &self.place {
            Place::Same => local,
            Place::Affine(transform) => transform.transform_point3a(local),
            Place::Tapered(transform, gather) => gather.point(transform.transform_point3a(local)),
        };
        if (index.cmplt(self.support.min) | index.cmpgt(self.support.max)).any() {
            return None;
        }
        Some(self.grid.sample(index))
    }

    /// Lower and upper bound of the values over a box of the volume's space.
    pub fn range(&self, local: &Aabb) -> (V, V) {
        let (index, is_whole) = match &self.place {
            Place::Same => (*local, true),
            Place::Affine(transform) => (local.transformed(transform), true),
            Place::Tapered(transform, gather) => {
                let around = gather.boxed(&local.transformed(transform), &self.support);
                let Some(index) = around else { return (V::ZERO, V::ZERO) };
                (index, false)
            }
        };
        let (min, max) = self.grid.range(index.min.into(), index.max.into());
        let inside = index.min.cmpge(self.support.min) & index.max.cmple(self.support.max);
        if is_whole && inside.all() {
            return (min, max);
        }
        (min.component_min(V::ZERO), max.component_max(V::ZERO))
    }
}

/// The box a grid fills in its index space: half a voxel beyond its stored values.
pub fn grid_support<V: Voxel>(grid: &SparseGrid<V>) -> Aabb {
    match grid.bounds() {
        None => Aabb::EMPTY,
        Some(bounds) => Aabb::new(
            bounds.min.as_vec3a() - Vec3A::splat(0.5),
            bounds.max.as_vec3a() + Vec3A::splat(0.5),
        ),
    }
}

/// A scalar at each point of a volume.
#[derive(Clone, Debug)]
pub enum ScalarField {
    /// A constant value.
    Constant(f32),
    /// A stored grid.
    Grid(GridField<f32>),
    /// A gradient along one axis.
    Ramp(Ramp),
    /// Fractal noise.
    Noise(Noise),
    /// A function of another field's value.
    Curved(Box<Curved>),
}

/// Relative rounding of interpolated values.
const ROUNDING: f32 = 8.0 * f32::EPSILON;

/// A curve over the values of a field; a grid is 0 outside of its box, whatever the curve.
#[derive(Clone, Debug)]
pub struct Curved {
    curve: Curve,
    field: ScalarField,
}

impl Curved {
    #[inline]
    fn at(&self, local: Vec3A) -> f32 {
        match &self.field {
            ScalarField::Grid(grid) => grid.inside(local).map_or(0.0, |value| self.curve.at(value)),
            field => self.curve.at(field.at(local)),
        }
    }

    fn range(&self, local: &Aabb) -> (f32, f32) {
        let (low, high) = self.field.range(local);
        // Interpolated values may lie beyond those that they are made of by rounding, which a steep
        // curve would show.
        let slack = ROUNDING * low.abs().max(high.abs());
        let (least, most) = self.curve.range(low - slack, high + slack);
        match self.field {
            // The range of a box that reaches beyond the grid's has the 0 from there.
            ScalarField::Grid(_) if low <= 0.0 => (least.min(0.0), most.max(0.0)),
            _ => (least, most),
        }
    }
}

impl ScalarField {
    /// This field through a curve, if there is one.
    #[must_use]
    pub fn through(self, curve: Option<Curve>) -> Self {
        match (self, curve) {
            (field, None) => field,
            (Self::Constant(value), Some(curve)) => Self::Constant(curve.at(value)),
            (field, Some(curve)) => Self::Curved(Box::new(Curved { curve, field })),
        }
    }

    /// The value at a point.
    #[inline]
    pub fn at(&self, local: Vec3A) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Grid(grid) => grid.at(local),
            Self::Ramp(ramp) => ramp.at(local),
            Self::Noise(noise) => noise.at(local),
            Self::Curved(curved) => curved.at(local),
        }
    }

    /// Bounds of the values over a box.
    pub fn range(&self, local: &Aabb) -> (f32, f32) {
        match self {
            Self::Constant(value) => (*value, *value),
            Self::Grid(grid) => grid.range(local),
            Self::Ramp(ramp) => ramp.range(local),
            Self::Noise(noise) => noise.range(local),
            Self::Curved(curved) => curved.range(local),
        }
    }
}

/// A color at each point of a volume.
#[derive(Clone, Debug)]
pub enum RgbField {
    /// A constant color.
    Constant(Rgb),
    /// A scalar field times a color.
    Tinted(ScalarField, Rgb),
    /// A stored grid of colors.
    Grid(GridField<Vec3A>),
}

impl RgbField {
    /// The value at a point.
    #[inline]
    pub fn at(&self, local: Vec3A) -> Rgb {
        match self {
            Self::Constant(value) => *value,
            Self::Tinted(field, tint) => field.at(local) * *tint,
            Self::Grid(grid) => grid.at(local),
        }
    }

    /// Whether all channels are known to be equal everywhere, without a read of the field.
    #[inline]
    pub fn is_gray(&self) -> bool {
        match self {
            Self::Constant(value) | Self::Tinted(_, value) => *value == Rgb::splat(value.x),
            Self::Grid(_) => false,
        }
    }

    /// Upper bounds of the channels over a box.
    pub fn upper_bound(&self, local: &Aabb) -> Rgb {
        match self {
            Self::Constant(value) => *value,
            Self::Tinted(field, tint) => {
                let (min, max) = field.range(local);
                (min * *tint).max(max * *tint)
            }
            Self::Grid(grid) => grid.range(local).1,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{IVec3, UVec2, UVec3};

    use super::*;
    use crate::math::PathRng;

    /// A grid of random values, placed askew, through a curve: no value of a box leaves its range,
    /// inside of the grid, across its border and outside.
    #[test]
    fn ranges_of_curved_grids_hold_every_value() {
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let values: Vec<f32> = (0..216).map(|_| rng.uniform()).collect();
        let size = UVec3::splat(6);
        let grid = SparseGrid::from_dense(IVec3::splat(-3), size, &values, 0.0).unwrap();
        let place = Affine3A::from_rotation_z(0.4);
        let field = ScalarField::Grid(GridField::new(Arc::new(grid), place, None));
        let valley = &[[0.0, 3.0], [0.5, 1.0], [1.0, 2.0]][..];
        let peak = &[[0.0, 0.5], [0.5, 5.0], [1.0, 0.0]];
        let curves = [valley, peak, &[[0.2, 0.0], [0.200_01, 5.0]]];
        for points in curves {
            let curved = field.clone().through(Curve::new(points));
            let (mut outside, mut inside) = (0, 0);
            for _ in 0..2000 {
                let mut point = || Vec3A::from_array([(); 3].map(|()| 12.0 * rng.uniform() - 6.0));
                let low = point();
                let edge = 0.1 * (point() + 6.0);
                let (least, most) = curved.range(&Aabb::new(low, low + edge));
                for _ in 0..8 {
                    let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
                    let value = curved.at(low + u * edge);
                    assert!(least <= value && value <= most, "{least} to {most}: {value}");
                    let is_inside = field.at(low + u * edge) != 0.0;
                    *(if is_inside { &mut inside } else { &mut outside }) += 1;
                }
            }
            assert!(inside > 1000 && outside > 1000, "{inside} {outside}");
            assert_eq!(curved.at(Vec3A::splat(40.0)), 0.0, "outside, whatever the curve");
        }
    }
}
