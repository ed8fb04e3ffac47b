//! Settings to the core's scene.

mod camera;
mod environment;
mod motion;
mod placement;
mod source;
mod surfaces;
mod volumes;

use super::sequence::Gap;
use super::{VolumeCache, settings::Settings};
use crate::{
    error::{Progress, Result},
    light::{Light, Lights},
    transport::Scene,
    volume::world::World,
};

pub use camera::camera;
use environment::BuiltEnvironment;
pub(crate) use placement::world_from_file;
use surfaces::LightOrSurface;

/// A scene as it was built.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// The scene.
    pub scene: Scene,
    /// Missing files and grids of the frame, volume by volume, and of its environment.
    pub gaps: Vec<Gap>,
}

/// Builds the scene of the settings at their frame. What the frame lacks is passed over.
///
/// # Errors
/// The errors of [`assemble_frame`].
pub fn assemble(settings: &Settings, cache: &VolumeCache, progress: Progress) -> Result<Scene> {
    assemble_frame(settings, cache, progress).map(|assembled| assembled.scene)
}

/// Builds the scene of the settings at their frame. Files and what was derived from them stay in
/// `cache`, so that a scene of which only numbers have changed is built in a few milliseconds.
///
/// # Errors
/// The settings are not valid, or a file cannot be read; names the file, the key and the fix.
pub fn assemble_frame(
    settings: &Settings,
    cache: &VolumeCache,
    progress: Progress,
) -> Result<Assembled> {
    super::validate(settings, "")?;
    let mut surfaces: Vec<_> = settings.surface.iter().map(surfaces::surface).collect();
    let mut lights = Vec::new();
    for light in &settings.light {
        match surfaces::light(light) {
            LightOrSurface::Light(light) => lights.push(light),
            LightOrSurface::Surface(surface) => surfaces.push(surface),
        }
    }
    let (instances, mut gaps) =
        volumes::instances(&settings.volume, &settings.time, cache, progress)?;
    let used: Vec<_> = instances.iter().map(|instance| instance.volume().clone()).collect();
    cache.retain(&used);
    let world = World::new(instances);
    let camera = camera(settings)?;
    let BuiltEnvironment { environment, sun, gap } =
        environment::environment(settings, cache, progress)?;
    lights.extend(sun.map(Light::Sun));
    gaps.extend(gap);
    let lights = Lights::new(environment, lights, &surfaces, &world);
    let max_scatters = settings.path.max_scatters;
    let scene = Scene::new(camera, world, surfaces, lights, max_scatters, settings.strategy);
    Ok(Assembled { scene, gaps })
}

/// Reads and builds the volumes of the settings at their frame, so that they are there when the
/// scene goes to it. They stay in `cache` as far as there is room.
///
/// # Errors
/// The errors of [`assemble_frame`].
pub fn prefetch(settings: &Settings, cache: &VolumeCache, progress: Progress) -> Result<()> {
    volumes::instances(&settings.volume, &settings.time, cache, progress)?;
    Ok(())
}
