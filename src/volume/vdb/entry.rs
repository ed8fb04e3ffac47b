//! A grid's entry in the list of a file.

use std::ops::Range;

use super::compression::Compression;
use super::header::VdbHeader;
use super::metadata::{self, MetaValue, Metadata};
use super::reader::Reader;
use super::stream::{Fault, Result, Stream};
use super::transform;
use super::tree::{self, PassOver};
use super::values::{Scalar, ValueLayout};
use crate::error::Progress;
use crate::volume::grid::{GridClass, Transform};

fn class_of(metadata: &Metadata) -> GridClass {
    match metadata.get("class") {
        Some(MetaValue::Text(class)) if class == "level set" => GridClass::LevelSet,
        Some(MetaValue::Text(class)) if class == "fog volume" => GridClass::FogVolume,
        Some(MetaValue::Text(class)) if class == "staggered" => GridClass::Staggered,
        _ => GridClass::Unknown,
    }
}

/// A grid of a file, without its voxels.
#[derive(Clone, Debug)]
pub struct GridInfo {
    /// The name; other grids of the file may have the same one.
    pub name: String,
    /// The type as the file has it, such as `Tree_float_5_4_3`.
    pub type_name: String,
    /// Class of the grid.
    pub class: GridClass,
    /// Whether values of a wider type are stored as half floats.
    pub is_half: bool,
    /// Transform from index space to the world; [`Transform::IDENTITY`] if it is why the grid is
    /// unsupported.
    pub transform: Transform,
    /// The grid's own named values.
    pub metadata: Metadata,
    /// Reason why the grid cannot be loaded, if it cannot.
    pub unsupported: Option<String>,
    /// The name that no other grid of the file has.
    pub(super) unique_name: String,
    pub(super) tree: TreePlace,
}

/// Location of a grid's tree.
#[derive(Clone, Debug)]
pub(super) enum TreePlace {
    /// Bytes of the grid's own tree.
    Own { bytes: Range<usize>, layout: ValueLayout },
    /// The tree is that of the grid with this unique name.
    Shared(String),
    /// A tree of a kind that is not loaded.
    Foreign,
}

impl GridInfo {
    /// Reads an entry and what comes before its tree, and leaves the reader at the next entry;
    /// `name` is set as soon as it is known.
    pub(super) fn read(
        reader: &mut Reader,
        header: &VdbHeader,
        name: &mut String,
        progress: Progress,
    ) -> Result<Self> {
        let descriptor = reader.step("list of grids", Descriptor::read)?;
        *name = descriptor.name();
        if header.has_offsets {
            let mut window = reader.window(descriptor.start, descriptor.end)?;
            let grid = window.step("grid", |stream| descriptor.read_grid(stream, header))?;
            reader.skip(&window);
            return Ok(grid);
        }
        let grid = reader.step("grid", |stream| descriptor.read_grid(stream, header))?;
        match &grid.tree {
            TreePlace::Shared(_) => {}
            TreePlace::Own { layout, .. } => {
                tree::walk(reader, *layout, &mut PassOver, progress)?;
            }
            TreePlace::Foreign => {
                return Err(Fault::Unsupported(format!(
                    "the file has no table of offsets, so that a grid of type '{}' cannot be \
                     stepped over; save the file again without that grid",
                    grid.type_name
                )));
            }
        }
        Ok(grid)
    }
}

/// An entry as the file has it.
struct Descriptor {
    unique_name: String,
    type_name: String,
    half: bool,
    /// Unique name of the grid whose tree this one shares; empty if it has its own.
    parent: String,
    start: i64,
    end: i64,
}

impl Descriptor {
    fn read(stream: &mut Stream) -> Result<Self> {
        stream.enter("list of grids");
        let unique_name = stream.text()?;
        let type_text = stream.text()?;
        let parent = stream.text()?;
        let [start, _values, end] = [stream.i64()?, stream.i64()?, stream.i64()?];
        let plain = type_text.strip_suffix("_HalfFloat");
        let half = plain.is_some();
        let type_name = plain.unwrap_or(&type_text).to_owned();
        Ok(Self { unique_name, type_name, half, parent, start, end })
    }

    /// Names used twice are told apart by a number after this character.
    fn name(&self) -> String {
        self.unique_name.split('\u{1e}').next().unwrap_or_default().to_owned()
    }

    /// Reads what comes before the tree, if the grid has one of its own.
    fn read_grid(&self, stream: &mut Stream, header: &VdbHeader) -> Result<GridInfo> {
        let compression = match header.has_node_masks() {
            true => Compression::read(stream)?,
            false => header.compression,
        };
        let metadata = metadata::read(stream)?;
        let (transform, refused) = match transform::read(stream, header.version) {
            Ok(transform) => (transform, None),
            Err(Fault::Unsupported(reason)) if header.has_offsets => {
                (Transform::IDENTITY, Some(reason))
            }
            Err(fault) => return Err(fault),
        };
        let half_flag = metadata.get("is_saved_as_half_float") == Some(&MetaValue::Bool(true));
        let is_half = self.half || half_flag;
        let values = stored_values(&self.type_name);
        let tree = match values {
            _ if !self.parent.is_empty() => TreePlace::Shared(self.parent.clone()),
            Some((scalar, components)) => {
                let node_masks = header.has_node_masks();
                let layout =
                    ValueLayout { scalar, components, half: is_half, compression, node_masks };
                TreePlace::Own { bytes: stream.rest(), layout }
            }
            None => TreePlace::Foreign,
        };
        Ok(GridInfo {
            name: self.name(),
            class: class_of(&metadata),
            is_half,
            transform,
            metadata,
            unsupported: refused.or_else(|| unsupported_type(&self.type_name)),
            type_name: self.type_name.clone(),
            unique_name: self.unique_name.clone(),
            tree,
        })
    }
}

/// Levels of the usual tree, log2 of the places along an edge from the top down.
const LEVELS: &str = "5_4_3";

impl GridInfo {
    /// The type of the values, such as `float` or `vec3s`; the whole type where it has no such
    /// part.
    pub fn value_type(&self) -> &str {
        split_type(&self.type_name).map_or(&self.type_name, |(value, _)| value)
    }
}

/// The two parts of a type such as `Tree_float_5_4_3`.
fn split_type(type_name: &str) -> Option<(&str, &str)> {
    type_name.strip_prefix("Tree_")?.split_once('_')
}

/// Storage of a tree's values: type and number of components; `None` unless it is a usual tree of
/// values of known size.
fn stored_values(type_name: &str) -> Option<(Scalar, usize)> {
    let (values, LEVELS) = split_type(type_name)? else { return None };
    Some(match values {
        "half" => (Scalar::F16, 1),
        "vec3h" | "vec3H" | "Vec3H" => (Scalar::F16, 3),
        "float" => (Scalar::F32, 1),
        "double" => (Scalar::F64, 1),
        "vec3s" => (Scalar::F32, 3),
        "vec3d" => (Scalar::F64, 3),
        "int32" => (Scalar::Opaque { bytes: 4 }, 1),
        "int64" => (Scalar::Opaque { bytes: 8 }, 1),
        "vec3i" => (Scalar::Opaque { bytes: 4 }, 3),
        _ => return None,
    })
}

/// Reason why trees of this type are not loaded, if they are not.
fn unsupported_type(type_name: &str) -> Option<String> {
    match (split_type(type_name), stored_values(type_name)) {
        (_, Some((Scalar::F16 | Scalar::F32 | Scalar::F64, _))) => None,
        (Some((values, LEVELS)), _) if values.starts_with("pt") => Some(format!(
            "points ('{type_name}'); rasterize them to a density grid before exporting"
        )),
        (Some((values, LEVELS)), _) => Some(format!(
            "values of type {values}; only float, double and half grids, and vec3 grids of these, are loaded"
        )),
        (Some((_, levels)), _) => Some(format!(
            "a tree with levels {levels} instead of the usual {LEVELS}; save the grid with \
             OpenVDB's default tree"
        )),
        (None, _) => Some(format!("a grid of unknown type '{type_name}'")),
    }
}
