//! Rules across several values of a scene: directions that are not zero, placements that can be
//! inverted, a volume that is either a file or a shape.

use glam::{Mat3, Vec3};

use super::settings::{
    CameraSettings, EmissionMode, EnvironmentSettings, LightKind, LightSettings, RampKind,
    Settings, SurfaceSettings, SurfaceShape, VelocitySettings, VolumeSettings, VolumeShape,
};
use crate::error::{Error, Result};
use crate::volume::curve::Curve;

/// Checks the rules across values, of a scene whose single values are within their bounds.
pub(super) fn check_rules(settings: &Settings, source: &str) -> Result<()> {
    let fail = |(field, reason): (String, String)| Error::invalid(source, field, reason);
    let items = |list: &str, index: usize| {
        let prefix = format!("{list}.{index}");
        move |(key, reason): Fault| (format!("{prefix}.{key}"), reason)
    };
    camera(&settings.camera).map_err(|(key, reason)| fail((format!("camera.{key}"), reason)))?;
    environment(&settings.environment)
        .map_err(|(key, reason)| fail((format!("environment.{key}"), reason)))?;
    if settings.time.range.is_some_and(|[first, last]| first > last) {
        let reason = "the first frame comes after the last".to_owned();
        return Err(fail(("time.range".to_owned(), reason)));
    }
    for (index, one) in settings.volume.iter().enumerate() {
        volume(one).map_err(items("volume", index)).map_err(fail)?;
    }
    for (index, one) in settings.light.iter().enumerate() {
        light(one).map_err(items("light", index)).map_err(fail)?;
    }
    for (index, one) in settings.surface.iter().enumerate() {
        surface(one).map_err(items("surface", index)).map_err(fail)?;
    }
    if let Some(reason) = settings.strategy.tracker_refusal() {
        return Err(fail(("strategy.advanced.tracker".to_owned(), reason.to_owned())));
    }
    Ok(())
}

/// A key and what is wrong with it.
type Fault = (&'static str, String);

fn fault(key: &'static str, reason: impl Into<String>) -> Result<(), Fault> {
    Err((key, reason.into()))
}

fn camera(camera: &CameraSettings) -> Result<(), Fault> {
    if camera.key.windows(2).any(|pair| pair[0].frame >= pair[1].frame) {
        return fault("key", "the frames of the keys must ascend");
    }
    direction("up", camera.up)?;
    if camera.key.is_empty() {
        return camera_view(camera);
    }
    for key in &camera.key {
        camera_view(&camera.at(key.frame)).map_err(|(name, reason)| {
            (name, format!("{reason} (in the camera.key of frame {})", key.frame))
        })?;
    }
    Ok(())
}

/// Checks a camera without keys.
fn camera_view(camera: &CameraSettings) -> Result<(), Fault> {
    let forward = Vec3::from(camera.target) - Vec3::from(camera.position);
    if forward.try_normalize().is_none() {
        return fault("target", "target and position are the same point; move one of them");
    }
    let side = forward.normalize().cross(Vec3::from(camera.up).normalize());
    if side.length() < 1e-6 {
        return fault("up", "up points along the view; choose another direction");
    }
    Ok(())
}

/// At most one source of light; a radiance of 0 is none.
fn environment(environment: &EnvironmentSettings) -> Result<(), Fault> {
    let EnvironmentSettings { radiance, file, gradient, sky, .. } = environment;
    if file.as_ref().is_some_and(String::is_empty) {
        return fault("file", "the name is empty; name a picture, .hdr or .exr");
    }
    let sources = [
        ("radiance", !radiance.is_black()),
        ("file", file.is_some()),
        ("gradient", gradient.is_some()),
        ("sky", sky.is_some()),
    ];
    let mut given = sources.iter().filter(|(_, is_given)| *is_given);
    match (given.next(), given.next()) {
        (Some((first, _)), Some((second, _))) => {
            fault(second, format!("the sky has {first} or {second}, not both; leave one out"))
        }
        _ => Ok(()),
    }
}

fn volume(volume: &VolumeSettings) -> Result<(), Fault> {
    match (&volume.file, volume.shape) {
        (None, None) => return fault("file", "a volume needs a file or a shape"),
        (Some(_), Some(_)) => return fault("shape", "a volume has a file or a shape, not both"),
        (Some(file), None) if file.is_empty() => {
            return fault("file", "the name is empty; name a volume file");
        }
        _ => {}
    }
    if volume.frame_range.is_some_and(|[first, last]| first > last) {
        return fault("frame_range", "the first frame comes after the last");
    }
    if volume.density.level_set && volume.file.is_none() {
        return fault("density.level_set", "a shape is no level set; only a grid of a file is");
    }
    placement(volume)?;
    velocity(volume)?;
    if volume.shape == Some(VolumeShape::Everywhere) {
        everywhere(volume)?;
    }
    if volume.shape == Some(VolumeShape::Ramp) {
        ramp(volume)?;
    }
    let emission = &volume.emission;
    curve("density.curve", &volume.density.curve, Some(0.0))?;
    curve("emission.curve", &emission.curve, None)?;
    curve("emission.intensity_curve", &emission.intensity_curve, Some(0.0))?;
    if emission.intensity_grid.is_none() && !emission.intensity_curve.is_empty() {
        return fault("emission.intensity_curve", "name the grid that it maps in intensity_grid");
    }
    let stops = volume.emission.stops();
    if stops.is_empty() {
        return fault("emission.stops", "a ramp needs at least one stop [value, r, g, b]");
    }
    if stops.iter().zip(stops.iter().skip(1)).any(|(a, b)| a[0] >= b[0]) {
        return fault("emission.stops", "the values of the stops must ascend");
    }
    if stops.iter().any(|[_, rgb @ ..]| rgb.iter().any(|channel| *channel < 0.0)) {
        return fault("emission.stops", "a color is negative; the least is 0");
    }
    Ok(())
}

/// Most points of a curve.
const MOST_POINTS: usize = 64;

/// Checks the points of a curve, whose values are at least `least`, if there is a least.
fn curve(key: &'static str, points: &[[f32; 2]], least: Option<f32>) -> Result<(), Fault> {
    if points.len() > MOST_POINTS {
        return fault(key, format!("a curve has at most {MOST_POINTS} points"));
    }
    if points.windows(2).any(|pair| pair[0][0] >= pair[1][0]) {
        return fault(key, "the first numbers of the points must ascend");
    }
    if least.is_some_and(|least| points.iter().any(|point| point[1] < least)) {
        return fault(key, "a value of the curve is negative; the least is 0");
    }
    Ok(())
}

fn placement(volume: &VolumeSettings) -> Result<(), Fault> {
    let Some(matrix) = volume.matrix else { return Ok(()) };
    let other = VolumeSettings::default();
    if (volume.translate, volume.rotate, volume.scale)
        != (other.translate, other.rotate, other.scale)
    {
        return fault("matrix", "matrix replaces scale, rotate and translate; leave those out");
    }
    let rows = matrix.map(|[x, y, z, _]| Vec3::new(x, y, z));
    let determinant = Mat3::from_cols(rows[0], rows[1], rows[2]).determinant();
    let size: f32 = rows.iter().map(|row| row.length()).product();
    if determinant.abs() <= 1e-6 * size {
        return fault("matrix", "its first three columns flatten space; they must span it");
    }
    Ok(())
}

fn velocity(volume: &VolumeSettings) -> Result<(), Fault> {
    let velocity = &volume.velocity;
    if *velocity == VelocitySettings::default() {
        return Ok(());
    }
    if volume.file.is_none() {
        return fault("velocity", "a shape has no grids to move by; only a file has");
    }
    match (&velocity.grid, &velocity.grids) {
        (None, None) => {
            fault("velocity.grid", "name a grid of vectors, or three of numbers in grids")
        }
        (Some(_), Some(_)) => fault("velocity.grids", "grids replaces grid; leave one of them out"),
        _ => Ok(()),
    }
}

/// Without extinction, emission that fills space adds up to infinity.
fn everywhere(volume: &VolumeSettings) -> Result<(), Fault> {
    let emits = !matches!(volume.emission.mode, EmissionMode::None | EmissionMode::Source);
    let value = Curve::new(&volume.density.curve).map_or(1.0, |curve| curve.at(1.0));
    if emits && (volume.density.scale.rgb() * value).min_element() <= 0.0 {
        let reason = "a volume without borders that glows must have a density above 0 in every \
                      channel, else it is infinitely bright";
        return fault("density.scale", reason);
    }
    Ok(())
}

fn ramp(volume: &VolumeSettings) -> Result<(), Fault> {
    let axis = volume.axis().index();
    let far = 2.0 * volume.half_size().axes().get(axis).copied().unwrap_or(1.0);
    let end = volume.a() + volume.b() * far;
    if volume.kind() == RampKind::Linear && end < 0.0 {
        let reason = format!("the ramp falls to {end} at its high face; the least density is 0");
        return fault("b", reason);
    }
    Ok(())
}

fn light(light: &LightSettings) -> Result<(), Fault> {
    match light.kind {
        LightKind::Sun => direction("direction", light.direction()),
        LightKind::Quad => quad(light.half_u(), light.half_v()),
        LightKind::Spot => {
            let axis = Vec3::from(light.target()) - Vec3::from(light.position());
            match axis.try_normalize() {
                Some(_) => Ok(()),
                None => fault("target", "target and position are the same point; move one of them"),
            }
        }
        _ => Ok(()),
    }
}

fn surface(surface: &SurfaceSettings) -> Result<(), Fault> {
    match surface.shape {
        SurfaceShape::Plane => {
            if matches!(surface.half_size, Some(super::settings::Extent::Axes(_))) {
                return fault("half_size", "expected one number: a plane is cut to a square");
            }
            direction("normal", surface.normal())
        }
        SurfaceShape::Quad => quad(surface.half_u(), surface.half_v()),
        SurfaceShape::Box if surface.half_size.is_none() => {
            fault("half_size", "a box needs a half_size, a number or [x, y, z]")
        }
        _ => Ok(()),
    }
}

fn direction(key: &'static str, value: [f32; 3]) -> Result<(), Fault> {
    match Vec3::from(value).try_normalize() {
        Some(_) => Ok(()),
        None => fault(key, "a direction must not be zero"),
    }
}

fn quad(half_u: [f32; 3], half_v: [f32; 3]) -> Result<(), Fault> {
    let (u, v) = (Vec3::from(half_u), Vec3::from(half_v));
    if u.cross(v).length() <= 1e-6 * u.length() * v.length() {
        return fault("half_v", "half_u and half_v must point along two different edges");
    }
    Ok(())
}
