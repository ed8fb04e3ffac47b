//! Observation of a path step by step: renders observe nothing at no cost, a replay prints every
//! step.

use super::learned_counts::BounceClass;
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
    /// Volume emission was gathered.
    Emission {
        /// Contribution to the pixel.
        contribution: Rgb,
        /// Technique that gathered it.
        technique: Technique,
    },
    /// The surface or environment at the ray's end was gathered.
    End {
        /// Contribution to the pixel.
        contribution: Rgb,
        /// Class of the vertex that the ray left.
        class: BounceClass,
        /// Whether it was gathered through the transmittance of the ray, and not by arrival.
        by_transmittance: bool,
        /// Collisions of the walk, if one was taken for it alone.
        own_walk: Option<u32>,
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
        /// Class of the vertex.
        class: BounceClass,
        /// The path's throughput on arrival.
        throughput: Rgb,
    },
    /// A light was sampled.
    Light {
        /// Contribution to the pixel.
        contribution: Rgb,
        /// Technique that sampled it: of fires, or of other lights.
        technique: Technique,
        /// Whether fires were sampled.
        fires: bool,
        /// Direction and length of the shadow ray; `None` where none was followed.
        shadow_ray: Option<(Vec3A, f32)>,
    },
}

/// One of the two techniques that find the same light from a vertex, light samples and the path's
/// own ray, with what its MIS weight was made of.
#[derive(Clone, Copy, Debug)]
pub struct Technique {
    /// Class of the vertex.
    pub class: BounceClass,
    /// Mean throughput of the path at the vertex.
    pub throughput: f32,
    /// Rough share of the lights that are sampled in the irradiance at the vertex.
    pub share: f32,
    /// Expected counts at the vertex, this technique's first.
    pub counts: [f32; 2],
    /// Densities over solid angle of the direction, this technique's first, 1/sr.
    pub pdfs: [f32; 2],
    /// Collisions of the sample.
    pub collisions: u32,
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
