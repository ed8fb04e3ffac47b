//! The role of a grid of a file in a volume, and how to give it that role.

use super::describe::GridDescription;
use super::grid_address::is_same;
use super::grid_names::{self, kelvin_scale};
use super::settings::{Color, EmissionMode, EmissionSettings, Normalize, VolumeSettings};
use crate::format::two_digits;

/// The optical depth that smoke gets along the shortest edge of its box where it had none.
const DEPTH: f32 = 4.0;

/// The role of a grid in a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The thickness of smoke.
    Density,
    /// A temperature, which emits as a black body.
    Temperature,
    /// The amount of flame, which emits through a ramp of colors.
    Flame,
    /// The emission itself.
    Emission,
}

impl Role {
    /// All roles.
    pub const ALL: [Self; 4] = [Self::Density, Self::Temperature, Self::Flame, Self::Emission];

    /// The names of grids with this role, the best first.
    pub(super) fn names(self) -> &'static [&'static str] {
        match self {
            Self::Density => grid_names::DENSITY,
            Self::Temperature => grid_names::TEMPERATURE,
            Self::Flame => grid_names::FLAME,
            Self::Emission => grid_names::EMISSION,
        }
    }

    /// Whether a grid can have the role: grids of numbers can be anything, colors only emission,
    /// level sets only density.
    pub fn suits(self, grid: &GridDescription) -> bool {
        let fits = |is_vector: bool| match is_vector {
            true => self == Self::Emission && !grid.is_level_set(),
            false => self == Self::Density || !grid.is_level_set(),
        };
        grid.voxels.is_some_and(|voxels| fits(voxels.is_vector))
    }

    /// The grid whose name fits the role best; a level set never does.
    pub fn best_of(self, grids: &[GridDescription]) -> Option<&GridDescription> {
        let rank = |grid: &&GridDescription| {
            self.names().iter().position(|name| grid.name.eq_ignore_ascii_case(name))
        };
        let usable = grids.iter().filter(|grid| self.suits(grid) && !grid.is_level_set());
        let named = usable.filter(|grid| rank(grid).is_some());
        named.min_by_key(rank)
    }

    /// Whether `volume` uses the grid called `name` so.
    pub fn is_of(self, volume: &VolumeSettings, name: &str) -> bool {
        match self.mode() {
            None => !volume.density.scale.is_black() && is_same(volume.density_grid(), name),
            Some(mode) => {
                let grid = volume.emission_grid();
                volume.emission.mode == mode && grid.is_some_and(|grid| is_same(grid, name))
            }
        }
    }

    /// The role of the grid that a mode of emission reads; `None` if it reads none.
    pub fn of_mode(mode: EmissionMode) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.mode() == Some(mode))
    }

    fn mode(self) -> Option<EmissionMode> {
        match self {
            Self::Density => None,
            Self::Temperature => Some(EmissionMode::Blackbody),
            Self::Flame => Some(EmissionMode::Ramp),
            Self::Emission => Some(EmissionMode::Grid),
        }
    }

    /// Has `volume` use `grid` in this role. Its thickness and brightness stay as far as they can.
    pub fn give(self, volume: &mut VolumeSettings, grid: &GridDescription) {
        let Some(mode) = self.mode() else {
            volume.density.grid = Some(grid.name.clone());
            volume.density.level_set = grid.is_level_set();
            if volume.density.scale.is_black() {
                volume.density.scale = Color::Gray(visible_scale(grid));
            }
            return;
        };
        let max = grid.voxels.map_or(0.0, |voxels| voxels.max);
        let before = std::mem::take(&mut volume.emission);
        let is_driven = self != Self::Emission;
        volume.emission = EmissionSettings {
            mode,
            grid: Some(grid.name.clone()),
            intensity: before.intensity.filter(|_| is_driven),
            times_density: before.times_density.filter(|_| is_driven),
            scale: before.scale.filter(|_| self == Self::Emission),
            normalize: (self == Self::Temperature)
                .then(|| before.normalize.unwrap_or(Normalize::T4)),
            kelvin_scale: (self == Self::Temperature).then(|| kelvin_scale(max)),
            stops: (self == Self::Flame).then(|| flame_stops(max)),
            color: before.color,
            intensity_grid: before.intensity_grid,
            intensity_curve: before.intensity_curve,
            ..EmissionSettings::default()
        };
    }
}

/// The density scale at which a grid is smoke that can be seen and not a wall.
fn visible_scale(grid: &GridDescription) -> f32 {
    let depth = grid.voxels.and_then(|voxels| {
        let [low, high] = voxels.bounds?;
        let edges = std::iter::zip(low, high).map(|(low, high)| high - low);
        // The fog of a level set is 1 but near its surface.
        let mean = if grid.is_level_set() { 1.0 } else { voxels.mean };
        Some(edges.fold(f64::INFINITY, f64::min) as f32 * mean)
    });
    depth.filter(|depth| *depth > 0.0).map_or(1.0, |depth| two_digits(DEPTH / depth))
}

/// Ramp from nothing through red and orange to yellow at the grid's largest value.
pub(super) fn flame_stops(max: f32) -> Vec<[f32; 4]> {
    let max = if max > 0.0 { max } else { 1.0 };
    [[0.0, 0.0, 0.0, 0.0], [0.35, 0.5, 0.05, 0.003], [0.7, 2.0, 0.6, 0.08], [1.0, 3.0, 1.6, 0.5]]
        .map(|[value, r, g, b]| [two_digits(value * max), r, g, b])
        .to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::NO_PROGRESS;
    use crate::scene::conventions::Program;
    use crate::scene::{Settings, VolumeCache, describe, validate};

    fn torch() -> (Vec<GridDescription>, VolumeSettings) {
        let cache = VolumeCache::default();
        let grids = describe("builtin:torch_hd", &cache, NO_PROGRESS).unwrap().grids;
        let file = Some("builtin:torch_hd".to_owned());
        (grids, VolumeSettings { file, ..VolumeSettings::default() })
    }

    #[test]
    fn every_grid_can_be_handed_every_role_and_the_scene_stays_valid() {
        let (grids, mut volume) = torch();
        for grid in &grids {
            for role in Role::ALL {
                assert!(role.suits(grid));
                role.give(&mut volume, grid);
                assert!(role.is_of(&volume, &grid.name), "{role:?} of {}", grid.name);
                let others = grids.iter().filter(|other| other.name != grid.name);
                assert!(others.into_iter().all(|other| !role.is_of(&volume, &other.name)));
                let scene = Settings { volume: vec![volume.clone()], ..Settings::default() };
                validate(&scene, "").unwrap();
            }
        }
        volume.density.scale = Color::Gray(0.0);
        Role::Density.give(&mut volume, &grids[0]);
        assert!(volume.density.scale.rgb().x > 0.0, "what was nothing can be seen");
    }

    #[test]
    fn programs_name_grids_and_temperatures_their_own_way() {
        let (grids, mut volume) = torch();
        Program::Blender.dress(&mut volume, &grids);
        assert_eq!(volume.density_grid(), "density");
        assert_eq!(volume.emission_grid(), Some("temperature"));
        assert_eq!(volume.emission.kelvin_scale(), 1000.0);
        Program::Houdini.dress(&mut volume, &grids);
        assert_eq!(volume.emission.kelvin_scale(), 840.0, "the hottest 2.96 is 2500 kelvin");
        Program::EmberGen.dress(&mut volume, &grids);
        assert_eq!(volume.emission.mode, EmissionMode::Ramp);
        assert_eq!(volume.emission_grid(), Some("flame"));
    }
}
