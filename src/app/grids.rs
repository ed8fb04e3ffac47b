//! The grids of a volume's file, as the volume panel lists them.

use super::loader::Built;

/// One grid of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSummary {
    /// Its name in the file.
    pub name: String,
    /// Its lowest value.
    pub low: f64,
    /// Its highest value.
    pub high: f64,
    /// How many voxels hold a value.
    pub voxels: u64,
}

/// The grids of the volume `index` of a scene; none for shapes.
pub fn grids_of(_built: &Built, _index: usize) -> Vec<GridSummary> {
    Vec::new()
}
