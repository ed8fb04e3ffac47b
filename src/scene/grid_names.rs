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

/// Names of grids that simulations write beside those that are seen.
pub(super) const OTHER: &[&str] = &[
    "velocity",
    "vel",
    "v",
    "shadow",
    "color",
    "colour",
    "color_r",
    "color_g",
    "color_b",
    "cd",
    "fuel",
    "fuel_noise",
    "react",
    "pressure",
    "flags",
    "phi",
    "collision",
    "divergence",
    "age",
];

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
    fn temperatures_are_told_by_their_largest_value() {
        assert_eq!([2000.0, 2.96, 0.5].map(kelvin_scale), [1.0, 1000.0, 5000.0]);
        assert_eq!(kelvin_scale(0.0), 1.0);
    }
}
