//! The types that a grid's values can have.

use super::layout::{Scalar, ValueLayout};

/// Type of a grid's values, with its number in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct GridType(pub u32);

/// The names of the types, by number.
const NAMES: [&str; 27] = [
    "unknown",
    "float",
    "double",
    "int16",
    "int32",
    "int64",
    "vec3f",
    "vec3d",
    "mask",
    "half",
    "uint32",
    "bool",
    "rgba8",
    "Fp4",
    "Fp8",
    "Fp16",
    "FpN",
    "vec4f",
    "vec4d",
    "index",
    "onindex",
    "indexmask",
    "onindexmask",
    "pointindex",
    "vec3u8",
    "vec3u16",
    "uint8",
];

impl GridType {
    /// The name of the type.
    pub fn name(self) -> String {
        let known = NAMES.get(self.0 as usize);
        known.map_or_else(|| format!("type {}", self.0), |&name| name.to_owned())
    }

    /// The layout of the values, or the reason why they are not loaded.
    pub fn layout(self) -> Result<ValueLayout, String> {
        let (scalar, components) = match self.0 {
            1 => (Scalar::F32, 1),
            2 => (Scalar::F64, 1),
            6 => (Scalar::F32, 3),
            7 => (Scalar::F64, 3),
            13 => (Scalar::Code { bits: 4 }, 1),
            14 => (Scalar::Code { bits: 8 }, 1),
            15 => (Scalar::Code { bits: 16 }, 1),
            16 => (Scalar::CodeOfLeaf, 1),
            19..=22 => {
                return Err(format!(
                    "a grid of indices ('{}') whose values lie elsewhere; write the grid with its \
                     values",
                    self.name()
                ));
            }
            23 => {
                return Err("points ('pointindex'); rasterize them to a density grid before \
                            exporting"
                    .to_owned());
            }
            _ => {
                return Err(format!(
                    "values of type {}; only float, double, vec3f, vec3d, Fp4, Fp8, Fp16 and FpN \
                     grids are loaded",
                    self.name()
                ));
            }
        };
        Ok(ValueLayout { scalar, components })
    }
}
