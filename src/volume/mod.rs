//! What fills space. Light transport reads `medium` and asks `world`; the rest is behind them.

pub mod blackbody;
pub mod cells;
pub mod emission;
pub mod energy;
pub mod field;
pub mod grid;
pub mod majorant;
pub mod medium;
pub mod phase;
pub mod procedural;
mod region;
pub mod vdb;
mod volume;
pub mod world;

pub use region::Region;
pub use volume::{CoefficientBounds, MediumProperties, Volume};
