//! How far both sides are from a reference.

use std::path::Path;

use glam::UVec2;
use serde::Serialize;

use crate::error::Result;
use crate::image::Reference;
use crate::image::metrics::{Flip, Viewing, rel_mse};
use crate::render::publish::resolve;
use crate::render::side_by_side::RenderedPair;

/// How far a side is from the reference.
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
        let flip = Flip::new(reference, Viewing::default())?;
        let errors = |side: usize| {
            let mut pixels = Vec::new();
            resolve(&pair.sides[side].film, &mut pixels);
            let rel_mse = rel_mse(&pixels, reference)?.mean;
            Ok(Errors { rel_mse, flip: flip.compare(&pixels)?.mean })
        };
        Ok([errors(0)?, errors(1)?])
    })
}
