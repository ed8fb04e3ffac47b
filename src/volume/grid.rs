//! Sparse voxel grids: storage, look-up and conservative ranges.
//!
//! Values are samples at integer positions of *index space*, trilinear in between. They lie in
//! *bricks* of 8x8x8 cells that carry the first samples of the bricks after them, so that a look-up
//! touches one brick; the bricks lie in *nodes* of 16x16x16. Voxels that were not stored have the
//! background's value.

mod assemble;
mod bricks;
mod builder;
mod class;
mod histogram;
mod index;
mod index_box;
mod leaf;
mod mass;
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
