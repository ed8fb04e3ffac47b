//! The programs that simulate fire and smoke: which way is up in their files, and which of their
//! grids are drawn.

use super::describe::GridDescription;
use super::grid_names::{BLENDER_KELVIN, KELVIN_FROM, hottest};
use super::role::Role;
use super::settings::{Axis, VolumeSettings};
use crate::volume::file::{Directory, MetaValue};

/// A program that simulates fire and smoke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// Blender's Mantaflow: z up; grids density, flame, temperature (0 to 3, not kelvin).
    Blender,
    /// Houdini's pyro: y up; grids density, temperature (no unit), flame, in older files heat.
    Houdini,
    /// EmberGen: z up; grids density, flames, temperature (no unit). It draws fire by its flames.
    EmberGen,
}

impl Program {
    /// All conventions.
    pub const ALL: [Self; 3] = [Self::Blender, Self::Houdini, Self::EmberGen];

    /// Name of the convention.
    pub fn name(self) -> &'static str {
        match self {
            Self::Blender => "Blender",
            Self::Houdini => "Houdini",
            Self::EmberGen => "EmberGen",
        }
    }

    /// Axis of the program's files that points up.
    pub fn up(self) -> Axis {
        match self {
            Self::Houdini => Axis::Y,
            Self::Blender | Self::EmberGen => Axis::Z,
        }
    }

    /// The program that wrote a file, where the file tells.
    pub(super) fn of(file: &Directory) -> Option<Self> {
        let metadata = || {
            let grids = file.grids.iter().map(|grid| &grid.metadata);
            std::iter::once(&file.metadata).chain(grids)
        };
        let has =
            |known: fn(&str) -> bool| metadata().any(|values| values.keys().any(|k| known(k)));
        let creator = metadata().find_map(|values| match values.get("creator") {
            Some(MetaValue::Text(creator)) => Some(creator.to_ascii_lowercase()),
            _ => None,
        });
        let says = |name: &str| creator.as_ref().is_some_and(|creator| creator.contains(name));
        let by_creator =
            Self::ALL.into_iter().find(|program| says(&program.name().to_ascii_lowercase()));
        by_creator.or_else(|| {
            if has(|key| key == "embergen_version") {
                Some(Self::EmberGen)
            } else if has(|key| key.starts_with("blender/") || key == "file_base_resolution") {
                Some(Self::Blender)
            } else {
                None
            }
        })
    }

    /// Roles whose grids may drive fire, the best first.
    fn fire(self) -> [Role; 2] {
        match self {
            Self::Blender | Self::Houdini => [Role::Temperature, Role::Flame],
            Self::EmberGen => [Role::Flame, Role::Temperature],
        }
    }

    /// Takes density and fire of `volume` from the grids that this program writes them to, as far
    /// as the file has them, with its scale of temperature. How thick and how bright it is stays.
    pub fn dress(self, volume: &mut VolumeSettings, grids: &[GridDescription]) {
        if let Some(density) = Role::Density.best_of(grids) {
            Role::Density.give(volume, density);
        }
        let best = |role: Role| role.best_of(grids).map(|grid| (role, grid));
        if let Some((role, grid)) = self.fire().into_iter().find_map(best) {
            role.give(volume, grid);
            if role == Role::Temperature {
                let max = grid.voxels.as_ref().map_or(0.0, |voxels| voxels.max);
                volume.emission.kelvin_scale = Some(self.kelvin_scale(max));
            }
        }
    }

    fn kelvin_scale(self, max: f32) -> f32 {
        match self {
            Self::Blender if max <= KELVIN_FROM => BLENDER_KELVIN,
            Self::Houdini | Self::EmberGen if max <= KELVIN_FROM => hottest(max),
            _ => 1.0,
        }
    }
}

/// The rotation, in degrees about x, y and z, that puts a file with `up` on its feet: the world's z
/// is up.
pub fn upright(up: Axis) -> [f32; 3] {
    match up {
        Axis::X => [0.0, -90.0, 0.0],
        Axis::Y => [90.0, 0.0, 0.0],
        Axis::Z => [0.0; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_have_their_own_units_of_temperature() {
        assert_eq!(Program::Blender.kelvin_scale(0.5), 1000.0);
        assert_eq!(Program::Houdini.kelvin_scale(2.5), 1000.0);
        assert_eq!(Program::Houdini.kelvin_scale(1800.0), 1.0);
    }
}
