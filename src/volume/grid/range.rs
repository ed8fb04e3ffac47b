//! Conservative ranges of the interpolated function, from the ranges cached for bricks and nodes.

use glam::{IVec3, Vec3};

use super::bricks::{BRICK_EDGE, union};
use super::index::{node_box, node_of};
use super::index_box::IndexBox;
use super::sparse_grid::SparseGrid;
use super::voxel::Voxel;

impl<V: Voxel> SparseGrid<V> {
    /// The smallest and largest value, by component, that [`sample`](Self::sample) can return in
    /// the closed box from `min` to `max` in index space, or a little more: the ranges are those of
    /// parts of 4x4x4 cells. The cost grows with the data stored in the box, never with empty
    /// space. A box with a coordinate that is not a number gets the range of the whole grid.
    pub fn range(&self, min: Vec3, max: Vec3) -> (V, V) {
        if min.is_nan() || max.is_nan() {
            return self.total_range;
        }
        let low = min.floor().as_ivec3();
        // A position on the far face reads the last samples of the cell before it.
        let high = max.ceil().as_ivec3().saturating_sub(IVec3::ONE).max(low);
        self.range_of_cells(&IndexBox { min: low, max: high })
    }

    /// As [`SparseGrid::range`], over the cells from each voxel of `cells` to the next.
    pub(super) fn range_of_cells(&self, cells: &IndexBox) -> (V, V) {
        let nodes = IndexBox { min: node_of(cells.min), max: node_of(cells.max) };
        let mut range = None;
        let mut include = |more: (V, V)| {
            range = Some(range.map_or(more, |range| union(range, more)));
        };
        let some_background = self.index.visit(&nodes, |position, id| {
            let of_node = self.node_ranges[id as usize];
            let bounds = node_box(position);
            if cells.contains(&bounds) || of_node.0 == of_node.1 {
                include(of_node);
            } else {
                include(self.range_in_node(id, &bounds, cells));
            }
        });
        if some_background {
            include((self.background, self.background));
        }
        range.unwrap_or(self.total_range)
    }

    fn range_in_node(&self, id: u32, bounds: &IndexBox, cells: &IndexBox) -> (V, V) {
        let part = cells.intersection(bounds);
        let (min, max) = (part.min - bounds.min, part.max - bounds.min);
        let bricks = IndexBox { min: min / BRICK_EDGE, max: max / BRICK_EDGE };
        let node = &self.index.nodes[id as usize];
        let mut range: Option<(V, V)> = None;
        for brick in bricks.positions() {
            let first = brick * BRICK_EDGE;
            let low = (min - first).max(IVec3::ZERO);
            let high = (max - first).min(IVec3::splat(BRICK_EDGE - 1));
            let block = node[super::index::brick_in_node(first)];
            let more = self.ranges.of(block).within(low, high);
            range = Some(range.map_or(more, |range| union(range, more)));
        }
        range.unwrap_or(self.total_range)
    }
}
