//! Emission ε of a volume, radiance per length, in every mode of the scene file.

use glam::Vec3A;

use super::{
    blackbody,
    field::{RgbField, ScalarField},
};
use crate::math::{Aabb, Rgb, luminance};

/// The emission of a volume at each of its points. All modes are formed after interpolation.
#[derive(Clone, Debug)]
pub enum Emission {
    /// No emission.
    None,
    /// ε = scale · value, whatever density and albedo are.
    Field {
        /// Field of the values.
        field: RgbField,
        /// Multiplier of the values.
        scale: Rgb,
    },
    /// ε = μ_a · L_e: in thermal equilibrium with its absorption.
    Source {
        /// L_e, radiance.
        le: Rgb,
    },
    /// Color by temperature.
    Blackbody(Blackbody),
    /// Color by a ramp over a field's value.
    Ramp(ColorRamp),
    /// An emission times the value of another field.
    Scaled(Box<ScaledEmission>),
}

/// ε = value · ε of another emission: its color from one field, its intensity from another.
#[derive(Clone, Debug)]
pub struct ScaledEmission {
    /// Emission that is multiplied.
    pub emission: Emission,
    /// Field of the multiplier; negative values count as 0.
    pub intensity: ScalarField,
}

/// Black-body emission driven by a temperature field.
#[derive(Clone, Debug)]
pub struct Blackbody {
    /// The field that stands for temperature.
    pub field: ScalarField,
    /// kelvin = (value − offset) · scale.
    pub kelvin_offset: f32,
    /// See `kelvin_offset`.
    pub kelvin_scale: f32,
    /// Multiplier, radiance per length.
    pub intensity: Rgb,
    /// Multiply by the density field's value.
    pub times_density: bool,
    /// Reference temperature T₀ in kelvin, with which the emission is multiplied by (T/T₀)⁴.
    pub t4_reference: Option<f32>,
}

/// Emission by a piecewise linear color ramp over a field's value, constant beyond its ends.
#[derive(Clone, Debug)]
pub struct ColorRamp {
    /// The field that drives it.
    pub field: ScalarField,
    /// Stops in ascending order of value; at least one.
    pub stops: Vec<(f32, Rgb)>,
    /// Multiplier, radiance per length.
    pub intensity: Rgb,
    /// Multiply by the density field's value.
    pub times_density: bool,
}

impl Emission {
    /// ε at a point where the volume absorbs `mu_a` and its density field has the value `density`.
    #[inline]
    pub fn at(&self, local: Vec3A, mu_a: Rgb, density: f32) -> Rgb {
        match self {
            Self::None => Rgb::ZERO,
            Self::Field { field, scale } => (*scale * field.at(local)).max(Rgb::ZERO),
            Self::Source { le } => mu_a * *le,
            Self::Blackbody(blackbody) => blackbody.at(local, density),
            Self::Ramp(ramp) => ramp.at(local, density),
            Self::Scaled(scaled) => match scaled.intensity.at(local) {
                intensity if intensity > 0.0 => {
                    intensity * scaled.emission.at(local, mu_a, density)
                }
                _ => Rgb::ZERO,
            },
        }
    }

    /// Upper bound of the luminance of ε over a box, 0 only where ε is 0 throughout.
    pub fn upper_bound(&self, local: &Aabb, mu_t_max: Rgb, density_max: f32) -> f32 {
        match self {
            Self::None => 0.0,
            Self::Field { field, scale } => {
                luminance((*scale * field.upper_bound(local)).max(Rgb::ZERO))
            }
            Self::Source { le } => luminance(mu_t_max * *le),
            Self::Blackbody(blackbody) => blackbody.upper_bound(local, density_max),
            Self::Ramp(ramp) => ramp.upper_bound(local, density_max),
            Self::Scaled(scaled) => {
                let most = scaled.intensity.range(local).1.max(0.0);
                most * scaled.emission.upper_bound(local, mu_t_max, density_max)
            }
        }
    }

    /// Whether [`Emission::at`] depends on the absorption or the density that it is given.
    #[inline]
    pub fn needs_density(&self) -> bool {
        match self {
            Self::None | Self::Field { .. } => false,
            Self::Source { .. } => true,
            Self::Blackbody(blackbody) => blackbody.times_density,
            Self::Ramp(ramp) => ramp.times_density,
            Self::Scaled(scaled) => scaled.emission.needs_density(),
        }
    }

    /// Whether the emission may be above zero anywhere.
    pub fn is_some(&self) -> bool {
        !matches!(self, Self::None)
    }
}

/// The color of a ramp at a value; black without stops.
pub fn color_at(stops: &[(f32, Rgb)], value: f32) -> Rgb {
    let above = stops.partition_point(|stop| stop.0 <= value);
    match (above.checked_sub(1).map(|i| stops[i]), stops.get(above)) {
        (Some((v0, c0)), Some(&(v1, c1))) => c0.lerp(c1, (value - v0) / (v1 - v0)),
        (Some((_, color)), None) | (None, Some(&(_, color))) => color,
        (None, None) => Rgb::ZERO,
    }
}

impl Blackbody {
    fn at(&self, local: Vec3A, density: f32) -> Rgb {
        let kelvin = (self.field.at(local) - self.kelvin_offset) * self.kelvin_scale;
        let mask = if self.times_density { density } else { 1.0 };
        blackbody::peak_normalized(kelvin) * self.intensity * (self.brightness(kelvin) * mask)
    }

    fn brightness(&self, kelvin: f32) -> f32 {
        self.t4_reference.map_or(1.0, |reference| (kelvin.max(0.0) / reference).powi(4))
    }

    fn upper_bound(&self, local: &Aabb, density_max: f32) -> f32 {
        let (low, high) = self.field.range(local);
        let (a, b) = (
            (low - self.kelvin_offset) * self.kelvin_scale,
            (high - self.kelvin_offset) * self.kelvin_scale,
        );
        let hottest = a.max(b);
        let mask = if self.times_density { density_max } else { 1.0 };
        // The color's luminance times the brightest intensity channel bounds their product's.
        let intensity = self.intensity.max_element();
        blackbody::peak_normalized_bound(a.min(b), hottest)
            * intensity
            * (self.brightness(hottest) * mask)
    }
}

impl ColorRamp {
    fn at(&self, local: Vec3A, density: f32) -> Rgb {
        let mask = if self.times_density { density } else { 1.0 };
        self.color(self.field.at(local)) * self.intensity * mask
    }

    fn color(&self, value: f32) -> Rgb {
        color_at(&self.stops, value)
    }

    fn upper_bound(&self, local: &Aabb, density_max: f32) -> f32 {
        let (low, high) = self.field.range(local);
        let inside = self.stops.iter().filter(|s| s.0 > low && s.0 < high).map(|s| s.1);
        let color = inside.fold(self.color(low).max(self.color(high)), Rgb::max);
        let mask = if self.times_density { density_max } else { 1.0 };
        luminance(color * self.intensity) * mask
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::math::PathRng;
    use crate::volume::{curve::Curve, procedural::Noise};

    fn noise(seed: u32) -> ScalarField {
        ScalarField::Noise(Noise { frequency: 1.5, octaves: 3, contrast: 2.0, seed })
    }

    /// Color from one field times intensity from another, negative ones as 0; a bound over a box
    /// holds for all of it.
    #[test]
    fn a_second_field_multiplies_the_emission() {
        let steep = Curve::new(&[[0.4, -1.0], [0.6, 2.0]]);
        let (color, intensity) = (noise(1), noise(2).through(steep));
        let field = RgbField::Tinted(color, Rgb::new(1.0, 0.5, 0.0));
        let emission = Emission::Field { field, scale: Rgb::ONE };
        let (base, intensity_of) = (emission.clone(), intensity.clone());
        let scaled = Emission::Scaled(Box::new(ScaledEmission { emission, intensity }));
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let mut glows = 0;
        for _ in 0..500 {
            let mut point = || Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
            let (low, edge) = (4.0 * point(), 0.5 * point());
            let bound = scaled.upper_bound(&Aabb::new(low, low + edge), Rgb::ONE, 1.0);
            for _ in 0..4 {
                let at = low + edge * point();
                let seen = scaled.at(at, Rgb::ONE, 1.0);
                let expected = base.at(at, Rgb::ONE, 1.0) * intensity_of.at(at).max(0.0);
                assert!((seen - expected).abs().max_element() < 1e-6, "{seen} {expected}");
                assert!(luminance(seen) <= bound * (1.0 + 1e-5), "{seen} above {bound}");
                glows += u32::from(seen.x > 0.0);
            }
        }
        assert!((200..1900).contains(&glows), "{glows}");
    }
}
