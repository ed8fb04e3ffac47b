//! The places of fields in nodes, which follow from the type of the values: each field is aligned
//! to its own size, tables and whole nodes to 32 bytes.

/// Storage type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    F32,
    F64,
    /// Codes of so many bits in leaves, single precision elsewhere.
    Code {
        bits: usize,
    },
    /// Codes in leaves, each of which says how many bits they have.
    CodeOfLeaf,
}

/// Layout of the values of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ValueLayout {
    pub scalar: Scalar,
    pub components: usize,
}

/// The places of the fields of a tree's nodes, in bytes from the start of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct NodeLayout {
    pub root_background: usize,
    /// Size of the root, behind which its entries lie.
    pub root: usize,
    pub entry_value: usize,
    pub entry: usize,
    pub upper_table: usize,
    pub upper: usize,
    pub lower_table: usize,
    pub lower: usize,
    /// Size of a place in the tables of upper and lower nodes.
    pub place: usize,
    pub leaf_table: usize,
    /// The least size of a leaf.
    pub leaf: usize,
}

/// Size of a grid's header, behind which its tree lies.
pub(super) const GRID_HEADER: usize = 672;
pub(super) const UPPER_PLACES: usize = 32 * 32 * 32;
pub(super) const LOWER_PLACES: usize = 16 * 16 * 16;
pub(super) const LEAF_VOXELS: usize = 512;
/// Masks of upper and lower nodes follow the box (24 bytes) and the flags (8 bytes).
pub(super) const NODE_MASKS: usize = 32;
/// The mask of a leaf follows the corner of its box (12 bytes), its size (3 bytes) and the flags.
pub(super) const LEAF_MASK: usize = 16;
/// The flags of a leaf.
pub(super) const LEAF_FLAGS: usize = 15;
/// Bytes before the statistics of a root: box and number of entries.
const ROOT_BASE: usize = 28;
/// Bytes before the value of a root's entry: key, child and state.
const ENTRY_BASE: usize = 20;
const ALIGNMENT: usize = 32;

impl ValueLayout {
    /// Size of a component outside leaves, which is also the alignment of a value.
    pub fn scalar_bytes(self) -> usize {
        if self.scalar == Scalar::F64 { 8 } else { 4 }
    }

    /// Size of a value outside leaves.
    pub fn value_bytes(self) -> usize {
        self.components * self.scalar_bytes()
    }

    pub fn nodes(self) -> NodeLayout {
        let scalar = self.scalar_bytes();
        // Minimum, maximum, mean and standard deviation; the last two have one component.
        let statistics = 2 * self.value_bytes() + 2 * scalar;
        let table = |base: usize| (base.next_multiple_of(scalar) + statistics).next_multiple_of(32);
        let (upper_table, lower_table) =
            (table(NODE_MASKS + 2 * UPPER_PLACES / 8), table(NODE_MASKS + 2 * LOWER_PLACES / 8));
        let place = self.value_bytes().next_multiple_of(8);
        let root_background = ROOT_BASE.next_multiple_of(scalar);
        let root = root_background + self.value_bytes() + statistics;
        let entry_value = ENTRY_BASE.next_multiple_of(scalar);
        let leaf_base = LEAF_MASK + LEAF_VOXELS / 8;
        let (leaf_table, values) = match self.scalar {
            // Minimum and quantum, then four statistics of 16 bits.
            Scalar::Code { bits } => (leaf_base + 16, LEAF_VOXELS * bits / 8),
            Scalar::CodeOfLeaf => (leaf_base + 16, LEAF_VOXELS / 8),
            _ => (table(leaf_base), LEAF_VOXELS * self.value_bytes()),
        };
        NodeLayout {
            root_background,
            root: root.next_multiple_of(ALIGNMENT),
            entry_value,
            entry: (entry_value + self.value_bytes()).next_multiple_of(ALIGNMENT),
            upper_table,
            upper: (upper_table + UPPER_PLACES * place).next_multiple_of(ALIGNMENT),
            lower_table,
            lower: (lower_table + LOWER_PLACES * place).next_multiple_of(ALIGNMENT),
            place,
            leaf_table,
            leaf: leaf_table + values,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::grid_type::GridType;

    /// Sizes that NanoVDB publishes in its table of constants, by the number of the type: root,
    /// value of an entry, entry, table and size of upper and lower nodes and leaves.
    #[test]
    fn sizes_are_those_of_nanovdb() {
        for (number, sizes) in [
            (1, [64, 20, 32, 8256, 270_400, 1088, 33_856, 96, 2144]),
            (2, [96, 24, 32, 8256, 270_400, 1088, 33_856, 128, 4224]),
            (6, [96, 20, 32, 8256, 532_544, 1088, 66_624, 128, 6272]),
            (7, [128, 24, 64, 8288, 794_720, 1120, 99_424, 160, 12_448]),
            (13, [64, 20, 32, 8256, 270_400, 1088, 33_856, 96, 352]),
            (14, [64, 20, 32, 8256, 270_400, 1088, 33_856, 96, 608]),
            (15, [64, 20, 32, 8256, 270_400, 1088, 33_856, 96, 1120]),
            (16, [64, 20, 32, 8256, 270_400, 1088, 33_856, 96, 96 + 64]),
        ] {
            let n = GridType(number).layout().unwrap().nodes();
            let (upper, lower) = ([n.upper_table, n.upper], [n.lower_table, n.lower]);
            let got = [n.root, n.entry_value, n.entry, upper[0], upper[1], lower[0], lower[1]];
            assert_eq!(got, sizes[..7], "type {number}");
            assert_eq!([n.leaf_table, n.leaf], sizes[7..], "type {number}");
        }
        let names = |number: u32| GridType(number).layout().unwrap_err();
        assert!(names(4).contains("int32") && names(23).contains("points"));
        assert!(names(20).contains("indices") && names(99).contains("type 99"));
    }
}
