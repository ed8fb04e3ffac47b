//! Roles of the grids of a file, guessed by name, type, class and range.

use super::candidate::Candidate;
use crate::scene::grid_names::{DENSITY, EMISSION, FLAME, TEMPERATURE};
use crate::scene::role::Role;

/// The grids that are the density, all of one name: by name, else the first that is named like
/// nothing else and nowhere below zero.
pub(super) fn density(grids: &[Candidate]) -> Vec<&Candidate> {
    let usable = || grids.iter().filter(|grid| grid.is_number());
    let named = usable().filter(|grid| grid.is_named(DENSITY)).min_by_key(|g| g.rank(DENSITY));
    let first = named.or_else(|| usable().find(|grid| may_be_density(grid)));
    first.map_or_else(Vec::new, |first| usable().filter(|grid| grid.name == first.name).collect())
}

/// Whether a grid that is not named like a density may be one.
fn may_be_density(grid: &Candidate) -> bool {
    let is_fire = [EMISSION, TEMPERATURE, FLAME].iter().any(|names| grid.is_named(names));
    !is_fire && grid.min >= 0.0
}

/// The grids that emit, all of one name, with their role: emission itself, else a temperature, else
/// a flame.
pub(super) fn emission(grids: &[Candidate]) -> (Vec<&Candidate>, Role) {
    let best = |role: Role| {
        let names = role.names();
        let usable = || grids.iter().filter(|grid| role == Role::Emission || grid.is_number());
        let named = usable().filter(|grid| grid.is_named(names));
        let first = named.min_by_key(|grid| grid.rank(names))?;
        Some((usable().filter(|grid| grid.name == first.name).collect(), role))
    };
    let roles = [Role::Emission, Role::Temperature, Role::Flame];
    roles.into_iter().find_map(best).unwrap_or((Vec::new(), Role::Emission))
}

/// Why a grid has neither role where no grid has one.
pub(super) fn why_unused(grid: &Candidate) -> &'static str {
    match grid.is_number() {
        true => "it goes below zero and is not named like a density",
        false => "it holds vectors and is not named like an emission",
    }
}
