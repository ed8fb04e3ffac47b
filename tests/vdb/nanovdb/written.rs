//! Every type, codec and arrangement, and what is refused.

use flambeau::error::{Error, NO_PROGRESS, Result};
use flambeau::scene::{self, VolumeCache};
use flambeau::volume::file::{self, Format};
use flambeau::volume::grid::{GridClass, SparseGrid, Voxel, VoxelValues};
use flambeau::volume::nvdb::Directory;
use glam::{DVec3, IVec3};

use super::writer::{
    BACKGROUND, Codec, Grid, Kind, LOWER_TILE, ROOT_TILE, UPPER_TILE, buffer, leaf_active,
    leaf_value, segment, version,
};

fn parse(bytes: Vec<u8>) -> Result<Directory> {
    Directory::parse("written.nvdb", bytes, NO_PROGRESS)
}

fn check(directory: &Directory, index: usize, kind: Kind) {
    match directory.load(index, NO_PROGRESS).unwrap() {
        VoxelValues::Float(grid) if kind.components() == 1 => check_voxels(&grid, kind),
        VoxelValues::Vec3(grid) if kind.components() == 3 => check_voxels(&grid, kind),
        other => panic!("{kind:?} became {other:?}"),
    }
}

fn check_voxels<V: Voxel>(grid: &SparseGrid<V>, kind: Kind) {
    let expect = |value: f64, at: [i32; 3]| {
        let want = V::from_components([1.0, 2.0, 3.0].map(|c| (c * value) as f32));
        assert_eq!(grid.value(IVec3::from_array(at)), want, "{kind:?} at {at:?}");
    };
    for offset in 0..512 {
        let [x, y, z] = [offset >> 6, offset >> 3 & 7, offset & 7].map(|c| c as i32);
        expect(leaf_value(kind, offset), [x - 8, y, z]);
    }
    expect(BACKGROUND, [-9, 0, 0]);
    expect(BACKGROUND, [0, 0, 0]);
    expect(LOWER_TILE, [-8, 0, 16]);
    expect(LOWER_TILE, [-1, 7, 23]);
    expect(BACKGROUND, [-8, 0, 24]);
    expect(UPPER_TILE, [0, 0, 128]);
    expect(UPPER_TILE, [127, 127, 255]);
    expect(BACKGROUND, [0, 0, 256]);
    expect(ROOT_TILE, [4096, 0, 0]);
    expect(ROOT_TILE, [8191, 4095, 4095]);
    expect(BACKGROUND, [4095, 0, 0]);
    let active = (0..512).filter(|&offset| leaf_active(offset)).count() as u64;
    let tiles = 128_u64.pow(3) + 4096_u64.pow(3);
    assert_eq!(grid.stats().active_voxels, active + tiles, "{kind:?}");
}

#[test]
fn all_types_codecs_and_arrangements_hold_the_same_voxels() {
    for kind in Kind::ALL {
        let grids = [Grid::new("density", kind)];
        for codec in [Codec::None, Codec::Zip, Codec::Blosc] {
            let magic = if codec == Codec::Zip { b'2' } else { b'0' };
            check(&parse(segment(magic, codec, &grids)).unwrap(), 0, kind);
        }
        for magic in [b'0', b'1'] {
            let [grid] = grids.clone();
            check(&parse(buffer(&[Grid { magic, ..grid }])).unwrap(), 0, kind);
        }
    }
}

#[test]
fn several_grids_in_several_segments_and_in_a_buffer() {
    let long = "long ".repeat(70);
    let grids = [
        Grid::new("density", Kind::Float),
        Grid { class: 1, ..Grid::new(&long, Kind::Fp8) },
        Grid { class: 3, ..Grid::new("velocity", Kind::Vec3f) },
    ];
    let segments =
        [segment(b'2', Codec::Zip, &grids[..1]), segment(b'0', Codec::None, &grids[1..])];
    for bytes in [segments.concat(), buffer(&grids)] {
        let directory = parse(bytes).unwrap();
        let names: Vec<&str> = directory.grids.iter().map(|grid| grid.name.as_str()).collect();
        assert_eq!(names, ["density", &long, "velocity"]);
        let classes = [GridClass::FogVolume, GridClass::LevelSet, GridClass::Staggered];
        for (index, (grid, class)) in grids.iter().zip(classes).enumerate() {
            assert_eq!(directory.grids[index].class, class);
            check(&directory, index, grid.kind);
        }
        assert_eq!(directory.version.to_string(), "32.4.0");
        assert!(directory.load(3, NO_PROGRESS).is_err());
    }
}

#[test]
fn the_map_takes_index_space_to_the_world() {
    let directory = parse(segment(b'0', Codec::Zip, &[Grid::new("a", Kind::Fp4)])).unwrap();
    let transform = directory.grids[0].transform;
    assert_eq!(transform.voxel_size, DVec3::new(2.0, 2.0, 4.0));
    let world = transform.index_to_world.transform_point3(DVec3::new(1.0, 10.0, 100.0));
    assert_eq!(world, DVec3::new(-15.0, 8.0, 407.0));
    let mut flat = buffer(&[Grid::new("a", Kind::Float)]);
    flat[384..456].fill(0);
    let directory = parse(flat).unwrap();
    let VoxelValues::Unsupported(reason) = directory.load(0, NO_PROGRESS).unwrap() else {
        panic!()
    };
    assert!(reason.contains("flattens space"), "{reason}");
}

#[test]
fn versions_and_types_that_are_not_read_are_named() {
    for minor in 0..10 {
        let mut bytes = segment(b'0', Codec::None, &[Grid::new("a", Kind::Float)]);
        bytes[8..12].copy_from_slice(&version(32, minor).to_le_bytes());
        assert_eq!(parse(bytes).unwrap().version.to_string(), format!("32.{minor}.0"));
    }
    for major in [31, 33] {
        let mut bytes = segment(b'2', Codec::None, &[Grid::new("a", Kind::Float)]);
        bytes[8..12].copy_from_slice(&version(major, 1).to_le_bytes());
        let message = parse(bytes).unwrap_err().to_string();
        assert!(message.contains(&format!("version {major}.1.0")), "{message}");
        let grid = Grid { version: version(major, 1), ..Grid::new("a", Kind::Float) };
        assert!(parse(buffer(std::slice::from_ref(&grid))).is_err());
        let directory = parse(segment(b'2', Codec::Zip, &[grid])).unwrap();
        let reason = directory.grids[0].unsupported.as_ref().unwrap();
        assert!(reason.contains(&format!("version {major}.1.0")), "{reason}");
    }
    for (type_number, words) in
        [(4, "int32"), (9, "half"), (19, "indices"), (23, "points"), (99, "99")]
    {
        let grids = [
            Grid { type_number, ..Grid::new("other", Kind::Float) },
            Grid::new("density", Kind::Float),
        ];
        let directory = parse(segment(b'0', Codec::Blosc, &grids)).unwrap();
        assert!(directory.grids[0].unsupported.as_ref().unwrap().contains(words));
        check(&directory, 1, Kind::Float);
    }
}

#[test]
fn files_cut_anywhere_are_refused_with_their_name() {
    let grids = [Grid::new("density", Kind::FpN(2)), Grid::new("flame", Kind::Float)];
    let read = |bytes: Vec<u8>| {
        let directory = parse(bytes)?;
        (0..directory.grids.len()).try_for_each(|n| directory.load(n, NO_PROGRESS).map(drop))
    };
    for whole in [
        segment(b'2', Codec::None, &grids),
        segment(b'0', Codec::Zip, &grids),
        segment(b'0', Codec::Blosc, &grids),
        buffer(&grids),
    ] {
        assert!(read(whole.clone()).is_ok());
        let every = if whole.len() < 50_000 { 7 } else { 4999 };
        for length in (0..whole.len()).filter(|length| *length < 1200 || length % every == 0) {
            let message = read(whole[..length].to_vec()).expect_err("cut").to_string();
            assert!(message.starts_with("written.nvdb: "), "{message}");
        }
    }
}

/// Offsets may lead to one node again and again, so that a small file would fill all memory.
#[test]
fn nodes_in_each_other_are_refused() {
    const LOWER: usize = 736 + 64 + 3 * 32 + 2 * 270_400;
    let mut bytes = buffer(&[Grid::new("a", Kind::Float)]);
    let leaf_offset = 33_856_u64.to_le_bytes();
    bytes[LOWER + 544..LOWER + 1056].fill(0xff);
    for place in 0..4096 {
        let entry = LOWER + 1088 + 8 * place;
        bytes[entry..entry + 8].copy_from_slice(&leaf_offset);
    }
    let error = parse(bytes).unwrap().load(0, NO_PROGRESS).unwrap_err();
    assert!(error.to_string().contains("nodes that lie in each other"), "{error}");
}

#[test]
fn sizes_beyond_what_the_bytes_can_hold_are_refused() {
    for codec in [Codec::None, Codec::Zip, Codec::Blosc] {
        let mut bytes = segment(b'0', codec, &[Grid::new("a", Kind::Float)]);
        bytes[16..24].copy_from_slice(&(1_u64 << 40).to_le_bytes());
        assert!(parse(bytes).is_err());
    }
}

#[test]
fn loading_can_be_cancelled() {
    for codec in [Codec::None, Codec::Zip, Codec::Blosc] {
        let directory = parse(segment(b'0', codec, &[Grid::new("a", Kind::Float)])).unwrap();
        assert!(matches!(directory.load(0, &|_| false), Err(Error::Cancelled)));
    }
}

/// Formats are told by what is in a file, whatever its name.
#[test]
fn a_file_of_any_name_is_opened_by_its_first_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let open = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        file::Directory::open(path, NO_PROGRESS)
    };
    let nanovdb = segment(b'0', Codec::Zip, &[Grid::new("density", Kind::Float)]);
    let openvdb = std::fs::read(crate::fixtures::fixture("inactive_values")).unwrap();
    for name in ["a.vdb", "a.nvdb", "a"] {
        let directory = open(name, &nanovdb).unwrap();
        assert_eq!((directory.format, directory.grids.len()), (Format::NanoVdb, 1));
        assert!(matches!(directory.load(0, NO_PROGRESS), Ok(VoxelValues::Float(_))));
        assert_eq!(open(name, &openvdb).unwrap().format, Format::OpenVdb);
    }
    let message = open("a.vdb", b"neither of both").unwrap_err().to_string();
    assert!(message.contains("a.vdb: ") && message.contains("no volume"), "{message}");
    let mut old = nanovdb.clone();
    old[8..12].copy_from_slice(&version(29, 0).to_le_bytes());
    assert!(open("a", &old).unwrap_err().to_string().contains("version 29.0.0"));
    let reversed: Vec<u8> = nanovdb[..8].iter().rev().copied().chain([0; 20]).collect();
    assert!(open("a", &reversed).unwrap_err().to_string().contains("big-endian"));
}

/// A scene takes either format, and guesses for a bare volume are the same.
#[test]
fn scenes_open_both_formats() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("smoke.bin");
    let grid = Grid { with_root_tile: false, ..Grid::new("density", Kind::Float) };
    std::fs::write(&path, segment(b'2', Codec::Blosc, &[grid])).unwrap();
    let settings = flambeau::scene::load(path.to_str().unwrap()).unwrap();
    assert_eq!(settings.volume[0].density.grid.as_deref(), Some("density"));
    std::fs::write(&path, "no volume").unwrap();
    let message = flambeau::scene::load(path.to_str().unwrap()).unwrap_err().to_string();
    assert!(message.contains("(.vdb, .nvdb)"), "{message}");
}

#[test]
fn a_level_set_is_shown_as_fog() {
    let level_set = Grid { class: 1, background: 2.0, ..Grid::new("surface", Kind::Fp8) };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("surface.nvdb");
    std::fs::write(&path, buffer(&[level_set])).unwrap();
    let text = "[[volume]]\nfile = 'surface.nvdb'\n\
                density = { grid = 'surface', level_set = true }";
    let scene = scene::parse(text, "", folder.path(), &Default::default()).unwrap();
    let built = scene::assemble(&scene, &VolumeCache::default(), NO_PROGRESS).unwrap();
    let properties = built.world.instances()[0].volume().properties();
    let density = |at: IVec3| properties.mu_t(at.as_vec3a()).x;
    for offset in 0..512 {
        let [x, y, z] = [offset >> 6, offset >> 3 & 7, offset & 7].map(|c| c as i32);
        let depth = -leaf_value(Kind::Fp8, offset) as f32;
        assert_eq!(density(IVec3::new(x - 8, y, z)), depth.clamp(0.0, 2.0) / 2.0);
    }
    assert_eq!(density(IVec3::new(-1, 7, 23)), 1.0, "an inactive tile inside");
    assert_eq!(density(IVec3::new(0, 0, 128)), 0.0, "an active tile outside");
}
