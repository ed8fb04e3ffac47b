//! A scene as light transport sees it.

use glam::{UVec2, Vec2};

use super::camera::Camera;
use super::effective::SceneFacts;
use super::strategy::Strategy;
use crate::math::{PathRng, Ray, Slot};
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
    /// The effective sampling strategy, see [`Strategy::effective`].
    pub(in crate::transport) strategy: Strategy,
}

impl Scene {
    /// A scene with the parts that the fields of the same names describe, and a strategy, of which
    /// it keeps the part that acts in it.
    pub fn new(
        camera: Camera,
        world: World,
        surfaces: Vec<Surface>,
        lights: Lights,
        max_scatters: u32,
        strategy: Strategy,
    ) -> Self {
        Self { camera, world, surfaces, lights, max_scatters, strategy }.with_strategy(strategy)
    }

    /// This scene with `strategy`, of which it keeps the part that has an effect in it.
    pub fn with_strategy(self, strategy: Strategy) -> Self {
        let strategy = strategy.effective(self.facts());
        Self { strategy, ..self }
    }

    /// A camera ray in its pixel, through a random point of the lens and at a random time while the
    /// shutter is open. No number is drawn for a pinhole, nor where nothing moves.
    pub(super) fn camera_ray(
        &self,
        size: UVec2,
        pixel: UVec2,
        offset: Vec2,
        rng: &mut PathRng,
    ) -> Ray {
        let time = match self.world.open_seconds().max(self.camera.open_seconds()) {
            0.0 => 0.0,
            seconds => (rng.at(Slot::Time) - 0.5) * seconds,
        };
        let mut u = || Vec2::new(rng.at(Slot::LensX), rng.at(Slot::LensY));
        let on_lens = self.camera.has_aperture().then(&mut u);
        self.camera.lens_ray((size, pixel, offset), on_lens, time)
    }

    /// The effective strategy: toggles that change nothing in this scene have one position.
    pub fn strategy(&self) -> &Strategy {
        &self.strategy
    }

    /// Properties of the scene that decide which toggles have an effect in it.
    pub fn facts(&self) -> SceneFacts {
        let mut volumes = self.world.instances().iter().map(|instance| instance.volume());
        SceneFacts {
            emits: self.world.emits(),
            emits_without_borders: self.world.emits_beyond_lights(),
            scatters: volumes.any(|volume| volume.properties().scatters()),
            reflects: self.surfaces.iter().any(Surface::reflects),
        }
    }
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
