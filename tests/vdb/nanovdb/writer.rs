//! Writes small NanoVDB files byte by byte. What is in their grids is always the same: see
//! [`leaf_value`] and the tiles.

use std::io::Write;

/// The places of fields, from NanoVDB's own table of constants for a type of value.
struct Places {
    root_background: usize,
    root: usize,
    entry_value: usize,
    entry: usize,
    upper_table: usize,
    upper: usize,
    lower_table: usize,
    lower: usize,
    place: usize,
    leaf_table: usize,
    leaf: usize,
}

const fn places(numbers: [usize; 11]) -> Places {
    let [root_background, root, entry_value, entry, upper_table, upper, ..] = numbers;
    let [.., lower_table, lower, place, leaf_table, leaf] = numbers;
    Places {
        root_background,
        root,
        entry_value,
        entry,
        upper_table,
        upper,
        lower_table,
        lower,
        place,
        leaf_table,
        leaf,
    }
}

/// A type of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Float,
    Double,
    Vec3f,
    Vec3d,
    Fp4,
    Fp8,
    Fp16,
    /// Codes of that many bits.
    FpN(usize),
}

impl Kind {
    pub const ALL: [Self; 12] = [
        Self::Float,
        Self::Double,
        Self::Vec3f,
        Self::Vec3d,
        Self::Fp4,
        Self::Fp8,
        Self::Fp16,
        Self::FpN(1),
        Self::FpN(2),
        Self::FpN(4),
        Self::FpN(8),
        Self::FpN(16),
    ];

    pub fn number(self) -> u32 {
        match self {
            Self::Float => 1,
            Self::Double => 2,
            Self::Vec3f => 6,
            Self::Vec3d => 7,
            Self::Fp4 => 13,
            Self::Fp8 => 14,
            Self::Fp16 => 15,
            Self::FpN(_) => 16,
        }
    }

    pub fn components(self) -> usize {
        if matches!(self, Self::Vec3f | Self::Vec3d) { 3 } else { 1 }
    }

    fn is_double(self) -> bool {
        matches!(self, Self::Double | Self::Vec3d)
    }

    /// Bits of the codes of quantized leaves.
    fn code_bits(self) -> Option<usize> {
        match self {
            Self::Fp4 => Some(4),
            Self::Fp8 => Some(8),
            Self::Fp16 => Some(16),
            Self::FpN(bits) => Some(bits),
            _ => None,
        }
    }

    fn places(self) -> Places {
        match self {
            Self::Float => places([28, 64, 20, 32, 8256, 270_400, 1088, 33_856, 8, 96, 2144]),
            Self::Double => places([32, 96, 24, 32, 8256, 270_400, 1088, 33_856, 8, 128, 4224]),
            Self::Vec3f => places([28, 96, 20, 32, 8256, 532_544, 1088, 66_624, 16, 128, 6272]),
            Self::Vec3d => places([32, 128, 24, 64, 8288, 794_720, 1120, 99_424, 24, 160, 12_448]),
            Self::Fp4 | Self::Fp8 | Self::Fp16 | Self::FpN(_) => {
                let leaf = 96 + self.code_bits().unwrap_or(0) * 64;
                places([28, 64, 20, 32, 8256, 270_400, 1088, 33_856, 8, 96, leaf])
            }
        }
    }
}

/// Value outside of all tiles and voxels, unless a grid says otherwise.
pub const BACKGROUND: f64 = 0.25;
/// The active tile at (4096, 0, 0), 4096 voxels a side.
pub const ROOT_TILE: f64 = 2.0;
/// The active tile at (0, 0, 128), 128 voxels a side.
pub const UPPER_TILE: f64 = 4.0;
/// The inactive tile at (0, 0, 16), 8 voxels a side.
pub const LOWER_TILE: f64 = -3.0;
/// Quantized leaves have minimum -1 and quantum 0.5.
const MINIMUM: f32 = -1.0;
const QUANTUM: f32 = 0.5;

/// The value in the leaf at (-8, 0, 0), which is the last of the node before the one at the origin.
pub fn leaf_value(kind: Kind, offset: usize) -> f64 {
    match kind.code_bits() {
        Some(bits) => code(bits, offset) as f64 * f64::from(QUANTUM) + f64::from(MINIMUM),
        None => offset as f64 * 0.5,
    }
}

fn code(bits: usize, offset: usize) -> usize {
    (offset * 7 + offset / 16) & ((1 << bits) - 1)
}

/// Three of four voxels are active.
pub fn leaf_active(offset: usize) -> bool {
    offset % 4 != 1
}

/// The map that every grid has: half a turn of a quarter, twice as large, and moved.
pub const MATRIX: [f64; 9] = [0.0, -2.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 4.0];
pub const TRANSLATION: [f64; 3] = [5.0, 6.0, 7.0];

/// A grid to be written.
#[derive(Clone, Debug)]
pub struct Grid {
    pub name: String,
    pub kind: Kind,
    /// The number of its type where that is to be another.
    pub type_number: u32,
    pub class: u32,
    /// Value outside everything else.
    pub background: f64,
    /// Minor version of 32.
    pub version: u32,
    pub with_root_tile: bool,
    /// The last digit of its magic number.
    pub magic: u8,
}

impl Grid {
    pub fn new(name: &str, kind: Kind) -> Self {
        let name = name.to_owned();
        let (type_number, version) = (kind.number(), version(32, 4));
        Self {
            name,
            kind,
            type_number,
            class: 2,
            background: BACKGROUND,
            version,
            with_root_tile: true,
            magic: b'0',
        }
    }

    /// The grid as it is in memory, number `index` of `count`.
    pub fn bytes(&self, index: usize, count: usize) -> Vec<u8> {
        let mut grid = Writer { kind: self.kind, background: self.background, bytes: vec![0; 736] };
        self.tree(&mut grid);
        let has_long_name = self.name.len() >= 256;
        let blind = grid.bytes.len();
        if has_long_name {
            grid.bytes.resize(blind + 288 + (self.name.len() + 1).next_multiple_of(32), 0);
            grid.u64(blind, 288);
            grid.u64(blind + 8, self.name.len() as u64 + 1);
            grid.u32(blind + 16, 1);
            grid.u32(blind + 24, 3);
            grid.put(blind + 288, self.name.as_bytes());
            grid.u64(640, blind as u64);
            grid.u32(648, 1);
        }
        grid.put(0, b"NanoVDB");
        grid.put(7, &[self.magic]);
        grid.u64(8, u64::MAX);
        for (at, number) in [
            (16, self.version),
            (20, u32::from(has_long_name)),
            (24, index as u32),
            (28, count as u32),
            (632, self.class),
            (636, self.type_number),
        ] {
            grid.u32(at, number);
        }
        grid.u64(32, grid.bytes.len() as u64);
        grid.put(40, &self.name.as_bytes()[..self.name.len().min(255)]);
        for (n, number) in MATRIX.iter().enumerate() {
            grid.put(384 + 8 * n, &number.to_le_bytes());
        }
        for (n, number) in TRANSLATION.iter().enumerate() {
            grid.put(528 + 8 * n, &number.to_le_bytes());
        }
        grid.bytes
    }

    /// A root with an upper node before the origin, one at it, and a tile; a lower node below each.
    fn tree(&self, grid: &mut Writer) {
        let p = self.kind.places();
        let root = grid.bytes.len();
        let entries = 2 + usize::from(self.with_root_tile);
        let uppers = root + p.root + entries * p.entry;
        let lower = uppers + 2 * p.upper;
        let leaf = lower + p.lower;
        grid.bytes.resize(leaf + p.leaf, 0);
        for (n, at) in [leaf, lower, uppers, root].into_iter().enumerate() {
            grid.u64(672 + 8 * n, (at - 672) as u64);
        }
        [1, 1, 2].iter().enumerate().for_each(|(n, &count)| grid.u32(672 + 32 + 4 * n, count));
        grid.u32(root + 24, entries as u32);
        grid.value(root + p.root_background, self.background);
        let mut entry = root + p.root;
        for (n, x) in [-4096_i32, 0].into_iter().enumerate() {
            grid.u64(entry, u64::from(x as u32 >> 12) << 42);
            grid.u64(entry + 8, (uppers + n * p.upper - root) as u64);
            entry += p.entry;
        }
        if self.with_root_tile {
            grid.u64(entry, 1 << 42);
            grid.u32(entry + 16, 1);
            grid.value(entry + p.entry_value, ROOT_TILE);
        }
        // The last place of 32 along x, the first along y and z.
        let last = 31 << 10;
        grid.node(uppers, 32768, p.upper_table, p.place);
        grid.child(uppers, 32768, last, p.upper_table + last * p.place, lower);
        grid.node(uppers + p.upper, 32768, p.upper_table, p.place);
        grid.tile(uppers + p.upper, 1, p.upper_table + p.place, UPPER_TILE, true);
        grid.node(lower, 4096, p.lower_table, p.place);
        let last = 15 << 8;
        grid.child(lower, 4096, last, p.lower_table + last * p.place, leaf);
        grid.tile(lower, last + 2, p.lower_table + (last + 2) * p.place, LOWER_TILE, false);
        grid.leaf(leaf, p.leaf_table);
    }
}

/// A version of the format, patch 0.
pub fn version(major: u32, minor: u32) -> u32 {
    major << 21 | minor << 10
}

struct Writer {
    kind: Kind,
    background: f64,
    bytes: Vec<u8>,
}

impl Writer {
    fn put(&mut self, at: usize, bytes: &[u8]) {
        self.bytes[at..at + bytes.len()].copy_from_slice(bytes);
    }

    fn u32(&mut self, at: usize, number: u32) {
        self.put(at, &number.to_le_bytes());
    }

    fn u64(&mut self, at: usize, number: u64) {
        self.put(at, &number.to_le_bytes());
    }

    /// A value: v, 2v, 3v for vectors.
    fn value(&mut self, at: usize, value: f64) {
        for component in 0..self.kind.components() {
            let value = value * (component + 1) as f64;
            match self.kind.is_double() {
                true => self.put(at + 8 * component, &value.to_le_bytes()),
                false => self.put(at + 4 * component, &(value as f32).to_le_bytes()),
            }
        }
    }

    fn set_bit(&mut self, mask: usize, bit: usize) {
        self.bytes[mask + bit / 8] |= 1 << (bit % 8);
    }

    /// A node with the background everywhere.
    fn node(&mut self, at: usize, places: usize, table: usize, place: usize) {
        (0..places).for_each(|n| self.value(at + table + n * place, self.background));
    }

    fn child(&mut self, node: usize, places: usize, place: usize, entry: usize, child: usize) {
        self.set_bit(node + 32 + places / 8, place);
        self.u64(node + entry, (child - node) as u64);
    }

    fn tile(&mut self, node: usize, place: usize, entry: usize, value: f64, active: bool) {
        if active {
            self.set_bit(node + 32, place);
        }
        self.value(node + entry, value);
    }

    fn leaf(&mut self, at: usize, table: usize) {
        let kind = self.kind;
        self.put(at, &(-8_i32).to_le_bytes());
        (0..512).filter(|&n| leaf_active(n)).for_each(|n| self.set_bit(at + 16, n));
        let Some(bits) = kind.code_bits() else {
            let size = kind.components() * if kind.is_double() { 8 } else { 4 };
            (0..512).for_each(|n| self.value(at + table + n * size, leaf_value(kind, n)));
            return;
        };
        if let Kind::FpN(bits) = kind {
            self.bytes[at + 15] = (bits.ilog2() as u8) << 5;
        }
        self.put(at + 80, &MINIMUM.to_le_bytes());
        self.put(at + 84, &QUANTUM.to_le_bytes());
        for n in 0..512 {
            let (bit, code) = (n * bits, code(bits, n));
            self.bytes[at + table + bit / 8] |= (code << (bit % 8)) as u8;
            if bits == 16 {
                self.bytes[at + table + bit / 8 + 1] = (code >> 8) as u8;
            }
        }
    }
}

/// How the grids of a segment are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Codec {
    None,
    Zip,
    Blosc,
}

/// A segment with these grids; `magic` is the last digit of its magic number.
pub fn segment(magic: u8, codec: Codec, grids: &[Grid]) -> Vec<u8> {
    let mut bytes = b"NanoVDB".to_vec();
    bytes.push(magic);
    bytes.extend(version(32, 4).to_le_bytes());
    bytes.extend((grids.len() as u16).to_le_bytes());
    bytes.extend((codec as u16).to_le_bytes());
    let mut data = Vec::new();
    for (index, grid) in grids.iter().enumerate() {
        let raw = grid.bytes(index, grids.len());
        let packed = pack(codec, &raw);
        let mut entry = vec![0; 176];
        entry[..8].copy_from_slice(&(raw.len() as u64).to_le_bytes());
        entry[8..16].copy_from_slice(&(packed.len() as u64).to_le_bytes());
        entry[136..140].copy_from_slice(&(grid.name.len() as u32 + 1).to_le_bytes());
        bytes.extend(entry);
        bytes.extend(grid.name.bytes());
        bytes.push(0);
        data.extend(packed);
    }
    bytes.extend(data);
    bytes
}

/// A buffer of grids as they are in memory.
pub fn buffer(grids: &[Grid]) -> Vec<u8> {
    (0..grids.len()).flat_map(|index| grids[index].bytes(index, grids.len())).collect()
}

fn pack(codec: Codec, raw: &[u8]) -> Vec<u8> {
    let packed = match codec {
        Codec::None => return raw.to_vec(),
        Codec::Zip => {
            let fast = flate2::Compression::fast();
            let mut zip = flate2::write::ZlibEncoder::new(Vec::new(), fast);
            zip.write_all(raw).unwrap();
            zip.finish().unwrap()
        }
        Codec::Blosc => blosc(raw),
    };
    [&(packed.len() as u64).to_le_bytes()[..], &packed].concat()
}

/// A Blosc container of LZ4 blocks, each one stream, not shuffled.
fn blosc(raw: &[u8]) -> Vec<u8> {
    const BLOCK: usize = 1 << 16;
    const NOT_SPLIT_LZ4: u8 = 0x30;
    let blocks: Vec<Vec<u8>> = raw.chunks(BLOCK).map(lz4_flex::block::compress).collect();
    let mut starts = Vec::new();
    let mut body = Vec::new();
    let first = 16 + 4 * blocks.len();
    for block in &blocks {
        starts.extend(((first + body.len()) as u32).to_le_bytes());
        body.extend((block.len() as u32).to_le_bytes());
        body.extend(block);
    }
    let mut bytes = vec![2, 1, NOT_SPLIT_LZ4, 4];
    for size in [raw.len(), BLOCK, first + body.len()] {
        bytes.extend((size as u32).to_le_bytes());
    }
    [bytes, starts, body].concat()
}
