//! The ramp of [`crate::image::ramp`] in the window's own colors.

use egui::Color32;

use crate::app::ui::theme;

/// The color at a place in 0..=1 of the ramp.
pub fn color(place: f32) -> Color32 {
    theme::color::of(crate::image::ramp::color(place))
}
