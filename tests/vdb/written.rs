//! The layouts that the fixtures do not cover.

use flambeau::error::NO_PROGRESS;
use flambeau::volume::grid::{SparseGrid, Voxel, VoxelValues};
use flambeau::volume::vdb::{self, Directory, VdbFile};
use glam::{DVec3, IVec3};

use crate::writer::{
    BACKGROUND, LOWER_TILE, Layout, ROOT_TILE, Scalar, UPPER_TILE, leaf_active, leaf_value, write,
};

/// Every combination of what a layout can be.
fn layouts() -> impl Iterator<Item = Layout> {
    let versions = [220, 222, 225];
    let scalars = [Scalar::Half, Scalar::Float, Scalar::Double];
    let all = (0..versions.len() * scalars.len() * 32).map(move |n| Layout {
        version: versions[n / 32 / scalars.len()],
        offsets: n & 1 != 0,
        zip: n & 2 != 0,
        active_mask: n & 4 != 0,
        half: n & 8 != 0,
        scalar: scalars[n / 32 % scalars.len()],
        components: if n & 16 != 0 { 3 } else { 1 },
        code: 0,
    });
    // Grids of native halves are as old as version 225.
    all.filter(|layout| layout.scalar != Scalar::Half || layout.version == 225)
}

#[test]
fn all_layouts_hold_the_same_voxels() {
    layouts().for_each(|layout| read_back(&layout));
}

#[test]
fn inactive_values_follow_from_their_code() {
    let masked = |layout: &Layout| layout.version == 225 && layout.active_mask && layout.offsets;
    for layout in layouts().filter(masked) {
        (1..=5).for_each(|code| read_back(&Layout { code, ..layout }));
    }
}

/// Files on a disk are read piece by piece, those without offsets through all of their trees.
#[test]
fn a_file_on_a_disk_holds_the_same_voxels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("written.vdb");
    for layout in layouts().step_by(5) {
        std::fs::write(&path, write(&layout)).unwrap();
        check_file(&vdb::read(&path, NO_PROGRESS).unwrap(), &layout);
    }
}

#[test]
fn a_file_that_changes_after_it_was_opened_is_not_mixed_up() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("written.vdb");
    let bytes = write(&layouts().next().unwrap());
    std::fs::write(&path, &bytes).unwrap();
    let directory = Directory::open(&path, NO_PROGRESS).unwrap();
    assert!(directory.load(0, NO_PROGRESS).is_ok());
    std::fs::write(&path, &bytes[..bytes.len() - 1]).unwrap();
    let refused = directory.load(0, NO_PROGRESS).unwrap_err().to_string();
    assert!(refused.contains("written.vdb") && refused.contains("changed"), "{refused}");
    std::fs::remove_file(&path).unwrap();
    assert!(Directory::open(&path, NO_PROGRESS).is_err());
}

fn read_back(layout: &Layout) {
    let directory = Directory::parse("written.vdb", write(layout), NO_PROGRESS);
    check_file(&directory.unwrap().load_all(NO_PROGRESS).unwrap(), layout);
}

fn check_file(file: &VdbFile, layout: &Layout) {
    let grid = &file.grids[0];
    assert_eq!(grid.info.is_half, layout.half);
    assert_eq!(grid.info.transform.voxel_size, DVec3::splat(2.0));
    match &grid.values {
        VoxelValues::Float(grid) if layout.components == 1 => check(grid, layout),
        VoxelValues::Vec3(grid) if layout.components == 3 => check(grid, layout),
        other => panic!("{layout:?} became {other:?}"),
    }
}

fn check<V: Voxel>(grid: &SparseGrid<V>, layout: &Layout) {
    let expect = |value: f64, at: [i32; 3]| {
        let want = V::from_components([1.0, 2.0, 3.0].map(|c| (c * value) as f32));
        assert_eq!(grid.value(IVec3::from_array(at)), want, "{layout:?} at {at:?}");
    };
    for offset in 0..512 {
        let place = [offset >> 6, offset >> 3 & 7, offset & 7];
        expect(leaf_value(layout, offset), place.map(|c| c as i32));
    }
    expect(BACKGROUND, [-1, 0, 0]);
    expect(BACKGROUND, [0, 0, 8]);
    expect(LOWER_TILE, [0, 0, 16]);
    expect(LOWER_TILE, [7, 7, 23]);
    expect(BACKGROUND, [0, 0, 24]);
    expect(UPPER_TILE, [0, 0, 128]);
    expect(UPPER_TILE, [127, 127, 255]);
    expect(BACKGROUND, [0, 0, 256]);
    expect(ROOT_TILE, [4096, 0, 0]);
    expect(ROOT_TILE, [8191, 4095, 4095]);
    expect(BACKGROUND, [4095, 0, 0]);
    let active = (0..512).filter(|&offset| leaf_active(offset)).count() as u64;
    let tiles = 8_u64.pow(3) + 128_u64.pow(3) + 4096_u64.pow(3);
    assert_eq!(grid.stats().active_voxels, active + tiles, "{layout:?}");
}
