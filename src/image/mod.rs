//! Pictures on disk and their way to a screen.
//!
//! - [`exr`]: snapshots, which hold everything and can be continued.
//! - `exr_header`, `exr_layout`: their attributes and channels; `exr_color`: the color of any EXR.
//! - [`npy`], `npy_header`: the beauty for scripts, as a numpy array.
//! - [`png`]: the picture as the screen shows it, through the curves of [`tone`].
//! - [`ramp`]: colors of numbers; [`map`]: a number per pixel as a picture with its [`legend`].
//! - [`plot`]: curves over time; [`bars`]: a bar chart; `log_axis`, `drawing`: axes and canvas.
//! - [`panorama`]: pictures of everything around, of `.exr` or, by `radiance_hdr`, `.hdr` files;
//!   `primaries`: their colors in Rec.709.
//! - [`export`]: a view with its figures below.
//! - [`metrics`]: errors of a picture against a [`reference`](mod@reference).

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
pub mod panorama;
pub mod plot;
pub mod png;
mod primaries;
mod radiance_hdr;
pub mod ramp;
pub mod reference;
pub mod tone;

pub use reference::Reference;
