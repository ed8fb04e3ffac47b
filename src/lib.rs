//! Flambeau: interactive, progressive preview of fire, smoke, fog and cloud.

pub mod error;
pub mod volume;
