//! Observation of a path step by step: renders observe nothing at no cost, a replay prints every
//! step.

use super::vertex::Vertex;
use crate::math::{Ray, Rgb};
use glam::Vec3A;

/// A step of a path, in the order in which they happen.
#[derive(Clone, Copy, Debug)]
pub enum PathStep<'a> {
    /// A ray sets out; surfaces end it at `t_max`.
    Ray {
        /// The ray.
        ray: &'a Ray,
        /// Ray parameter of the surface that ends it.
        t_max: f32,
        /// The path's throughput so far.
        throughput: Rgb,
    },
    /// Volume emission was added.
    Emission {
        /// Contribution to the pixel.
        contribution: Rgb,
    },
    /// The surface or environment at the ray's end was added.
    End {
        /// Contribution to the pixel.
        contribution: Rgb,
    },
    /// The path was absorbed.
    Absorbed {
        /// Point of the absorption.
        point: Vec3A,
    },
    /// The path scatters or is reflected.
    Vertex {
        /// The vertex.
        vertex: &'a Vertex,
        /// The path's throughput on arrival.
        throughput: Rgb,
    },
    /// A sampled light was added.
    Light {
        /// Contribution to the pixel.
        contribution: Rgb,
    },
}

/// Observer of the steps of a path.
pub trait Observer {
    /// Called for each step.
    fn step(&mut self, step: PathStep);
}

/// Observer that ignores every step.
pub struct Nobody;

impl Observer for Nobody {
    #[inline(always)]
    fn step(&mut self, _: PathStep) {}
}
