//! Requests: a render to begin or to go on with.

use std::sync::Arc;

use glam::UVec2;

use crate::render::film::Film;
use crate::transport::PixelSampler;

/// A request for a render.
pub struct Request {
    /// Sampler of the pixels.
    pub sampler: Arc<dyn PixelSampler>,
    /// Width and height in pixels.
    pub size: UVec2,
    /// Samples a pixel; 0: until stopped.
    pub spp: u32,
    /// The caller's number, which the pictures carry.
    pub generation: u64,
    /// The render to go on from, with a film of the same size. It waits for a better sampler that
    /// is in the making, so that the samples of two never mix.
    pub resume: Option<Resume>,
    /// Whether a better sampler of the same picture is in the making, which
    /// [`Session::improve`](super::Session::improve) will bring. Until then the render is not
    /// finished, whatever its limit, and a snapshot waits, unless it is paused.
    pub provisional: bool,
}

/// A render to go on from.
#[derive(Debug)]
pub struct Resume {
    /// Film with its samples.
    pub film: Film,
    /// Seconds of rendering that the samples took.
    pub seconds: f64,
    /// CPU time that the sampling threads spent on the film, in seconds.
    pub cpu_seconds: f64,
}
