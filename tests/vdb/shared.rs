//! Files outside the repository, and comparisons.

use std::path::PathBuf;
use std::sync::Arc;

use flambeau::error::NO_PROGRESS;
use flambeau::volume::grid::{SparseGrid, VoxelValues};
use flambeau::volume::vdb::{self, VdbFile, VdbGrid};

/// A file or folder shared between checkouts; `None`, said aloud, where there is none.
pub fn shared(name: &str) -> Option<PathBuf> {
    let root = std::env::var_os("FLAMBEAU_SHARED")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared"), PathBuf::from);
    let path = root.join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: {} is not there", path.display());
    None
}

/// The .vdb files of a folder of the shared ones, those below it included; none if it is absent.
pub fn shared_volumes(name: &str) -> Vec<PathBuf> {
    let mut folders: Vec<_> = shared(name).into_iter().collect();
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "vdb") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

pub fn read(path: impl AsRef<std::path::Path>) -> VdbFile {
    vdb::read(path, NO_PROGRESS).unwrap()
}

pub fn float(grid: &VdbGrid) -> &Arc<SparseGrid<f32>> {
    match &grid.values {
        VoxelValues::Float(grid) => grid,
        other => panic!("{} is no float grid but {other:?}", grid.info.name),
    }
}

/// Equal up to rounding to single precision and `tolerance`, relative.
#[track_caller]
pub fn assert_close(got: f64, want: f64, tolerance: f64, what: &str) {
    let difference = (got - want).abs();
    assert!(difference <= tolerance * want.abs().max(1e-6), "{what}: {got} instead of {want}");
}
