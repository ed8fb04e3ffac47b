//! Small files that OpenVDB 10 wrote, in the repository, with what it says is in them.

use flambeau::error::NO_PROGRESS;
use flambeau::volume::grid::{GridClass, IndexBox, VoxelValues};
use flambeau::volume::vdb::{self, Directory};
use glam::{DVec3, IVec3, Vec3, Vec3A};

use crate::shared::{assert_close, float, read};

/// The path of a fixture.
pub fn fixture(name: &str) -> String {
    format!("{}/tests/fixtures/vdb/{name}.vdb", env!("CARGO_MANIFEST_DIR"))
}

fn index_box(min: [i32; 3], max: [i32; 3]) -> Option<IndexBox> {
    Some(IndexBox { min: min.into(), max: max.into() })
}

#[test]
fn half_floats_packed_by_blosc_and_active_masks() {
    let file = read(fixture("half_blosc"));
    let [density] = &file.grids[..] else { panic!("{} grids", file.grids.len()) };
    let info = &density.info;
    assert_eq!((info.name.as_str(), info.is_half), ("density", true));
    assert_eq!((info.class, info.type_name.as_str()), (GridClass::FogVolume, "Tree_float_5_4_3"));
    assert_eq!(info.transform.voxel_size, DVec3::splat(0.05));
    let grid = float(density);
    assert_eq!(grid.bounds(), index_box([-14, -18, -16], [16, 30, 16]));
    let stats = grid.stats();
    assert_eq!((stats.active_voxels, stats.min, stats.max), (19988, 0.001_010_894_8, 1.358_398_4));
    assert_close(stats.mean.into(), 0.280_646_941_4, 1e-6, "mean");
    assert_close(grid.value(IVec3::new(1, 6, 0)).into(), 1.195_009_71, 1e-3, "voxel");
    assert_close(grid.sample(Vec3A::new(1.25, 6.5, 0.125)).into(), 1.119_697, 1e-3, "sample");
    let (low, high) = grid.range(Vec3::splat(-100.0), Vec3::splat(100.0));
    assert_eq!((low, high), (0.0, stats.max));
}

#[test]
fn inactive_values_of_every_code() {
    let file = read(fixture("inactive_values"));
    let grid = float(&file.grids[0]);
    let stats = grid.stats();
    assert_eq!((stats.active_voxels, stats.min, stats.max), (32700, 1.0, 1.0));
    assert_eq!(stats.active_bounds, index_box([0; 3], [31; 3]));
    // Leaves with one, two and five other values along x, and one whose inactive voxels are 0.
    let special = |x: i32, y: i32, z: i32| match (x, y, z) {
        (0..8, 0 | 8, 0) => -7.0,
        (0..8, 9, 0) => 11.0,
        (0..8, 16..21, 0) => (100 + y - 16) as f32,
        (16..20, 0, 0) => 0.0,
        _ => 1.0,
    };
    for n in 0..32 * 32 * 32 {
        let (x, y, z) = (n >> 10, n >> 5 & 31, n & 31);
        assert_eq!(grid.value(IVec3::new(x, y, z)), special(x, y, z), "{x} {y} {z}");
    }
}

#[test]
fn tiles_of_two_sizes_over_a_background() {
    let file = read(fixture("tiles_leaf_and_internal"));
    let grid = float(&file.grids[0]);
    let stats = grid.stats();
    assert_eq!((stats.active_voxels, stats.min, stats.max), (2_143_240, 2.0, 5.0));
    assert_close(stats.mean.into(), 4.012_187_155_9, 1e-6, "mean");
    assert_eq!(grid.bounds(), index_box([-300, -40, -9], [255, 127, 127]));
    assert_eq!((grid.background(), grid.value(IVec3::splat(-200))), (0.5, 0.5));
    assert!(stats.memory_bytes < 2 << 20, "{} bytes", stats.memory_bytes);
}

#[test]
fn values_that_are_not_finite_are_replaced_and_counted() {
    let file = read(fixture("nonfinite"));
    let grid = float(&file.grids[0]);
    let stats = grid.stats();
    assert_eq!((stats.replaced_values, stats.active_voxels), (3, 9));
    assert_eq!((stats.min, stats.max), (-1.0, 1e30));
    let values: Vec<f32> = (0..9).map(|x| grid.value(IVec3::new(x, 0, 0))).collect();
    assert_eq!(values[..5], [0.0, 0.0, 0.0, -1.0, 1e30]);
}

#[test]
fn files_and_grids_with_nothing_in_them() {
    assert!(read(fixture("no_grids")).grids.is_empty());
    let file = read(fixture("empty_grid"));
    assert_eq!(float(&file.grids[0]).bounds(), None);
}

#[test]
fn what_cannot_be_loaded_says_why_and_does_not_stand_in_the_way() {
    let file = read(fixture("points_then_float"));
    let grid = |name| file.grids.iter().find(|grid| grid.info.name == name).unwrap();
    assert_eq!(float(grid("density")).stats().active_voxels, 2487);
    let VoxelValues::Unsupported(reason) = &grid("points").values else { panic!() };
    assert!(reason.contains("points") && reason.contains("rasterize"), "{reason}");
    let deep = read(fixture("tree_5_5_4_3"));
    let VoxelValues::Unsupported(reason) = &deep.grids[0].values else { panic!() };
    assert!(reason.contains("5_5_4_3"), "{reason}");
    let message = vdb::read(fixture("bad_lfs_pointer"), NO_PROGRESS).unwrap_err().to_string();
    assert!(message.contains("git lfs pull") && message.contains("bad_lfs_pointer.vdb"));
    let message = vdb::read(fixture("absent"), NO_PROGRESS).unwrap_err().to_string();
    assert!(message.contains("absent.vdb"), "{message}");
}

#[test]
fn single_grids_are_loaded_from_the_list() {
    let directory = Directory::open(fixture("points_then_float"), NO_PROGRESS).unwrap();
    let index = directory.grids.iter().position(|grid| grid.name == "density").unwrap();
    assert!(directory.grids[index].unsupported.is_none());
    assert!(directory.grids[1 - index].unsupported.is_some());
    let VoxelValues::Float(grid) = directory.load(index, NO_PROGRESS).unwrap() else { panic!() };
    assert_eq!(grid.stats().active_voxels, 2487);
    assert!(directory.load(2, NO_PROGRESS).is_err());
    assert!(directory.metadata.is_empty() || directory.version == 224);
}
