//! Rays, boxes, frames and random numbers: the base of every other room.

mod aabb;
mod blue_noise;
mod bvh;
mod frame;
mod ray;
mod rng;
mod sobol;
pub mod two_float;

pub use aabb::Aabb;
pub use bvh::Bvh;
pub use frame::OrthonormalBasis;
pub use ray::Ray;
pub use rng::{ACCUMULATORS, PathRng, Slot};

/// A linear Rec.709 color, or three values that belong to its channels.
pub type Rgb = glam::Vec3A;

/// Rec.709 luminance of a linear color.
pub fn luminance(color: Rgb) -> f32 {
    color.dot(Rgb::new(0.2126, 0.7152, 0.0722))
}

/// Mean of the three channels, the gray value that noise is measured on.
pub fn mean(color: Rgb) -> f32 {
    color.element_sum() * (1.0 / 3.0)
}
