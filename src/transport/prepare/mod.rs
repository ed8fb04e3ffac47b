//! Paths that are traced before the picture, to find out what pays in it.

pub(super) mod cost;
pub(super) mod guided_flights;
pub(super) mod learning;
pub(super) mod optimal_majorant;
pub(super) mod pilot_pixel;
