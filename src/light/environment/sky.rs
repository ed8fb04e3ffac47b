//! A clear sky with its sun.
//!
//! The sky is the model of Hosek and Wilkie 2012, *An Analytic Model for Full Spectral Sky-Dome
//! Radiance*, fitted to path-traced atmospheres, in linear Rec.709. The sun is a black body of
//! 5778 K whose light comes through the same air: molecules and haze of the turbidity as of Preetham
//! et al. 1999, *A Practical Analytic Model for Daylight*, appendix A.1, without the few per cent
//! that ozone takes, along the air mass of Kasten and Young 1989. The ground is a diffuse plane of
//! an even gray, lit by both.
//!
//! Radiance 1 is 20 000 cd/m², so that a clear noon has a sun of an irradiance of about 5.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{UVec2, Vec3A};
use hw_skymodel::rgb::{Channel, SkyParams, SkyState};

use crate::math::{Rgb, luminance};
use crate::volume::blackbody;

/// Candela per square meter of a radiance of 1.
const UNIT: f32 = 20_000.0;
/// Lumen per watt at the peak of the eye's sensitivity: the model's luminance is in watts.
const LUMEN_PER_WATT: f32 = 683.0;
/// Illuminance by the sun above the air, in lux.
const SOLAR_ILLUMINANCE: f32 = 133_000.0;
/// Temperature of a black body of the sun's color above the air, in kelvin.
const SOLAR_KELVIN: f64 = 5778.0;
/// Size of the map in texels: rows above and below the horizon are of one side of it only.
const SIZE: UVec2 = UVec2::new(512, 256);

/// A clear sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearSky {
    /// Elevation of the sun above the horizon, 0 to 90 degrees.
    pub sun_elevation: f32,
    /// Haze, 1 (pure air) to 10.
    pub turbidity: f32,
    /// Reflectance of the ground, 0 to 1.
    pub ground_albedo: f32,
    /// Whether the sun lights the ground.
    pub has_sun: bool,
}

impl ClearSky {
    /// Radiance by texels of latitude and longitude, as a map has them, without the disk of the
    /// sun. The sun is above the middle of the map.
    pub fn texels(&self) -> (UVec2, Vec<[f32; 3]>) {
        let above: Vec<Rgb> = match self.model() {
            Some(model) => (0..SIZE.y / 2).flat_map(|row| self.row(&model, row)).collect(),
            None => vec![Rgb::ZERO; (SIZE.x * SIZE.y / 2) as usize],
        };
        let mut irradiance = Rgb::ZERO;
        for (row, texels) in (0..).zip(above.chunks(SIZE.x as usize)) {
            let [upper, lower] = [row, row + 1].map(|edge| from_zenith(edge as f32).cos());
            // ∫ cos θ dω over a texel.
            let share = 0.5 * (upper * upper - lower * lower) * TAU / SIZE.x as f32;
            irradiance += share * texels.iter().copied().sum::<Rgb>();
        }
        if self.has_sun {
            irradiance += self.sun_irradiance() * self.sun_elevation.to_radians().sin();
        }
        let ground = irradiance * (self.ground_albedo / PI);
        let below = std::iter::repeat_n(ground, above.len());
        (SIZE, above.iter().copied().chain(below).map(|radiance| radiance.to_array()).collect())
    }

    /// Direction towards the sun in the space of the environment.
    pub fn to_sun(&self) -> Vec3A {
        let (sin, cos) = self.sun_elevation.to_radians().sin_cos();
        Vec3A::new(cos, 0.0, sin)
    }

    /// Irradiance of the sun on a plane across its direction.
    pub fn sun_irradiance(&self) -> Rgb {
        let elevation = f64::from(self.sun_elevation.clamp(0.0, 90.0));
        let turbidity = f64::from(self.turbidity);
        let air_mass =
            1.0 / (elevation.to_radians().sin() + 0.505_72 * (elevation + 6.079_95).powf(-1.636_4));
        let haze = (0.046_08 * turbidity - 0.045_86).max(0.0);
        let through = |nanometers: f64| {
            let micrometers = 1e-3 * nanometers;
            let molecules = 0.008_735 * micrometers.powf(-4.08);
            (-air_mass * (molecules + haze * micrometers.powf(-1.3))).exp()
        };
        let whole = luminance(blackbody::filtered(SOLAR_KELVIN, |_| 1.0));
        blackbody::filtered(SOLAR_KELVIN, through) * (SOLAR_ILLUMINANCE / UNIT / whole)
    }

    fn model(&self) -> Option<SkyState> {
        let elevation = self.sun_elevation.to_radians().clamp(0.0, FRAC_PI_2);
        let albedo = [self.ground_albedo.clamp(0.0, 1.0); 3];
        let turbidity = self.turbidity.clamp(1.0, 10.0);
        SkyState::new(&SkyParams { elevation, turbidity, albedo }).ok()
    }

    /// Radiance of a row of texels above the horizon. Where the fit dips below 0, the sky is black.
    fn row(&self, model: &SkyState, row: u32) -> impl Iterator<Item = Rgb> {
        let to_sun = self.to_sun();
        let theta = from_zenith(row as f32 + 0.5);
        (0..SIZE.x).map(move |column| {
            let azimuth = PI - TAU * (column as f32 + 0.5) / SIZE.x as f32;
            let direction = crate::sampling::warp::spherical(theta.cos(), azimuth);
            let gamma = to_sun.dot(direction).clamp(-1.0, 1.0).acos();
            let rgb = [Channel::R, Channel::G, Channel::B];
            let rgb = rgb.map(|channel| model.radiance(theta, gamma, channel));
            Rgb::from_array(rgb).max(Rgb::ZERO) * (LUMEN_PER_WATT / UNIT)
        })
    }
}

/// Angle from the zenith of a row of texels.
fn from_zenith(row: f32) -> f32 {
    PI * row / SIZE.y as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOON: ClearSky =
        ClearSky { sun_elevation: 60.0, turbidity: 3.0, ground_albedo: 0.3, has_sun: true };

    fn texel(sky: &ClearSky, [x, y]: [u32; 2]) -> Rgb {
        Rgb::from_array(sky.texels().1[(y * SIZE.x + x) as usize])
    }

    /// Irradiance of the sky on the ground, by the light that the ground gives back.
    fn irradiance(sky: ClearSky) -> Rgb {
        let sky = ClearSky { has_sun: false, ..sky };
        texel(&sky, [0, SIZE.y - 1]) * (PI / sky.ground_albedo)
    }

    /// At a clear noon the sun brings about 80 and the sky about 20 kilolux (IES: 60 to 100, 10 to
    /// 25).
    #[test]
    fn the_light_of_a_clear_noon_is_as_measured() {
        let sun = luminance(NOON.sun_irradiance()) * NOON.to_sun().z * UNIT;
        let sky = luminance(irradiance(NOON)) * UNIT;
        assert!((60e3..100e3).contains(&sun), "{sun} lx");
        assert!((10e3..25e3).contains(&sky), "{sky} lx");
        let ground = luminance(texel(&NOON, [9, 200])) * UNIT;
        assert!((ground / ((sun + sky) * 0.3 / PI) - 1.0).abs() < 1e-3, "{ground} cd/m²");
    }

    #[test]
    fn colors_and_brightness_follow_the_air() {
        let blue = |color: Rgb| color.z / color.x;
        for sun_elevation in [10.0, 30.0, 60.0] {
            let sky = ClearSky { sun_elevation, ..NOON };
            // Opposite of the sun.
            let [zenith, horizon] = [1, 126].map(|row| texel(&sky, [0, row]));
            assert!(blue(zenith) > 1.2 * blue(horizon), "{sun_elevation}: {zenith} {horizon}");
        }
        let suns = [60.0, 30.0, 10.0, 3.0, 0.0]
            .map(|sun_elevation| ClearSky { sun_elevation, ..NOON }.sun_irradiance());
        let warm = |color: Rgb| color.x / (color.y + color.z);
        for pair in suns.windows(2) {
            assert!(warm(pair[1]) > warm(pair[0]), "{pair:?}");
            assert!(luminance(pair[1]) < luminance(pair[0]), "{pair:?}");
        }
        let hazy = ClearSky { turbidity: 8.0, ..NOON };
        let [sun, sky] = [hazy, NOON].map(|sky| [sky.sun_irradiance(), irradiance(sky)]);
        let ratios = [0, 1].map(|part| luminance(sun[part]) / luminance(sky[part]));
        assert!(ratios[0] < 0.7 && ratios[1] > 1.5, "{ratios:?}");
        // Brightest around the sun, which is above the middle of the map.
        let row = (30.0 / 180.0 * SIZE.y as f32) as u32;
        let [towards, away] = [SIZE.x / 2, 0].map(|x| luminance(texel(&NOON, [x, row])));
        assert!(towards > 3.0 * away, "{towards} {away}");
    }

    #[test]
    fn every_sky_is_finite() {
        for sun_elevation in [0.0, 0.01, 45.0, 89.99, 90.0] {
            for turbidity in [1.0, 5.5, 10.0] {
                for ground_albedo in [0.0, 1.0] {
                    let sky = ClearSky { sun_elevation, turbidity, ground_albedo, has_sun: true };
                    let (size, texels) = sky.texels();
                    assert_eq!(texels.len() as u32, size.x * size.y);
                    let is_light = |value: &f32| *value >= 0.0 && value.is_finite();
                    assert!(texels.iter().flatten().all(is_light), "{sky:?}");
                    assert!(sky.sun_irradiance().is_finite());
                }
            }
        }
    }
}
