//! Local bounds on a regular grid of cells.

use glam::{IVec3, Vec3A};
use rayon::prelude::*;

use super::cells::{CellGrid, CellWalk};
use crate::error::{Progress, Result, report};
use crate::math::{Aabb, Ray};

/// Bounds are raised by this factor, or lowered, so that rounding cannot lift a coefficient over
/// them.
const ROUNDING: f32 = 1.0 + 4.0 * f32::EPSILON;

/// Upper bounds that hold over a region.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Majorant {
    /// Upper bound of the extinction's largest channel, 1/length.
    pub mu_t: f32,
    /// Upper bound of the luminance of the emission, radiance per length; zero only where nothing
    /// emits.
    pub emission: f32,
}

impl Majorant {
    /// Whether the region neither extinguishes nor emits.
    pub fn is_zero(&self) -> bool {
        self.mu_t == 0.0 && self.emission == 0.0
    }
}

/// Majorants on a grid of equal cells over a box, and minorants apart, which few walks ask for.
#[derive(Clone, Debug)]
pub struct MajorantGrid {
    grid: CellGrid,
    cells: Vec<Majorant>,
    /// Lower bounds of the extinction's largest channel, for which [`Majorant::mu_t`] is the upper
    /// bound.
    minorants: Vec<f32>,
}

impl MajorantGrid {
    /// Builds the grid from `bounds_over` each cell of about `cell_size` inside `bounds`: the
    /// majorant there and the minorant of the extinction's largest channel. Cell faces lie at
    /// multiples of their size, so that they can agree with the bricks of a grid.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn build(
        bounds: Aabb,
        cell_size: Vec3A,
        bounds_over: impl Fn(&Aabb) -> (Majorant, f32) + Sync,
        progress: Progress,
    ) -> Result<Self> {
        let grid = CellGrid::new(bounds, cell_size);
        let bounds_of = |index: usize| {
            report(progress, index as f32 / grid.len() as f32)?;
            let (bound, minorant) = bounds_over(&grid.clipped(grid.cell(index)));
            let Majorant { mu_t, emission } = bound;
            let raised = Majorant { mu_t: ROUNDING * mu_t, emission: ROUNDING * emission };
            Ok((raised, minorant / ROUNDING))
        };
        let bounds = (0..grid.len()).into_par_iter().with_min_len(64).map(bounds_of);
        let (cells, minorants) = bounds.collect::<Result<Vec<_>>>()?.into_iter().unzip();
        Ok(Self { grid, cells, minorants })
    }

    /// The cells.
    pub fn grid(&self) -> &CellGrid {
        &self.grid
    }

    /// The majorants in the order of the cells' indices.
    pub fn cells(&self) -> &[Majorant] {
        &self.cells
    }

    /// The box that the cells cover.
    pub fn bounds(&self) -> &Aabb {
        self.grid.bounds()
    }

    /// Edge lengths of a cell.
    pub fn cell_size(&self) -> Vec3A {
        self.grid.cell_size()
    }

    /// The minorant of the segment that [`MajorantGrid::next_occupied`] returned last.
    #[inline]
    pub fn minorant(&self, walk: &CellWalk) -> f32 {
        self.minorants[walk.found()]
    }

    /// Calls `visit` with every cell's box and majorant.
    pub fn for_each_cell(&self, mut visit: impl FnMut(IVec3, &Aabb, &Majorant)) {
        for (index, majorant) in self.cells.iter().enumerate() {
            let cell = self.grid.cell(index);
            visit(cell, &self.grid.whole(cell), majorant);
        }
    }

    /// Starts a walk along `ray` from parameter `t0` to `t1`, both inside the bounds.
    pub fn walk(&self, ray: &Ray, t0: f32, t1: f32) -> CellWalk {
        self.grid.walk(ray, t0, t1)
    }

    /// The next segment `(t0, t1)` of a walk in cells that are not empty.
    #[inline]
    pub fn next_occupied(&self, walk: &mut CellWalk) -> Option<(f32, f32, Majorant)> {
        walk.next_where(|cell| {
            let majorant = self.cells[cell];
            (!majorant.is_zero()).then_some(majorant)
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::error::NO_PROGRESS;
    use crate::math::PathRng;

    fn checkered(region: &Aabb) -> (Majorant, f32) {
        let cell = (region.center()).floor().as_ivec3();
        let odd = (cell.x + cell.y + cell.z).rem_euclid(3);
        (Majorant { mu_t: odd as f32, emission: 0.0 }, 0.5 * odd as f32)
    }

    #[test]
    fn the_walk_agrees_with_a_look_up_at_every_point() {
        let bounds = Aabb::new(Vec3A::new(-3.5, -2.5, 0.5), Vec3A::new(4.5, 3.5, 5.5));
        let grid = MajorantGrid::build(bounds, Vec3A::ONE, checkered, NO_PROGRESS).unwrap();
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
            while let Some((a, b, majorant)) = grid.next_occupied(&mut walk) {
                assert!(a >= end && b >= a && b <= t1);
                end = b;
                if b - a > 1e-3 {
                    let p = ray.at(0.5 * (a + b));
                    let (expected, least) = checkered(&Aabb::new(p, p));
                    let apart = (majorant.mu_t - expected.mu_t).abs();
                    assert!(apart < 1e-4, "{majorant:?} at {p}");
                    assert!((grid.minorant(&walk) - least).abs() < 1e-4, "at {p}");
                    seen += 1;
                }
            }
        }
        assert!(seen > 500);
    }

    #[test]
    fn a_vast_box_gets_larger_cells_instead_of_more() {
        let bounds = Aabb::centered(Vec3A::splat(1e9));
        let nothing = |_: &Aabb| Default::default();
        let grid = MajorantGrid::build(bounds, Vec3A::splat(4.0), nothing, NO_PROGRESS).unwrap();
        assert!(grid.cells.len() <= 1 << 21 && grid.cell_size().x > 1e6);
    }
}
