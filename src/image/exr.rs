//! Snapshots: one-part EXR files with the picture, its layers, and all that is needed to go on.

use std::io::BufWriter;
use std::path::Path;

use exr::meta::attribute::AttributeValue;
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, MetaData, ReadChannels, ReadLayers, SmallVec, Text, WritableImage,
};
use glam::UVec2;

use super::exr_layout::{SAMPLES, channel_names, push_pixel, state_from, state_names, words_at};
use super::replace_file;
use crate::error::{Error, Result};
use crate::render::estimate::samples_per_pixel;
use crate::render::film::{Film, Totals};

/// What a snapshot says about itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header {
    /// The whole setting as a scene file, with absolute file names.
    pub scene: String,
    /// The sampling strategy as TOML.
    pub strategy: String,
    /// The seed of all samples.
    pub seed: u64,
    /// The version of Flambeau that wrote it.
    pub version: String,
    /// Wall-clock seconds spent on the picture, over all its sessions.
    pub wall_seconds: f64,
    /// CPU seconds spent on building the scene.
    pub cpu_seconds_setup: f64,
    /// CPU seconds spent on rendering.
    pub cpu_seconds_render: f64,
}

/// What the first bytes of an EXR say, whoever wrote it.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    /// Width and height of the first part.
    pub size: UVec2,
    /// Channels of the first part.
    pub channels: Vec<String>,
    /// The header, if Flambeau wrote it.
    pub header: Option<Header>,
    /// Mean samples of a pixel, if Flambeau wrote it.
    pub samples: f64,
    /// Counts over the whole film.
    pub totals: Totals,
}

const SCENE: &str = "flambeau.scene";
const STRATEGY: &str = "flambeau.strategy";
const SEED: &str = "flambeau.seed";
const SAMPLES_PER_PIXEL: &str = "flambeau.samples";
const VERSION: &str = "flambeau.version";
const WALL_SECONDS: &str = "flambeau.wallSeconds";
const CPU_SECONDS_SETUP: &str = "flambeau.cpuSecondsSetup";
const CPU_SECONDS_RENDER: &str = "flambeau.cpuSecondsRender";
const PATHS: &str = "flambeau.paths";
const TRACKING_STEPS: &str = "flambeau.trackingSteps";
const NON_FINITE: &str = "flambeau.nonFiniteSamples";
const GUARD_HITS: &str = "flambeau.guardHits";

/// Writes `film` as a snapshot.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, film: &Film, header: &Header) -> Result<()> {
    let size = film.size();
    let names = channel_names();
    let pixels = size.x as usize * size.y as usize;
    let mut planes = vec![Vec::with_capacity(pixels); names.len()];
    for y in 0..size.y {
        for x in 0..size.x {
            push_pixel(film, UVec2::new(x, y), &mut planes);
        }
    }
    let channels: SmallVec<[_; 4]> = std::iter::zip(&names, planes)
        .map(|(name, plane)| AnyChannel::new(name.as_str(), FlatSamples::F32(plane)))
        .collect();
    let software_name = Some(text(&format!("Flambeau {}", header.version)));
    let mut attributes = LayerAttributes { software_name, ..LayerAttributes::default() };
    attributes.other.extend(attribute_list(film, header));
    let encoding = Encoding {
        compression: Compression::ZIP16,
        line_order: LineOrder::Increasing,
        ..Encoding::default()
    };
    let extent = (size.x as usize, size.y as usize);
    let layer = Layer::new(extent, attributes, encoding, AnyChannels::sort(channels));
    replace_file(path, |file| {
        Image::from_layer(layer)
            .write()
            .to_buffered(BufWriter::new(file))
            .map_err(|e| exr_error(path, e))
    })
}

fn attribute_list(film: &Film, header: &Header) -> Vec<(Text, AttributeValue)> {
    let words = |value: &str| AttributeValue::Text(text(value));
    let count = |value: u64| AttributeValue::Text(text(&value.to_string()));
    let entries = [
        (SCENE, words(&header.scene)),
        (STRATEGY, words(&header.strategy)),
        (SEED, count(header.seed)),
        (VERSION, words(&header.version)),
        (SAMPLES_PER_PIXEL, AttributeValue::F64(samples_per_pixel(film))),
        (WALL_SECONDS, AttributeValue::F64(header.wall_seconds)),
        (CPU_SECONDS_SETUP, AttributeValue::F64(header.cpu_seconds_setup)),
        (CPU_SECONDS_RENDER, AttributeValue::F64(header.cpu_seconds_render)),
        (PATHS, count(film.totals.paths)),
        (TRACKING_STEPS, count(film.totals.tracking_steps)),
        (NON_FINITE, count(film.totals.non_finite)),
        (GUARD_HITS, count(film.totals.guard_hits)),
    ];
    entries.into_iter().map(|(name, value)| (text(name), value)).collect()
}

/// EXR text is bytes; ours are UTF-8.
fn text(value: &str) -> Text {
    Text::from_slice_unchecked(value.as_bytes())
}

/// Reads what `path` says about itself, without its pixels.
///
/// # Errors
/// When it cannot be read or is no EXR.
pub fn read_info(path: &Path) -> Result<Info> {
    let file = std::fs::File::open(path).map_err(|e| Error::io(path, e))?;
    let data = MetaData::read_from_unbuffered(file, false).map_err(|e| exr_error(path, e))?;
    let Some(part) = data.headers.first() else {
        return Err(invalid(path, "", "has no image inside"));
    };
    let attributes = Attributes { path, other: &part.own_attributes.other };
    let is_ours = attributes.other.contains_key(text(SCENE).as_slice());
    let size = UVec2::new(
        u32::try_from(part.layer_size.x()).map_err(|_| invalid(path, "", "is too wide"))?,
        u32::try_from(part.layer_size.y()).map_err(|_| invalid(path, "", "is too high"))?,
    );
    let mut info = Info {
        size,
        channels: part.channels.list.iter().map(|channel| channel.name.to_string()).collect(),
        header: None,
        samples: 0.0,
        totals: Totals::default(),
    };
    if is_ours {
        info.header = Some(attributes.header()?);
        info.totals = attributes.totals()?;
        info.samples = attributes.float(SAMPLES_PER_PIXEL)?;
    }
    Ok(info)
}

/// Custom attributes by name.
struct Attributes<'a> {
    path: &'a Path,
    other: &'a std::collections::HashMap<Text, AttributeValue>,
}

impl Attributes<'_> {
    fn header(&self) -> Result<Header> {
        Ok(Header {
            scene: self.text(SCENE)?,
            strategy: self.text(STRATEGY)?,
            seed: self.count(SEED)?,
            version: self.text(VERSION)?,
            wall_seconds: self.float(WALL_SECONDS)?,
            cpu_seconds_setup: self.float(CPU_SECONDS_SETUP)?,
            cpu_seconds_render: self.float(CPU_SECONDS_RENDER)?,
        })
    }

    fn totals(&self) -> Result<Totals> {
        Ok(Totals {
            paths: self.count(PATHS)?,
            tracking_steps: self.count(TRACKING_STEPS)?,
            non_finite: self.count(NON_FINITE)?,
            guard_hits: self.count(GUARD_HITS)?,
        })
    }

    fn text(&self, name: &str) -> Result<String> {
        match self.other.get(text(name).as_slice()) {
            Some(AttributeValue::Text(value)) => String::from_utf8(value.as_slice().to_vec())
                .map_err(|_| invalid(self.path, name, "is not UTF-8 text")),
            _ => Err(self.missing(name)),
        }
    }

    fn count(&self, name: &str) -> Result<u64> {
        let value = self.text(name)?;
        value.parse().map_err(|_| invalid(self.path, name, format!("{value:?} is not a count")))
    }

    fn float(&self, name: &str) -> Result<f64> {
        match self.other.get(text(name).as_slice()) {
            Some(AttributeValue::F64(value)) if value.is_finite() => Ok(*value),
            _ => Err(self.missing(name)),
        }
    }

    fn missing(&self, name: &str) -> Error {
        invalid(self.path, name, "this attribute is missing or of another type")
    }
}

/// A snapshot read back.
#[derive(Debug)]
pub struct Snapshot {
    /// The film, as it was when it was written.
    pub film: Film,
    /// What it says about itself.
    pub header: Header,
}

/// Reads a snapshot to go on from.
///
/// # Errors
/// When it cannot be read, was not written by [`write()`], or is damaged.
pub fn read_snapshot(path: &Path) -> Result<Snapshot> {
    let info = read_info(path)?;
    let Some(header) = info.header else {
        let reason = "this EXR was not written by Flambeau, so there is nothing to continue";
        return Err(invalid(path, "", reason));
    };
    let mut wanted = state_names();
    wanted.push(SAMPLES.to_owned());
    if let Some(missing) = wanted.iter().find(|name| !info.channels.contains(name)) {
        let reason = "this channel is missing; another program may have dropped it, and without \
                      it the render cannot be continued";
        return Err(invalid(path, missing.as_str(), reason));
    }
    let mut film = Film::new(info.size)?;
    let planes = read_planes(path, info.size, &wanted)?;
    let planes: Vec<&[f32]> = planes.iter().map(Vec::as_slice).collect();
    let (counts, states) = (planes[wanted.len() - 1], &planes[..wanted.len() - 1]);
    for y in 0..info.size.y {
        for x in 0..info.size.x {
            let index = y as usize * info.size.x as usize + x as usize;
            let (count, sums) =
                state_from(counts[index], words_at(states, index)).ok_or_else(|| {
                    invalid(path, "state", format!("pixel {x},{y} holds impossible sums"))
                })?;
            film.restore(UVec2::new(x, y), count, &sums);
        }
    }
    film.totals = info.totals;
    Ok(Snapshot { film, header })
}

/// The float planes of the wanted channels, in their order.
fn read_planes(path: &Path, size: UVec2, wanted: &[String]) -> Result<Vec<Vec<f32>>> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(|e| exr_error(path, e))?;
    let mut channels = image.layer_data.channel_data.list;
    let pixels = size.x as usize * size.y as usize;
    let take = |name: &String| {
        let found = channels.iter_mut().find(|channel| channel.name.eq(name.as_str()));
        match found
            .map(|channel| std::mem::replace(&mut channel.sample_data, FlatSamples::F32(vec![])))
        {
            Some(FlatSamples::F32(plane)) if plane.len() == pixels => Ok(plane),
            _ => Err(invalid(path, name.as_str(), "this channel is not of 32-bit floats")),
        }
    };
    wanted.iter().map(take).collect()
}

fn invalid(path: &Path, field: &str, reason: impl Into<String>) -> Error {
    Error::invalid(path.display().to_string(), field, reason)
}

fn exr_error(path: &Path, error: exr::error::Error) -> Error {
    match error {
        exr::error::Error::Io(e) => Error::io(path, e),
        exr::error::Error::NotSupported(what) => {
            Error::unsupported(path.display().to_string(), "", what)
        }
        exr::error::Error::Invalid(what) => {
            invalid(path, "", format!("not a readable EXR: {what}"))
        }
        exr::error::Error::Aborted => Error::Cancelled,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::synthetic::Uniform;
    use crate::transport::{PathSample, PixelSampler};

    fn film(samples: u32) -> Film {
        let size = UVec2::new(37, 19);
        let mut film = Film::new(size).unwrap();
        for y in 0..size.y {
            for x in 0..size.x {
                let pixel = UVec2::new(x, y);
                // Uneven counts, as after an interrupt.
                for s in 0..samples + (x + y) % 2 {
                    film.add(pixel, &Uniform::default().sample(pixel, s));
                }
            }
        }
        film.add(UVec2::ZERO, &PathSample { alpha: f32::NAN, ..Default::default() });
        film
    }

    fn header() -> Header {
        Header {
            scene: "# Rauch über Feuer 煙\n[film]\nsize = [37, 19]\n".to_owned(),
            strategy: "emission_decoupling = true\n".to_owned(),
            seed: u64::MAX - 3,
            version: "0.1.0".to_owned(),
            wall_seconds: 1.5,
            cpu_seconds_setup: 0.25,
            cpu_seconds_render: 2.75,
        }
    }

    #[test]
    fn a_snapshot_comes_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.exr");
        for samples in [0, 1, 1000] {
            let film = film(samples);
            write(&path, &film, &header()).unwrap();
            let snapshot = read_snapshot(&path).unwrap();
            assert_eq!(snapshot.film, film);
            assert_eq!(snapshot.header, header());
        }
    }

    #[test]
    fn layers_sum_to_the_beauty() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.exr");
        write(&path, &film(50), &header()).unwrap();
        let names: Vec<String> = ["R", "emission.R", "background.R", "direct.R", "indirect.R"]
            .map(str::to_owned)
            .to_vec();
        let planes = read_planes(&path, UVec2::new(37, 19), &names).unwrap();
        for i in 0..planes[0].len() {
            let sum: f32 = planes[1..].iter().map(|plane| plane[i]).sum();
            assert!((sum - planes[0][i]).abs() <= 1e-6 * planes[0][i].abs(), "pixel {i}");
        }
        let info = read_info(&path).unwrap();
        assert_eq!(info.size, UVec2::new(37, 19));
        assert!((50.0..51.0).contains(&info.samples), "{}", info.samples);
        assert_eq!(info.totals.non_finite, 1);
    }

    #[test]
    fn strangers_and_wrecks_are_refused_with_a_reason() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("foreign.exr");
        exr::prelude::write_rgb_file(&path, 4, 4, |_, _| (0.5f32, 0.5f32, 0.5f32)).unwrap();
        let error = read_snapshot(&path).unwrap_err().to_string();
        assert!(error.contains("not written by Flambeau"), "{error}");
        assert_eq!(read_info(&path).unwrap().channels, ["B", "G", "R"]);

        write(&path, &film(2), &header()).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        let error = read_snapshot(&path).unwrap_err().to_string();
        assert!(error.contains("foreign.exr"), "{error}");

        std::fs::write(&path, b"no picture").unwrap();
        assert!(read_info(&path).unwrap_err().to_string().contains("EXR"));
        assert!(read_info(&folder.path().join("absent.exr")).is_err());
    }
}
