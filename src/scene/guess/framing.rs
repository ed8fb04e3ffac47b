//! The part of a volume that the camera frames, and the place of the volume in the world.

use super::candidate::Candidate;
use super::note::{About, Note};
use crate::format::{in_steps, rounded};
use crate::scene::assemble::world_from_file;
use crate::scene::file_box::FileBox;
use crate::scene::settings::VolumeSettings;

/// Coordinates past this many voxels have less than 1/32 of a voxel in single precision.
const FAR_VOXELS: f64 = (1 << 18) as f64;

/// Notes of grids that reach far beyond what is looked at.
pub(super) fn notes_of_strays(seen: &[&Candidate], notes: &mut Vec<Note>) {
    for candidate in seen {
        let (core, bounds) = (candidate.core, candidate.bounds);
        let beyond = (core.min - bounds.min).max(bounds.max - core.max);
        let axis = (1..3).fold(0, |a, b| if beyond[b] > beyond[a] { b } else { a });
        if beyond[axis] <= candidate.voxel {
            continue;
        }
        let (name, axis, size) =
            (&candidate.grid.name, ["x", "y", "z"][axis], rounded(beyond[axis], 4));
        let text = format!(
            "\"{name}\" has stray voxels up to {size} units away along {axis} from where the rest \
             is; the camera frames the rest"
        );
        notes.push(Note::new(About::Framing, text));
    }
}

/// Moves a volume that lies so far away that single precision would blur its voxels to the origin
/// of the world; `core` is what is looked at, in the file's space.
pub(super) fn move_near(
    volume: &mut VolumeSettings,
    core: &FileBox,
    voxel: f64,
    notes: &mut Vec<Note>,
) {
    let place = core.transformed(&world_from_file(volume));
    let farthest = place.min.abs().max(place.max.abs()).max_element();
    // Also false for what is not a number.
    if !(farthest > FAR_VOXELS * voxel && farthest < f64::from(f32::MAX)) {
        return;
    }
    let step = 10_f64.powf(place.size().max_element().max(f64::MIN_POSITIVE).log10().floor());
    let whole = |center: f64| (center / step).round() * step;
    // Any number of single precision will do: the volume need not be centered exactly.
    let translate = place.center().to_array().map(|center| 0.0 - whole(center) as f32);
    if !translate.iter().all(|c| c.is_finite()) {
        return;
    }
    volume.translate = translate;
    let center = core.center();
    let [x, y, z] = center.to_array().map(|c| in_steps(c, core.size().max_element()));
    let text = format!(
        "the volume lies far away, about [{x}, {y}, {z}] in the file, and was moved to the origin"
    );
    notes.push(Note::new(About::Placement, text));
}
