//! The names that programs give to the grids of their volumes, and the units of their temperatures.

use crate::format::two_digits;

/// Names of grids of smoke.
pub(super) const DENSITY: &[&str] =
    &["density", "smoke", "soot", "fog", "cloud", "density_noise", "vapour"];

/// Names of grids of emission itself.
pub(super) const EMISSION: &[&str] = &["emission", "emit", "ce", "le", "incandescence"];

/// Names of grids of temperatures.
pub(super) const TEMPERATURE: &[&str] = &["temperature", "temp", "heat", "kelvin"];

/// Names of grids that say how much flame there is.
pub(super) const FLAME: &[&str] = &["flame", "flames", "fire", "burn", "flame_noise"];

/// Names of grids of velocities, or in front of the names of their components.
pub(super) const VELOCITY: &[&str] = &["vel", "v", "velocity"];

/// Names of grids that simulations write beside those that are seen.
const OTHER: &[&str] = &[
    "v",
    "n",
    "p",
    "pos",
    "id",
    "uid",
    "ls",
    "color",
    "colour",
    "cd",
    "rgb",
    "albedo",
    "shadow",
    "fuel",
    "fuel_noise",
    "react",
    "flags",
    "age",
    "life",
    "distance",
    "surface",
    "obstacle",
    "obstacles",
    "index",
    "rest",
    "rest2",
    "uv",
    "uvw",
    "force",
    "forces",
    "wind",
    "flow",
    "stick",
];

/// Words that mark a grid as one of those, whatever else its name says.
const OTHER_WORDS: &[&str] = &[
    "velocity",
    "vel",
    "vels",
    "velocities",
    "speed",
    "motion",
    "motionvector",
    "vorticity",
    "vort",
    "curl",
    "normal",
    "normals",
    "position",
    "gradient",
    "acceleration",
    "accel",
    "displacement",
    "mask",
    "sdf",
    "isdf",
    "levelset",
    "collision",
    "collisions",
    "collider",
    "pressure",
    "divergence",
    "texcoord",
];

/// Endings of the grids that hold one component of a vector each.
const COMPONENTS: &[&str] = &["x", "y", "z", "w", "r", "g", "b", "u", "0", "1", "2"];

/// Names of vectors whose components are also written as `vx` or `velx`.
const JOINED: &[&str] = &["v", "vel", "velocity", "n", "p", "rest", "vort", "vorticity"];

/// Whether a grid of that name is smoke or fire.
pub(super) fn is_seen(name: &str) -> bool {
    let names = [DENSITY, EMISSION, TEMPERATURE, FLAME];
    names.iter().any(|names| names.iter().any(|known| name.eq_ignore_ascii_case(known)))
}

/// Whether a grid of that name is neither smoke nor fire: a velocity or one of its components
/// (`vel`, `vel.x`, `v_y`, `velz`), texture coordinates, identifiers, masks, distances.
pub(super) fn is_other(name: &str) -> bool {
    if is_seen(name) {
        return false;
    }
    let name = name.to_ascii_lowercase();
    let words = name.split(|letter: char| !letter.is_alphanumeric());
    let mut words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    if words.len() > 1 {
        words.pop_if(|last| COMPONENTS.contains(last));
    }
    let is_component = |word: &str| {
        let vector = word.strip_suffix(['x', 'y', 'z']);
        vector.is_some_and(|vector| JOINED.contains(&vector))
    };
    let marks =
        |word: &&str| OTHER_WORDS.contains(word) || word.starts_with("phi") || is_component(word);
    OTHER.contains(&&*name) || OTHER.contains(&&*words.join("_")) || words.iter().any(marks)
}

/// The velocity and the axis that a grid of that name holds a component of, if it does: `vel.x`,
/// `v_y`, `velocityZ`.
pub(super) fn velocity_component(name: &str) -> Option<(&'static str, usize)> {
    let name = name.to_ascii_lowercase();
    let axes = ['x', 'y', 'z'].into_iter().enumerate();
    let (axis, vector) =
        axes.into_iter().find_map(|(axis, letter)| Some((axis, name.strip_suffix(letter)?)))?;
    let vector = vector.strip_suffix(['.', '_']).unwrap_or(vector);
    VELOCITY.iter().find(|known| **known == vector).map(|known| (*known, axis))
}

/// Largest value of a grid above which its temperatures are in kelvin.
pub(super) const KELVIN_FROM: f32 = 200.0;

/// Kelvin of the hottest place of a temperature whose unit is not known.
pub(super) const HOTTEST_KELVIN: f32 = 2500.0;

/// Kelvin per unit of Blender's temperature, which goes from 0 to about 3.
pub(super) const BLENDER_KELVIN: f32 = 1000.0;

/// The largest values by which Blender's temperature is known.
pub(super) const BLENDER_HOTTEST: std::ops::RangeInclusive<f32> = 1.2..=5.0;

/// Kelvin per unit of a temperature that reaches up to `max`.
pub(super) fn kelvin_scale(max: f32) -> f32 {
    match max {
        _ if max > KELVIN_FROM => 1.0,
        _ if BLENDER_HOTTEST.contains(&max) => BLENDER_KELVIN,
        _ => hottest(max),
    }
}

/// Kelvin per unit of a temperature without a known unit that reaches up to `max`.
pub(super) fn hottest(max: f32) -> f32 {
    if max > 0.0 { two_digits(HOTTEST_KELVIN / max) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn companions_of_smoke_are_told_by_their_names() {
        let other = "vel vel.x vel_y velz VELOCITY.X v v.x v_z vx rest rest.y uvw vorticity N N.z Cd \
                     Cd.r P P_x id mask density_mask sdf smoke_sdf collision vel_old phiObs phi_out \
                     color_r vel[2] motion.vector pressure";
        other.split_whitespace().for_each(|name| assert!(is_other(name), "{name}"));
        let seen = "density Density smoke temperature flame flames heat burn emission Ce cloud_main \
                    haze unnamed density.001 fire_density dust x1";
        seen.split_whitespace().for_each(|name| assert!(!is_other(name), "{name}"));
        assert!(!is_other(""));
    }

    #[test]
    fn components_of_velocities_are_told_by_their_endings() {
        for (name, component) in [
            ("vel.x", Some(("vel", 0))),
            ("V_Y", Some(("v", 1))),
            ("velz", Some(("vel", 2))),
            ("vx", Some(("v", 0))),
            ("velocityZ", Some(("velocity", 2))),
            ("vel", None),
            ("x", None),
            ("old_vel.x", None),
            ("vel..x", None),
        ] {
            assert_eq!(velocity_component(name), component, "{name}");
        }
    }

    #[test]
    fn temperatures_are_told_by_their_largest_value() {
        assert_eq!([2000.0, 2.96, 0.5].map(kelvin_scale), [1.0, 1000.0, 5000.0]);
        assert_eq!(kelvin_scale(0.0), 1.0);
    }
}
