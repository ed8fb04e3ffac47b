//! The environment of the settings as the core knows it.

use crate::error::{Progress, Result};
use crate::light::{ClearSky, Environment, Gradient, Orientation, Radiance, Sun, Up};
use crate::math::Rgb;
use crate::scene::VolumeCache;
use crate::scene::sequence::Gap;
use crate::scene::settings::{EnvironmentSettings, Settings, SkySettings, WorldUp};

/// The largest factor of an environment's radiance.
const MOST_SCALE: f32 = 1e30;
/// Diameter of the sun's disk in degrees.
const SUN_ANGLE: f32 = 0.53;

/// The environment of a scene, as it was built.
pub(super) struct BuiltEnvironment {
    pub(super) environment: Environment,
    /// The sun of its sky.
    pub(super) sun: Option<Sun>,
    /// Pixels of its picture that hold no radiance.
    pub(super) gap: Option<Gap>,
}

/// The environment of the scene file. Its map stays in `cache` until a scene is built without.
///
/// # Errors
/// The picture cannot be read; names the file.
pub(super) fn environment(
    settings: &Settings,
    cache: &VolumeCache,
    progress: Progress,
) -> Result<BuiltEnvironment> {
    let EnvironmentSettings { radiance, file, gradient, sky, .. } = &settings.environment;
    let maps = cache.environment();
    match (file, gradient, sky) {
        (Some(file), ..) => {
            let kept = maps.of_file(file, progress)?;
            let gap = Gap::Pixels { file: file.clone(), pixels: kept.mended };
            let gap = (kept.mended > 0).then_some(gap);
            Ok(BuiltEnvironment { gap, ..turned(settings, Radiance::Map(kept.map), 0.0) })
        }
        (_, _, Some(sky)) => {
            let model = clear_sky(sky);
            let map = maps.of_sky(&model)?.map;
            let built = turned(settings, Radiance::Map(map), sky.sun_azimuth);
            let sun = sky.sun.then(|| sun(settings, &model, sky.sun_azimuth));
            Ok(BuiltEnvironment { sun, ..built })
        }
        (_, gradient, _) => {
            maps.clear();
            let gradient = gradient.map(|colors| Gradient::new(colors.map(|color| color.rgb())));
            let radiance = gradient.map_or(Radiance::Even(radiance.rgb()), Radiance::Gradient);
            Ok(turned(settings, radiance, 0.0))
        }
    }
}

/// An environment with the factors and the rotation of the settings, turned by so many degrees
/// more.
fn turned(settings: &Settings, radiance: Radiance, degrees: f32) -> BuiltEnvironment {
    let orientation = orientation(settings, degrees);
    let is_hidden = !settings.environment.visible;
    let environment = Environment::new(radiance, scale(settings), orientation, is_hidden);
    BuiltEnvironment { environment, sun: None, gap: None }
}

fn orientation(settings: &Settings, degrees: f32) -> Orientation {
    let up = match settings.scene.up {
        WorldUp::Y => Up::Y,
        WorldUp::Z => Up::Z,
    };
    Orientation::new(up, settings.environment.rotation + degrees)
}

fn scale(settings: &Settings) -> Rgb {
    let EnvironmentSettings { exposure, tint, .. } = &settings.environment;
    (tint.rgb() * exposure.exp2()).min(Rgb::splat(MOST_SCALE))
}

fn clear_sky(sky: &SkySettings) -> ClearSky {
    let SkySettings { sun_elevation, sun_azimuth: _, turbidity, ground_albedo, sun } = *sky;
    ClearSky { sun_elevation, turbidity, ground_albedo, has_sun: sun }
}

fn sun(settings: &Settings, sky: &ClearSky, azimuth: f32) -> Sun {
    let to_sun = orientation(settings, azimuth).world_from_local(sky.to_sun());
    let irradiance = scale(settings) * sky.sun_irradiance();
    Sun::new(-to_sun, irradiance, SUN_ANGLE, settings.environment.visible)
}
