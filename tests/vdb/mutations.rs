//! Files of both formats with their bytes changed at random: any result but a panic, a hang or a
//! huge allocation. `FLAMBEAU_MUTATIONS=1000000` asks for so many, in chunks that are told as they
//! are done, and `FLAMBEAU_MUTATIONS=710000..1000000` for those; the seed of each is its number.

use std::num::NonZero;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use flambeau::error::NO_PROGRESS;
use flambeau::volume::file::Directory;
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::fixtures::fixture;
use crate::nanovdb::writer::{Codec, Grid, Kind, buffer, segment};
use crate::writer::{Layout, Scalar, write_quick};

const CHUNK: u64 = 10_000;
/// What reading one small file never takes, however damaged it is, on a machine that is busy.
const TOO_LONG: Duration = Duration::from_secs(60);

/// Small files of both formats.
fn inputs() -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for name in ["inactive_values", "nonfinite", "empty_grid", "tiles_leaf_and_internal"] {
        files.push((name.to_owned(), std::fs::read(fixture(name)).unwrap()));
    }
    let layout = Layout {
        version: 224,
        offsets: true,
        zip: true,
        active_mask: true,
        half: false,
        scalar: Scalar::Float,
        components: 1,
        code: 5,
    };
    files.push(("zip".to_owned(), write_quick(&layout)));
    files.push((
        "version 220".to_owned(),
        write_quick(&Layout { version: 220, half: true, ..layout }),
    ));
    let grid = |kind| Grid { with_root_tile: false, ..Grid::new("density", kind) };
    for kind in [Kind::Float, Kind::Vec3f, Kind::FpN(4)] {
        files.push((format!("{kind:?}"), segment(b'2', Codec::None, &[grid(kind)])));
    }
    for codec in [Codec::Zip, Codec::Blosc] {
        files.push((format!("{codec:?}"), segment(b'0', codec, &[grid(Kind::Fp8)])));
    }
    let long = Grid { with_root_tile: false, ..Grid::new(&"long ".repeat(60), Kind::FpN(16)) };
    files.push(("buffer".to_owned(), buffer(&[grid(Kind::Float), long])));
    files
}

/// Numbers that sizes, counts and offsets are likely to be mistaken for.
const EXTREMES: [u64; 8] =
    [0, 1, 0x7fff_ffff, 0xffff_ffff, 1 << 40, i64::MAX as u64, 1 << 63, u64::MAX];

/// Changes some bytes. Structure is hit as often as all the rest, which is mostly values.
fn mutate(bytes: &mut Vec<u8>, rng: &mut Xoshiro256PlusPlus) {
    for _ in 0..rng.random_range(1..4) {
        let length = bytes.len();
        if length < 16 {
            return;
        }
        let region = [length, length.min(2000), length.min(300)][rng.random_range(0..3)];
        let at = rng.random_range(0..region);
        match rng.random_range(0..8) {
            0 => bytes[at] ^= 1 << rng.random_range(0..8),
            1 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][rng.random_range(0..5)],
            2 => put(bytes, at, &EXTREMES[rng.random_range(0..8)].to_le_bytes()),
            3 => put(bytes, at, &(EXTREMES[rng.random_range(0..8)] as u32).to_le_bytes()),
            4 => put(bytes, at & !7, &rng.random_range(0..2 * length as u64).to_le_bytes()),
            5 => put(bytes, at & !3, &rng.next_u32().to_le_bytes()),
            6 => bytes.truncate(at),
            _ => {
                let from = rng.random_range(0..length);
                let part = bytes[from..length.min(from + rng.random_range(1..200))].to_vec();
                put(bytes, at, &part);
            }
        }
    }
}

fn put(bytes: &mut [u8], at: usize, part: &[u8]) {
    let end = bytes.len().min(at + part.len());
    bytes[at..end].copy_from_slice(&part[..end - at]);
}

fn read(bytes: Vec<u8>) -> usize {
    let Ok(directory) = Directory::parse("mutated", bytes, NO_PROGRESS) else { return 0 };
    let loaded = |index: &usize| directory.load(*index, NO_PROGRESS).is_ok();
    (0..directory.grids.len()).filter(loaded).count()
}

/// Reads the mutated file with that number: whether a grid of it is sound, and how long it took.
fn case(number: u64, files: &[(String, Vec<u8>)]) -> (bool, Duration) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(number);
    let (name, file) = &files[rng.random_range(0..files.len())];
    let mut bytes = file.clone();
    mutate(&mut bytes, &mut rng);
    let start = Instant::now();
    let result = catch_unwind(AssertUnwindSafe(|| read(bytes)));
    let time = start.elapsed();
    assert!(time < TOO_LONG, "{name}, case {number} took {time:?}");
    let sound = result.unwrap_or_else(|_| panic!("{name}, case {number}"));
    (sound > 0, time)
}

/// Reads the mutated files with these numbers, on as many threads as there are processors. They are
/// none of the readers' own threads, which would begin another file while they wait for a part of
/// one, and make it seem slow.
fn cases(numbers: Range<u64>, files: &[(String, Vec<u8>)]) -> Vec<(bool, Duration, u64)> {
    let next = AtomicU64::new(numbers.start);
    let work = || {
        let number = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|n| numbers.contains(n));
        let read = |number| {
            let (sound, time) = case(number, files);
            (sound, time, number)
        };
        std::iter::from_fn(number).map(read).collect::<Vec<_>>()
    };
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("no case failed")).collect()
    })
}

/// The numbers that `1000000` or `710000..1000000` asks for.
fn numbers(text: &str) -> Range<u64> {
    let number = |text: &str| text.parse().expect("a number of mutations or a range of them");
    let (first, end) = text.split_once("..").unwrap_or(("0", text));
    number(first)..number(end)
}

#[test]
fn mutated_files_are_refused_or_harmless() {
    let wanted = std::env::var("FLAMBEAU_MUTATIONS").map_or(0..CHUNK, |text| numbers(&text));
    let files = inputs();
    let (mut done, mut sound, mut slowest) = (0, 0, (Duration::ZERO, 0));
    for first in wanted.clone().step_by(CHUNK as usize) {
        for (is_sound, time, number) in cases(first..wanted.end.min(first + CHUNK), &files) {
            done += 1;
            sound += u64::from(is_sound);
            slowest = slowest.max((time, number));
        }
        println!(
            "{done} mutations, {sound} readable, the slowest, {}, in {:?}",
            slowest.1, slowest.0
        );
    }
    // The harness reaches past the headers, and what it changes is noticed.
    let is_usual = sound > done / 20 && sound < done;
    assert!(is_usual || done < CHUNK, "{sound} of {done} readable");
}
