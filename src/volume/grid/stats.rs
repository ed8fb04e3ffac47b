//! Figures of a grid's values, gathered while it is built.

use super::index_box::IndexBox;
use super::leaf::Leaf;
use super::voxel::Voxel;

/// Figures of a grid's active voxels (tiles weigh as the voxels they stand for) and its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridStats<V> {
    /// Smallest active value, by component; zero when there is none.
    pub min: V,
    /// Largest active value, by component; zero when there is none.
    pub max: V,
    /// Mean of the active values, by component; zero when there is none.
    pub mean: V,
    /// Number of active voxels.
    pub active_voxels: u64,
    /// The inclusive box around the active voxels.
    pub active_bounds: Option<IndexBox>,
    /// Number of stored values that were not finite (or too large to interpolate) and became the
    /// background.
    pub replaced_values: u64,
    /// Memory that the grid takes, in bytes.
    pub memory_bytes: usize,
}

/// Sums over leaves and tiles, from which [`GridStats`] come.
#[derive(Clone, Copy)]
pub(super) struct GridSummary<V> {
    range: Option<(V, V)>,
    sum: [f64; 3],
    summed: u64,
    active: u64,
    active_bounds: Option<IndexBox>,
    /// Active voxels and those that differ from the background.
    pub bounds: Option<IndexBox>,
    replaced: u64,
}

impl<V: Voxel> GridSummary<V> {
    pub fn empty() -> Self {
        Self {
            range: None,
            sum: [0.0; 3],
            summed: 0,
            active: 0,
            active_bounds: None,
            bounds: None,
            replaced: 0,
        }
    }

    /// Sums a leaf up and replaces its unusable values by the background.
    pub fn of_leaf(leaf: &mut Leaf<V>, background: V) -> Self {
        let mut summary = Self::empty();
        for offset in 0..leaf.values.len() {
            let value = leaf.values[offset];
            let usable = value.is_usable();
            if !usable {
                leaf.values[offset] = background;
                summary.replaced += 1;
            }
            let active = leaf.active[offset >> 6] >> (offset & 63) & 1 == 1;
            if !active && (!usable || value == background) {
                continue;
            }
            let voxel = IndexBox::of_voxel(leaf.voxel(offset));
            summary.bounds = IndexBox::union(summary.bounds, Some(voxel));
            if active {
                summary.active += 1;
                summary.active_bounds = IndexBox::union(summary.active_bounds, Some(voxel));
                if usable {
                    summary.add_values(value, 1);
                }
            }
        }
        summary
    }

    /// Sums a box of equal values up; `value` is as stored, before any replacement.
    pub fn of_tile(bounds: IndexBox, value: V, active: bool, background: V) -> Self {
        let mut summary = Self::empty();
        let usable = value.is_usable();
        summary.replaced = u64::from(!usable);
        if active {
            summary.active = bounds.voxel_count();
            summary.active_bounds = Some(bounds);
            if usable {
                summary.add_values(value, summary.active);
            }
        }
        if active || (usable && value != background) {
            summary.bounds = Some(bounds);
        }
        summary
    }

    /// Counts one unusable value that belongs to no voxel, such as the background.
    pub fn count_replaced(&mut self) {
        self.replaced += 1;
    }

    fn add_values(&mut self, value: V, count: u64) {
        self.range = Some(match self.range {
            None => (value, value),
            Some((low, high)) => (low.component_min(value), high.component_max(value)),
        });
        for (sum, component) in self.sum.iter_mut().zip(value.to_f64()) {
            *sum += component * count as f64;
        }
        self.summed += count;
    }

    pub fn merge(&mut self, other: &Self) {
        self.range = match (self.range, other.range) {
            (Some((a, b)), Some((c, d))) => Some((a.component_min(c), b.component_max(d))),
            (a, b) => a.or(b),
        };
        for (sum, more) in self.sum.iter_mut().zip(other.sum) {
            *sum += more;
        }
        self.summed += other.summed;
        self.active = self.active.saturating_add(other.active);
        self.active_bounds = IndexBox::union(self.active_bounds, other.active_bounds);
        self.bounds = IndexBox::union(self.bounds, other.bounds);
        self.replaced += other.replaced;
    }

    pub fn stats(&self, memory_bytes: usize) -> GridStats<V> {
        let (min, max) = self.range.unwrap_or((V::ZERO, V::ZERO));
        let count = self.summed.max(1) as f64;
        GridStats {
            min,
            max,
            mean: V::from_components(self.sum.map(|sum| (sum / count) as f32)),
            active_voxels: self.active,
            active_bounds: self.active_bounds,
            replaced_values: self.replaced,
            memory_bytes,
        }
    }
}
