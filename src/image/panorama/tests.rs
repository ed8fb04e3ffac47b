use std::fmt::Debug;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    Compression, Encoding, Image, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage,
    f16,
};
use rand::{RngExt, SeedableRng};

use super::*;
use crate::error::NO_PROGRESS;

/// Rec.2020 in the order of an EXR's attribute.
const REC_2020: Chromaticities = Chromaticities {
    red: Vec2(0.708, 0.292),
    green: Vec2(0.170, 0.797),
    blue: Vec2(0.131, 0.046),
    white: Vec2(0.3127, 0.3290),
};

fn written(path: &Path, bytes: &[u8]) -> Result<Panorama> {
    std::fs::write(path, bytes).unwrap();
    read(path, 0, NO_PROGRESS)
}

/// An EXR of 3 x 2 pixels whose red counts them, in half floats or floats.
fn exr(compression: Compression, half: bool, chromaticities: Option<Chromaticities>) -> Vec<u8> {
    let encoding = Encoding { compression, ..Encoding::FAST_LOSSLESS };
    let red = |Vec2(x, y): Vec2<usize>| (3 * y + x) as f32;
    let attributes = LayerAttributes::default();
    let mut bytes = Cursor::new(Vec::new());
    if half {
        let rgba = move |at| (f16::from_f32(red(at)), f16::ONE, f16::from_f32(0.5), f16::ONE);
        let channels = SpecificChannels::rgba(rgba);
        let mut image = Image::from_layer(Layer::new((3, 2), attributes, encoding, channels));
        image.attributes.chromaticities = chromaticities;
        image.write().to_buffered(&mut bytes).unwrap();
    } else {
        let channels = SpecificChannels::rgb(move |at| (red(at), 1.0_f32, -0.5_f32));
        let mut image = Image::from_layer(Layer::new((3, 2), attributes, encoding, channels));
        image.attributes.chromaticities = chromaticities;
        image.write().to_buffered(&mut bytes).unwrap();
    }
    bytes.into_inner()
}

fn hdr() -> Vec<u8> {
    let head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 9\n";
    let mut body = vec![2, 2, 0, 9];
    for value in [100, 50, 25, 130] {
        body.extend([128 + 7, value, 2, value / 2, value]);
    }
    let old = [&[9, 8, 7, 128][..], &[1, 1, 1, 6], &[3, 2, 1, 129], &[4, 4, 4, 120]].concat();
    [head.as_bytes(), &body, &old].concat()
}

#[test]
fn pictures_of_both_formats_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a'b é.any");
    for half in [false, true] {
        let blue = if half { 0.5 } else { -0.5 };
        let plain = written(&path, &exr(Compression::ZIP16, half, None)).unwrap();
        assert_eq!(plain.size, UVec2::new(3, 2));
        assert_eq!(plain.pixels[4], [4.0, 1.0, blue]);
        // White stays white; of pure red, green is negative.
        let wide = written(&path, &exr(Compression::RLE, half, Some(REC_2020))).unwrap();
        let [r, g, b] = wide.pixels[5];
        let expected = [
            1.6605 * 5.0 - 0.5876 - 0.0728 * blue,
            -0.1246 * 5.0 + 1.1329 - 0.0083 * blue,
            -0.0182 * 5.0 - 0.1006 + 1.1187 * blue,
        ];
        assert!(std::iter::zip([r, g, b], expected).all(|(a, b)| (a - b).abs() < 0.01), "{wide:?}");
    }
    let picture = written(&path, &hdr()).unwrap();
    assert_eq!((picture.size, picture.pixels.len()), (UVec2::new(9, 2), 18));
    assert_eq!(picture.pixels[0], [100.0 / 64.0, 50.0 / 64.0, 25.0 / 64.0]);
    assert_eq!(picture.pixels[9], [9.0 / 256.0, 8.0 / 256.0, 7.0 / 256.0]);
}

#[test]
fn other_files_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("set.hdr");
    let message = |result: Result<Panorama>| result.unwrap_err().to_string();
    for (bytes, reason) in [
        (&b"\x89PNG\r\n\x1a\n"[..], "neither an .exr nor an .hdr"),
        (b"", "neither"),
        (b"#?RADIANCE\n\n-Y 2 +X 3\n", "line 0"),
        (b"#?RADIANCE\n\n-Y 99999 +X 99999\n", "too many"),
        (b"\x76\x2f\x31\x01", "set.hdr"),
    ] {
        let text = message(written(&path, bytes));
        assert!(text.contains("set.hdr") && text.contains(reason), "{text}");
    }
    assert!(message(read(folder.path(), 0, NO_PROGRESS)).contains("folder"));
    assert!(message(read(&path.join("x"), 0, NO_PROGRESS)).contains("set.hdr"));
    #[cfg(unix)]
    assert!(message(read(Path::new("/dev/zero"), 0, NO_PROGRESS)).contains("device"));
    // A picture of which the memory holds the pixels but not what is made of them.
    std::fs::write(&path, hdr()).unwrap();
    assert!(message(read(&path, 1 << 56, NO_PROGRESS)).contains("memory"));
    let degenerate = Chromaticities { green: REC_2020.red, ..REC_2020 };
    let text = message(written(&path, &exr(Compression::ZIP1, false, Some(degenerate))));
    assert!(text.contains("chromaticities"), "{text}");
}

/// Files of both formats with their bytes changed at random: any result but a panic. With
/// `FLAMBEAU_MUTATIONS=1000000` so many are read.
#[test]
fn damaged_pictures_are_refused_or_read() {
    let wanted = std::env::var("FLAMBEAU_MUTATIONS").ok().and_then(|text| text.parse().ok());
    let files = [
        hdr(),
        exr(Compression::Uncompressed, false, Some(REC_2020)),
        exr(Compression::ZIP16, true, None),
        exr(Compression::PIZ, true, None),
        exr(Compression::RLE, false, None),
        exr(Compression::B44, true, None),
        exr(Compression::PXR24, false, None),
    ];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damaged");
    let failed = (0..wanted.unwrap_or(4000_u64)).find(|&number| {
        let mut rng = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(number);
        let mut bytes = files[(number % files.len() as u64) as usize].clone();
        for _ in 0..rng.random_range(1..6) {
            let at = rng.random_range(0..bytes.len());
            match rng.random_range(0..4) {
                0 => bytes[at] = rng.random(),
                1 => bytes[at] ^= 1 << rng.random_range(0..8),
                2 => bytes.truncate(at.max(1)),
                _ => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][rng.random_range(0..5)],
            }
        }
        is_panic(|| written(&path, &bytes))
    });
    assert_eq!(failed, None, "this number makes a file that panics");
}

fn is_panic<R: Debug>(read: impl FnOnce() -> R) -> bool {
    catch_unwind(AssertUnwindSafe(|| drop(read()))).is_err()
}
