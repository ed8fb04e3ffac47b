//! Every file of the conformance collection against what its manifest says.

use flambeau::error::{Error, NO_PROGRESS};
use flambeau::volume::grid::{GridClass, IndexBox, SparseGrid, Voxel, VoxelValues};
use flambeau::volume::vdb::{self, VdbFile, VdbGrid};
use glam::{DVec3, IVec3};
use serde_json::Value;

use crate::shared::{assert_close, shared};

#[test]
fn every_file_is_read_as_its_manifest_says() {
    let Some(folder) = shared("conformance") else { return };
    let manifest = std::fs::read_to_string(folder.join("manifest.json")).unwrap();
    let manifest: Value = serde_json::from_str(&manifest).unwrap();
    let mut checked = 0;
    for entry in manifest["files"].as_array().unwrap() {
        let name = entry["file"].as_str().unwrap();
        if name.ends_with(".vdb") {
            println!("{name}: {}", entry["covers"]);
            check_file(entry, vdb::read(folder.join(name), NO_PROGRESS));
            checked += 1;
        }
    }
    assert!(checked > 40, "only {checked} files");
}

fn check_file(entry: &Value, result: Result<VdbFile, Error>) {
    let name = entry["file"].as_str().unwrap();
    let expected = entry["expect"].as_str().unwrap();
    match expected {
        "no_crash" => return,
        "error" => {
            let message = result.unwrap_err().to_string();
            assert!(message.contains(name) && message.len() > name.len() + 20, "{message}");
            return;
        }
        _ => {}
    }
    let file = result.unwrap();
    let grids = entry["grids"].as_array().map_or(&[][..], |grids| grids);
    assert_eq!(file.grids.len(), grids.len());
    for grid in grids {
        let found = find(&file, grid);
        match expected {
            "refuse_tree" => assert!(reason(found).contains("tree with levels 5_5_4_3")),
            _ => check_grid(grid, found),
        }
        let is_level_set = expected == "ok_levelset";
        assert_eq!(found.info.class == GridClass::LevelSet, is_level_set);
    }
}

/// The grid of that name whose transform agrees, if one of several does.
fn find<'a>(file: &'a VdbFile, wanted: &Value) -> &'a VdbGrid {
    let name = wanted["name"].as_str().unwrap();
    let size = wanted["voxel_size"][0].as_f64().unwrap();
    let mut named: Vec<_> = file.grids.iter().filter(|grid| grid.info.name == name).collect();
    assert!(!named.is_empty(), "no grid '{name}'");
    let off = |grid: &&VdbGrid| (grid.info.transform.voxel_size.x - size).abs();
    named.sort_by(|a, b| off(a).total_cmp(&off(b)));
    named[0]
}

fn reason(grid: &VdbGrid) -> &str {
    match &grid.values {
        VoxelValues::Unsupported(reason) => reason,
        other => panic!("should be refused: {other:?}"),
    }
}

fn check_grid(wanted: &Value, grid: &VdbGrid) {
    let type_name = wanted["type"].as_str().unwrap();
    assert_eq!(grid.info.type_name, type_name);
    assert_eq!(grid.info.is_half, wanted["half"].as_bool().unwrap_or(false));
    assert_eq!(grid.info.class.to_string(), wanted["class"].as_str().unwrap());
    check_transform(wanted, grid);
    match (&grid.values, wanted["value_type"].as_str().unwrap()) {
        (VoxelValues::Float(values), "float" | "double") => check_values(wanted, values),
        (VoxelValues::Vec3(values), "vec3s" | "vec3d") => check_values(wanted, values),
        (VoxelValues::Unsupported(reason), "int32" | "int64" | "vec3i" | "bool") => {
            assert!(reason.contains("only float"), "{reason}");
        }
        (VoxelValues::Unsupported(reason), "ptdataidx32") => assert!(reason.contains("points")),
        (values, type_name) => panic!("{type_name} became {values:?}"),
    }
}

fn check_transform(wanted: &Value, grid: &VdbGrid) {
    let transform = grid.info.transform;
    let world = transform.point(DVec3::new(3.0, -2.0, 5.0));
    let rows = &wanted["matrix_rows_rowvector_convention"];
    let columns = transform.index_to_world.matrix3.to_cols_array_2d();
    for axis in 0..3 {
        let number = |value: &Value| value.as_f64().unwrap();
        let size = number(&wanted["voxel_size"][axis]);
        assert_close(transform.voxel_size[axis], size, 1e-9, "voxel size");
        let point = number(&wanted["index_3_m2_5_to_world"][axis]);
        assert_close(world[axis], point, 1e-9, "a point in the world");
        if transform.taper.is_some() {
            continue;
        }
        for row in 0..3 {
            let want = number(&rows[row][axis]);
            assert!((columns[row][axis] - want).abs() < 1e-12, "matrix {columns:?}");
        }
        let translation = transform.index_to_world.translation[axis];
        assert!((translation - number(&rows[3][axis])).abs() < 1e-12);
    }
}

/// The components of a number or an array; "NaN" and the like stand for the background.
fn components(value: &Value, background: [f64; 3]) -> [f64; 3] {
    match value {
        Value::Array(array) => {
            std::array::from_fn(|c| components(&array[c], [background[c]; 3])[0])
        }
        Value::String(_) => background,
        number => [number.as_f64().unwrap(), 0.0, 0.0],
    }
}

fn check_values<V: Voxel>(wanted: &Value, grid: &SparseGrid<V>) {
    let stats = grid.stats();
    assert_eq!(Some(stats.active_voxels), wanted["active_voxels"].as_u64());
    let background = components(&wanted["background"], [0.0; 3]);
    let compare = |got: V, want: &Value, tolerance: f64, what: &str| {
        let want = components(want, background);
        for (got, want) in got.to_f64().into_iter().zip(want) {
            assert_close(got, want, tolerance, what);
        }
    };
    compare(grid.background(), &wanted["background"], 1e-7, "background");
    let lost = wanted["has_nonfinite"].as_bool().unwrap_or(false);
    assert_eq!(stats.replaced_values > 0, lost);
    if stats.active_voxels == 0 {
        assert_eq!(stats.active_bounds, None);
        return;
    }
    let corner = |name: &str| {
        IVec3::from_array(std::array::from_fn(|axis| wanted[name][axis].as_i64().unwrap() as i32))
    };
    let bounds = IndexBox { min: corner("bbox_min"), max: corner("bbox_max") };
    assert_eq!(stats.active_bounds, Some(bounds));
    compare(stats.min, &wanted["min"], 1e-6, "min");
    compare(stats.max, &wanted["max"], 1e-6, "max");
    compare(stats.mean, &wanted["mean"], 1e-5, "mean");
    for sample in wanted["samples"].as_array().unwrap() {
        let ijk: [i64; 3] = std::array::from_fn(|axis| sample["ijk"][axis].as_i64().unwrap());
        let got = grid.value(IVec3::from_array(ijk.map(|c| c as i32)));
        compare(got, &sample["value"], 1e-6, &format!("voxel {ijk:?}"));
    }
    // Vector grids have none.
    for sample in wanted["trilinear"].as_array().into_iter().flatten() {
        let index: [f64; 3] = std::array::from_fn(|axis| sample["index"][axis].as_f64().unwrap());
        let got = grid.sample(index.map(|c| c as f32).into());
        compare(got, &sample["value"], 1e-4, &format!("position {index:?}"));
    }
}
