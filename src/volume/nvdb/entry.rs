//! A grid's header: all of it but the tree.

use glam::{DAffine3, DMat3};

use super::bytes::{Bytes, broken};
use super::grid_type::GridType;
use super::layout::{GRID_HEADER, ValueLayout};
use super::segments::{Version, is_nanovdb};
use super::stored::StoredGrid;
use crate::error::Result;
use crate::volume::grid::{GridClass, Transform};

const VERSION: usize = 16;
const FLAGS: usize = 20;
const NAME: usize = 40;
const NAME_LENGTH: usize = 256;
/// The map in double precision: nine numbers of a matrix, row by row, and its translation.
const MATRIX: usize = 384;
const TRANSLATION: usize = 528;
const CLASS: usize = 632;
const TYPE: usize = 636;
const BLIND_OFFSET: usize = 640;
const BLIND_COUNT: usize = 648;
/// The flag of grids whose names do not fit in the header.
const HAS_LONG_NAME: u32 = 1;

/// A grid of a file, without its voxels.
#[derive(Clone, Debug)]
pub struct GridInfo {
    /// The name; other grids of the file may have the same one.
    pub name: String,
    /// The type of the values: `float`, `vec3d`, `Fp16`, ...
    pub type_name: String,
    /// Class of the grid.
    pub class: GridClass,
    /// Transform from index space to the world; [`Transform::IDENTITY`] if it is why the grid is
    /// unsupported.
    pub transform: Transform,
    /// Reason why the grid cannot be loaded, if it cannot.
    pub unsupported: Option<String>,
    pub(super) stored: StoredGrid,
    /// Layout of the values, for types that are loaded.
    pub(super) layout: Option<ValueLayout>,
}

impl GridInfo {
    /// Reads the header of a grid.
    pub(super) fn read(file: Bytes, stored: StoredGrid) -> Result<Self> {
        let start = stored.start(file, GRID_HEADER)?;
        let header = Bytes(&start);
        header.slice(0, GRID_HEADER)?;
        if !is_nanovdb(header.slice(0, 8)?) {
            let reason =
                "no grid where one should be; the file is damaged, export or copy it again";
            return Err(broken(stored.packed.start, reason));
        }
        let version = Version::read(header, VERSION)?;
        let grid_type = GridType(header.u32(TYPE)?);
        let (layout, mut unsupported) = match grid_type.layout() {
            _ if !version.is_read() => (None, Some(version.refusal())),
            Ok(layout) => (Some(layout), None),
            Err(reason) => (None, Some(reason)),
        };
        let transform = transform(header)?.unwrap_or_else(|| {
            unsupported.get_or_insert_with(|| Transform::UNUSABLE.to_owned());
            Transform::IDENTITY
        });
        Ok(Self {
            name: name(file, header, &stored)?,
            type_name: grid_type.name(),
            class: class(header.u32(CLASS)?),
            transform,
            unsupported,
            stored,
            layout,
        })
    }
}

fn class(number: u32) -> GridClass {
    match number {
        1 => GridClass::LevelSet,
        2 => GridClass::FogVolume,
        3 => GridClass::Staggered,
        _ => GridClass::Unknown,
    }
}

fn transform(header: Bytes) -> Result<Option<Transform>> {
    let row = |row: usize| header.dvec3(MATRIX + 24 * row);
    let matrix3 = DMat3::from_cols(row(0)?, row(1)?, row(2)?).transpose();
    Ok(Transform::new(DAffine3 { matrix3, translation: header.dvec3(TRANSLATION)? }))
}

/// The name in the segment, else the one in the blind data, else the one in the header, which may
/// be cut.
fn name(file: Bytes, header: Bytes, stored: &StoredGrid) -> Result<String> {
    if !stored.name.is_empty() {
        return Ok(stored.name.clone());
    }
    if header.u32(FLAGS)? & HAS_LONG_NAME != 0 {
        let grid = Bytes(file.slice(stored.packed.start, stored.packed.len())?);
        if let Some(name) = long_name(grid)? {
            return Ok(name);
        }
    }
    header.text(NAME, NAME_LENGTH)
}

/// The name in the blind data of an unpacked grid.
fn long_name(grid: Bytes) -> Result<Option<String>> {
    const BLIND_HEADER: usize = 288;
    const VALUE_COUNT: usize = 8;
    const DATA_CLASS: usize = 24;
    const GRID_NAME: u32 = 3;
    const LONGEST: usize = 1 << 16;
    let mut at = grid.target(BLIND_OFFSET, 0)?;
    for _ in 0..grid.u32(BLIND_COUNT)? {
        grid.slice(at, BLIND_HEADER)?;
        if grid.u32(at + DATA_CLASS)? == GRID_NAME {
            let length = grid.size(at + VALUE_COUNT)?.min(LONGEST);
            return grid.text(grid.target(at, at)?, length).map(Some);
        }
        at += BLIND_HEADER;
    }
    Ok(None)
}
