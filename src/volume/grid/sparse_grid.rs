//! A grid and its look-ups.

use glam::{IVec3, Vec3A};

use super::bricks::{Brick, BrickRange, interpolate, sample_at, union};
use super::index::Index;
use super::index_box::IndexBox;
use super::stats::{GridStats, GridSummary};
use super::voxel::Voxel;

/// A sparse grid of `f32` or [`Vec3A`] values whose memory grows with the stored data, not with the
/// box around it.
///
/// Built by a [`GridBuilder`](super::GridBuilder) or [`SparseGrid::from_dense`] and not changed
/// afterwards.
pub struct SparseGrid<V> {
    pub(super) index: Index,
    /// The bricks; the first holds the background.
    pub(super) bricks: Vec<Brick<V>>,
    pub(super) ranges: Vec<BrickRange<V>>,
    pub(super) node_ranges: Vec<(V, V)>,
    /// The range of all values, the background included.
    pub(super) total_range: (V, V),
    pub(super) background: V,
    pub(super) bounds: Option<IndexBox>,
    /// Voxel of the grid as it was stored that is voxel 0 here.
    pub(super) origin: IVec3,
    pub(super) stats: GridStats<V>,
}

impl<V: Voxel> SparseGrid<V> {
    /// A grid from its storage; the first brick holds the background.
    pub(super) fn from_parts(
        index: Index,
        bricks: Vec<Brick<V>>,
        ranges: Vec<BrickRange<V>>,
        node_ranges: Vec<(V, V)>,
        summary: &GridSummary<V>,
    ) -> Self {
        let memory = size_of_val(&*bricks)
            + size_of_val(&*ranges)
            + size_of_val(&*node_ranges)
            + index.memory_bytes();
        let background = bricks[0][0];
        let total_range = node_ranges.iter().copied().fold((background, background), union);
        let (bounds, stats) = (summary.bounds, summary.stats(memory));
        let origin = IVec3::ZERO;
        Self { index, bricks, ranges, node_ranges, total_range, background, bounds, origin, stats }
    }

    /// The value wherever nothing was stored.
    pub fn background(&self) -> V {
        self.background
    }

    /// The box around all voxels that are active or differ from the background; `None` for an
    /// empty grid. Outside it every value is the background.
    pub fn bounds(&self) -> Option<IndexBox> {
        self.bounds
    }

    /// Figures of the active voxels, and the memory taken.
    pub fn stats(&self) -> &GridStats<V> {
        &self.stats
    }

    /// The value of a voxel, stored or background.
    #[inline]
    pub fn value(&self, voxel: IVec3) -> V {
        let brick = self.index.brick(voxel);
        self.bricks.get(brick).map_or(self.background, |brick| sample_at(brick, voxel))
    }

    /// The trilinear interpolant at a position in index space; voxel (i, j, k) is the sample at
    /// exactly that position.
    #[inline]
    pub fn sample(&self, position: Vec3A) -> V {
        let floor = position.floor();
        let cell = floor.as_ivec3();
        let brick = self.index.brick(cell);
        let Some(brick) = self.bricks.get(brick) else { return self.background };
        interpolate(brick, cell, position - floor)
    }
}

impl<V: Voxel> std::fmt::Debug for SparseGrid<V> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SparseGrid")
            .field("background", &self.background)
            .field("bounds", &self.bounds)
            .field("stats", &self.stats)
            .finish_non_exhaustive()
    }
}
