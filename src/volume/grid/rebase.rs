//! Moving a grid to the origin of its index space, where single precision tells voxels apart.

use glam::{I64Vec3, IVec3};

use super::index::NODE_VOXEL_BITS;
use super::index_box::IndexBox;
use super::sparse_grid::SparseGrid;
use super::voxel::Voxel;

/// Up to this coordinate a position in single precision has 1/128 of a voxel.
const NEAR: i64 = 1 << 16;

impl<V: Voxel> SparseGrid<V> {
    /// Voxel of the grid as it was stored that is voxel 0 here; zero unless the grid was moved by
    /// [`SparseGrid::rebase`].
    pub fn origin(&self) -> IVec3 {
        self.origin
    }

    /// Moves a grid whose voxels lie far from voxel 0 so that what counts of it lies near, and
    /// says where by [`SparseGrid::origin`]. Positions in single precision would miss the voxels.
    pub fn rebase(&mut self) {
        let Some(bounds) = self.bounds else { return };
        let (min, max) = (bounds.min.as_i64vec3(), bounds.max.as_i64vec3());
        if min.abs().max(max.abs()).max_element() <= NEAR {
            return;
        }
        let core = match (max - min).max_element() <= NEAR {
            true => bounds,
            false => self.core_bounds().unwrap_or(bounds),
        };
        let center = (core.min.as_i64vec3() + core.max.as_i64vec3()) / 2;
        let shift = (center >> NODE_VOXEL_BITS).as_ivec3();
        let moved = shift.as_i64vec3() << NODE_VOXEL_BITS;
        // The nodes before the first voxels have to keep a coordinate too.
        let margin = I64Vec3::splat(2 << NODE_VOXEL_BITS);
        let fits = |voxel: I64Vec3| voxel.abs().max_element() <= i64::from(i32::MAX);
        if !fits(min - moved - margin) || !fits(max - moved + margin) {
            return;
        }
        let back = |bounds: IndexBox| IndexBox {
            min: (bounds.min.as_i64vec3() - moved).as_ivec3(),
            max: (bounds.max.as_i64vec3() - moved).as_ivec3(),
        };
        self.index.shift(shift);
        self.bounds = Some(back(bounds));
        self.stats.active_bounds = self.stats.active_bounds.map(back);
        self.origin += moved.as_ivec3();
    }
}

#[cfg(test)]
mod tests {
    use glam::{UVec3, Vec3, Vec3A};

    use super::*;

    fn rebased(at: IVec3) -> SparseGrid<f32> {
        let values: Vec<f32> = (1..=27).map(|value| value as f32).collect();
        let mut grid = SparseGrid::from_dense(at, UVec3::splat(3), &values, 0.0).unwrap();
        grid.rebase();
        grid
    }

    #[test]
    fn far_voxels_come_near_and_stay_what_they_are() {
        for at in [500_000_000, -500_000_000, 2_147_000_000, -2_147_000_000, 70_001] {
            let at = IVec3::new(at, 20, -at);
            let grid = rebased(at);
            let near = at - grid.origin();
            assert!(near.abs().max_element() < 256, "{near}");
            assert_eq!(grid.bounds(), Some(IndexBox { min: near, max: near + 2 }));
            assert_eq!(grid.stats().active_bounds, grid.bounds());
            for n in 0..27 {
                let voxel = near + IVec3::new(n / 9, n / 3 % 3, n % 3);
                assert_eq!(grid.value(voxel), (n + 1) as f32);
                assert_eq!(grid.sample(voxel.as_vec3a()), (n + 1) as f32);
            }
            assert_eq!(grid.sample(near.as_vec3a() + Vec3A::splat(0.5)), 7.5);
            let corner = near.as_vec3();
            assert_eq!(grid.range(corner, corner + Vec3::splat(2.0)), (0.0, 27.0));
            assert_eq!(grid.value(near - 1), 0.0);
        }
    }

    #[test]
    fn near_grids_and_those_that_fill_the_range_stay_in_place() {
        assert_eq!(rebased(IVec3::new(60_000, -60_000, 0)).origin(), IVec3::ZERO);
        let mut builder = super::super::GridBuilder::new(0.0);
        let leaf = |x: i32, value: f32| super::super::Leaf {
            origin: IVec3::new(x, 0, 0),
            values: [value; 512],
            active: [u64::MAX; 8],
        };
        builder.add_leaves(vec![leaf(-2_000_000_000, 1.0), leaf(2_000_000_000, 1.0)]);
        let mut grid = builder.finish(crate::error::NO_PROGRESS).unwrap();
        grid.rebase();
        assert_eq!(grid.value(IVec3::new(2_000_000_000, 0, 0) - grid.origin()), 1.0);
    }
}
