//! The NanoVDB files of the conformance collection against what its manifest says.

use std::path::Path;

use flambeau::error::{NO_PROGRESS, Result};
use flambeau::volume::grid::{GridClass, IndexBox, SparseGrid, VoxelValues};
use flambeau::volume::nvdb::{Directory, GridInfo};
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
        if name.ends_with(".nvdb") {
            println!("{name}: {}", entry["covers"]);
            check_file(entry, read(&folder.join(name)));
            checked += 1;
        }
    }
    assert!(checked > 10, "only {checked} files");
}

type Read = Vec<(GridInfo, VoxelValues)>;

fn read(path: &Path) -> Result<Read> {
    let directory = Directory::open(path, NO_PROGRESS)?;
    let load =
        |index: usize| Ok((directory.grids[index].clone(), directory.load(index, NO_PROGRESS)?));
    (0..directory.grids.len()).map(load).collect()
}

fn check_file(entry: &Value, result: Result<Read>) {
    let name = entry["file"].as_str().unwrap();
    match entry["expect"].as_str().unwrap() {
        "no_crash" => return,
        "error" => {
            let message = result.unwrap_err().to_string();
            assert!(message.contains(name) && message.len() > name.len() + 20, "{message}");
            return;
        }
        _ => {}
    }
    let grids = result.unwrap();
    let wanted = entry["grids"].as_array().unwrap();
    assert_eq!(grids.len(), wanted.len());
    for ((info, values), wanted) in grids.iter().zip(wanted) {
        assert_eq!(info.name, wanted["name"].as_str().unwrap());
        let is_level_set = wanted["class"] == "SDF";
        assert_eq!(info.class == GridClass::LevelSet, is_level_set);
        assert_eq!(info.class == GridClass::FogVolume, wanted["class"] == "FOG");
        check_transform(wanted, info);
        match (values, wanted["value_type"].as_str().unwrap()) {
            (VoxelValues::Unsupported(reason), "int32") => assert!(reason.contains("int32")),
            (VoxelValues::Float(grid), "float" | "Float4" | "Float8" | "Float16" | "FloatN") => {
                check_voxels(wanted, grid);
            }
            (values, wanted) => panic!("{wanted} became {values:?}"),
        }
    }
}

fn numbers(value: &Value) -> [f64; 3] {
    std::array::from_fn(|axis| value[axis].as_f64().unwrap())
}

fn check_transform(wanted: &Value, info: &GridInfo) {
    let size = DVec3::from_array(numbers(&wanted["voxel_size"]));
    assert!(info.transform.voxel_size.abs_diff_eq(size, 1e-9), "{:?}", info.transform);
    let world = info.transform.index_to_world.transform_point3(DVec3::new(3.0, -2.0, 5.0));
    let point = DVec3::from_array(numbers(&wanted["index_3_m2_5_to_world"]));
    assert!(world.abs_diff_eq(point, 1e-9), "{world} instead of {point}");
}

fn check_voxels(wanted: &Value, grid: &SparseGrid<f32>) {
    let stats = grid.stats();
    assert_eq!(Some(stats.active_voxels), wanted["active_voxels"].as_u64());
    let corner = |name: &str| IVec3::from_array(numbers(&wanted[name]).map(|c| c as i32));
    let bounds = IndexBox { min: corner("bbox_min"), max: corner("bbox_max") };
    assert_eq!(stats.active_bounds, Some(bounds));
    let samples = wanted["samples"].as_array().unwrap();
    assert!(samples.len() > 20);
    for sample in samples {
        let ijk = numbers(&sample["ijk"]).map(|c| c as i32);
        let got = f64::from(grid.value(ijk.into()));
        let want = sample["value"].as_f64().unwrap();
        assert_close(got, want, 1e-6, &format!("voxel {ijk:?}"));
    }
}
