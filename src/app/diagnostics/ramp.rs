//! The ramp of [`crate::image::ramp`] in the window's own colors.

use egui::Color32;

pub use crate::image::ramp::{STOPS, Scale, stops};

/// The color at a place in 0..=1 of the ramp.
pub fn color(place: f32) -> Color32 {
    let [r, g, b] = crate::image::ramp::color(place);
    Color32::from_rgb(r, g, b)
}
