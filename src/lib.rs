//! Flambeau: interactive, progressive preview of fire, smoke, fog and cloud.

pub mod error;
pub mod light;
pub mod math;
pub mod sampling;
pub mod scene;
pub mod surface;
pub mod transport;
pub mod volume;
