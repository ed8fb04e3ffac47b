//! What fills space: sparse voxel grids and the readers of their files.

pub mod grid;
pub mod vdb;
