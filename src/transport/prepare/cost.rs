//! Cost of a path, counted instead of timed, so that decisions based on it are the same on any
//! machine and at any time.

use crate::transport::observer::{Observer, PathStep};
use crate::transport::sample::PathSample;

/// Cost of a ray or a vertex beside the tracking steps, in tracking steps. Measured on the scenes
/// of the noise benchmark: good to a factor of two, and between two strategies on one scene to a
/// quarter.
const RAY_COST: f64 = 11.0;

/// Counts the rays and vertices of a path.
#[derive(Debug, Default)]
pub(in crate::transport) struct Cost {
    rays_and_vertices: u32,
}

impl Cost {
    /// Cost of the path of `sample`, in tracking steps.
    pub(in crate::transport) fn of(&self, sample: &PathSample) -> f64 {
        f64::from(sample.tracking_steps) + RAY_COST * f64::from(self.rays_and_vertices)
    }
}

impl Observer for Cost {
    fn step(&mut self, step: PathStep) {
        if matches!(step, PathStep::Ray { .. } | PathStep::Vertex { .. }) {
            self.rays_and_vertices += 1;
        }
    }
}
