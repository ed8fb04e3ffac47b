//! Light transport in participating media: the strategies and the paths they sample. Read `path`
//! first.

pub mod camera;
pub mod context;
mod counts;
pub mod direct;
mod distance;
pub mod effective;
pub mod emission;
mod frame;
mod guiding;
pub mod learned_counts;
mod march;
pub mod observer;
pub mod path;
pub mod path_setup;
pub mod prepare;
pub mod probes;
pub mod profile;
mod sample;
pub mod scene;
pub mod shadow;
pub mod spending;
pub mod strategy;
pub mod toggle;
pub mod tracking;
mod transmittance;
pub mod vertex;
mod weight_window;

pub use frame::{Frame, PreparedFrame};
pub use sample::{PATH_VERSION, PathSample, PixelSampler, Prepared, SampleNumber};
pub use scene::Scene;

#[cfg(test)]
mod tests;
