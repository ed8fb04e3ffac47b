//! A box cut into equal cells, and the walk of a ray through them.

use glam::{IVec3, Vec3A};

use crate::math::{Aabb, Ray};

/// More cells than this cost more memory than their tightness is worth; the cells grow instead.
const MOST_CELLS: f32 = (1 << 21) as f32;

/// Equal cells over a box, those at its border cut off by it. Values per cell are kept elsewhere,
/// by index.
#[derive(Clone, Debug)]
pub struct CellGrid {
    bounds: Aabb,
    origin: Vec3A,
    cell_size: Vec3A,
    dims: IVec3,
}

impl CellGrid {
    /// Cells of about `cell_size` over `bounds`. Their faces lie at multiples of their size, so
    /// that they can agree with the bricks of a grid.
    pub fn new(bounds: Aabb, mut cell_size: Vec3A) -> Self {
        if bounds.is_empty() {
            return Self { bounds, origin: Vec3A::ZERO, cell_size, dims: IVec3::ZERO };
        }
        while (bounds.size() / cell_size + Vec3A::ONE).element_product() > MOST_CELLS {
            cell_size *= 2.0;
        }
        let origin = (bounds.min / cell_size).floor() * cell_size;
        let dims = ((bounds.max - origin) / cell_size).ceil().max(Vec3A::ONE).as_ivec3();
        Self { bounds, origin, cell_size, dims }
    }

    /// The grid cropped to the cells from `low` to `high`, both included.
    pub fn cropped(&self, low: IVec3, high: IVec3) -> Self {
        let bounds = self.clipped(low).union(&self.clipped(high));
        let origin = self.origin + low.as_vec3a() * self.cell_size;
        Self { bounds, origin, cell_size: self.cell_size, dims: high - low + IVec3::ONE }
    }

    /// The box that the cells cover.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Edge lengths of a cell.
    pub fn cell_size(&self) -> Vec3A {
        self.cell_size
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.dims.as_usizevec3().element_product()
    }

    /// Whether the grid has no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cell with an index.
    pub fn cell(&self, index: usize) -> IVec3 {
        let index = index as i32;
        IVec3::new(
            index % self.dims.x,
            (index / self.dims.x) % self.dims.y,
            index / (self.dims.x * self.dims.y),
        )
    }

    /// The index of a cell.
    pub fn index(&self, cell: IVec3) -> usize {
        (cell.x + self.dims.x * (cell.y + self.dims.y * cell.z)) as usize
    }

    /// The cell around a point, or the nearest one. There must be cells.
    pub fn cell_at(&self, point: Vec3A) -> IVec3 {
        let cell = ((point - self.origin) / self.cell_size).floor().as_ivec3();
        cell.clamp(IVec3::ZERO, (self.dims - IVec3::ONE).max(IVec3::ZERO))
    }

    /// Box of a whole cell, even beyond the grid's box.
    pub fn whole(&self, cell: IVec3) -> Aabb {
        let low = self.origin + cell.as_vec3a() * self.cell_size;
        Aabb::new(low, low + self.cell_size)
    }

    /// The part of a cell inside the box.
    pub fn clipped(&self, cell: IVec3) -> Aabb {
        let whole = self.whole(cell);
        Aabb::new(whole.min.max(self.bounds.min), whole.max.min(self.bounds.max))
    }

    /// Starts a walk along `ray` from parameter `t0` to `t1`, both inside the box.
    pub fn walk(&self, ray: &Ray, t0: f32, t1: f32) -> CellWalk {
        let cell = self.cell_at(ray.at(t0));
        let last = self.dims - IVec3::ONE;
        let mut walk = CellWalk {
            t: t0,
            t_end: t1,
            next: [f32::INFINITY; 3],
            delta: [f32::INFINITY; 3],
            cells_left: [0; 3],
            stride: [0; 3],
            index: self.index(cell),
            found: 0,
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

/// The walk of one ray through the cells of a [`CellGrid`] (Amanatides and Woo 1987).
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
    /// Index of the cell of the last segment.
    found: usize,
}

impl CellWalk {
    /// Index of the cell of the segment that [`CellWalk::next_where`] returned last.
    #[inline]
    pub fn found(&self) -> usize {
        self.found
    }

    /// The next segment `(t0, t1)` in a cell for whose index `value` returns a value, with that
    /// value.
    #[inline]
    pub fn next_where<T>(&mut self, value: impl Fn(usize) -> Option<T>) -> Option<(f32, f32, T)> {
        while self.t < self.t_end {
            let (cell, t0) = (self.index, self.t);
            let found = value(cell);
            self.step();
            if let Some(found) = found {
                self.found = cell;
                return Some((t0, self.t, found));
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
