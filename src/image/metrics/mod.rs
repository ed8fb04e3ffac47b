//! Errors of a picture against a reference: one number, and a map over the pixels.
//!
//! - [`rel_mse()`] is the usual measure of noise in linear light: squared differences, relative to
//!   the brightness of the reference.
//! - [`flip()`] is what somebody notices who flips between the two pictures as the screen shows
//!   them; [`Flip`] holds on to the reference for many pictures.
//!
//! Both give an [`ErrorMap`], and [`Errors`] holds the two; [`magma`] colors that of FLIP.

mod error_map;
mod errors;
mod flip;
mod magma;
mod rel_mse;

pub use error_map::ErrorMap;
pub use errors::Errors;
pub use flip::{Flip, PIXELS_PER_DEGREE, Viewing, flip};
pub use magma::magma;
pub use rel_mse::{REL_MSE_FLOOR, rel_mse};
