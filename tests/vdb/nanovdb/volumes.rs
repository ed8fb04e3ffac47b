//! NanoVDB versions of volumes against the OpenVDB files that they were made of.

use std::path::Path;
use std::sync::Arc;

use flambeau::error::NO_PROGRESS;
use flambeau::scene::About;
use flambeau::volume::file::Directory;
use flambeau::volume::grid::{IndexBox, SparseGrid, VoxelValues};
use glam::IVec3;

use crate::shared::shared;

/// The float grids of a file, by name.
fn floats(path: &Path) -> Vec<(String, Arc<SparseGrid<f32>>)> {
    let directory = Directory::open(path, NO_PROGRESS).unwrap();
    let load = |index| match directory.load(index, NO_PROGRESS).unwrap() {
        VoxelValues::Float(grid) => Some((directory.grids[index].name.clone(), grid)),
        _ => None,
    };
    (0..directory.grids.len()).filter_map(load).collect()
}

/// The largest difference of two grids' voxels over the box of both, relative to the largest value.
fn difference(a: &SparseGrid<f32>, b: &SparseGrid<f32>) -> f32 {
    let Some(bounds) = IndexBox::union(a.bounds(), b.bounds()) else { return 0.0 };
    let mut largest = 0.0_f32;
    for x in bounds.min.x - 1..=bounds.max.x + 1 {
        for y in bounds.min.y - 1..=bounds.max.y + 1 {
            for z in bounds.min.z - 1..=bounds.max.z + 1 {
                let voxel = IVec3::new(x, y, z);
                largest = largest.max((a.value(voxel) - b.value(voxel)).abs());
            }
        }
    }
    largest / a.stats().max.max(f32::MIN_POSITIVE)
}

fn compare(nanovdb: &str, openvdb: &str, tolerance: f32) {
    let (Some(nanovdb), Some(openvdb)) = (shared(nanovdb), shared(openvdb)) else { return };
    let (converted, original) = (floats(&nanovdb), floats(&openvdb));
    assert!(!converted.is_empty());
    for (name, grid) in &converted {
        let (_, original) = original.iter().find(|(known, _)| known == name).unwrap();
        assert_eq!(grid.stats().active_voxels, original.stats().active_voxels, "{name}");
        assert_eq!(grid.stats().active_bounds, original.stats().active_bounds, "{name}");
        let difference = difference(original, grid);
        assert!(difference <= tolerance, "{}, {name}: {difference}", nanovdb.display());
    }
}

#[test]
fn a_frame_of_a_torch_is_the_same_in_every_codec() {
    for codec in ["none", "zip", "blosc"] {
        let name = format!("volumes/nvdb/torch.f32_{codec}.nvdb");
        compare(&name, "assets/torch_seq/torch_0020.vdb", 0.0);
    }
}

/// Codes of 16 bits are half a quantum off at most, which is 1/65535 of a leaf's range.
#[test]
fn quantized_volumes_are_the_same_within_their_quanta() {
    const HALF_QUANTUM: f32 = 0.51 / 65535.0;
    compare("volumes/nvdb/torch.fp16.nvdb", "assets/torch_seq/torch_0020.vdb", HALF_QUANTUM);
    for name in ["cloud", "explosion_hd", "torch_hd"] {
        let (nanovdb, openvdb) =
            (format!("volumes/nvdb/{name}.fp16.nvdb"), format!("assets/{name}.vdb"));
        compare(&nanovdb, &openvdb, HALF_QUANTUM);
    }
}

/// The same guesses for a bare volume, in the same words but for the program that made the file,
/// which NanoVDB files do not name.
#[test]
fn guesses_do_not_depend_on_the_format() {
    let (Some(nanovdb), Some(openvdb)) =
        (shared("volumes/nvdb/torch.f32_zip.nvdb"), shared("assets/torch_seq/torch_0020.vdb"))
    else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let open = |path: &Path| {
        // On its own it is no frame of a sequence.
        let alone = folder.path().join("fire");
        std::fs::copy(path, &alone).unwrap();
        let path = alone.to_str().unwrap();
        let cache = flambeau::scene::VolumeCache::default();
        let opened = flambeau::scene::open(
            path,
            &flambeau::scene::Overrides::default(),
            &cache,
            NO_PROGRESS,
        );
        let mut opened = opened.unwrap();
        opened.notes.retain(|note| note.about != About::UpAxis);
        opened
    };
    assert_eq!(open(&nanovdb), open(&openvdb));
}
