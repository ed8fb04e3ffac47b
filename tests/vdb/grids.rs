//! Writes files of any number of grids of a few voxels, byte by byte: format 224 with active masks
//! and offsets, uncompressed.

use std::collections::BTreeMap;

use glam::{DVec3, IVec3};

/// A grid of active voxels over a background.
#[derive(Clone)]
pub struct Grid {
    pub name: &'static str,
    pub class: &'static str,
    /// Type of the values, as in `Tree_float_5_4_3`.
    pub kind: &'static str,
    pub voxels: Vec<(IVec3, f32)>,
    /// Inactive tiles of 8 voxels a side by their first voxels, in the lower nodes of the voxels.
    pub tiles: Vec<(IVec3, f32)>,
    pub background: f32,
    /// Components of a vector for each unit of a voxel's value.
    pub components: [f32; 3],
    pub voxel_size: f64,
    pub translation: DVec3,
    /// Taper and depth of a frustum over the box from -8 to 8, before scale and translation.
    pub frustum: Option<[f64; 2]>,
}

impl Grid {
    /// A fog volume of voxels 0.1 a side.
    pub fn fog(name: &'static str, voxels: Vec<(IVec3, f32)>) -> Self {
        Self {
            name,
            class: "fog volume",
            kind: "float",
            voxels,
            tiles: Vec::new(),
            background: 0.0,
            components: [1.0; 3],
            voxel_size: 0.1,
            translation: DVec3::ZERO,
            frustum: None,
        }
    }
}

/// The voxels of a ball.
pub fn ball(center: IVec3, radius: i32, value: f32) -> Vec<(IVec3, f32)> {
    let edge = 2 * radius + 1;
    let places = (0..edge.pow(3)).map(|n| IVec3::new(n / edge / edge, n / edge % edge, n % edge));
    let offsets = places.map(|place| place - radius);
    let inside = offsets.filter(|offset| offset.length_squared() <= radius * radius);
    inside.map(|offset| (center + offset, value)).collect()
}

/// The bytes of a file of these grids.
pub fn file(grids: &[Grid]) -> Vec<u8> {
    let mut file = Bytes(b" BDV\0\0\0\0".to_vec());
    [224_u32, 12, 0].iter().for_each(|&word| file.u32(word));
    file.0.push(1);
    file.0.extend([b'0'; 36]);
    file.u32(0);
    file.u32(grids.len() as u32);
    for (index, grid) in grids.iter().enumerate() {
        let named = |other: &&Grid| other.name == grid.name;
        let earlier = grids[..index].iter().filter(named).count();
        let unique = match grids.iter().filter(named).count() {
            1 => grid.name.to_owned(),
            _ => format!("{}\u{1e}{earlier}", grid.name),
        };
        file.text(&unique);
        file.text(&format!("Tree_{}_5_4_3", grid.kind));
        file.text("");
        let start = file.0.len() + 24;
        let body = body(grid);
        let end = (start + body.len()) as i64;
        [start as i64, start as i64, end].iter().for_each(|at| file.0.extend(at.to_le_bytes()));
        file.0.extend(body);
    }
    file.0
}

fn body(grid: &Grid) -> Vec<u8> {
    let mut bytes = Bytes(Vec::new());
    bytes.u32(2);
    bytes.u32(1);
    ["class", "string", grid.class].iter().for_each(|text| bytes.text(text));
    if let Some(shape) = grid.frustum {
        bytes.text("NonlinearFrustumMap");
        let corners = [-8.0_f64, -8.0, -8.0, 8.0, 8.0, 8.0];
        corners.iter().chain(&shape).for_each(|number| bytes.0.extend(number.to_le_bytes()));
    }
    bytes.text("UniformScaleTranslateMap");
    let derived = [DVec3::ONE; 4];
    for vector in [grid.translation, DVec3::splat(grid.voxel_size)].iter().chain(&derived) {
        vector.to_array().iter().for_each(|c| bytes.0.extend(c.to_le_bytes()));
    }
    tree(grid, &mut bytes);
    bytes.0
}

/// Leaves by their upper node, lower node and origin; voxels by their offset in the leaf.
type Leaves = BTreeMap<[i32; 3], BTreeMap<[i32; 3], BTreeMap<[i32; 3], BTreeMap<usize, f32>>>>;

fn tree(grid: &Grid, bytes: &mut Bytes) {
    let mut tree = Leaves::new();
    for &(voxel, value) in &grid.voxels {
        let origin = |bits: i32| ((voxel >> bits) << bits).to_array();
        let lower = tree.entry(origin(12)).or_default().entry(origin(7)).or_default();
        let leaf = lower.entry(origin(3)).or_default();
        leaf.insert(place(voxel.to_array(), 3, 0), value);
    }
    bytes.u32(1);
    bytes.value(grid, grid.background);
    bytes.u32(0);
    bytes.u32(tree.len() as u32);
    let mut values = Bytes(Vec::new());
    for (origin, lowers) in &tree {
        origin.iter().for_each(|c| bytes.0.extend(c.to_le_bytes()));
        bytes.node(32 * 32 * 32, lowers.keys().map(|&child| place(child, 5, 7)));
        bytes.0.push(0);
        for (&lower, leaves) in lowers {
            bytes.node(16 * 16 * 16, leaves.keys().map(|&child| place(child, 4, 3)));
            bytes.tiles(grid, lower);
            for voxels in leaves.values() {
                bytes.mask(512, voxels.keys().copied());
                values.mask(512, voxels.keys().copied());
                values.0.push(0);
                voxels.values().for_each(|&value| values.value(grid, value));
            }
        }
    }
    bytes.0.extend(values.0);
}

/// The place of a position in its node of `1 << places` places a side, `1 << voxels` voxels each.
fn place(position: [i32; 3], places: i32, voxels: i32) -> usize {
    let along = position.map(|c| (c >> voxels & ((1 << places) - 1)) as usize);
    along.iter().fold(0, |place, along| place << places | along)
}

struct Bytes(Vec<u8>);

impl Bytes {
    /// The masks of an internal node without active tiles.
    fn node(&mut self, places: usize, children: impl Iterator<Item = usize>) {
        self.mask(places, children);
        self.mask(places, std::iter::empty());
    }

    /// The values of the lower node that starts at a voxel, each written where there are tiles.
    fn tiles(&mut self, grid: &Grid, lower: [i32; 3]) {
        let is_in = |origin: IVec3| ((origin >> 7_i32) << 7_i32).to_array() == lower;
        let mut values = vec![grid.background; 16 * 16 * 16];
        for (origin, value) in grid.tiles.iter().filter(|(origin, _)| is_in(*origin)) {
            values[place(origin.to_array(), 4, 3)] = *value;
        }
        if values.iter().all(|value| *value == grid.background) {
            self.0.push(0);
            return;
        }
        self.0.push(6);
        values.into_iter().for_each(|value| self.value(grid, value));
    }

    fn mask(&mut self, bits: usize, on: impl Iterator<Item = usize>) {
        let mut mask = vec![0; bits / 8];
        on.for_each(|bit| mask[bit / 8] |= 1 << (bit % 8));
        self.0.extend(mask);
    }

    fn value(&mut self, grid: &Grid, value: f32) {
        match grid.kind {
            "half" => self.0.extend(half::f16::from_f32(value).to_le_bytes()),
            "vec3s" => {
                grid.components.iter().for_each(|c| self.0.extend((value * c).to_le_bytes()))
            }
            _ => self.0.extend(value.to_le_bytes()),
        }
    }

    fn u32(&mut self, value: u32) {
        self.0.extend(value.to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.u32(text.len() as u32);
        self.0.extend(text.bytes());
    }
}
