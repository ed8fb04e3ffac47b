//! References of all kinds, and what is said of broken ones.

use std::path::PathBuf;

use exr::prelude::*;
use glam::UVec2;

use super::Reference;
use crate::image::exr::SnapshotHeader;
use crate::render::Film;
use crate::render::picture::resolve;
use crate::render::synthetic::{Uniform, sample_of};

/// A folder for one file.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn load(&self, bytes: &[u8]) -> crate::error::Result<Reference> {
        let path = self.path("reference");
        std::fs::write(&path, bytes).unwrap();
        Reference::load(&path)
    }

    #[track_caller]
    fn assert_refused(&self, bytes: &[u8], words: &[&str]) {
        let error = self.load(bytes).unwrap_err().to_string();
        for word in words.iter().chain(&["reference"]) {
            assert!(error.contains(word), "{word:?} is not in {error:?}");
        }
    }
}

/// A numpy file, put together by hand from the description of the format.
fn npy(version: u8, descr: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut header =
        format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}");
    let before = if version == 1 { 10 } else { 12 };
    let end = (before + header.len() + 1).next_multiple_of(64) - before;
    header.extend(std::iter::repeat_n(' ', end - 1 - header.len()));
    header.push('\n');
    let length = header.len() as u32;
    let mut bytes = b"\x93NUMPY".to_vec();
    bytes.extend([version, 0]);
    bytes.extend(&length.to_le_bytes()[..before - 8]);
    bytes.extend(header.bytes());
    bytes.extend(data);
    bytes
}

/// 0.5, 1.5, ... as little-endian float32.
fn floats(count: usize) -> Vec<u8> {
    (0..count).flat_map(|i| (i as f32 + 0.5).to_le_bytes()).collect()
}

fn rgb(reference: &Reference) -> Vec<[f32; 3]> {
    reference.pixels().iter().map(|&[r, g, b, _]| [r, g, b]).collect()
}

#[test]
fn arrays_of_all_types_shapes_and_versions_are_read() {
    let place = Place::new();
    let big: Vec<u8> = (0..6).flat_map(|i| (i as f32 + 0.5).to_be_bytes()).collect();
    let double: Vec<u8> = (0..6).flat_map(|i| (f64::from(i) + 0.5).to_le_bytes()).collect();
    let double_big: Vec<u8> = (0..6).flat_map(|i| (f64::from(i) + 0.5).to_be_bytes()).collect();
    let (colors, size) = (vec![[0.5, 1.5, 2.5], [3.5, 4.5, 5.5]], UVec2::new(1, 2));
    for (version, descr, data) in [
        (1, "<f4", floats(6)),
        (2, "<f4", floats(6)),
        (3, "<f4", floats(6)),
        (1, ">f4", big),
        (1, "<f8", double),
        (2, ">f8", double_big),
    ] {
        let read = place.load(&npy(version, descr, "False", "(2, 1, 3)", &data)).unwrap();
        assert_eq!((read.size(), rgb(&read)), (size, colors.clone()), "{version} {descr}");
    }
    let gray = place.load(&npy(1, "<f4", "False", "(1, 2)", &floats(2))).unwrap();
    assert_eq!((gray.size(), rgb(&gray)), (UVec2::new(2, 1), vec![[0.5; 3], [1.5; 3]]));
    let alpha = place.load(&npy(1, "<f4", "False", "(2, 1, 4)", &floats(8))).unwrap();
    assert_eq!(rgb(&alpha), [[0.5, 1.5, 2.5], [4.5, 5.5, 6.5]]);
}

#[test]
fn arrays_that_are_no_pictures_are_refused_with_the_mend() {
    let place = Place::new();
    let refuse = |descr, order, shape, count, words: &[&str]| {
        place.assert_refused(&npy(1, descr, order, shape, &floats(count)), words);
    };
    refuse("<f4", "True", "(2, 1, 3)", 6, &["fortran_order", "ascontiguousarray"]);
    refuse("|u1", "False", "(2, 1, 3)", 6, &["descr", "|u1", "astype"]);
    refuse("<f4", "False", "(2, 1, 5)", 10, &["shape", "[2, 1, 5]", "(height, width, 3)"]);
    refuse("<f4", "False", "(6,)", 6, &["shape"]);
    refuse("<f4", "False", "(0, 2, 3)", 0, &["shape"]);
    refuse("<f4", "False", "(2, 1, 3)", 5, &["shape", "24", "20"]);
    refuse("<f4", "False", "(2, 1, 3)", 7, &["shape", "24", "28"]);
    refuse("<f4", "False", "(4000000000, 4000000000, 3)", 6, &["shape"]);
    refuse("<f4", "False", "(99999999999999999999, 1)", 6, &["shape"]);
    for value in 3..6 {
        let mut nan = floats(6);
        nan[4 * value..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
        let nan = npy(1, "<f4", "False", "(2, 1, 3)", &nan);
        place.assert_refused(&nan, &["0,1", "not finite"]);
    }
    let huge: Vec<u8> = [1.0e300; 3].iter().flat_map(|x: &f64| x.to_le_bytes()).collect();
    place.assert_refused(&npy(1, "<f8", "False", "(1, 1, 3)", &huge), &["not finite"]);
}

#[test]
fn other_files_and_sizes_are_refused_with_the_mend() {
    let place = Place::new();
    for other in [&b""[..], b"\x89PNG\r\n\x1a\n picture", b"\x93NUM", b"\x76\x2f"] {
        place.assert_refused(other, &[".exr", ".npy"]);
    }
    let absent = Reference::load(&place.path("absent.exr")).unwrap_err().to_string();
    assert!(absent.contains("absent.exr"), "{absent}");

    let reference = place.load(&npy(1, "<f4", "False", "(2, 1, 3)", &floats(6))).unwrap();
    reference.matches(UVec2::new(1, 2)).unwrap();
    let error = reference.matches(UVec2::new(2, 1)).unwrap_err().to_string();
    for word in ["reference", "1 x 2", "2 x 1", "--size 1x2"] {
        assert!(error.contains(word), "{error}");
    }
    assert!(Reference::new("x", UVec2::new(2, 2), vec![[0.0; 4]; 3]).is_err());
    assert!(Reference::new("x", UVec2::ZERO, Vec::new()).is_err());
}

/// A snapshot whose pixels all differ.
fn snapshot(path: &std::path::Path, size: UVec2) -> Film {
    let mut film = Film::new(size).unwrap();
    for (y, x) in (0..size.y).flat_map(|y| (0..size.x).map(move |x| (y, x))) {
        let pixel = UVec2::new(x, y);
        (0..3).for_each(|sample| film.add(pixel, &sample_of(&Uniform::default(), pixel, sample)));
    }
    crate::image::exr::write(path, &film, &SnapshotHeader::default()).unwrap();
    film
}

#[test]
fn snapshots_give_their_beauty() {
    let place = Place::new();
    let path = place.path("torch.exr");
    let size = UVec2::new(37, 19);
    let film = snapshot(&path, size);
    let mut shown = Vec::new();
    resolve(&film, &mut shown);
    let read = Reference::load(&path).unwrap();
    let expected: Vec<_> = shown.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
    assert_eq!((read.size(), rgb(&read)), (size, expected));
}

fn channel(name: &str, values: FlatSamples) -> AnyChannel<FlatSamples> {
    AnyChannel::new(name, values)
}

/// Channels of 3 × 2 pixels of half floats, for one layer.
fn layer(channels: &[(&str, f32)], encoding: Encoding) -> Layer<AnyChannels<FlatSamples>> {
    let plane = |&(name, first): &(&str, f32)| {
        let values = (0..6).map(|i| f16::from_f32(first + i as f32)).collect();
        channel(name, FlatSamples::F16(values))
    };
    let channels = AnyChannels::sort(channels.iter().map(plane).collect());
    let mut attributes = LayerAttributes::named(channels.list[0].name.clone());
    attributes.layer_position = Vec2(-5, 7);
    Layer::new((3, 2), attributes, encoding, channels)
}

fn parts(path: &std::path::Path, layers: Vec<Layer<AnyChannels<FlatSamples>>>) {
    let attributes = ImageAttributes::new(IntegerBounds::from_dimensions((3, 2)));
    Image::from_layers(attributes, layers).write().to_file(path).unwrap();
}

#[test]
fn exrs_of_others_give_the_first_layer_with_colors() {
    let place = Place::new();
    let path = place.path("other.exr");
    let tiles = Encoding {
        compression: Compression::ZIP1,
        blocks: Blocks::Tiles(Vec2(2, 2)),
        line_order: LineOrder::Unspecified,
    };
    let expected: Vec<[f32; 3]> =
        (0..6).map(|i| [1.0, 2.0, 3.0].map(|first| first + i as f32)).collect();
    let plain = [("A", 9.0), ("B", 3.0), ("G", 2.0), ("R", 1.0)];
    let mixed = [&plain[..], &[("AO.R", 7.0), ("AO.G", 7.0), ("AO.B", 7.0)]].concat();
    let named = [("Z", 9.0), ("a.R", 8.0), ("b.R", 1.0), ("b.G", 2.0), ("b.B", 3.0), ("XR", 7.0)];
    for encoding in [Encoding::UNCOMPRESSED, Encoding::SMALL_LOSSLESS, tiles] {
        for channels in [&plain[..], &mixed, &named] {
            parts(&path, vec![layer(channels, encoding)]);
            let read = Reference::load(&path).unwrap();
            assert_eq!((read.size(), rgb(&read)), (UVec2::new(3, 2), expected.clone()));
            assert!(read.pixels().iter().all(|pixel| pixel[3] == 1.0));
        }
        parts(&path, vec![layer(&[("Z", 9.0)], encoding), layer(&plain, encoding)]);
        assert_eq!(rgb(&Reference::load(&path).unwrap()), expected);
    }
    parts(&path, vec![layer(&[("Z", 9.0), ("R", 1.0)], tiles)]);
    let error = Reference::load(&path).unwrap_err().to_string();
    assert!(error.contains("other.exr") && error.contains("R, G and B"), "{error}");
}

/// Every cut, and changes of every byte; none of them may panic. Returns how many could be read.
fn damage(place: &Place, whole: &[u8]) -> usize {
    place.load(whole).unwrap();
    for length in 0..whole.len() {
        assert!(place.load(&whole[..length]).is_err(), "{length} of {} bytes", whole.len());
    }
    let mut readable = 0;
    for index in 0..whole.len() {
        for change in [0x04, 0xff] {
            let mut bytes = whole.to_vec();
            bytes[index] ^= change;
            match place.load(&bytes) {
                Ok(read) => readable += usize::from(read.pixels().iter().all(|p| p[0].is_finite())),
                Err(error) => assert!(error.to_string().contains("reference"), "{error}"),
            }
        }
    }
    readable
}

#[test]
fn damaged_arrays_are_refused_or_read() {
    let whole = npy(1, "<f4", "False", "(2, 1, 3)", &floats(6));
    // Most changes of its values give other values.
    assert!(damage(&Place::new(), &whole) > 30);
}

#[test]
fn damaged_exrs_are_refused_or_read() {
    let place = Place::new();
    let path = place.path("other.exr");
    for compression in [Compression::ZIP16, Compression::PIZ] {
        let encoding = Encoding { compression, ..Encoding::default() };
        parts(&path, vec![layer(&[("R", 1.0), ("G", 2.0), ("B", 3.0)], encoding)]);
        damage(&place, &std::fs::read(&path).unwrap());
    }
}
