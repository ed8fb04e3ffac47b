//! The path that is being followed.

use super::state::State;
use crate::transport::context::PathContext;
use crate::transport::march::MarchTable;
use crate::transport::sample::Contributions;
use crate::transport::scene::Scene;

/// A path from the camera, and what it has gathered.
pub(super) struct Path<'s> {
    pub(super) scene: &'s Scene,
    pub(super) context: PathContext<'s>,
    pub(super) state: State,
    /// Expected contribution of one flight of the camera ray; 0 where it is unknown.
    pub(super) expected: f32,
    /// Splits whose branches are being followed.
    pub(super) nested: u32,
    /// Branches so far.
    pub(super) branches: u32,
    /// Table of steps of the present ray, for ray marching.
    pub(super) table: MarchTable,
    pub(super) contributions: Contributions,
}
