//! The values of a leaf.

use super::bytes::{Bytes, broken};
use super::layout::{LEAF_FLAGS, LEAF_MASK, LEAF_VOXELS, NodeLayout, Scalar, ValueLayout};
use crate::error::Result;
use crate::volume::grid::Voxel;

/// The bytes of the leaf at `at`, all of them.
pub(super) fn bytes<'a>(
    grid: Bytes<'a>,
    at: usize,
    layout: ValueLayout,
    nodes: &NodeLayout,
) -> Result<&'a [u8]> {
    if layout.scalar != Scalar::CodeOfLeaf {
        return grid.slice(at, nodes.leaf);
    }
    let bits = code_bits(grid.slice(at, nodes.leaf)?).ok_or_else(|| {
        broken(at, "a leaf with codes of unknown size; the file is damaged, export it again")
    })?;
    grid.slice(at, nodes.leaf_table + LEAF_VOXELS * bits / 8)
}

/// Bits of a code, from the flags of a leaf: a power of two up to 16.
fn code_bits(leaf: &[u8]) -> Option<usize> {
    let exponent = leaf[LEAF_FLAGS] >> 5;
    (exponent <= 4).then_some(1 << exponent)
}

/// Which voxels are active.
pub(super) fn active(leaf: &[u8]) -> [u64; 8] {
    let (words, _) = leaf[LEAF_MASK..].as_chunks();
    std::array::from_fn(|n| words.get(n).map_or(0, |&word| u64::from_le_bytes(word)))
}

/// Decodes the values of a leaf.
pub(super) fn decode<V: Voxel>(
    leaf: &[u8],
    layout: ValueLayout,
    nodes: &NodeLayout,
    values: &mut [V],
) {
    let table = &leaf[nodes.leaf_table..];
    match layout.scalar {
        Scalar::F32 => decode_scalars(table, values, f32::from_le_bytes),
        Scalar::F64 => decode_scalars(table, values, |bytes| f64::from_le_bytes(bytes) as f32),
        Scalar::Code { bits } => decode_codes(leaf, table, bits, values),
        Scalar::CodeOfLeaf => decode_codes(leaf, table, code_bits(leaf).unwrap_or(1), values),
    }
}

/// The value whose components start `bytes`, as tables of nodes hold them.
pub(super) fn value<V: Voxel>(bytes: &[u8], layout: ValueLayout) -> V {
    let mut value = [V::ZERO];
    match layout.scalar {
        Scalar::F64 => decode_scalars(bytes, &mut value, |bytes| f64::from_le_bytes(bytes) as f32),
        _ => decode_scalars(bytes, &mut value, f32::from_le_bytes),
    }
    value[0]
}

fn decode_scalars<V: Voxel, const N: usize>(
    bytes: &[u8],
    values: &mut [V],
    scalar: impl Fn([u8; N]) -> f32,
) {
    let (scalars, _) = bytes.as_chunks::<N>();
    for (value, scalars) in values.iter_mut().zip(scalars.chunks_exact(V::COMPONENTS)) {
        let mut components = [0.0; 3];
        for (component, &bytes) in components.iter_mut().zip(scalars) {
            *component = scalar(bytes);
        }
        *value = V::from_components(components);
    }
}

fn decode_codes<V: Voxel>(leaf: &[u8], table: &[u8], bits: usize, values: &mut [V]) {
    const MINIMUM: usize = LEAF_MASK + LEAF_VOXELS / 8;
    let number = |at: usize| leaf[at..].first_chunk().map_or(0.0, |&b| f32::from_le_bytes(b));
    let (minimum, quantum) = (number(MINIMUM), number(MINIMUM + 4));
    for (n, value) in values.iter_mut().enumerate() {
        let first = n * bits;
        let code = match bits {
            16 => u32::from(table[first / 8]) | u32::from(table[first / 8 + 1]) << 8,
            _ => u32::from(table[first / 8]) >> (first % 8) & ((1 << bits) - 1),
        };
        *value = V::from_components([code as f32 * quantum + minimum, 0.0, 0.0]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A leaf of codes: minimum 1, quantum 0.5, every byte of its table 0xb1.
    fn leaf(bits: usize) -> Vec<u8> {
        let mut leaf = vec![0; 96];
        leaf[LEAF_FLAGS] = (bits.ilog2() as u8) << 5;
        leaf[80..84].copy_from_slice(&1.0_f32.to_le_bytes());
        leaf[84..88].copy_from_slice(&0.5_f32.to_le_bytes());
        leaf.extend(std::iter::repeat_n(0xb1, LEAF_VOXELS * bits / 8));
        leaf
    }

    #[test]
    fn codes_of_every_size() {
        for (bits, codes) in [
            (1, [1, 0, 0, 0, 1, 1, 0, 1]),
            (2, [1, 0, 3, 2, 1, 0, 3, 2]),
            (4, [1, 11, 1, 11, 1, 11, 1, 11]),
            (8, [0xb1; 8]),
            (16, [0xb1b1; 8]),
        ] {
            let leaf = leaf(bits);
            let layout = ValueLayout { scalar: Scalar::CodeOfLeaf, components: 1 };
            let nodes = layout.nodes();
            assert_eq!(bytes(Bytes(&leaf), 0, layout, &nodes).unwrap().len(), leaf.len());
            assert!(bytes(Bytes(&leaf[..leaf.len() - 1]), 0, layout, &nodes).is_err());
            let mut values = [0.0_f32; LEAF_VOXELS];
            decode(&leaf, layout, &nodes, &mut values);
            assert_eq!(values[..8], codes.map(|code| code as f32 * 0.5 + 1.0), "{bits} bits");
            assert_eq!(values[504..], values[..8]);
        }
    }

    #[test]
    fn codes_of_32_bits_are_refused() {
        let mut leaf = leaf(16);
        leaf[LEAF_FLAGS] = 5 << 5;
        let layout = ValueLayout { scalar: Scalar::CodeOfLeaf, components: 1 };
        assert!(bytes(Bytes(&leaf), 0, layout, &layout.nodes()).is_err());
    }
}
