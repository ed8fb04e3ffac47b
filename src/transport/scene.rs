//! A scene as light transport sees it.

use super::{camera::Camera, strategy::Strategy};
use crate::{light::Lights, surface::Surface, volume::world::World};

/// Everything a path needs to know.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Where the picture is taken from.
    pub camera: Camera,
    /// What fills space.
    pub world: World,
    /// What bounds it.
    pub surfaces: Vec<Surface>,
    /// What lights it, emissive volumes apart.
    pub lights: Lights,
    /// Most real scattering events and reflections of a path; 0 for no limit but the guard.
    pub max_scatters: u32,
    /// How it is sampled.
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
