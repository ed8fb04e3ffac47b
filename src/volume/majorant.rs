//! Local upper bounds on a regular grid of cells, and the walk of a ray through them.

use glam::{IVec3, UVec3, Vec3A};
use rayon::prelude::*;

use crate::math::{Aabb, Ray};

/// More cells than this cost more memory than their tightness is worth; the cells grow instead.
const MOST_CELLS: f32 = (1 << 21) as f32;
/// Bounds are raised by this factor so that rounding cannot lift a coefficient above them.
const ROUNDING: f32 = 1.0 + 4.0 * f32::EPSILON;

/// Upper bounds that hold over a region.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Majorant {
    /// Of the extinction's largest channel, 1/length.
    pub mu_t: f32,
    /// Of the luminance of the emission; zero only where nothing emits.
    pub emission: f32,
}

impl Majorant {
    /// Whether the region neither extinguishes nor emits.
    pub fn is_zero(&self) -> bool {
        self.mu_t == 0.0 && self.emission == 0.0
    }
}

/// Majorants on a grid of equal cells over a box.
#[derive(Clone, Debug)]
pub struct MajorantGrid {
    bounds: Aabb,
    origin: Vec3A,
    cell_size: Vec3A,
    dims: IVec3,
    cells: Vec<Majorant>,
}

impl MajorantGrid {
    /// Bounds `majorant_over` each cell of about `cell_size` inside `bounds`. Cell faces lie at
    /// multiples of their size, so that they can agree with the bricks of a grid.
    pub fn build(
        bounds: Aabb,
        mut cell_size: Vec3A,
        majorant_over: impl Fn(&Aabb) -> Majorant + Sync,
    ) -> Self {
        if bounds.is_empty() {
            let dims = IVec3::ZERO;
            return Self { bounds, origin: Vec3A::ZERO, cell_size, dims, cells: Vec::new() };
        }
        while (bounds.size() / cell_size + Vec3A::ONE).element_product() > MOST_CELLS {
            cell_size *= 2.0;
        }
        let origin = (bounds.min / cell_size).floor() * cell_size;
        let dims = ((bounds.max - origin) / cell_size).ceil().max(Vec3A::ONE);
        let dims: UVec3 = dims.as_uvec3();
        let cells = (0..dims.element_product())
            .into_par_iter()
            .with_min_len(64)
            .map(|index| {
                let cell = UVec3::new(
                    index % dims.x,
                    (index / dims.x) % dims.y,
                    index / (dims.x * dims.y),
                );
                let low = origin + cell.as_vec3a() * cell_size;
                let region = Aabb::new(low.max(bounds.min), (low + cell_size).min(bounds.max));
                let bound = majorant_over(&region);
                Majorant { mu_t: ROUNDING * bound.mu_t, emission: ROUNDING * bound.emission }
            })
            .collect();
        Self { bounds, origin, cell_size, dims: dims.as_ivec3(), cells }
    }

    /// The box it covers.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Edge lengths of a cell.
    pub fn cell_size(&self) -> Vec3A {
        self.cell_size
    }

    /// Calls `visit` with every cell's box and majorant.
    pub fn for_each_cell(&self, mut visit: impl FnMut(IVec3, &Aabb, &Majorant)) {
        for (index, majorant) in self.cells.iter().enumerate() {
            let index = index as i32;
            let cell = IVec3::new(
                index % self.dims.x,
                (index / self.dims.x) % self.dims.y,
                index / (self.dims.x * self.dims.y),
            );
            let low = self.origin + cell.as_vec3a() * self.cell_size;
            visit(cell, &Aabb::new(low, low + self.cell_size), majorant);
        }
    }

    /// Starts a walk along `ray` from parameter `t0` to `t1`, both inside the bounds.
    pub fn walk(&self, ray: &Ray, t0: f32, t1: f32) -> CellWalk {
        let entry = (ray.at(t0) - self.origin) / self.cell_size;
        let last = self.dims - IVec3::ONE;
        let cell = entry.floor().as_ivec3().clamp(IVec3::ZERO, last.max(IVec3::ZERO));
        let mut walk = CellWalk {
            t: t0,
            t_end: t1,
            next: [f32::INFINITY; 3],
            delta: [f32::INFINITY; 3],
            cells_left: [0; 3],
            stride: [0; 3],
            index: (cell.x + self.dims.x * (cell.y + self.dims.y * cell.z)) as usize,
        };
        let strides = [1, self.dims.x as isize, (self.dims.x * self.dims.y) as isize];
        for axis in 0..3 {
            let d = ray.direction[axis];
            if d == 0.0 {
                continue;
            }
            let forward = d > 0.0;
            let face = (cell[axis] + i32::from(forward)) as f32 * self.cell_size[axis];
            walk.next[axis] = (self.origin[axis] + face - ray.origin[axis]) / d;
            walk.delta[axis] = self.cell_size[axis] / d.abs();
            walk.cells_left[axis] = if forward { last[axis] - cell[axis] } else { cell[axis] };
            walk.stride[axis] = if forward { strides[axis] } else { -strides[axis] };
        }
        walk
    }
}

/// The way of one ray through the cells of a [`MajorantGrid`] (Amanatides and Woo 1987).
#[derive(Clone, Copy, Debug)]
pub struct CellWalk {
    t: f32,
    t_end: f32,
    next: [f32; 3],
    delta: [f32; 3],
    /// Cells ahead on each axis before the grid ends.
    cells_left: [i32; 3],
    stride: [isize; 3],
    index: usize,
}

impl CellWalk {
    /// The next stretch `(t0, t1)` with something in it, empty cells passed over.
    #[inline]
    pub fn next_occupied(&mut self, grid: &MajorantGrid) -> Option<(f32, f32, Majorant)> {
        while self.t < self.t_end {
            let majorant = grid.cells[self.index];
            let t0 = self.t;
            self.step();
            if !majorant.is_zero() {
                return Some((t0, self.t, majorant));
            }
        }
        None
    }

    #[inline]
    fn step(&mut self) {
        let [x, y, z] = self.next;
        let axis = if x <= y && x <= z {
            0
        } else if y <= z {
            1
        } else {
            2
        };
        let face = self.next[axis];
        if face >= self.t_end || self.cells_left[axis] == 0 {
            self.t = self.t_end;
            return;
        }
        // Rounding may put the first face a little behind the entry.
        self.t = self.t.max(face);
        self.next[axis] += self.delta[axis];
        self.cells_left[axis] -= 1;
        self.index = self.index.wrapping_add_signed(self.stride[axis]);
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::math::PathRng;

    fn checkered(region: &Aabb) -> Majorant {
        let cell = (region.center()).floor().as_ivec3();
        let odd = (cell.x + cell.y + cell.z).rem_euclid(3);
        Majorant { mu_t: odd as f32, emission: 0.0 }
    }

    #[test]
    fn the_walk_agrees_with_a_look_up_at_every_point() {
        let bounds = Aabb::new(Vec3A::new(-3.5, -2.5, 0.5), Vec3A::new(4.5, 3.5, 5.5));
        let grid = MajorantGrid::build(bounds, Vec3A::ONE, checkered);
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let mut point = |scale: f32| {
            scale * (Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform()) - Vec3A::splat(0.5))
        };
        let mut seen = 0;
        for i in 0..1000 {
            let mut direction = point(2.0);
            if i % 5 == 0 {
                direction.x = 0.0;
            }
            let ray = Ray::new(point(12.0), direction);
            let Some((t0, t1)) = bounds.intersect(&ray, 0.0, f32::INFINITY) else { continue };
            let mut walk = grid.walk(&ray, t0, t1);
            let mut end = t0;
            while let Some((a, b, majorant)) = walk.next_occupied(&grid) {
                assert!(a >= end && b >= a && b <= t1);
                end = b;
                if b - a > 1e-3 {
                    let p = ray.at(0.5 * (a + b));
                    let expected = checkered(&Aabb::new(p, p)).mu_t;
                    assert!((majorant.mu_t - expected).abs() < 1e-4, "{majorant:?} at {p}");
                    seen += 1;
                }
            }
        }
        assert!(seen > 500);
    }

    #[test]
    fn a_vast_box_gets_larger_cells_instead_of_more() {
        let bounds = Aabb::centered(Vec3A::splat(1e9));
        let grid = MajorantGrid::build(bounds, Vec3A::splat(4.0), |_| Majorant::default());
        assert!(grid.cells.len() <= 1 << 21 && grid.cell_size().x > 1e6);
    }
}
