//! State of a path: everything that a branch saves and restores.

use glam::Vec3A;

use crate::math::{Ray, Rgb};
use crate::transport::direct::PrevVertex;
use crate::transport::learned_counts::BounceClass;

/// The part of a path that a branch saves and restores.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) ray: Ray,
    /// β: the product of f/p so far, without any MIS weight of direct light.
    pub(super) throughput: Rgb,
    /// p_mixture / p_bsdf of the last direction drawn at a vertex that scatters everywhere, for
    /// roulette: a path that was guided to light is not dim for being one of many.
    pub(super) guiding_ratio: f32,
    /// Scattering events and reflections so far.
    pub(super) scatters: u32,
    /// Mean throughput with which the path came to the vertex that the ray left, as light samples
    /// there had it.
    pub(super) throughput_before: f32,
    /// The vertex that the ray left, for MIS; `None` for the camera ray.
    pub(super) prev_vertex: Option<PrevVertex>,
    /// Sampled point of a light that the ray is guided by.
    pub(super) light_point: Option<Vec3A>,
    pub(super) branch: Branch,
}

/// Series of random numbers that a path draws: a camera ray may have guided flights beside its own,
/// and paths may be split at vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Branch {
    /// The path of the unguided flight.
    Main,
    /// The path of the first guided flight.
    FirstGuided,
    /// The path of any other guided flight or split.
    Other,
}

impl State {
    /// Class of the vertex that the ray left.
    pub(super) fn class(&self) -> BounceClass {
        let is_surface = self.prev_vertex.is_some_and(|prev| prev.from.normal.is_some());
        BounceClass::new(self.scatters, is_surface)
    }

    /// The state of a camera ray.
    pub(super) fn new(ray: Ray) -> Self {
        Self {
            ray,
            throughput: Rgb::ONE,
            guiding_ratio: 1.0,
            scatters: 0,
            throughput_before: 1.0,
            prev_vertex: None,
            light_point: None,
            branch: Branch::Main,
        }
    }
}
