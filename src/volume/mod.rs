//! Participating media. Light transport uses `medium` and `world`; the rest is behind them.

pub mod blackbody;
pub mod cells;
pub mod curve;
pub mod emission;
pub mod energy;
pub mod field;
pub mod file;
pub mod grid;
mod half;
mod local_volume;
pub mod majorant;
pub mod medium;
mod motion;
pub mod nvdb;
mod packing;
pub mod phase;
pub mod procedural;
mod region;
mod taper;
pub mod vdb;
pub mod world;

pub use local_volume::{CoefficientBounds, MediumProperties, Volume};
pub use motion::{Motion, Shutter, VelocityField};
pub use region::Region;
pub use taper::Taper;
