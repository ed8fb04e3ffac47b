//! Named values of a file or a grid.

use std::collections::BTreeMap;
use std::fmt;

use super::stream::{Result, Stream};

/// Named values, sorted by name.
pub type Metadata = BTreeMap<String, MetaValue>;

/// One named value.
#[derive(Clone, Debug, PartialEq)]
pub enum MetaValue {
    /// A switch.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// The components of a vector or, row by row, of a matrix.
    Vector(Vec<f64>),
    /// A value of some other type, not decoded.
    Other {
        /// The name of the type.
        type_name: String,
        /// Size of the value in bytes.
        bytes: usize,
    },
}

impl fmt::Display for MetaValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(value) => write!(f, "{value}"),
            Self::Integer(value) => write!(f, "{value}"),
            Self::Number(value) => write!(f, "{value}"),
            Self::Text(value) => f.write_str(value),
            Self::Vector(values) => write!(f, "{values:?}"),
            Self::Other { type_name, bytes } => write!(f, "({type_name}, {bytes} bytes)"),
        }
    }
}

/// Reads a count and that many named values.
pub(super) fn read(stream: &mut Stream) -> Result<Metadata> {
    stream.enter("metadata");
    // Two lengths and a size are the least that a value takes.
    let count = stream.count(12)?;
    let mut metadata = Metadata::new();
    for _ in 0..count {
        let name = stream.text()?;
        let type_name = stream.text()?;
        let size = stream.count(1)?;
        let bytes = stream.take(size)?;
        metadata.insert(name, decode(type_name, bytes));
    }
    Ok(metadata)
}

fn decode(type_name: String, bytes: &[u8]) -> MetaValue {
    let value = match type_name.as_str() {
        "string" => Some(MetaValue::Text(String::from_utf8_lossy(bytes).into_owned())),
        "bool" => numbers(bytes, 1, |[byte]: [u8; 1]| byte != 0).map(|v| MetaValue::Bool(v[0])),
        "int32" => numbers(bytes, 1, i32::from_le_bytes).map(|v| MetaValue::Integer(v[0].into())),
        "int64" => numbers(bytes, 1, i64::from_le_bytes).map(|v| MetaValue::Integer(v[0])),
        "float" => numbers(bytes, 1, f32::from_le_bytes).map(|v| MetaValue::Number(v[0].into())),
        "double" => numbers(bytes, 1, f64::from_le_bytes).map(|v| MetaValue::Number(v[0])),
        name => vector(name, bytes).map(MetaValue::Vector),
    };
    value.unwrap_or(MetaValue::Other { type_name, bytes: bytes.len() })
}

/// Components of a vector or matrix type, `vec2i` to `vec4d` and `mat3s` to `mat4d`.
fn vector(name: &str, bytes: &[u8]) -> Option<Vec<f64>> {
    let (shape, component) = name.split_at_checked(4)?;
    let count = match shape {
        "vec2" => 2,
        "vec3" => 3,
        "vec4" => 4,
        "mat3" => 9,
        "mat4" => 16,
        _ => return None,
    };
    match component {
        "i" => numbers(bytes, count, |bytes| f64::from(i32::from_le_bytes(bytes))),
        "s" => numbers(bytes, count, |bytes| f64::from(f32::from_le_bytes(bytes))),
        "d" => numbers(bytes, count, f64::from_le_bytes),
        _ => None,
    }
}

/// Decodes exactly `count` numbers of `N` bytes each; `None` if the size is another.
fn numbers<const N: usize, T>(
    bytes: &[u8],
    count: usize,
    number: impl Fn([u8; N]) -> T,
) -> Option<Vec<T>> {
    let (chunks, rest) = bytes.as_chunks::<N>();
    (chunks.len() == count && rest.is_empty())
        .then(|| chunks.iter().map(|&chunk| number(chunk)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(name: &str, type_name: &str, value: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        for text in [name.as_bytes(), type_name.as_bytes(), value] {
            bytes.extend((text.len() as u32).to_le_bytes());
            bytes.extend(text);
        }
        bytes
    }

    #[test]
    fn values_of_every_kind() {
        let mut bytes = 6_u32.to_le_bytes().to_vec();
        bytes.extend(entry("on", "bool", &[1]));
        bytes.extend(entry("frame", "int32", &(-7_i32).to_le_bytes()));
        bytes.extend(entry("name", "string", "fumée".as_bytes()));
        let vector: Vec<u8> = [1.0_f32, 2.0, 3.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        bytes.extend(entry("v", "vec3s", &vector));
        bytes.extend(entry("wrong size", "float", &[0; 3]));
        bytes.extend(entry("far off", "vendor::type", &[0; 5]));
        let metadata = read(&mut Stream::new(&bytes, 0, "")).unwrap();
        assert_eq!(metadata["on"], MetaValue::Bool(true));
        assert_eq!(metadata["frame"], MetaValue::Integer(-7));
        assert_eq!(metadata["name"], MetaValue::Text("fumée".into()));
        assert_eq!(metadata["v"], MetaValue::Vector(vec![1.0, 2.0, 3.0]));
        assert_eq!(metadata["wrong size"].to_string(), "(float, 3 bytes)");
        assert_eq!(metadata["far off"].to_string(), "(vendor::type, 5 bytes)");
        for length in 0..bytes.len() {
            assert!(read(&mut Stream::new(&bytes[..length], 0, "")).is_err());
        }
    }
}
