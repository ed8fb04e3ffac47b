//! Both error measures of one picture: relMSE and FLIP.

use super::{ErrorMap, Flip, Viewing, rel_mse};
use crate::error::Result;
use crate::image::reference::Reference;

/// Errors of a picture against a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// The relative mean squared error, see [`rel_mse`].
    pub rel_mse: ErrorMap,
    /// Perceived differences in 0..=1, see [`Flip`].
    pub flip: ErrorMap,
}

impl Errors {
    /// The errors of linear pictures, shown as `viewing` says. Runs on the threads of the calling
    /// pool; the reference is looked at once.
    ///
    /// # Errors
    /// When a picture has another number of pixels than the reference, or the pixels per degree are
    /// out of their range.
    pub fn of(
        pictures: &[&[[f32; 4]]],
        reference: &Reference,
        viewing: Viewing,
    ) -> Result<Vec<Self>> {
        let flip = Flip::new(reference, viewing)?;
        let errors = |pixels: &&[[f32; 4]]| {
            Ok(Self { rel_mse: rel_mse(pixels, reference)?, flip: flip.compare(pixels)? })
        };
        pictures.iter().map(errors).collect()
    }
}
