//! What fills space. Light transport reads `medium` and asks `world`; the rest is behind them.

pub mod blackbody;
pub mod body;
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
pub mod world;
