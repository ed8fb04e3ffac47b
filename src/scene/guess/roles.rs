//! Roles of the grids of a file, guessed by name, type, class and range.

use crate::error::Result;
use crate::scene::cache::{GridValues, PlacedGrid};
use crate::scene::grid_names::{DENSITY, EMISSION, FLAME, OTHER, TEMPERATURE};
use crate::scene::role::Role;
use crate::volume::grid::GridClass;

/// A grid of numbers or colors that is worth rendering.
pub(super) struct Candidate {
    pub(super) grid: PlacedGrid,
    /// Largest active value of the grid; for colors of the largest channel.
    pub(super) max: f32,
    /// Mean of the grid's active values.
    pub(super) mean: f32,
}

impl Candidate {
    /// `None` for grids with nothing above zero.
    pub(super) fn of(grid: PlacedGrid) -> Option<Self> {
        let (max, mean) = match &grid.values {
            GridValues::Float(values) => (values.stats().max, values.stats().mean),
            GridValues::Vector(values) => {
                (values.stats().max.max_element(), values.stats().mean.max_element())
            }
        };
        (max > 0.0).then_some(Self { grid, max, mean })
    }

    fn is_number(&self) -> bool {
        matches!(self.grid.values, GridValues::Float(_))
    }

    fn is_named(&self, names: &[&str]) -> bool {
        self.rank(names).is_some()
    }

    /// Position of the grid's name among `names`.
    fn rank(&self, names: &[&str]) -> Option<usize> {
        names.iter().position(|name| self.grid.name.eq_ignore_ascii_case(name))
    }
}

/// The grid that is the density: by name, else the first fog that is named like nothing else.
pub(super) fn density(grids: &[Candidate]) -> Option<&Candidate> {
    let usable = || grids.iter().filter(|g| g.is_number() && g.grid.class != GridClass::LevelSet);
    let named = usable().filter(|grid| grid.is_named(DENSITY)).min_by_key(|g| g.rank(DENSITY));
    let unnamed = |grid: &&Candidate| {
        ![EMISSION, TEMPERATURE, FLAME, OTHER].iter().any(|names| grid.is_named(names))
    };
    named.or_else(|| usable().find(unnamed))
}

/// The grid that emits, with its role: emission itself, else a temperature, else a flame.
pub(super) fn emission(grids: &[Candidate]) -> Option<(&Candidate, Role)> {
    let best = |role: Role| {
        let names = role.names();
        let usable = grids.iter().filter(|grid| {
            grid.grid.class != GridClass::LevelSet && (role == Role::Emission || grid.is_number())
        });
        let named = usable.filter(|grid| grid.is_named(names));
        named.min_by_key(|grid| grid.rank(names)).map(|grid| (grid, role))
    };
    [Role::Emission, Role::Temperature, Role::Flame].into_iter().find_map(best)
}

/// All grids of the file that have something above zero and might be seen; grids of other types are
/// passed over.
pub(super) fn candidates(
    count: usize,
    mut load: impl FnMut(usize) -> Result<Option<PlacedGrid>>,
) -> Result<Vec<Candidate>> {
    let mut grids = Vec::new();
    for index in 0..count {
        grids.extend(load(index)?.and_then(Candidate::of));
    }
    Ok(grids)
}

/// Whether a grid of that name can be seen at all, so that it is worth loading.
pub(super) fn is_worth_loading(name: &str) -> bool {
    !OTHER.iter().any(|other| name.eq_ignore_ascii_case(other))
}
