//! Pictures on disk and their way to a screen.

pub mod exr;
pub mod npy;
pub mod png;
pub mod tone;
