//! Sparse voxel grids: storage, look-up and conservative ranges.
//!
//! Values are samples at integer positions of *index space*, trilinear in between. They lie in
//! *blocks* of 8x8x8 voxels, the blocks in *nodes* of 16x16x16. Voxels that were not stored have
//! the background's value. A *brick* is the cells that start in a block: it reads the first samples
//! of the next blocks too, and has its range of values cached.
//!
//! Blocks are stored as half floats where every value is exactly one and as floats elsewhere, bit
//! for bit; in grids of up to 32 MiB they are padded with the first samples of the next blocks,
//! which makes look-ups faster still. Bytes for an active voxel, held and at the peak of loading,
//! and processor time of `flambeau info FILE`, where 8 or 9 of 10 voxels of a leaf are active:
//!
//! | file | active voxels | held | peak | time |
//! |---|---|---|---|---|
//! | two grids of half floats, Blosc, 130 MB | 77 million | 2.4 | 2.7 | 1.1 s |
//! | one grid of floats, Blosc, 670 MB, in a box of 2000³ | 196 million | 4.8 | 5.0 | 3.1 s |

mod assemble;
mod block_id;
mod blocks;
mod bricks;
mod builder;
mod class;
mod histogram;
mod index;
mod index_box;
mod leaf;
mod level_set;
mod mass;
mod node;
mod parts;
mod range;
mod rebase;
mod sparse_grid;
mod stats;
#[cfg(test)]
mod tests;
mod transform;
mod voxel;
mod voxel_values;

pub use builder::GridBuilder;
pub use class::GridClass;
pub use histogram::{BINS, Histogram};
pub use index_box::IndexBox;
pub use leaf::Leaf;
pub use sparse_grid::SparseGrid;
pub use stats::GridStats;
pub use transform::Transform;
pub use voxel::Voxel;
pub use voxel_values::VoxelValues;
