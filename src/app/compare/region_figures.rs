//! The figures of a region of one picture, or of two.

use std::sync::Arc;

use crate::render::compare::{Comparison, SideFigures};
use crate::render::{Area, Picture};

/// Request for the figures of a region, of one picture or of A and B.
#[derive(Clone)]
pub struct RegionTask {
    /// The pictures.
    pub pictures: Vec<Arc<Picture>>,
    /// The region.
    pub area: Area,
}

impl RegionTask {
    /// Whether both tasks have the same figures.
    pub fn same(&self, other: &Self) -> bool {
        let pairs = std::iter::zip(&self.pictures, &other.pictures);
        self.area == other.area
            && self.pictures.len() == other.pictures.len()
            && pairs.into_iter().all(|(a, b)| Arc::ptr_eq(a, b))
    }
}

/// The figures of a region.
pub struct RegionFigures {
    /// The region.
    pub area: Area,
    /// The figures of the one picture, or of A and B.
    pub sides: Vec<SideFigures>,
    /// Comparison of A and B, where there are two pictures.
    pub comparison: Option<Comparison>,
}

impl RegionFigures {
    /// The figures of the region of `task`.
    pub fn of(task: &RegionTask) -> Self {
        let area = task.area;
        match &task.pictures[..] {
            [a, b] if a.size == b.size => {
                let comparison = Comparison::of_pictures([a, b], Some(area));
                Self { area, sides: comparison.sides.to_vec(), comparison: Some(comparison) }
            }
            pictures => {
                let side = |picture: &Arc<Picture>| SideFigures::of_picture(picture, Some(area));
                Self { area, sides: pictures.iter().map(side).collect(), comparison: None }
            }
        }
    }
}
