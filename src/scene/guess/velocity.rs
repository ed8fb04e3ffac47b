//! The velocity of a bare volume, by the names and types of its grids; no voxel is read.

use super::note::{About, Note};
use crate::scene::cache::VolumeFile;
use crate::scene::grid_names::{VELOCITY, velocity_component};
use crate::scene::settings::VelocitySettings;
use crate::volume::file::GridInfo;

/// The velocities of a file, one for each grid of the name: of a grid of vectors, else of three of
/// numbers. Empty if there is none.
pub(super) fn velocities(file: &VolumeFile, notes: &mut Vec<Note>) -> Vec<VelocitySettings> {
    let vectors = of_vectors(file);
    let found = if vectors.is_empty() { of_components(file) } else { vectors };
    let Some(first) = found.first() else { return found };
    let names = match (&first.grid, &first.grids) {
        (Some(grid), _) => format!("\"{grid}\" is the velocity"),
        (None, Some([x, y, z])) => format!("\"{x}\", \"{y}\" and \"{z}\" are the velocity"),
        (None, None) => return found,
    };
    let text = format!("{names}, per second; motion blurs where time.shutter is above 0");
    notes.push(Note::new(About::Velocity, text));
    found
}

fn of_vectors(file: &VolumeFile) -> Vec<VelocitySettings> {
    let found = VELOCITY.iter().map(|name| {
        addresses(file, |info| {
            is_vector(info) == Some(true) && info.name.eq_ignore_ascii_case(name)
        })
    });
    let first = found.into_iter().find(|addresses| !addresses.is_empty()).unwrap_or_default();
    let of_grid = |grid| VelocitySettings { grid: Some(grid), ..VelocitySettings::default() };
    first.into_iter().map(of_grid).collect()
}

fn of_components(file: &VolumeFile) -> Vec<VelocitySettings> {
    let of_axis = |name: &str, axis: usize| {
        addresses(file, |info| {
            let component = velocity_component(&info.name);
            is_vector(info) == Some(false) && component == Some((name, axis))
        })
    };
    for name in VELOCITY {
        let [x, y, z] = [0, 1, 2].map(|axis| of_axis(name, axis));
        let all = std::iter::zip(x, std::iter::zip(y, z)).map(|(x, (y, z))| [x, y, z]);
        let found: Vec<_> = all
            .map(|grids| VelocitySettings { grids: Some(grids), ..VelocitySettings::default() })
            .collect();
        if !found.is_empty() {
            return found;
        }
    }
    Vec::new()
}

/// Whether a grid that can be loaded holds vectors or single numbers; `None` of one that cannot.
fn is_vector(info: &GridInfo) -> Option<bool> {
    let value_type = info.value_type.to_ascii_lowercase();
    info.unsupported.is_none().then(|| value_type.starts_with("vec3"))
}

/// The addresses of the grids that are meant, in the order of the file.
fn addresses(file: &VolumeFile, is_meant: impl Fn(&GridInfo) -> bool) -> Vec<String> {
    let infos = file.directory().grids.iter().enumerate();
    infos.filter(|(_, info)| is_meant(info)).map(|(index, _)| file.address(index)).collect()
}
