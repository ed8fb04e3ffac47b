//! Figures of a grid's values, gathered while it is built.

use glam::IVec3;

use super::bricks::union;
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

/// Voxels of a leaf with the same x.
const LAYER: usize = 64;

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
        let unusable = replace_unusable(&mut leaf.values, background);
        let mut occupied = leaf.active;
        for (x, layer) in leaf.values.as_chunks().0.iter().enumerate() {
            summary.add_layer(layer, leaf.active[x] & !unusable[x]);
            if leaf.active[x] != u64::MAX {
                occupied[x] |= bits_where(layer, |value| value != background);
            }
        }
        summary.replaced = ones(&unusable);
        summary.active = ones(&leaf.active);
        summary.active_bounds = bounds_of(leaf.origin, &leaf.active);
        summary.bounds = bounds_of(leaf.origin, &occupied);
        summary
    }

    /// Adds the values of a layer of equal x whose bits are set.
    fn add_layer(&mut self, layer: &[V; LAYER], mut bits: u64) {
        if bits == u64::MAX {
            self.add_all(layer);
            return;
        }
        while bits != 0 {
            self.add_values(layer[bits.trailing_zeros() as usize], 1);
            bits &= bits - 1;
        }
    }

    /// Adds the values of a whole layer: as many side by side as the processor does at a time.
    fn add_all(&mut self, layer: &[V; LAYER]) {
        let (rows, _) = layer.as_chunks::<8>();
        let (mut low, mut high) = (rows[0], rows[0]);
        for row in rows {
            for ((low, high), &value) in low.iter_mut().zip(&mut high).zip(row) {
                *low = low.component_min(value);
                *high = high.component_max(value);
            }
        }
        let low = low.into_iter().fold(low[0], V::component_min);
        let high = high.into_iter().fold(high[0], V::component_max);
        self.range = Some(self.range.map_or((low, high), |range| union(range, (low, high))));
        for (component, sum) in self.sum.iter_mut().enumerate().take(V::COMPONENTS) {
            let mut sums = [0.0; 8];
            for row in rows {
                for (sum, value) in sums.iter_mut().zip(row) {
                    *sum += f64::from(value.component(component));
                }
            }
            *sum += sums.iter().sum::<f64>();
        }
        self.summed += LAYER as u64;
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

/// Replaces what is unusable by the background, and returns where that was.
fn replace_unusable<V: Voxel>(values: &mut [V; 512], background: V) -> [u64; 8] {
    let mut unusable = [0; 8];
    // Without an early end, so that many values are tested at a time; there hardly ever is one.
    if values.iter().fold(true, |all, value| all & value.is_usable()) {
        return unusable;
    }
    for (bits, layer) in unusable.iter_mut().zip(values.as_chunks_mut::<LAYER>().0) {
        *bits = bits_where(layer, |value| !value.is_usable());
        layer.iter_mut().filter(|value| !value.is_usable()).for_each(|value| *value = background);
    }
    unusable
}

/// A bit for each value, set where `test` holds.
fn bits_where<V: Voxel>(layer: &[V; LAYER], test: impl Fn(V) -> bool) -> u64 {
    layer.iter().rev().fold(0, |bits, &value| bits << 1 | u64::from(test(value)))
}

fn ones(words: &[u64; 8]) -> u64 {
    words.iter().map(|word| u64::from(word.count_ones())).sum()
}

/// The box around the set bits of a leaf that starts at `origin`.
fn bounds_of(origin: IVec3, words: &[u64; 8]) -> Option<IndexBox> {
    let x0 = words.iter().position(|&word| word != 0)?;
    let x1 = words.iter().rposition(|&word| word != 0)?;
    let layer = words.iter().fold(0, |layer, word| layer | word);
    let row = layer.to_le_bytes().iter().fold(0, |row, byte| row | byte);
    let [low, high] = [layer.trailing_zeros(), 63 - layer.leading_zeros()].map(|bit| bit as i32);
    let [z0, z1] = [row.trailing_zeros(), 7 - row.leading_zeros()].map(|bit| bit as i32);
    Some(IndexBox {
        min: origin + IVec3::new(x0 as i32, low >> 3, z0),
        max: origin + IVec3::new(x1 as i32, high >> 3, z1),
    })
}
