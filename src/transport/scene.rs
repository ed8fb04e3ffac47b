//! A scene as light transport sees it.

use super::{camera::Camera, strategy::Strategy};
use crate::{light::Lights, surface::Surface, volume::world::World};

/// Scene data that a path reads: camera, volumes, surfaces, lights and strategy.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Camera that the picture is taken with.
    pub camera: Camera,
    /// Volumes of the scene.
    pub world: World,
    /// Surfaces of the scene.
    pub surfaces: Vec<Surface>,
    /// Lights and environment of the scene; emissive volumes themselves belong to `world`.
    pub lights: Lights,
    /// Most real scattering events and reflections of a path; 0 for no limit but
    /// [`path::MOST_VERTICES`](super::path::MOST_VERTICES).
    pub max_scatters: u32,
    /// Sampling strategy.
    pub strategy: Strategy,
}

#[cfg(test)]
impl Scene {
    /// Builds a scene that a test describes.
    pub(super) fn of_text(text: &str) -> Self {
        use crate::scene;
        let folder = std::path::Path::new(".");
        let settings = scene::parse(text, "test", folder, &scene::Overrides::default()).unwrap();
        scene::assemble(&settings, &scene::VolumeCache::default(), crate::error::NO_PROGRESS)
            .unwrap()
    }
}
