//! Writes small files byte by byte, in the layouts that the fixtures do not cover: old versions,
//! zipped buffers, double precision, files without offsets.

use std::io::Write;

use half::f16;

/// How a file is laid out; what is in it is always the same (see [`write`]).
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    pub version: u32,
    pub offsets: bool,
    pub zip: bool,
    pub active_mask: bool,
    pub half: bool,
    pub scalar: Scalar,
    pub components: usize,
    /// With an active mask, which of the codes 0 to 5 tells the leaf's inactive values.
    pub code: u8,
}

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scalar {
    Half,
    Float,
    Double,
}

/// Value outside of all tiles and voxels.
pub const BACKGROUND: f64 = 0.25;
/// The active tile at (4096, 0, 0), 4096 voxels a side.
pub const ROOT_TILE: f64 = 2.0;
/// The active tile at (0, 0, 128), 128 voxels a side.
pub const UPPER_TILE: f64 = 4.0;
/// The active tile at (0, 0, 16), 8 voxels a side.
pub const LOWER_TILE: f64 = 3.0;

/// Inactive values that are neither the background nor its opposite.
const OTHERS: [f64; 2] = [-7.0, 11.0];

/// The value in the leaf at the origin.
pub fn leaf_value(layout: &Layout, offset: usize) -> f64 {
    let first = !leaf_selected(offset);
    match (leaf_active(offset), layout.code) {
        (true, _) => offset as f64 * 0.5,
        (_, 1) => -BACKGROUND,
        (_, 2) => OTHERS[0],
        (_, 3) if first => -BACKGROUND,
        (_, 4 | 5) if first => OTHERS[0],
        (_, 5) => OTHERS[1],
        _ => BACKGROUND,
    }
}

/// Where two inactive values take turns, which voxels have the second one.
fn leaf_selected(offset: usize) -> bool {
    offset % 8 == 5
}

/// Three of four voxels are active.
pub fn leaf_active(offset: usize) -> bool {
    offset % 4 != 1
}

/// A file with one grid "density" of voxel size 2: a leaf at the origin and three tiles. Vectors
/// have v, 2v, 3v for what a scalar grid has v.
pub fn write(layout: &Layout) -> Vec<u8> {
    Writer { layout: *layout, root_tile: true, bytes: Vec::new() }.file()
}

/// The file of [`write`] but for the tile at the root, which takes most of the time of reading it.
pub fn write_quick(layout: &Layout) -> Vec<u8> {
    Writer { layout: *layout, root_tile: false, bytes: Vec::new() }.file()
}

struct Writer {
    layout: Layout,
    root_tile: bool,
    bytes: Vec<u8>,
}

impl Writer {
    fn file(mut self) -> Vec<u8> {
        let layout = self.layout;
        self.bytes.extend(b" BDV\0\0\0\0");
        self.u32(layout.version);
        self.bytes.extend([0; 8]);
        self.bytes.push(layout.offsets.into());
        if layout.version < 222 {
            self.bytes.push(layout.zip.into());
        }
        self.bytes.extend([b'0'; 36]);
        self.u32(0);
        self.u32(1);
        self.text("density");
        let value = match (layout.scalar, layout.components) {
            (Scalar::Half, 1) => "half",
            (Scalar::Float, 1) => "float",
            (Scalar::Double, 1) => "double",
            (Scalar::Half, _) => "vec3h",
            (Scalar::Float, _) => "vec3s",
            (Scalar::Double, _) => "vec3d",
        };
        self.text(&format!("Tree_{value}_5_4_3{}", if layout.half { "_HalfFloat" } else { "" }));
        self.text("");
        let offsets = self.bytes.len();
        self.bytes.extend([0; 24]);
        let start = self.bytes.len() as i64;
        self.grid();
        if layout.offsets {
            let end = self.bytes.len() as i64;
            let all: Vec<u8> = [start, start, end].iter().flat_map(|at| at.to_le_bytes()).collect();
            self.bytes[offsets..offsets + 24].copy_from_slice(&all);
        }
        self.bytes
    }

    fn grid(&mut self) {
        let layout = self.layout;
        if layout.version >= 222 {
            self.u32(u32::from(layout.zip) | u32::from(layout.active_mask) << 1);
        }
        self.u32(0);
        self.text("UniformScaleMap");
        (0..15).for_each(|_| self.bytes.extend(2.0_f64.to_le_bytes()));
        self.u32(1);
        self.value(BACKGROUND);
        self.u32(self.root_tile.into());
        self.u32(1);
        if self.root_tile {
            [4096_i32, 0, 0].iter().for_each(|c| self.bytes.extend(c.to_le_bytes()));
            self.value(ROOT_TILE);
            self.bytes.push(1);
        }
        self.bytes.extend([0; 12]);
        self.internal(32 * 32 * 32, 1, UPPER_TILE);
        self.internal(16 * 16 * 16, 2, LOWER_TILE);
        self.mask(512, leaf_active);
        self.mask(512, leaf_active);
        if layout.version < 222 {
            self.bytes.extend([0; 12]);
            self.bytes.push(1);
        }
        let values: Vec<f64> = (0..512).map(|offset| leaf_value(&layout, offset)).collect();
        self.values(&values, leaf_active, layout.code);
    }

    /// An internal node whose first place is a child and another one a tile.
    fn internal(&mut self, places: usize, tile_place: usize, tile: f64) {
        self.mask(places, |place| place == 0);
        self.mask(places, |place| place == tile_place);
        let mut values = vec![BACKGROUND; places];
        values[tile_place] = tile;
        if self.layout.version < 222 {
            values.remove(0);
        }
        self.values(&values, |place| place == tile_place, 0);
    }

    fn values(&mut self, values: &[f64], active: impl Fn(usize) -> bool, code: u8) {
        let layout = self.layout;
        let masked = layout.version >= 222 && layout.active_mask;
        if layout.version >= 222 {
            self.bytes.push(if masked { code } else { 6 });
        }
        if masked {
            let written = [0, 0, 1, 0, 1, 2][usize::from(code)];
            OTHERS[..written].iter().for_each(|&value| self.value(value));
            if code >= 3 {
                self.mask(values.len(), leaf_selected);
            }
        }
        let stored = values.iter().enumerate().filter(|&(place, _)| !masked || active(place));
        let stored: Vec<f64> = stored.map(|(_, &value)| value).collect();
        let mut raw = Writer { layout, root_tile: false, bytes: Vec::new() };
        match layout.half {
            true => stored.iter().for_each(|&value| raw.half(value)),
            false => stored.iter().for_each(|&value| raw.value(value)),
        }
        if !layout.zip {
            self.bytes.extend(raw.bytes);
            return;
        }
        let mut zip = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        zip.write_all(&raw.bytes).unwrap();
        let zip = zip.finish().unwrap();
        let worth_it = zip.len() < raw.bytes.len();
        let size = if worth_it { zip.len() as i64 } else { -(raw.bytes.len() as i64) };
        self.bytes.extend(size.to_le_bytes());
        self.bytes.extend(if worth_it { zip } else { raw.bytes });
    }

    fn value(&mut self, value: f64) {
        for component in 1..=self.layout.components {
            let value = value * component as f64;
            match self.layout.scalar {
                Scalar::Half => self.bytes.extend(f16::from_f64(value).to_le_bytes()),
                Scalar::Float => self.bytes.extend((value as f32).to_le_bytes()),
                Scalar::Double => self.bytes.extend(value.to_le_bytes()),
            }
        }
    }

    fn half(&mut self, value: f64) {
        for component in 1..=self.layout.components {
            self.bytes.extend(f16::from_f64(value * component as f64).to_le_bytes());
        }
    }

    fn mask(&mut self, bits: usize, on: impl Fn(usize) -> bool) {
        let byte = |first: usize| (0..8).map(|bit| u8::from(on(first + bit)) << bit).sum::<u8>();
        self.bytes.extend((0..bits).step_by(8).map(byte));
    }

    fn u32(&mut self, value: u32) {
        self.bytes.extend(value.to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.u32(text.len() as u32);
        self.bytes.extend(text.bytes());
    }
}
