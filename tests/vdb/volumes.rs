//! Volumes from Houdini, Blender and OpenUSD, and the ones that are shipped.

use flambeau::error::{Error, NO_PROGRESS};
use flambeau::volume::grid::VoxelValues;
use flambeau::volume::vdb::{self, VdbFile};
use glam::{IVec3, Vec3A};

use crate::shared::{assert_close, float, read, shared, shared_volumes};

#[test]
fn houdini_smoke_of_a_million_voxels() {
    let Some(path) = shared("volumes/smoke.vdb") else { return };
    let file = read(path);
    assert_eq!((file.version, file.grids.len()), (222, 1));
    let stats = float(&file.grids[0]).stats();
    assert_eq!(stats.active_voxels, 1_049_275);
    let bounds = stats.active_bounds.unwrap();
    assert_eq!((bounds.min, bounds.max), (IVec3::new(1, 2, 1), IVec3::new(111, 223, 112)));
}

/// OpenVDB notes the count and the box of the active voxels in the metadata of what it writes.
#[test]
fn every_grid_has_the_voxels_that_its_metadata_announce() {
    let mut checked = 0;
    for path in [shared_volumes("volumes"), shared_volumes("assets")].concat() {
        for grid in read(&path).grids {
            let noted = |key: &str| {
                grid.info.metadata.get(key).map(ToString::to_string).unwrap_or_default()
            };
            let (count, bounds) = match &grid.values {
                VoxelValues::Float(grid) => {
                    (grid.stats().active_voxels, grid.stats().active_bounds)
                }
                VoxelValues::Vec3(grid) => (grid.stats().active_voxels, grid.stats().active_bounds),
                VoxelValues::Unsupported(_) => continue,
            };
            if noted("file_voxel_count").is_empty() {
                continue;
            }
            assert_eq!(noted("file_voxel_count"), count.to_string(), "{}", path.display());
            if let Some(bounds) = bounds {
                let text = |corner: IVec3| format!("{:?}", corner.as_dvec3().to_array());
                assert_eq!(noted("file_bbox_min"), text(bounds.min), "{}", path.display());
                assert_eq!(noted("file_bbox_max"), text(bounds.max), "{}", path.display());
            }
            checked += 1;
        }
    }
    assert!(checked == 0 || checked > 100, "only {checked} grids");
}

#[test]
fn one_frame_in_eight_encodings_is_one_frame() {
    let paths = shared_volumes("volumes/codecs");
    let files: Vec<VdbFile> = paths.iter().map(read).collect();
    for (file, path) in files.iter().zip(&paths) {
        for grid in &file.grids {
            let first = files[0].grids.iter().find(|other| other.info.name == grid.info.name);
            let (first, grid) = (float(first.unwrap()), float(grid));
            let (a, b) = (first.stats(), grid.stats());
            assert_eq!(a.active_bounds, b.active_bounds, "{}", path.display());
            assert_eq!(a.active_voxels, b.active_voxels, "{}", path.display());
            let bounds = a.active_bounds.unwrap();
            let size = (bounds.max - bounds.min).as_vec3a();
            for n in 0..5000 {
                // An even spread over the box.
                let t = n as f32 * Vec3A::new(0.819_172_5, 0.671_043_6, 0.549_700_5);
                let position = bounds.min.as_vec3a() + t.fract() * size;
                let (got, want) = (grid.sample(position), first.sample(position));
                let what = format!("{} at {position}", path.display());
                assert!((got - want).abs() <= 1e-3 * want.abs() + 1e-6, "{what}: {got}, {want}");
            }
            assert_close(b.mean.into(), a.mean.into(), 1e-3, "mean");
        }
    }
}

#[test]
fn native_half_grids_of_format_225() {
    let Some(path) = shared("volumes/cases/half225.vdb") else { return };
    let file = read(path);
    assert_eq!((file.version, file.grids[0].info.value_type()), (225, "half"));
    let grid = float(&file.grids[0]);
    assert_eq!((grid.stats().active_voxels, grid.value(IVec3::ZERO)), (925, 1.0));
    assert_eq!(grid.value(IVec3::new(0, 7, 0)), 0.0);
}

#[test]
fn cancelling_stops_the_work() {
    let Some(path) = shared("volumes/smoke.vdb") else { return };
    for calls in [0, 1, 3, 10, 20] {
        let left = std::sync::atomic::AtomicI32::new(calls);
        let progress = |fraction: f32| {
            assert!((0.0..=1.0).contains(&fraction), "{fraction}");
            left.fetch_sub(1, std::sync::atomic::Ordering::Relaxed) > 0
        };
        let result = vdb::read(&path, &progress);
        assert!(matches!(result, Err(Error::Cancelled)), "after {calls} calls: {result:?}");
    }
    assert!(vdb::read(&path, NO_PROGRESS).is_ok());
}
