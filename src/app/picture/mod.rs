//! The picture and the input on it: camera moves, zoom, handles, regions.
//!
//! - `viewport`: input on the picture; `view`: where it lies in the window; `zoom`: its layout.
//! - `navigation`: camera moves; `gizmo`: handles of a light; `region`: a part of the picture.
//! - `look`: the data that is shown; `display`: the picture on the graphics card.
//! - `pixel_values`: numbers written into pixels; `ramp_color`: colors of numbers.

pub mod display;
pub mod gizmo;
pub mod look;
pub mod navigation;
pub mod pixel_values;
pub mod ramp_color;
pub mod region;
pub mod view;
pub mod viewport;
pub mod zoom;
