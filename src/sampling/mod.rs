//! Samplers, each with its density beside it, and the one place where MIS weights are made.

pub mod airlight;
#[cfg(test)]
pub(crate) mod chi2;
pub mod equiangular;
pub mod guiding_mixture;
pub mod mis;
pub mod von_mises_fisher;
pub mod warp;
