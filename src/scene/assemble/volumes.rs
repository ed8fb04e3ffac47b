//! Volumes of the settings as the core knows them.

use std::sync::Arc;

use glam::{DAffine3, Vec3A};

use super::{
    motion::{motion, time_in_motion},
    placement::world_from_file,
    source::{GridSource, ShapeSource, VolumeSource},
};
use crate::error::{Error, Progress, Result};
use crate::math::Rgb;
use crate::scene::VolumeCache;
use crate::scene::cache::{BuiltVolume, VolumeFile};
use crate::scene::effect::emits;
use crate::scene::sequence::{Gap, Listings, VolumeFrame, volume_frame};
use crate::scene::settings::{
    Albedo, EmissionMode, EmissionSettings, Extent, Normalize, Outside, PhaseSettings,
    TimeSettings, VolumeSettings,
};
use crate::volume::emission::{Blackbody, ColorRamp, Emission, ScaledEmission};
use crate::volume::field::{RgbField, ScalarField};
use crate::volume::phase::Phase;
use crate::volume::world::Instance;
use crate::volume::{MediumProperties, Region, Volume};

/// Edge of the cells that bound a file's grids, in voxels.
const CELL_VOXELS: f32 = 4.0;

/// Builds and places every volume; those that differ only in their placement are one. A volume that
/// shows nothing in this frame is left out. Gives what the frame lacks as well.
pub(super) fn instances(
    volumes: &[VolumeSettings],
    time: &TimeSettings,
    cache: &VolumeCache,
    progress: Progress,
) -> Result<(Vec<Instance>, Vec<Gap>)> {
    let count = volumes.len().max(1) as f32;
    let (mut instances, mut gaps) = (Vec::new(), Vec::new());
    let mut listings = Listings::default();
    for (index, settings) in volumes.iter().enumerate() {
        let part = |fraction: f32| progress((index as f32 + fraction) / count);
        if !part(0.0) {
            return Err(Error::Cancelled);
        }
        let key = format!("volume.{index}");
        let frame = volume_frame(settings, time, &mut listings)?;
        let time = time_in_motion(settings, time);
        let built = built((settings, time), &frame, &key, cache, &part)?;
        gaps.extend(frame.gap);
        let Some(built) = built else {
            gaps.extend(frame.file.map(|file| Gap::Empty { file }));
            continue;
        };
        gaps.extend(built.gaps.iter().cloned());
        instances.push(placed(built, settings, &key)?);
    }
    Ok((instances, gaps))
}

/// A volume in its place.
fn placed(built: BuiltVolume, settings: &VolumeSettings, key: &str) -> Result<Instance> {
    // Both may be far away and their product near, so that it is rounded only at the end.
    let world_from_local = (world_from_file(settings) * built.file_from_local).as_affine3a();
    if !(world_from_local.is_finite() && world_from_local.inverse().is_finite()) {
        let field = if settings.matrix.is_some() { "matrix" } else { "scale" };
        let reason = "places the volume too small, too large or too far away to be drawn";
        return Err(Error::invalid("", format!("{key}.{field}"), reason));
    }
    Ok(Instance::new(built.volume, world_from_local))
}

/// A volume of a shape or of the file of its `frame`, with its time within the frame if it moves;
/// `None` if that shows nothing.
fn built(
    (settings, time): (&VolumeSettings, Option<TimeSettings>),
    frame: &VolumeFrame,
    key: &str,
    cache: &VolumeCache,
    progress: Progress,
) -> Result<Option<BuiltVolume>> {
    let file = match &frame.file {
        Some(name) => Some(cache.file(name, progress)?),
        None if settings.file.is_some() => return Ok(None),
        None => None,
    };
    let unplaced = unplaced(settings, time.is_some());
    if let Some(known) = cache.built(&unplaced, time, file.as_ref()) {
        return Ok(Some(known));
    }
    let built = match (&file, settings.shape) {
        (Some(file), _) => {
            let fullest = frame.fullest.as_deref().filter(|name| *name != file.name());
            let lacks = |grid: &str| match fullest {
                Some(name) => {
                    Ok(!file.has_grid(grid) && cache.file(name, progress)?.has_grid(grid))
                }
                None => Ok(false),
            };
            from_file(file, (&unplaced, time), key, &lacks, progress)?
        }
        (None, Some(shape)) => {
            let shape = ShapeSource::new(shape, &unplaced);
            let volume = from_shape(shape, &unplaced, key, progress)?;
            Some((volume, DAffine3::IDENTITY, Vec::new()))
        }
        (None, None) => {
            return Err(Error::invalid("", key, "a volume needs a file or a shape"));
        }
    };
    let Some((volume, file_from_local, gaps)) = built else { return Ok(None) };
    let volume = Arc::new(volume);
    let built = BuiltVolume { settings: unplaced, time, file, volume, file_from_local, gaps };
    cache.keep(built.clone());
    Ok(Some(built))
}

/// The settings without what does not change the volume itself, as the velocity does not unless it
/// `moves`.
fn unplaced(settings: &VolumeSettings, moves: bool) -> VolumeSettings {
    let velocity = if moves { settings.velocity.clone() } else { Default::default() };
    VolumeSettings {
        velocity,
        name: String::new(),
        frame_offset: 0,
        frame_range: None,
        outside: Outside::default(),
        translate: [0.0; 3],
        rotate: [0.0; 3],
        scale: Extent::default(),
        matrix: None,
        ..settings.clone()
    }
}

/// A volume of the grids of a file, with its place in the file's space and the grids that it lacks;
/// `None` if there is nothing in them. With a `time` it moves.
fn from_file(
    file: &VolumeFile,
    (settings, time): (&VolumeSettings, Option<TimeSettings>),
    key: &str,
    lacks: &dyn Fn(&str) -> Result<bool>,
    progress: Progress,
) -> Result<Option<(Volume, DAffine3, Vec<Gap>)>> {
    let mut source = VolumeSource::Grids(GridSource::new(file, lacks, progress));
    let properties = properties(&mut source, settings, key)?;
    let VolumeSource::Grids(mut grids) = source else {
        return Err(Error::invalid(file.name(), key, "the file has no grids"));
    };
    if grids.bounds().is_empty() {
        return Ok(None);
    }
    let cell_size = Vec3A::splat(CELL_VOXELS);
    let voxel = grids.voxel();
    let volume = match time {
        None => Volume::varying(grids.bounds(), properties, cell_size, voxel, progress)?,
        Some(time) => {
            let motion = motion(&mut grids, &settings.velocity, &time, key)?;
            Volume::moving(motion, properties, cell_size, voxel, progress)?
        }
    };
    Ok(Some((volume, grids.file_from_local(), grids.into_gaps())))
}

fn from_shape(
    shape: ShapeSource,
    settings: &VolumeSettings,
    key: &str,
    progress: Progress,
) -> Result<Volume> {
    let (region, cell_size) = (shape.region, shape.cell_size);
    let is_constant = matches!(shape.field, ScalarField::Constant(_));
    let properties = properties(&mut VolumeSource::Shape(shape), settings, key)?;
    Ok(match region {
        Region::Box(bounds) if !is_constant => {
            Volume::varying(bounds, properties, cell_size, None, progress)?
        }
        region => Volume::uniform(region, properties),
    })
}

fn properties(
    source: &mut VolumeSource,
    settings: &VolumeSettings,
    key: &str,
) -> Result<MediumProperties> {
    // Without density the grid is read only where something else needs it: emission, or the
    // borders.
    let needs_density = !settings.density.scale.is_black()
        || settings.emission.times_density()
        || settings.emission_grid().is_none();
    let density = match needs_density {
        true => source.density(settings, &format!("{key}.density.grid"))?,
        false => ScalarField::Constant(0.0),
    };
    let albedo = match &settings.albedo {
        Albedo::Gray(value) => RgbField::Constant(Rgb::splat(*value)),
        Albedo::Rgb(rgb) => RgbField::Constant(Rgb::from_array(*rgb)),
        Albedo::Grid(_) if settings.density.scale.is_black() => RgbField::Constant(Rgb::ZERO),
        Albedo::Grid(named) => source.rgb(&named.grid, &format!("{key}.albedo.grid"))?,
    };
    let emission = match emission(source, settings, &format!("{key}.emission.grid"))? {
        Emission::None => Emission::None,
        emission => scaled(source, settings, emission, key)?,
    };
    // Emission of zero needs no walks, but its grids must be there all the same.
    let emission = if emits(settings) { emission } else { Emission::None };
    let density_scale = settings.density.scale.rgb();
    let PhaseSettings { g, g2, mix } = settings.phase;
    let phase = Phase { g, g2, mix };
    Ok(MediumProperties { density, density_scale, albedo, phase, emission })
}

/// An emission times the grid of its intensity, if it has one.
fn scaled(
    source: &mut VolumeSource,
    settings: &VolumeSettings,
    emission: Emission,
    key: &str,
) -> Result<Emission> {
    let EmissionSettings { intensity_grid: Some(grid), intensity_curve, .. } = &settings.emission
    else {
        return Ok(emission);
    };
    let field = format!("{key}.emission.intensity_grid");
    let intensity = source.curved(grid, &field, intensity_curve)?;
    Ok(Emission::Scaled(Box::new(ScaledEmission { emission, intensity })))
}

fn emission(source: &mut VolumeSource, settings: &VolumeSettings, key: &str) -> Result<Emission> {
    let emission = &settings.emission;
    // Of the modes that read a grid; the others leave it alone.
    let grid = settings.emission_grid().unwrap_or_default();
    let color = emission.color().rgb();
    Ok(match emission.mode {
        EmissionMode::None => Emission::None,
        EmissionMode::Grid => Emission::Field {
            field: match emission.curve.is_empty() {
                true => source.rgb(grid, key)?,
                false => RgbField::Tinted(source.curved(grid, key, &emission.curve)?, Rgb::ONE),
            },
            scale: emission.scale() * color,
        },
        EmissionMode::Constant => {
            Emission::Field { field: RgbField::Constant(emission.value().rgb()), scale: color }
        }
        EmissionMode::Source => Emission::Source { le: emission.le().rgb() * color },
        EmissionMode::Blackbody => Emission::Blackbody(Blackbody {
            field: source.curved(grid, key, &emission.curve)?,
            kelvin_offset: emission.kelvin_offset(),
            kelvin_scale: emission.kelvin_scale(),
            intensity: emission.intensity() * color,
            times_density: emission.times_density(),
            t4_reference: match emission.normalize() {
                Normalize::Peak => None,
                Normalize::T4 => Some(emission.reference_kelvin()),
            },
        }),
        EmissionMode::Ramp => Emission::Ramp(ColorRamp {
            field: source.curved(grid, key, &emission.curve)?,
            stops: emission
                .stops()
                .iter()
                .map(|&[value, r, g, b]| (value, Rgb::new(r, g, b)))
                .collect(),
            intensity: emission.intensity() * color,
            times_density: emission.times_density(),
        }),
    })
}
