//! Looking over a path's shoulder: renders look away at no cost, a replay prints every step.

use super::vertex::Vertex;
use crate::math::{Ray, Rgb};
use glam::Vec3A;

/// What happens along a path, in order.
#[derive(Clone, Copy, Debug)]
pub enum PathStep<'a> {
    /// A ray sets out; surfaces end it at `t_max`.
    Ray {
        /// The ray.
        ray: &'a Ray,
        /// Where it ends.
        t_max: f32,
        /// The path's throughput so far.
        throughput: Rgb,
    },
    /// Volume emission was added.
    Emission {
        /// What it adds to the pixel.
        contribution: Rgb,
    },
    /// The surface or environment at the ray's end was added.
    End {
        /// What it adds to the pixel.
        contribution: Rgb,
    },
    /// The path was absorbed.
    Absorbed {
        /// Where.
        point: Vec3A,
    },
    /// The path scatters or is reflected.
    Vertex {
        /// Where and how.
        vertex: &'a Vertex,
        /// The throughput that arrives there.
        throughput: Rgb,
    },
    /// A sampled light was added.
    Light {
        /// What it adds to the pixel.
        contribution: Rgb,
    },
}

/// Sees every step of a path.
pub trait Observer {
    /// Called for each step.
    fn step(&mut self, step: PathStep);
}

/// Sees nothing.
pub struct Nobody;

impl Observer for Nobody {
    #[inline(always)]
    fn step(&mut self, _: PathStep) {}
}
