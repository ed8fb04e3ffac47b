//! Pictures on disk and their way to a screen.
//!
//! [`exr`] keeps everything and can be continued; [`npy`] is the beauty for scripts; [`png`] is what
//! the screen shows, through the curves of [`tone`].

pub mod exr;
mod exr_header;
mod exr_layout;
pub mod npy;
pub mod png;
pub mod tone;
