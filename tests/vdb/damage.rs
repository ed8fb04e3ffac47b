//! Damaged files: any result but a panic, a hang or a huge allocation.

use flambeau::error::{Error, NO_PROGRESS};
use flambeau::volume::vdb::{Directory, VdbFile};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::fixtures::fixture;
use crate::writer::{Layout, Scalar, write};

const LAYOUT: Layout = Layout {
    version: 224,
    offsets: false,
    zip: true,
    active_mask: true,
    half: false,
    scalar: Scalar::Float,
    components: 1,
    code: 5,
};

fn read(bytes: Vec<u8>) -> Result<VdbFile, Error> {
    Directory::parse("damaged.vdb", bytes, NO_PROGRESS)?.load_all(NO_PROGRESS)
}

#[test]
fn a_file_cut_anywhere_is_refused_with_its_name() {
    for layout in [LAYOUT, Layout { version: 220, half: true, ..LAYOUT }] {
        let whole = write(&layout);
        assert!(read(whole.clone()).is_ok());
        let mut messages = std::collections::BTreeSet::new();
        for length in 0..whole.len() {
            let error = read(whole[..length].to_vec()).expect_err("cut");
            let message = error.to_string();
            assert!(message.starts_with("damaged.vdb: "), "{message}");
            messages.insert(message.split(": at byte").next().unwrap_or_default().to_owned());
        }
        for section in ["header", "metadata", "list of grids", "transform", "tree", "values"] {
            assert!(messages.iter().any(|m| m.contains(section)), "{section}: {messages:?}");
        }
    }
    let whole = std::fs::read(fixture("inactive_values")).unwrap();
    (0..whole.len()).for_each(|length| assert!(read(whole[..length].to_vec()).is_err()));
}

#[test]
fn flipped_bits_are_found_or_harmless() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
    let mut files = vec![write(&LAYOUT), write(&Layout { zip: false, offsets: true, ..LAYOUT })];
    for name in ["inactive_values", "nonfinite", "tiles_leaf_and_internal", "half_blosc"] {
        files.push(std::fs::read(fixture(name)).unwrap());
    }
    for file in &files {
        // The first bytes hold the counts and offsets.
        for region in [file.len(), file.len().min(600)] {
            for _ in 0..100 {
                let mut bytes = file.clone();
                for _ in 0..rng.random_range(1..4) {
                    let at = rng.random_range(0..region);
                    match rng.random_bool(0.5) {
                        true => bytes[at] ^= 1 << rng.random_range(0..8),
                        false => bytes[at] = [0, 0x7f, 0x80, 0xff][rng.random_range(0..4)],
                    }
                }
                let _any_result_without_a_panic = read(bytes);
            }
        }
    }
}
