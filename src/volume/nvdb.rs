//! Reader of NanoVDB files (`.nvdb`), versions 32.0 and later of the format; all numbers are
//! little-endian.
//!
//! ```text
//! file          segments one after another, or the buffer of its grids as it is in memory
//! segment       header (16 bytes): magic "NanoVDB0" or "NanoVDB2", version, number of grids (16
//!               bits), codec (16 bits); for each grid 176 bytes and its name; then the grids,
//!               each packed by the codec
//! buffer        magic "NanoVDB0" or "NanoVDB1"; grids one after another
//! grid          672 bytes: magic, checksum, version, flags, number among its grids, their number,
//!               size in bytes, name (256 bytes), map, box, voxel size, class, type, blind data
//! tree          64 bytes: offsets of first leaf, lower and upper node and root; their numbers
//! root          box, number of entries, background, statistics; then the entries: key (21 bits
//!               each of x, y, z, over 4096), offset of the child or 0, state, value
//! upper, lower  box, flags, mask of active tiles, mask of children, statistics, then for each of
//!               32x32x32 or 16x16x16 places the offset of the child or the value of the tile
//! leaf          corner, size and flags of the box of active voxels, mask of active voxels,
//!               statistics, 512 values
//! ```
//!
//! A version has 11 bits of major, 11 of minor and 10 of patch number; within one major version
//! the layout stays. Codec 0 stores grids as they are, codec 1 as one zlib stream after its length,
//! codec 2 in pieces of 1 GiB, each a Blosc container after its length. Offsets count from the node
//! that holds them, those of the tree from the tree. Values and nodes are aligned: fields to their
//! own size, tables and nodes to 32 bytes (`nvdb/layout.rs`). Quantized leaves (Fp4, Fp8, Fp16,
//! FpN) hold a minimum and a quantum before their codes of 4, 8, 16 or, as the top bits of the
//! leaf's flags say, 1 to 16 bits; value = minimum + code x quantum. Names of 256 bytes and more
//! lie in the blind data of class 3, and whole in the segment.
//!
//! [`Directory`] lists what a file holds without touching a voxel and loads single grids. Grids of
//! float, double, vec3f and vec3d values and the quantized ones are loaded; others are listed with
//! the reason why they are not.

mod bytes;
mod directory;
mod entry;
mod grid_type;
mod layout;
mod leaf;
mod segments;
mod stored;
mod tree;

pub use directory::Directory;
pub use entry::GridInfo;
pub use segments::Version;
pub(super) use segments::is_nanovdb;
