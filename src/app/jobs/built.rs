//! A scene that is built, and the render to start of it.

use std::collections::HashMap;
use std::sync::Arc;

use glam::UVec2;

use crate::scene::sequence::Gap;
use crate::scene::{GridDescription, Note, Settings};
use crate::transport::Scene;

/// The grids of volume files by the file's name.
pub type Grids = HashMap<String, Vec<GridDescription>>;

/// A built scene and the settings that it was built from.
#[derive(Clone)]
pub struct BuiltScene {
    /// The settings that it was built from.
    pub settings: Settings,
    /// The guesses made for a bare volume.
    pub notes: Vec<Note>,
    /// Missing files and grids of the scene's frame.
    pub gaps: Vec<Gap>,
    /// Ready to sample.
    pub scene: Arc<Scene>,
}

/// A render to start as soon as a job is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderStart {
    /// Width and height of the film in pixels.
    pub size: UVec2,
    /// The number of the render.
    pub generation: u64,
}
