//! A grid and its look-ups.

use glam::{IVec3, Vec3A};

use super::blocks::{Blocks, offset};
use super::bricks::{Ranges, union};
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
    pub(super) blocks: Blocks<V>,
    pub(super) ranges: Ranges<V>,
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
    /// A grid from its storage; the first constant block holds the background.
    pub(super) fn from_parts(
        index: Index,
        blocks: Blocks<V>,
        ranges: Ranges<V>,
        node_ranges: Vec<(V, V)>,
        summary: &GridSummary<V>,
    ) -> Self {
        let memory = blocks.memory_bytes()
            + ranges.memory_bytes()
            + size_of_val(&*node_ranges)
            + index.memory_bytes();
        let background = blocks.constants[0];
        let total_range = node_ranges.iter().copied().fold((background, background), union);
        let (bounds, stats) = (summary.bounds, summary.stats(memory));
        let origin = IVec3::ZERO;
        Self { index, blocks, ranges, node_ranges, total_range, background, bounds, origin, stats }
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
        self.blocks.value(self.index.block(voxel), offset(voxel))
    }

    /// The trilinear interpolant at a position in index space; voxel (i, j, k) is the sample at
    /// exactly that position.
    #[inline]
    pub fn sample(&self, position: Vec3A) -> V {
        let (cell, t) = cell_of(position);
        let block = self.index.block(cell);
        self.blocks.interpolate(&self.index, block, cell, t)
    }
}

/// The cell that holds a position, and where in it that lies, in 0..1.
///
/// Below 2²² the sum with 1.5 · 2²³ has the nearest whole number in its last bits: that takes a
/// quarter of the instructions of the usual conversions, which mind every number there is.
#[inline(always)]
fn cell_of(position: Vec3A) -> (IVec3, Vec3A) {
    const SHIFT: f32 = 12_582_912.0;
    const LARGEST: f32 = 4_194_304.0;
    if !position.abs().cmplt(Vec3A::splat(LARGEST)).all() {
        let floor = position.floor();
        return (floor.as_ivec3(), position - floor);
    }
    let nearest = (position + SHIFT) - SHIFT;
    let above = nearest.cmpgt(position);
    let floor = nearest - Vec3A::select(above, Vec3A::ONE, Vec3A::ZERO);
    let shifted = (floor + SHIFT).to_array();
    let cell = shifted.map(|c| c.to_bits().wrapping_sub(SHIFT.to_bits()) as i32);
    (IVec3::from_array(cell), position - floor)
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
