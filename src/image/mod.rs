//! Pictures on disk and their way to a screen.
//!
//! [`exr`] keeps everything and can be continued; [`npy`] is the beauty for scripts; [`png`] is what
//! the screen shows, through the curves of [`tone`]. [`ramp`] turns numbers into colors, [`map`] a
//! number a pixel into a picture with its [`legend`], [`plot`] numbers over time into curves, [`bars`]
//! some that are compared into a chart; [`export`] is a view with its figures below.
//! [`metrics`] tell how far a picture is from a [`reference`](mod@reference).

pub mod bars;
mod drawing;
pub mod export;
pub mod exr;
mod exr_color;
mod exr_header;
mod exr_layout;
pub mod legend;
mod log_axis;
pub mod map;
pub mod metrics;
pub mod npy;
mod npy_header;
pub mod plot;
pub mod png;
pub mod ramp;
pub mod reference;
pub mod tone;

pub use reference::Reference;
