//! Snapshots: one-part EXR files with the picture, its layers, and all that is needed to go on.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

use exr::block::UncompressedBlock;
use exr::block::reader::{ChunksReader, Reader};
use exr::meta::header::Header as Part;
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, MetaData, SampleType, SmallVec, Vec2, WritableImage,
};
use glam::UVec2;

pub use super::exr_header::SnapshotHeader;
use super::exr_header::{Attributes, attributes};
use super::exr_layout::{SAMPLES, channel_names, push_pixel, state_from, state_names, words_at};
use crate::error::{Error, NO_PROGRESS, Progress, Result, report};
use crate::files;
use crate::render::film::{Film, Totals};

/// Header of an EXR file of any program.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    /// Number of parts; everything else is about the first.
    pub parts: usize,
    /// Width and height.
    pub size: UVec2,
    /// Names of the channels of the first part.
    pub channels: Vec<String>,
    /// The header, if Flambeau wrote it.
    pub header: Option<SnapshotHeader>,
    /// Mean samples of a pixel, if Flambeau wrote it.
    pub samples: f64,
    /// Counts over the whole film, as the file claims.
    pub totals: Totals,
}

/// Writes `film` as a snapshot.
///
/// # Errors
/// When the system refuses to write.
pub fn write(path: &Path, film: &Film, header: &SnapshotHeader) -> Result<()> {
    let size = film.size();
    let names = channel_names();
    let pixels = size.x as usize * size.y as usize;
    let mut planes: Vec<Vec<f32>> = names.iter().map(|_| Vec::with_capacity(pixels)).collect();
    for y in 0..size.y {
        for x in 0..size.x {
            push_pixel(film, UVec2::new(x, y), &mut planes);
        }
    }
    let channels: SmallVec<[_; 4]> = std::iter::zip(&names, planes)
        .map(|(name, plane)| AnyChannel::new(name.as_str(), FlatSamples::F32(plane)))
        .collect();
    write_channels(path, size, attributes(film, header)?, channels)
}

/// Writes a picture alone, linear RGBA with row 0 on top, as floats; no snapshot to go on from.
///
/// # Errors
/// When the pixels are not as many as `size` says, or the system refuses to write.
pub fn write_picture(path: &Path, size: UVec2, pixels: &[[f32; 4]]) -> Result<()> {
    if (size.x as usize).checked_mul(size.y as usize) != Some(pixels.len()) {
        let reason = format!("{} pixels are no picture of {size}", pixels.len());
        return Err(invalid(path, "", reason));
    }
    let channels: SmallVec<[_; 4]> = ["R", "G", "B", "A"]
        .into_iter()
        .enumerate()
        .map(|(index, name)| {
            let plane = pixels.iter().map(|pixel| pixel[index]).collect();
            AnyChannel::new(name, FlatSamples::F32(plane))
        })
        .collect();
    write_channels(path, size, LayerAttributes::default(), channels)
}

/// Writes channels with as many values as the picture has pixels.
fn write_channels(
    path: &Path,
    size: UVec2,
    attributes: LayerAttributes,
    channels: SmallVec<[AnyChannel<FlatSamples>; 4]>,
) -> Result<()> {
    let encoding = Encoding {
        compression: Compression::ZIP16,
        line_order: LineOrder::Increasing,
        ..Encoding::default()
    };
    let extent = (size.x as usize, size.y as usize);
    let layer = Layer::new(extent, attributes, encoding, AnyChannels::sort(channels));
    files::replace(path, |file| {
        Image::from_layer(layer)
            .write()
            .to_buffered(BufWriter::new(file))
            .map_err(|e| exr_error(path, e))
    })
}

/// Reads the header of the EXR file at `path`, without its pixels.
///
/// # Errors
/// When it cannot be read or is no EXR.
pub fn read_info(path: &Path) -> Result<Info> {
    info(path, open(path)?.meta_data())
}

pub(super) fn open(path: &Path) -> Result<Reader<BufReader<File>>> {
    let file = File::open(path).map_err(|e| Error::io(path, e))?;
    exr::block::read(BufReader::new(file), false).map_err(|e| exr_error(path, e))
}

fn info(path: &Path, data: &MetaData) -> Result<Info> {
    let Some(part) = data.headers.first() else {
        return Err(invalid(path, "", "has no image inside"));
    };
    let attributes = Attributes::new(path, &part.own_attributes);
    let size = UVec2::new(
        u32::try_from(part.layer_size.x()).map_err(|_| invalid(path, "", "is too wide"))?,
        u32::try_from(part.layer_size.y()).map_err(|_| invalid(path, "", "is too high"))?,
    );
    let mut info = Info {
        parts: data.headers.len(),
        size,
        channels: part.channels.list.iter().map(|channel| channel.name.to_string()).collect(),
        header: None,
        samples: 0.0,
        totals: Totals::default(),
    };
    if attributes.are_ours() {
        info.header = Some(attributes.header()?);
        info.totals = attributes.totals()?;
        info.samples = attributes.samples()?;
    }
    Ok(info)
}

/// A snapshot read back.
#[derive(Debug)]
pub struct Snapshot {
    /// The film as it was written.
    pub film: Film,
    /// Header of the snapshot.
    pub header: SnapshotHeader,
}

/// Reads a snapshot to go on from.
///
/// # Errors
/// When it cannot be read, was not written by [`write()`], or is damaged.
pub fn read_snapshot(path: &Path) -> Result<Snapshot> {
    read_snapshot_unless(path, NO_PROGRESS)
}

/// Reads a snapshot as [`read_snapshot`] does, unless it is given up on the way.
///
/// # Errors
/// The errors of [`read_snapshot`], and [`Error::Cancelled`] where `progress` says so.
pub fn read_snapshot_unless(path: &Path, progress: Progress) -> Result<Snapshot> {
    let reader = open(path)?;
    let info = info(path, reader.meta_data())?;
    let Some(header) = info.header else {
        let reason = "this EXR was not written by Flambeau, so it cannot be resumed";
        return Err(invalid(path, "", reason));
    };
    if info.parts != 1 {
        let reason = format!(
            "it has {} parts, and a snapshot has one; another program may have added to it, so \
             it cannot be resumed",
            info.parts
        );
        return Err(invalid(path, "", reason));
    }
    let mut film = Film::new(info.size)?;
    let paths = read_state(path, reader, &mut film, progress)?;
    // What can be counted is not taken on trust.
    film.totals = Totals { paths, ..info.totals };
    if film.totals.non_finite > paths || film.totals.guard_hits > paths {
        return Err(invalid(path, "state", "it claims more bad paths than there are paths"));
    }
    Ok(Snapshot { film, header })
}

/// Reads the beauty of a snapshot and leaves the rest: its size and linear RGBA, row 0 on top, to
/// the bit as [`resolve`](crate::render::picture::resolve) reads it from the film.
///
/// # Errors
/// When it cannot be read, was not written by Flambeau, or is damaged.
pub fn read_picture(path: &Path) -> Result<(UVec2, Vec<[f32; 4]>)> {
    let Info { size, header, .. } = read_info(path)?;
    if header.is_none() {
        return Err(invalid(path, "", "this EXR was not written by Flambeau"));
    }
    let width = size.x as usize;
    let count = width.saturating_mul(size.y as usize);
    let image = exr::prelude::read_first_rgba_layer_from_file(
        path,
        move |_, _| bytemuck::allocation::try_zeroed_vec(count).unwrap_or_default(),
        move |pixels: &mut Vec<[f32; 4]>, at, (r, g, b, a): (f32, f32, f32, f32)| {
            if let Some(pixel) = pixels.get_mut(at.y() * width + at.x()) {
                *pixel = [r, g, b, a];
            }
        },
    )
    .map_err(|e| exr_error(path, e))?;
    let pixels = image.layer_data.channel_data.pixels;
    match pixels.len() == count {
        true => Ok((size, pixels)),
        false => Err(invalid(path, "", "its picture does not fit the memory")),
    }
}

/// Fills `film` from the state of every pixel; returns the number of paths.
fn read_state(
    path: &Path,
    reader: Reader<BufReader<File>>,
    film: &mut Film,
    progress: Progress,
) -> Result<u64> {
    let Some(part) = reader.headers().first() else { return Ok(0) };
    let mut state = State::new(path, part, film)?;
    let mut failure = None;
    let result = reader.filter_chunks(false, |_, tile, _| tile.level_index == Vec2(0, 0)).and_then(
        |chunks| {
            chunks.decompress_parallel(false, |data, block| {
                let restored = match data.headers.first() {
                    Some(part) => report(progress, 0.0).and_then(|()| state.restore(part, &block)),
                    None => Ok(()),
                };
                restored.map_err(|error| {
                    failure = Some(error);
                    exr::error::Error::Aborted
                })
            })
        },
    );
    match (failure, result) {
        (Some(error), _) => Err(error),
        (None, Err(error)) => Err(exr_error(path, error)),
        (None, Ok(())) => Ok(state.paths),
    }
}

/// Puts the blocks of a file back into a film.
struct State<'a> {
    path: &'a Path,
    film: &'a mut Film,
    /// For every channel of the file, its row in `rows`; `None` for channels not needed to resume.
    row_of_channel: Vec<Option<usize>>,
    /// One scan line of every channel needed to resume, the sample counts last.
    rows: Vec<Vec<f32>>,
    paths: u64,
}

impl<'a> State<'a> {
    fn new(path: &'a Path, part: &Part, film: &'a mut Film) -> Result<Self> {
        if part.deep {
            return Err(invalid(path, "", "it holds deep data, which no snapshot does"));
        }
        let mut wanted = state_names();
        wanted.push(SAMPLES.to_owned());
        let channels = &part.channels.list;
        for name in &wanted {
            let Some(channel) = channels.iter().find(|channel| channel.name.eq(name.as_str()))
            else {
                let reason = "this channel is missing, and without it the render cannot be \
                              continued; another program may have dropped it, or an earlier \
                              version of Flambeau, which did not keep it, wrote the file";
                return Err(invalid(path, name, reason));
            };
            if channel.sample_type != SampleType::F32 || channel.sampling != Vec2(1, 1) {
                return Err(invalid(path, name, "this channel is not of 32-bit floats"));
            }
        }
        let row_of =
            |name: &exr::prelude::Text| wanted.iter().position(|one| name.eq(one.as_str()));
        let row_of_channel = channels.iter().map(|channel| row_of(&channel.name)).collect();
        Ok(Self { path, film, row_of_channel, rows: vec![Vec::new(); wanted.len()], paths: 0 })
    }

    fn restore(&mut self, part: &Part, block: &UncompressedBlock) -> Result<()> {
        let (Vec2(left, top), Vec2(width, height)) =
            (block.index.pixel_position, block.index.pixel_size);
        let (size, last) = (self.film.size(), self.row_of_channel.len() - 1);
        if left + width > size.x as usize || top + height > size.y as usize {
            return Err(invalid(self.path, "", "a block of it lies outside of the picture"));
        }
        for line in block.lines(&part.channels) {
            if let Some(row) = self.row_of_channel[line.location.channel] {
                self.rows[row].resize(width, 0.0);
                let read = line.read_samples_into_slice(&mut self.rows[row]);
                read.map_err(|e| exr_error(self.path, e))?;
            }
            if line.location.channel == last {
                self.restore_line(UVec2::new(left as u32, line.location.position.y() as u32))?;
            }
        }
        Ok(())
    }

    /// Restores the pixels from `first` to the right, out of the rows.
    fn restore_line(&mut self, first: UVec2) -> Result<()> {
        let (states, counts) = self.rows.split_at(self.rows.len() - 1);
        for (index, &count) in counts.iter().flatten().enumerate() {
            let pixel = UVec2::new(first.x + index as u32, first.y);
            let Some((count, sums)) = state_from(count, words_at(states, index)) else {
                let reason = format!("pixel {},{} holds impossible sums", pixel.x, pixel.y);
                return Err(invalid(self.path, "state", reason));
            };
            self.film.restore(pixel, count, &sums);
            self.paths += u64::from(count);
        }
        Ok(())
    }
}

pub(super) fn invalid(path: &Path, field: &str, reason: impl Into<String>) -> Error {
    Error::invalid(path.display().to_string(), field, reason)
}

pub(super) fn exr_error(path: &Path, error: exr::error::Error) -> Error {
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
    use exr::prelude::LayerAttributes;

    use super::*;
    use crate::files::Fingerprint;
    use crate::render::synthetic::{Uniform, sample_of};
    use crate::transport::PathSample;

    fn film(samples: u32) -> Film {
        let size = UVec2::new(37, 19);
        let mut film = Film::new(size).unwrap();
        for y in 0..size.y {
            for x in 0..size.x {
                let pixel = UVec2::new(x, y);
                // Uneven counts, as after an interrupt.
                for s in 0..samples + (x + y) % 2 {
                    film.add(pixel, &sample_of(&Uniform::default(), pixel, s));
                }
            }
        }
        film.add(UVec2::ZERO, &PathSample { alpha: f32::NAN, ..Default::default() });
        film
    }

    fn header() -> SnapshotHeader {
        SnapshotHeader {
            scene: "# Rauch über Feuer 煙\n[film]\nsize = [37, 19]\n".to_owned(),
            strategy: "emission_decoupling = true\n".to_owned(),
            seed: u64::MAX - 3,
            version: "0.1.0".to_owned(),
            path_version: 7,
            wall_seconds: 1.5,
            cpu_seconds_setup: 0.25,
            cpu_seconds_render: 2.75,
            files: vec![
                Fingerprint::of("/home/änne/torch.vdb", &b"voxels"[..], NO_PROGRESS).unwrap(),
            ],
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
            let mut pixels = Vec::new();
            crate::render::picture::resolve(&film, &mut pixels);
            assert_eq!(read_picture(&path).unwrap(), (film.size(), pixels));
        }
    }

    #[test]
    fn layers_sum_to_the_beauty() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.exr");
        write(&path, &film(50), &header()).unwrap();
        let image = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
        let channels = &image.layer_data.channel_data.list;
        let plane = |name: &str| -> Vec<f32> {
            let channel = channels.iter().find(|channel| channel.name.eq(name)).unwrap();
            channel.sample_data.values_as_f32().collect()
        };
        let planes = ["R", "emission.R", "background.R", "direct.R", "indirect.R"].map(plane);
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

    #[test]
    fn steps_are_a_mean_and_a_file_without_their_sums_says_what_is_missing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.exr");
        let mut film = Film::new(UVec2::ONE).unwrap();
        for steps in [1, 2, 6] {
            let sample = PathSample { tracking_steps: steps, ..Default::default() };
            film.add(UVec2::ZERO, &sample);
        }
        write(&path, &film, &header()).unwrap();
        let mut image = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
        let channels = &mut image.layer_data.channel_data.list;
        let steps = channels.iter().find(|channel| channel.name.eq("steps")).unwrap();
        assert_eq!(steps.sample_data.values_as_f32().collect::<Vec<_>>(), [3.0]);

        channels.retain(|channel| !channel.name.to_string().starts_with("state.steps"));
        image.write().to_file(&path).unwrap();
        let error = read_snapshot(&path).unwrap_err().to_string();
        assert!(error.contains("state.steps.Y") && error.contains("earlier version"), "{error}");
    }

    /// Scripts read attributes by these names; readers lose or refuse a text named `version`.
    #[test]
    fn attributes_have_plain_names() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.exr");
        write(&path, &film(2), &header()).unwrap();
        let data = MetaData::read_from_file(&path, true).unwrap();
        let attributes = &data.headers[0].own_attributes;
        let mut names: Vec<String> = attributes.other.keys().map(|name| name.to_string()).collect();
        names.retain(|name| !name.starts_with("flambeau."));
        names.sort_unstable();
        let expected = ["cpu_seconds", "samples", "scene", "seed", "strategy", "wall_seconds"];
        assert_eq!(names, expected);
        assert_eq!(attributes.software_name.as_ref().unwrap().to_string(), "Flambeau 0.1.0");
    }

    #[test]
    fn claims_about_paths_are_checked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.exr");
        let mut film = film(2);
        let paths = film.totals.paths;
        film.totals.paths = u64::MAX;
        film.totals.tracking_steps = u64::MAX;
        write(&path, &film, &header()).unwrap();
        let mut read = read_snapshot(&path).unwrap().film;
        assert_eq!(read.totals.paths, paths);
        let sample = PathSample { tracking_steps: 7, ..Default::default() };
        read.add(UVec2::ZERO, &sample);
        assert_eq!((read.totals.paths, read.totals.tracking_steps), (paths + 1, u64::MAX));

        film.totals.guard_hits = u64::MAX;
        write(&path, &film, &header()).unwrap();
        assert!(read_snapshot(&path).unwrap_err().to_string().contains("bad paths"));
    }

    #[test]
    fn a_second_part_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("parts.exr");
        let part = |name: &str, mut attributes: LayerAttributes| {
            attributes.layer_name = Some(name.into());
            let plane = AnyChannel::new("Y", FlatSamples::F32(vec![0.5; 4]));
            let channels = AnyChannels::sort(SmallVec::from_vec(vec![plane]));
            Layer::new((2, 2), attributes, Encoding::default(), channels)
        };
        let ours = attributes(&film(1), &header()).unwrap();
        let layers = vec![part("first", ours), part("second", LayerAttributes::default())];
        let window = exr::prelude::IntegerBounds::from_dimensions((2, 2));
        let image = Image::from_layers(exr::prelude::ImageAttributes::new(window), layers);
        image.write().to_file(&path).unwrap();
        assert_eq!(read_info(&path).unwrap().parts, 2);
        let error = read_snapshot(&path).unwrap_err().to_string();
        assert!(error.contains("2 parts"), "{error}");
    }
}
