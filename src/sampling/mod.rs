//! Samplers, each with its density beside it, and the one place where MIS weights are made.

pub mod equiangular;
pub mod fisher;
pub mod halo;
pub mod mis;
pub mod towards;
pub mod warp;
