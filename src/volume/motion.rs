//! Motion of a volume within a frame: its grids are carried along by a velocity field.
//!
//! The coefficients at a point x and a time t, counted from that of the grids, are the grids' at
//! x − t v(x): the field is looked up where the light is, so that one look-up leads back.

use glam::{Mat3A, Vec3A};

use super::field::{GridField, ScalarField};
use crate::math::Aabb;

/// The time in which a picture sees the volumes. Every path has one moment of it, uniformly
/// distributed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shutter {
    /// Time of the frame, in seconds after that of the volumes' grids.
    pub frame: f32,
    /// Seconds that the shutter is open, half of them before the time of the frame.
    pub open: f32,
}

impl Shutter {
    /// The opening and the closing, in seconds after the time of the grids.
    fn ends(&self) -> [f32; 2] {
        [self.frame - 0.5 * self.open, self.frame + 0.5 * self.open]
    }
}

/// A field of velocities over the space of a volume, zero outside of its grids. The vectors have
/// axes and units of their own.
#[derive(Clone, Debug)]
pub enum VelocityField {
    /// Vectors at the centers of voxels.
    Centers(GridField<Vec3A>),
    /// Vectors with each component at the faces across its axis: the same grid three times, placed
    /// for its x, its y and its z.
    Faces([GridField<Vec3A>; 3]),
    /// One field for each component.
    Components([ScalarField; 3]),
}

impl VelocityField {
    /// The velocity at a point of the volume's space.
    fn at(&self, local: Vec3A) -> Vec3A {
        match self {
            Self::Centers(grid) => grid.at(local),
            Self::Faces([x, y, z]) => Vec3A::new(x.at(local).x, y.at(local).y, z.at(local).z),
            Self::Components([x, y, z]) => Vec3A::new(x.at(local), y.at(local), z.at(local)),
        }
    }

    /// Lower and upper bounds of the components over a box of the volume's space.
    fn range(&self, local: &Aabb) -> (Vec3A, Vec3A) {
        match self {
            Self::Centers(grid) => grid.range(local),
            Self::Faces([x, y, z]) => {
                let [(low_x, high_x), (low_y, high_y), (low_z, high_z)] =
                    [x, y, z].map(|grid| grid.range(local));
                let low = Vec3A::new(low_x.x, low_y.y, low_z.z);
                (low, Vec3A::new(high_x.x, high_y.y, high_z.z))
            }
            Self::Components(fields) => {
                let [x, y, z] = [0, 1, 2].map(|axis: usize| fields[axis].range(local));
                (Vec3A::new(x.0, y.0, z.0), Vec3A::new(x.1, y.1, z.1))
            }
        }
    }
}

/// The motion of a volume while the shutter is open.
#[derive(Clone, Debug)]
pub struct Motion {
    velocity: VelocityField,
    /// A box of the volume's space outside of which nothing moves.
    support: Aabb,
    /// From the axes and units of the field to lengths of the volume's space per second.
    local_from_velocity: Mat3A,
    /// The box that the volume fills at the time of its grids.
    still: Aabb,
    shutter: Shutter,
}

/// Cells along each edge in which the places that something can move to are searched.
const SEARCHED: usize = 16;
/// Rounding of a displacement, relative to its largest component.
const ROUNDING: f32 = 1e-5;

impl Motion {
    /// Motion of a volume that fills the box `still` at the time of its grids, by a field that is
    /// zero outside of the box `support`. `local_from_velocity` leads from the axes and units of
    /// the field to lengths of the volume's space per second.
    pub fn new(
        velocity: VelocityField,
        support: Aabb,
        local_from_velocity: Mat3A,
        still: Aabb,
        shutter: Shutter,
    ) -> Self {
        Self { velocity, support, local_from_velocity, still, shutter }
    }

    /// The time in which the volume is seen.
    pub fn shutter(&self) -> Shutter {
        self.shutter
    }

    /// The point that has moved to `local` at a time, in seconds after that of the frame; `None`
    /// where there is nothing.
    // In line it would crowd the loops of volumes that stand still.
    #[inline(never)]
    pub(super) fn source(&self, local: Vec3A, time: f32) -> Option<Vec3A> {
        let velocity = self.local_from_velocity * self.velocity.at(local);
        Some(local - (self.shutter.frame + time) * velocity)
            .filter(|source| self.still.contains(*source))
    }

    /// A box around the points that may move into `cell` while the shutter is open; where nothing
    /// in the cell moves, the cell itself.
    fn sources(&self, cell: &Aabb) -> Aabb {
        match self.displacements(cell) {
            Some((low, high)) => Aabb { min: cell.min - high, max: cell.max - low },
            None => Aabb { min: Vec3A::NEG_INFINITY, max: Vec3A::INFINITY },
        }
    }

    /// The part of [`Motion::sources`] that is not empty at the time of the grids, and whether that
    /// is all of it.
    pub(super) fn filled_sources(&self, cell: &Aabb) -> (Aabb, bool) {
        let sources = self.sources(cell);
        let filled = sources.intersection(&self.still);
        (filled, filled == sources)
    }

    /// Lower and upper bounds of the ways that lead into a box; `None` where they are not finite.
    fn displacements(&self, cell: &Aabb) -> Option<(Vec3A, Vec3A)> {
        let (low, high) = self.velocity.range(cell);
        let columns = self.local_from_velocity;
        let largest = absolute(columns) * low.abs().max(high.abs());
        if largest == Vec3A::ZERO {
            return Some((Vec3A::ZERO, Vec3A::ZERO));
        }
        let middle = columns * (0.5 * low + 0.5 * high);
        let half = absolute(columns) * (0.5 * high - 0.5 * low);
        let [opens, closes] = self.shutter.ends();
        let ends = [middle - half, middle + half].map(|v| (opens * v, closes * v));
        let all = [ends[0].0, ends[0].1, ends[1].0, ends[1].1];
        let longest = largest.max_element() * opens.abs().max(closes.abs());
        let places = cell.min.abs().max(cell.max.abs()).max_element();
        let slack = Vec3A::splat(ROUNDING * longest + 4.0 * f32::EPSILON * places);
        let least = all.into_iter().fold(Vec3A::INFINITY, Vec3A::min) - slack;
        let most = all.into_iter().fold(Vec3A::NEG_INFINITY, Vec3A::max) + slack;
        let is_finite = least.is_finite() && most.is_finite() && largest.is_finite();
        is_finite.then_some((least, most))
    }

    /// A box around all places where the volume can be while the shutter is open.
    pub(super) fn reach(&self) -> Aabb {
        let still = self.still;
        let near = match self.displacements(&self.support) {
            Some((low, high)) => Aabb { min: still.min + low, max: still.max + high },
            None => self.support,
        };
        let candidates = near.intersection(&self.support);
        if candidates.is_empty() || still.is_empty() {
            return still;
        }
        // One fast voxel far away reaches all, and few others do.
        let face =
            |count: usize| candidates.min + candidates.size() * (count as f32 / SEARCHED as f32);
        let cells = (0..SEARCHED * SEARCHED * SEARCHED).map(|index| {
            let at = [index % SEARCHED, index / SEARCHED % SEARCHED, index / (SEARCHED * SEARCHED)];
            let edge = |step: usize| {
                Vec3A::new(face(at[0] + step).x, face(at[1] + step).y, face(at[2] + step).z)
            };
            Aabb { min: edge(0), max: edge(1) }
        });
        let reached = cells.filter(|cell| !self.filled_sources(cell).0.is_empty());
        reached.fold(still, |all, cell| all.union(&cell))
    }
}

/// A matrix of the magnitudes.
fn absolute(matrix: Mat3A) -> Mat3A {
    Mat3A::from_cols(matrix.x_axis.abs(), matrix.y_axis.abs(), matrix.z_axis.abs())
}

#[cfg(test)]
mod tests;
