//! Where the mass of a grid lies, by quantiles along each axis: single voxels far out are stored
//! too, and must not decide what is looked at.

use glam::{I64Vec3, IVec3};
use rayon::prelude::*;

use super::index_box::IndexBox;
use super::sparse_grid::SparseGrid;
use super::voxel::Voxel;

/// The share of the mass that may lie before and behind the core along each axis.
const TAIL: f64 = 0.01;
/// Bounds larger than the core by this factor are those of strays.
const FAR: i64 = 3;
/// Edge of the smallest cells, in voxels.
const CELL: i64 = 8;
/// Cells at most; larger grids are looked at in larger cells.
const MOST_CELLS: usize = 1 << 17;
/// Up to this many cells every voxel is read, of more 4 along each edge of a cell.
const FEW_CELLS: usize = 1 << 12;
const SAMPLES: i64 = 4;

/// A cube of voxels.
#[derive(Clone, Copy)]
struct Cell {
    min: I64Vec3,
    edge: i64,
}

/// The mass of the voxels of a box.
struct CellMass {
    voxels: IndexBox,
    mass: f64,
}

impl<V: Voxel> SparseGrid<V> {
    /// The bounds without the parts far out in which next to nothing lies: along each axis the
    /// bounds, or where these are much longer, twice the length that holds 98 % of the mass (the
    /// sum of the values above zero; of vectors of the largest components). `None` for an empty
    /// grid.
    pub fn core_bounds(&self) -> Option<IndexBox> {
        let bounds = self.bounds()?;
        let masses = self.masses(&bounds);
        let mut core = bounds;
        for axis in 0..3 {
            let Some([low, high]) = quantiles(&masses, axis) else { return Some(bounds) };
            let (low, high) = (i64::from(low), i64::from(high));
            let length = high - low + 1;
            let (first, last) = (i64::from(bounds.min[axis]), i64::from(bounds.max[axis]));
            if last - first + 1 > FAR * length {
                core.min[axis] = (low - length / 2).max(first) as i32;
                core.max[axis] = (high + length / 2).min(last) as i32;
            }
        }
        Some(core)
    }

    /// Cells that together hold all the mass, as small as their number allows.
    fn masses(&self, bounds: &IndexBox) -> Vec<CellMass> {
        let (min, max) = (bounds.min.as_i64vec3(), bounds.max.as_i64vec3());
        let longest = (max - min).max_element() + 1;
        let mut edge = CELL.max((longest as u64).next_power_of_two() as i64);
        let first = min.div_euclid(I64Vec3::splat(edge)) * edge;
        let mut cells: Vec<Cell> =
            corners().map(|at| Cell { min: first + at * edge, edge }).collect();
        let mut done = Vec::new();
        loop {
            cells.retain(|cell| {
                let Some(voxels) = cell.voxels(bounds) else { return false };
                let (low, high) = self.range_of_cells(&voxels);
                let largest = largest(high).max(0.0);
                if low == high {
                    done.push(CellMass { voxels, mass: largest * voxels.voxel_count() as f64 });
                }
                low != high && largest > 0.0
            });
            if edge == CELL || cells.len() * 8 > MOST_CELLS {
                break;
            }
            cells = cells.iter().flat_map(Cell::children).collect();
            edge /= 2;
        }
        let samples = if cells.len() <= FEW_CELLS { CELL } else { SAMPLES };
        let voxels = cells.par_iter().filter_map(|cell| cell.voxels(bounds));
        done.par_extend(voxels.map(|voxels| self.mass_of(voxels, samples)));
        done
    }

    /// The mass of a box, from every voxel or up to `samples` along each edge.
    fn mass_of(&self, voxels: IndexBox, samples: i64) -> CellMass {
        let size = voxels.max.as_i64vec3() - voxels.min.as_i64vec3() + 1;
        let step = (size / samples).max(I64Vec3::ONE);
        let counts = size / step;
        let place = |axis: usize| {
            let (first, step) = (i64::from(voxels.min[axis]), step[axis]);
            (0..counts[axis]).map(move |n| (first + n * step + step / 2) as i32)
        };
        let mut sum = 0.0;
        for x in place(0) {
            for y in place(1) {
                for z in place(2) {
                    sum += largest(self.value(IVec3::new(x, y, z))).max(0.0);
                }
            }
        }
        let share = voxels.voxel_count() as f64 / (counts.x * counts.y * counts.z).max(1) as f64;
        CellMass { voxels, mass: sum * share }
    }
}

impl Cell {
    /// The part of the cell that lies in `bounds`.
    fn voxels(&self, bounds: &IndexBox) -> Option<IndexBox> {
        let last = self.min + (self.edge - 1);
        let min = self.min.max(bounds.min.as_i64vec3());
        let max = last.min(bounds.max.as_i64vec3());
        min.cmple(max).all().then(|| IndexBox { min: min.as_ivec3(), max: max.as_ivec3() })
    }

    fn children(&self) -> impl Iterator<Item = Self> + use<> {
        let (min, edge) = (self.min, self.edge / 2);
        corners().map(move |at| Self { min: min + at * edge, edge })
    }
}

/// The eight corners of a unit cube.
fn corners() -> impl Iterator<Item = I64Vec3> {
    (0..8).map(|n| I64Vec3::new(n >> 2, n >> 1 & 1, n & 1))
}

fn largest<V: Voxel>(value: V) -> f64 {
    let components = value.to_f64();
    components.iter().take(V::COMPONENTS).copied().fold(f64::NEG_INFINITY, f64::max)
}

/// The first and the last voxel along `axis` between which all but the tails lie; `None` without
/// mass.
fn quantiles(masses: &[CellMass], axis: usize) -> Option<[i32; 2]> {
    let tail = TAIL * masses.iter().map(|cell| cell.mass).sum::<f64>();
    if tail <= 0.0 || !tail.is_finite() {
        return None;
    }
    let mut order: Vec<&CellMass> = masses.iter().filter(|cell| cell.mass > 0.0).collect();
    order.sort_by_key(|cell| cell.voxels.min[axis]);
    let low = past(tail, order.iter().copied())?;
    order.sort_by_key(|cell| cell.voxels.max[axis]);
    let high = past(tail, order.iter().rev().copied())?;
    Some([low.min[axis], high.max[axis].max(low.min[axis])])
}

/// The cell with which the sum of the masses comes to more than `tail`.
fn past<'a>(tail: f64, mut cells: impl Iterator<Item = &'a CellMass>) -> Option<IndexBox> {
    let mut sum = 0.0;
    let found = cells.find(|cell| {
        sum += cell.mass;
        sum > tail
    });
    found.map(|cell| cell.voxels)
}

#[cfg(test)]
mod tests {
    use super::super::{GridBuilder, Leaf};
    use super::*;
    use crate::error::NO_PROGRESS;

    fn leaf(origin: IVec3, value: f32) -> Leaf<f32> {
        Leaf { origin, values: [value; 512], active: [u64::MAX; 8] }
    }

    /// A cube of 64 voxels of 1, with a leaf of `value` at `stray`.
    fn with_stray(stray: IVec3, value: f32) -> SparseGrid<f32> {
        let mut builder = GridBuilder::new(0.0);
        let cube = (0..512).map(|n| 8 * IVec3::new(n >> 6, n >> 3 & 7, n & 7));
        builder.add_leaves(cube.map(|origin| leaf(origin, 1.0)).collect());
        builder.add_leaves(vec![leaf(stray, value)]);
        builder.finish(NO_PROGRESS).unwrap()
    }

    #[test]
    fn a_stray_leaf_is_left_out_wherever_it_lies() {
        let far = [60_000, 10_000_000, 2_000_000_000];
        for far in far.into_iter().flat_map(|far| [far, -far]) {
            let core = with_stray(IVec3::new(far, 0, far), 1.0).core_bounds().unwrap();
            let size = core.max - core.min + 1;
            assert!(core.min.cmple(IVec3::ZERO).all() && core.max.cmpge(IVec3::splat(63)).all());
            assert!(size.max_element() <= 1024, "{core:?} for {far}");
            assert_eq!((core.min.y, core.max.y), (0, 63), "that axis has no strays");
        }
    }

    #[test]
    fn what_has_weight_is_kept() {
        let heavy = with_stray(IVec3::new(60_000, 0, 0), 50.0);
        assert_eq!(heavy.core_bounds(), heavy.bounds());
        let near = with_stray(IVec3::new(120, 0, 0), 1e-3);
        assert_eq!(near.core_bounds(), near.bounds());
        let empty = GridBuilder::<f32>::new(0.0).finish(NO_PROGRESS).unwrap();
        assert_eq!(empty.core_bounds(), None);
    }

    #[test]
    fn tiles_weigh_as_the_voxels_they_stand_for() {
        let mut builder = GridBuilder::new(0.0);
        builder.add_tile(IVec3::ZERO, 4096, 0.5, true).unwrap();
        builder.add_leaves(vec![leaf(IVec3::new(1_000_000, 0, 0), 1.0)]);
        let core = builder.finish(NO_PROGRESS).unwrap().core_bounds().unwrap();
        assert!(core.min.x <= 0 && (4095..10_000).contains(&core.max.x), "{core:?}");
    }
}
