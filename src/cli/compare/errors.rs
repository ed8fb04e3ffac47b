//! Errors of both sides against a reference.

use std::path::Path;

use glam::UVec2;
use serde::Serialize;

use crate::error::Result;
use crate::image::Reference;
use crate::image::metrics::{self, Viewing};
use crate::render::picture::resolve;
use crate::render::side_by_side::RenderedPair;

/// Errors of a side against the reference.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Errors {
    /// The relative mean squared error.
    pub rel_mse: f64,
    /// Mean FLIP of the pictures as the window shows them first.
    pub flip: f64,
}

/// Loads the reference for a film of `size`, before anything is rendered in vain.
pub fn load(path: &Path, size: UVec2) -> Result<Reference> {
    let reference = Reference::load(path)?;
    reference.matches(size)?;
    Ok(reference)
}

/// The errors of A and of B.
pub fn of(reference: &Reference, pair: &RenderedPair) -> Result<[Errors; 2]> {
    pair.pool.install(|| {
        let pictures = [0, 1].map(|side| {
            let mut pixels = Vec::new();
            resolve(&pair.sides[side].film, &mut pixels);
            pixels
        });
        let pictures = pictures.each_ref().map(Vec::as_slice);
        let errors = metrics::Errors::of(&pictures, reference, Viewing::default())?;
        let means = |side: usize| {
            let metrics::Errors { rel_mse, flip } = &errors[side];
            Errors { rel_mse: rel_mse.mean, flip: flip.mean }
        };
        Ok([means(0), means(1)])
    })
}
