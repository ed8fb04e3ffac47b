//! The color of any EXR, of Flambeau or another program.

use std::path::Path;

use bytemuck::allocation::try_zeroed_vec;
use exr::block::UncompressedBlock;
use exr::block::lines::LineRef;
use exr::block::reader::ChunksReader;
use exr::meta::header::Header as Part;
use exr::prelude::{SampleType, Vec2, f16};
use glam::{DVec2, UVec2};

use super::exr::{exr_error, invalid, open};
use super::primaries::Primaries;
use crate::error::{Error, Result};

/// A picture's size and its pixels, row 0 on top.
pub type Pixels = (UVec2, Vec<[f32; 4]>);

/// Largest number of pixels of a picture; a file that claims more is damaged.
const MAX_PIXELS: u64 = 1 << 28;

/// Reads R, G and B of the first layer that has all of them, as floats with an opaque alpha: the
/// beauty of a snapshot; elsewhere, within the first part that has one, the layer without a name,
/// or else the one that comes first.
///
/// # Errors
/// When the file cannot be read, is no EXR, is damaged, or has no such layer.
pub fn read(path: &Path) -> Result<Pixels> {
    let reader = open(path)?;
    let parts = reader.headers().iter().enumerate();
    let mut found = parts.filter_map(|(index, part)| Some((index, part, channels_of(part)?)));
    let Some((index, part, channels)) = found.next() else {
        return Err(no_color(path));
    };
    let mut target = BlockTarget::new(path, part, channels)?;
    let mut failure = None;
    let result = reader
        .filter_chunks(false, |_, tile, block| {
            block.layer == index && tile.level_index == Vec2(0, 0)
        })
        .and_then(|chunks| {
            chunks.decompress_parallel(false, |data, block| {
                let Some(part) = data.headers.get(index) else { return Ok(()) };
                target.put(part, &block).map_err(|error| {
                    failure = Some(error);
                    exr::error::Error::Aborted
                })
            })
        });
    match (failure, result) {
        (Some(error), _) => Err(error),
        (None, Err(error)) => Err(exr_error(path, error)),
        (None, Ok(())) => target.finish(),
    }
}

/// Size and chromaticities of the picture that [`read`] reads, without its pixels.
///
/// # Errors
/// When the file cannot be read or is no EXR, or has no such layer.
pub fn size_and_primaries(path: &Path) -> Result<(UVec2, Option<Primaries>)> {
    let reader = open(path)?;
    let part = reader.headers().iter().find(|part| channels_of(part).is_some());
    let Some(part) = part else { return Err(no_color(path)) };
    let Vec2(width, height) = part.layer_size;
    let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
    let primaries = part.shared_attributes.chromaticities.map(|found| {
        let [r, g, b, white] = [found.red, found.green, found.blue, found.white]
            .map(|Vec2(x, y)| DVec2::new(x.into(), y.into()));
        Primaries { rgb: [r, g, b], white }
    });
    Ok((UVec2::new(side(width), side(height)), primaries))
}

fn no_color(path: &Path) -> Error {
    let reason = "it has no layer with channels R, G and B; write one, flat and not deep";
    invalid(path, "R", reason)
}

/// The indices of R, G and B among the channels of `part`.
fn channels_of(part: &Part) -> Option<[usize; 3]> {
    let names: Vec<String> =
        part.channels.list.iter().map(|channel| channel.name.to_string()).collect();
    let index = |name: &str| names.iter().position(|one| one == name);
    let layer = |prefix: &str| {
        let [r, g, b] = ["R", "G", "B"].map(|channel| index(&format!("{prefix}{channel}")));
        Some([r?, g?, b?])
    };
    let named = || {
        let prefixes = names.iter().filter_map(|name| name.strip_suffix('R'));
        prefixes.filter(|prefix| prefix.ends_with('.')).find_map(layer)
    };
    if part.deep { None } else { layer("").or_else(named) }
}

/// A picture that is put together from blocks.
struct BlockTarget<'a> {
    path: &'a Path,
    size: UVec2,
    channels: [usize; 3],
    /// Alpha is 0 until a pixel's red has come.
    pixels: Vec<[f32; 4]>,
    /// A line of samples as floats.
    line: Vec<f32>,
}

impl<'a> BlockTarget<'a> {
    fn new(path: &'a Path, part: &Part, channels: [usize; 3]) -> Result<Self> {
        for channel in channels.map(|index| &part.channels.list[index]) {
            if channel.sampling != Vec2(1, 1) {
                let reason = "it has fewer samples than the picture has pixels; write it in full";
                return Err(invalid(path, &channel.name.to_string(), reason));
            }
        }
        let Vec2(width, height) = part.layer_size;
        let too_large = || {
            let reason = format!("{width} x {height} pixels do not fit the memory");
            invalid(path, "dataWindow", reason)
        };
        let pixels = (width as u64).saturating_mul(height as u64);
        if pixels == 0 {
            return Err(invalid(path, "dataWindow", "it has no pixels"));
        }
        if pixels > MAX_PIXELS {
            return Err(too_large());
        }
        // Zeroed by the system, page by page as blocks come.
        let pixels = try_zeroed_vec(pixels as usize).map_err(|()| too_large())?;
        let size = UVec2::new(width as u32, height as u32);
        Ok(Self { path, size, channels, pixels, line: Vec::new() })
    }

    fn put(&mut self, part: &Part, block: &UncompressedBlock) -> Result<()> {
        for line in block.lines(&part.channels) {
            let channel = line.location.channel;
            let Some(place) = self.channels.iter().position(|&index| index == channel) else {
                continue;
            };
            self.read_line(&line, part.channels.list[channel].sample_type)?;
            let Vec2(x, y) = line.location.position;
            let end = x + self.line.len();
            if end > self.size.x as usize || y >= self.size.y as usize {
                return Err(invalid(self.path, "", "a block of it lies outside of the picture"));
            }
            let row = y * self.size.x as usize;
            let pixels = &mut self.pixels[row + x..row + end];
            for (pixel, &sample) in std::iter::zip(pixels, &self.line) {
                pixel[place] = sample;
                pixel[3] = 1.0;
            }
        }
        Ok(())
    }

    fn read_line(&mut self, line: &LineRef<'_>, sample_type: SampleType) -> Result<()> {
        let count = line.location.sample_count;
        self.line.resize(count, 0.0);
        let read = match sample_type {
            SampleType::F32 => line.read_samples_into_slice(&mut self.line),
            SampleType::F16 => {
                let mut samples = vec![f16::ZERO; count];
                let read = line.read_samples_into_slice(&mut samples);
                std::iter::zip(&mut self.line, samples).for_each(|(to, from)| *to = from.to_f32());
                read
            }
            SampleType::U32 => {
                let reason = "it holds whole numbers; write floats, linear in light";
                return Err(Error::unsupported(self.path.display().to_string(), "R", reason));
            }
        };
        read.map_err(|e| exr_error(self.path, e))
    }

    fn finish(self) -> Result<Pixels> {
        match self.pixels.iter().position(|pixel| pixel[3] == 0.0) {
            None => Ok((self.size, self.pixels)),
            Some(index) => {
                let (x, y) = (index % self.size.x as usize, index / self.size.x as usize);
                let reason = format!("pixel {x},{y} is missing; the file is not complete");
                Err(invalid(self.path, "", reason))
            }
        }
    }
}
