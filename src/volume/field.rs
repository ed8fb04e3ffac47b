//! Scalar and color fields in a volume's own space: stored grids and procedural shapes alike.

use std::sync::Arc;

use glam::{Affine3A, Vec3A};

use super::{
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

    /// Trilinear value at a point of the volume's space.
    #[inline]
    pub fn at(&self, local: Vec3A) -> V {
        let index = match &self.place {
            Place::Same => local,
            Place::Affine(transform) => transform.transform_point3a(local),
            Place::Tapered(transform, gather) => gather.point(transform.transform_point3a(local)),
        };
        if (index.cmplt(self.support.min) | index.cmpgt(self.support.max)).any() {
            return V::ZERO;
        }
        self.grid.sample(index)
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
}

impl ScalarField {
    /// The value at a point.
    #[inline]
    pub fn at(&self, local: Vec3A) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Grid(grid) => grid.at(local),
            Self::Ramp(ramp) => ramp.at(local),
            Self::Noise(noise) => noise.at(local),
        }
    }

    /// Bounds of the values over a box.
    pub fn range(&self, local: &Aabb) -> (f32, f32) {
        match self {
            Self::Constant(value) => (*value, *value),
            Self::Grid(grid) => grid.range(local),
            Self::Ramp(ramp) => ramp.range(local),
            Self::Noise(noise) => noise.range(local),
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
