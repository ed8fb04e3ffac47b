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
pub mod vdb;
#[allow(clippy::module_inception, reason = "the folder is named after its main type")]
mod volume;
pub mod world;

pub use volume::{CoefficientBounds, MediumProperties, Region, Volume};
