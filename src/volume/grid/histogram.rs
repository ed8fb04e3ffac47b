//! Histogram of the values of a grid.

use rayon::prelude::*;

use super::block_id::BlockId;
use super::blocks::BLOCK_VALUES;
use super::index::NodeBlocks;
use super::sparse_grid::SparseGrid;
use super::voxel::Voxel;

/// Parts of equal width that a range of values is divided into.
pub const BINS: usize = 32;

/// Number of values in each part.
pub type Histogram = [u64; BINS];

impl<V: Voxel> SparseGrid<V> {
    /// Number of voxels with a value in each of [`BINS`] equal parts of `low..=high`; for vectors
    /// the largest component counts. Voxels that hold the background are passed over, as most of
    /// space does.
    pub fn histogram(&self, [low, high]: [f32; 2]) -> Histogram {
        let bins = Bins { low, high, scale: BINS as f32 / (high - low).max(f32::MIN_POSITIVE) };
        let merge = |a: Histogram, b: Histogram| std::array::from_fn(|index| a[index] + b[index]);
        let nodes = self.index.nodes.par_iter().zip(self.index.node_uses());
        let used = nodes.filter(|&(_, uses)| uses > 0);
        let counts = used.map(|(node, uses)| self.count_node(node, &bins).map(|n| n * uses));
        counts.reduce(|| [0; BINS], merge)
    }

    fn count_node(&self, node: &NodeBlocks, bins: &Bins) -> Histogram {
        let mut histogram = [0; BINS];
        for &block in node.iter().filter(|&&block| block != BlockId::BACKGROUND) {
            self.count_block(block, bins, &mut histogram);
        }
        histogram
    }

    fn count_block(&self, block: BlockId, bins: &Bins, histogram: &mut Histogram) {
        let (least, most) = self.ranges.of(block).whole();
        let apart = self.background.component_min(least) != least
            || self.background.component_max(most) != most;
        // Smooth blocks fall into one part as a whole.
        let one = bins.of(smallest(least)).filter(|&bin| bins.of(largest(most)) == Some(bin));
        if let Some(bin) = one.filter(|_| apart) {
            histogram[bin] += BLOCK_VALUES as u64;
            return;
        }
        if block.is_constant() {
            let value = self.blocks.value(block, 0);
            if let Some(bin) = bins.of(largest(value)).filter(|_| value != self.background) {
                histogram[bin] += BLOCK_VALUES as u64;
            }
            return;
        }
        for row in (0..BLOCK_VALUES).step_by(8) {
            for value in self.blocks.row(block, row) {
                if let Some(bin) = bins.of(largest(value)).filter(|_| value != self.background) {
                    histogram[bin] += 1;
                }
            }
        }
    }
}

/// The parts of a range.
struct Bins {
    low: f32,
    high: f32,
    scale: f32,
}

impl Bins {
    /// The part that a value lies in, if any.
    #[inline(always)]
    fn of(&self, value: f32) -> Option<usize> {
        let inside = value >= self.low && value <= self.high;
        inside.then(|| (((value - self.low) * self.scale) as usize).min(BINS - 1))
    }
}

#[inline(always)]
fn largest<V: Voxel>(value: V) -> f32 {
    (1..V::COMPONENTS).fold(value.component(0), |most, c| most.max(value.component(c)))
}

fn smallest<V: Voxel>(value: V) -> f32 {
    (1..V::COMPONENTS).fold(value.component(0), |least, c| least.min(value.component(c)))
}
