//! Radiance by texels of latitude and longitude.
//!
//! The radiance is interpolated bilinearly between the middles of texels. Directions are drawn by
//! texel, in proportion to its solid angle and the mean luminance of the interpolated radiance in
//! it, and evenly over its solid angle. That mean weights a texel and its neighbors by ⅛, ¾ and ⅛
//! along both axes: wherever there is light the density is above zero, and next to a bright texel
//! it is near to the brightness that is interpolated there.

use std::f64::consts::{PI, TAU};

use glam::{UVec2, Vec3A};
use rayon::prelude::*;

use super::drawn::DrawnDirection;
use super::texel_choice;
use crate::math::{Rgb, luminance};

/// The largest radiance of a texel, so that sums of products stay finite.
const MOST_RADIANCE: f32 = 1e30;

/// Radiance by texels of latitude and longitude: rows from the zenith to the nadir, columns
/// clockwise seen from above, the middle of the map along +x.
#[derive(Debug)]
pub struct RadianceMap {
    size: UVec2,
    texels: Vec<[f32; 3]>,
    /// Starts of the rows in the choice of a row.
    rows: Vec<u32>,
    /// Starts of the texels of each row in the choice of a texel of it.
    columns: Vec<u32>,
    fluence: Rgb,
    middle: Vec3A,
}

impl RadianceMap {
    /// Bytes of memory that a texel takes beside its color.
    pub const BYTES_OF_TEXEL: u64 = 2 * size_of::<u32>() as u64;

    /// A map of the radiance `texels`, row by row from the top, and the number of texels that held
    /// negative values or values that are no numbers, all of which become 0. `None` where `size`
    /// is not that of the texels.
    pub fn new(size: UVec2, mut texels: Vec<[f32; 3]>) -> Option<(Self, usize)> {
        let count = (size.x as usize).checked_mul(size.y as usize)?;
        if count == 0 || count != texels.len() {
            return None;
        }
        let mended = texels.par_iter_mut().map(|texel| usize::from(mend(texel))).sum();
        let mut map = Self {
            size,
            texels,
            rows: Vec::with_capacity(size.y as usize),
            columns: Vec::with_capacity(count),
            fluence: Rgb::ZERO,
            middle: Vec3A::Z,
        };
        map.build_choice();
        map.sum_up();
        Some((map, mended))
    }

    /// The radiance if it is the same everywhere.
    pub fn even(&self) -> Option<Rgb> {
        let first = self.texels.first()?;
        self.texels.iter().all(|texel| texel == first).then(|| Rgb::from_array(*first))
    }

    /// ∫ L dω.
    pub fn fluence(&self) -> Rgb {
        self.fluence
    }

    /// Unit direction towards the middle of the light; up where it has none.
    pub fn middle(&self) -> Vec3A {
        self.middle
    }

    /// Radiance from a unit direction.
    pub fn radiance(&self, direction: Vec3A) -> Rgb {
        let [x, y] = self.place(direction);
        self.radiance_at(x, y)
    }

    /// Density over solid angle of a drawn direction.
    pub fn pdf_solid_angle(&self, direction: Vec3A) -> f32 {
        let [x, y] = self.place(direction);
        let column = (x.max(0.0) as usize).min(self.size.x as usize - 1);
        let row = (y.max(0.0) as usize).min(self.size.y as usize - 1);
        let of_column = texel_choice::probability(self.columns_of(row), column);
        self.density(row, of_column)
    }

    /// Draws a direction.
    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> DrawnDirection {
        let (row, down) = texel_choice::choose(&self.rows, u);
        let columns = self.columns_of(row);
        let (column, along) = texel_choice::choose(columns, v);
        let [upper, lower] = self.cosines(row);
        let cosine = upper + down * (lower - upper);
        let x = column as f64 + along;
        let y = cosine.clamp(-1.0, 1.0).acos() / PI * f64::from(self.size.y);
        let azimuth = PI - TAU * x / f64::from(self.size.x);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (sin, cos) = azimuth.sin_cos();
        DrawnDirection {
            direction: Vec3A::new((sine * cos) as f32, (sine * sin) as f32, cosine as f32),
            radiance: self.radiance_at(x as f32, y as f32),
            pdf_solid_angle: self.density(row, texel_choice::probability(columns, column)),
        }
    }

    /// Coordinates on the map in texels, from the upper left corner.
    fn place(&self, direction: Vec3A) -> [f32; 2] {
        use std::f32::consts::{FRAC_1_PI, PI, TAU};
        let across = direction.x.hypot(direction.y);
        // Not by the arc cosine, which loses its digits near the poles.
        let from_zenith = across.atan2(direction.z);
        let azimuth = direction.y.atan2(direction.x);
        let size = self.size.as_vec2();
        [(PI - azimuth) / TAU * size.x, from_zenith * FRAC_1_PI * size.y]
    }

    /// Radiance at a place on the map: around it in the four nearest texels, across the seam too.
    fn radiance_at(&self, x: f32, y: f32) -> Rgb {
        let ([left, right], along) = around(x, self.size.x, i32::rem_euclid);
        let ([upper, lower], down) = around(y, self.size.y, |i, count| i.clamp(0, count - 1));
        let of_row = |y| self.texel(left, y).lerp(self.texel(right, y), along);
        of_row(upper).lerp(of_row(lower), down)
    }

    fn texel(&self, x: usize, y: usize) -> Rgb {
        let index = y * self.size.x as usize + x;
        self.texels.get(index).map_or(Rgb::ZERO, |texel| Rgb::from_array(*texel))
    }

    fn columns_of(&self, row: usize) -> &[u32] {
        let width = self.size.x as usize;
        &self.columns[row * width..][..width]
    }

    /// Cosines of the angles from the zenith between which a row lies.
    fn cosines(&self, row: usize) -> [f64; 2] {
        let at = |edge: usize| (PI * edge as f64 / f64::from(self.size.y)).cos();
        [at(row), at(row + 1)]
    }

    /// Solid angle of a texel of a row.
    fn solid_angle(&self, row: usize) -> f64 {
        let [upper, lower] = self.cosines(row);
        TAU / f64::from(self.size.x) * (upper - lower)
    }

    /// Density over the solid angle of a texel that is chosen in its row with a probability.
    fn density(&self, row: usize, of_column: f64) -> f32 {
        (texel_choice::probability(&self.rows, row) * of_column / self.solid_angle(row)) as f32
    }

    fn build_choice(&mut self) {
        let [width, height] = [self.size.x as usize, self.size.y as usize];
        let rows: Vec<(Vec<u32>, f64)> = (0..height)
            .into_par_iter()
            .map(|row| {
                let means = self.means(row);
                let mut starts = Vec::with_capacity(width);
                let total = texel_choice::append(&mut starts, means.iter().copied());
                (starts, total * self.solid_angle(row))
            })
            .collect();
        texel_choice::append(&mut self.rows, rows.iter().map(|(_, weight)| *weight));
        rows.iter().for_each(|(starts, _)| self.columns.extend_from_slice(starts));
    }

    /// Means of the luminance over each texel of a row.
    fn means(&self, row: usize) -> Vec<f64> {
        let [width, height] = [self.size.x as usize, self.size.y as usize];
        let near = |before: f64, here: f64, after: f64| 0.125 * (before + after) + 0.75 * here;
        let rows = [row.saturating_sub(1), row, (row + 1).min(height - 1)];
        let down = |x: usize| {
            let [before, here, after] = rows.map(|y| f64::from(luminance(self.texel(x, y))));
            near(before, here, after)
        };
        let column: Vec<f64> = (0..width).map(down).collect();
        let along =
            |x: usize| near(column[(x + width - 1) % width], column[x], column[(x + 1) % width]);
        (0..width).map(along).collect()
    }

    /// Sums up the light and its direction.
    fn sum_up(&mut self) {
        let width = self.size.x as usize;
        let azimuths: Vec<(f64, f64)> =
            (0..width).map(|x| (PI - TAU * (x as f64 + 0.5) / width as f64).sin_cos()).collect();
        let of_row = |row: usize| {
            let (mut light, mut flux) = (glam::DVec3::ZERO, glam::DVec3::ZERO);
            let [upper, lower] = self.cosines(row);
            let cosine = 0.5 * (upper + lower);
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            for (x, (sin, cos)) in azimuths.iter().enumerate() {
                let texel = self.texel(x, row);
                light += texel.as_dvec3();
                let direction = glam::DVec3::new(sine * cos, sine * sin, cosine);
                flux += f64::from(luminance(texel)) * direction;
            }
            let solid_angle = self.solid_angle(row);
            [light * solid_angle, flux * solid_angle]
        };
        let [light, flux] = (0..self.size.y as usize)
            .map(of_row)
            .fold([glam::DVec3::ZERO; 2], |[a, b], [c, d]| [a + c, b + d]);
        self.fluence = light.as_vec3a();
        self.middle = flux.try_normalize().map_or(Vec3A::Z, |flux| flux.as_vec3a());
    }
}

/// Makes a texel finite and not negative; whether it was not.
fn mend(texel: &mut [f32; 3]) -> bool {
    let mut was_bad = false;
    for value in texel {
        let bad = !(*value >= 0.0 && value.is_finite());
        was_bad |= bad;
        *value = if bad { 0.0 } else { value.min(MOST_RADIANCE) };
    }
    was_bad
}

/// The two texels of so many around a coordinate, moved into the map by `wrap`, and the place from
/// 0 to 1 between their middles.
fn around(coordinate: f32, count: u32, wrap: impl Fn(i32, i32) -> i32) -> ([usize; 2], f32) {
    let before = (coordinate - 0.5).floor();
    let index = |offset: i32| wrap(before as i32 + offset, count as i32) as usize;
    ([index(0), index(1)], coordinate - 0.5 - before)
}
