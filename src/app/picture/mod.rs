//! The picture and the hand on it: viewport, navigation, zoom, display, pixel values, handles.

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
