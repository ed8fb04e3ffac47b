//! Flambeau: interactive, progressive preview of fire, smoke, fog and cloud.

#[cfg(feature = "gui")]
pub mod app;
pub mod cli;
pub mod error;
pub mod image;
pub mod light;
pub mod math;
pub mod render;
pub mod sampling;
pub mod scene;
pub mod surface;
pub mod transport;
pub mod volume;
