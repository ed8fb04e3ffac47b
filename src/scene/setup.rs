//! Surroundings of a volume that stands alone: a floor that falls away into a soft sky, and a key
//! light, as ordinary tables of the scene.

use glam::Vec3;
use strum::{Display, EnumIter, IntoEnumIterator};

use super::settings::{
    Color, EmissionMode, EnvironmentSettings, LightKind, LightSettings, MaterialKind,
    MaterialSettings, Settings, SurfaceSettings, SurfaceShape,
};
use crate::math::{Aabb, Rgb};

/// Surroundings to choose from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Display, EnumIter)]
#[strum(serialize_all = "snake_case")]
pub enum Setup {
    /// A neutral floor under a soft sky, dim around fire.
    #[default]
    Studio,
    /// The same by moonlight.
    Night,
    /// Nothing but, where nothing glows, a key light.
    Black,
}

impl std::str::FromStr for Setup {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::iter().find(|setup| setup.to_string() == name);
        found.ok_or_else(|| "expected studio, night or black".to_owned())
    }
}

/// Light of a setup.
struct Look {
    /// Radiance at the horizon, which is that of the floor too.
    horizon: Rgb,
    /// Radiance straight up.
    top: Rgb,
    /// Irradiance of the key light across its direction.
    key: Rgb,
    /// Angular diameter of the key light in degrees.
    angle: f32,
}

/// The direction in which key light travels: from the left, in front and above.
const KEY: [f32; 3] = [0.55, 0.45, -0.7];
/// Distance of the floor from what stands on it, in heights of that.
const GAP: f32 = 0.01;

impl Setup {
    /// The setup after this one.
    #[must_use]
    pub fn next(self) -> Self {
        let all = || Self::iter().chain(Self::iter());
        all().skip_while(|setup| *setup != self).nth(1).unwrap_or(self)
    }

    /// The setup of a scene; `None` for surroundings of its own.
    pub fn of(settings: &Settings) -> Option<Self> {
        let is_named = |setup: &Self| {
            let parts = [setup.part(FLOOR), setup.part(LIGHT)];
            settings.surface.iter().any(|surface| parts.contains(&surface.name))
                || settings.light.iter().any(|light| parts.contains(&light.name))
        };
        let is_bare = settings.surface.is_empty()
            && settings.light.is_empty()
            && settings.environment == EnvironmentSettings::default();
        Self::iter().find(is_named).or(is_bare.then_some(Self::Black))
    }

    /// Puts a scene whose volumes fill `bounds` in these surroundings, in place of its environment
    /// and of other setups.
    pub fn apply(self, settings: &mut Settings, bounds: &Aabb) {
        let parts: Vec<String> =
            Self::iter().flat_map(|setup| [setup.part(FLOOR), setup.part(LIGHT)]).collect();
        settings.surface.retain(|surface| !parts.contains(&surface.name));
        settings.light.retain(|light| !parts.contains(&light.name));
        settings.environment = EnvironmentSettings::default();
        let glows = settings.volume.iter().any(|one| one.emission.mode != EmissionMode::None);
        let look = self.look(glows);
        if look.key != Rgb::ZERO {
            settings.light.push(self.key(&look));
        }
        if self != Self::Black {
            settings.environment.gradient =
                Some([look.horizon, look.horizon, look.top].map(|c| Color::Rgb(c.to_array())));
            settings.surface.push(self.floor(&look, bounds));
        }
    }

    fn look(self, glows: bool) -> Look {
        let gray = Rgb::splat;
        let blue = Rgb::new(0.55, 0.75, 1.2);
        match (self, glows) {
            (Self::Studio, true) => {
                Look { horizon: gray(0.045), top: gray(0.12), key: gray(0.12), angle: 20.0 }
            }
            (Self::Studio, false) => {
                Look { horizon: gray(0.17), top: gray(0.5), key: gray(2.4), angle: 20.0 }
            }
            (Self::Night, true) => {
                Look { horizon: 0.006 * blue, top: 0.015 * blue, key: 0.1 * blue, angle: 2.0 }
            }
            (Self::Night, false) => {
                Look { horizon: 0.016 * blue, top: 0.04 * blue, key: 0.5 * blue, angle: 2.0 }
            }
            (Self::Black, true) => {
                Look { horizon: Rgb::ZERO, top: Rgb::ZERO, key: Rgb::ZERO, angle: 0.0 }
            }
            (Self::Black, false) => {
                Look { horizon: Rgb::ZERO, top: Rgb::ZERO, key: gray(3.0), angle: 20.0 }
            }
        }
    }

    fn key(self, look: &Look) -> LightSettings {
        LightSettings {
            kind: LightKind::Sun,
            name: self.part(LIGHT),
            direction: Some(KEY),
            intensity: Color::Rgb(look.key.to_array()),
            angle: Some(look.angle),
            visible: false,
            ..LightSettings::default()
        }
    }

    /// A floor under `bounds`, as bright as the sky at the horizon where nothing shades it, so that
    /// no line parts them: a (E_sky + E_key cos θ) / π = L_horizon.
    fn floor(self, look: &Look, bounds: &Aabb) -> SurfaceSettings {
        let cos_theta = -Vec3::from(KEY).normalize().z;
        let sky = look.horizon + 2.0 / 3.0 * (look.top - look.horizon);
        let received = sky + look.key * (cos_theta / std::f32::consts::PI);
        let reflectance = (look.horizon / received).clamp(Rgb::ZERO, Rgb::ONE);
        let under = bounds.min.z - GAP * bounds.size().z;
        SurfaceSettings {
            shape: SurfaceShape::Plane,
            name: self.part(FLOOR),
            point: Some([bounds.center().x, bounds.center().y, under]),
            normal: Some([0.0, 0.0, 1.0]),
            material: Some(MaterialSettings {
                kind: MaterialKind::Diffuse,
                reflectance: Some(Color::Rgb(reflectance.to_array())),
                ..MaterialSettings::default()
            }),
            ..SurfaceSettings::default()
        }
    }

    /// Name of a part of the setup, by which it is known.
    fn part(self, what: &str) -> String {
        format!("{self} {what}")
    }
}

const FLOOR: &str = "floor";
const LIGHT: &str = "key";

#[cfg(test)]
mod tests {
    use glam::Vec3A;

    use super::*;
    use crate::scene::settings::VolumeSettings;

    const BOUNDS: Aabb = Aabb { min: Vec3A::new(-1.0, -2.0, 0.5), max: Vec3A::new(1.0, 2.0, 2.5) };

    fn bare(mode: EmissionMode) -> Settings {
        let mut volume = VolumeSettings::default();
        volume.emission.mode = mode;
        Settings { volume: vec![volume], ..Settings::default() }
    }

    /// The light that the floor sends back is that of the horizon, whatever the setup: a Lambertian
    /// floor under the sky L(s) = h + s (t - h), s the sine of the elevation, and a key light.
    #[test]
    fn the_floor_falls_away_into_the_sky() {
        for (setup, mode) in [Setup::Studio, Setup::Night]
            .into_iter()
            .flat_map(|setup| [EmissionMode::None, EmissionMode::Blackbody].map(|m| (setup, m)))
        {
            let mut settings = bare(mode);
            setup.apply(&mut settings, &BOUNDS);
            let [bottom, horizon, top] = settings.environment.gradient.unwrap().map(|c| c.rgb());
            let steps = 10_000;
            let sky: Rgb = (0..steps)
                .map(|n| (n as f32 + 0.5) / steps as f32)
                .map(|s| std::f32::consts::TAU / steps as f32 * s * (horizon + s * (top - horizon)))
                .sum();
            let key = &settings.light[0];
            let down = -Vec3::from(key.direction()).normalize().z;
            let material = settings.surface[0].material.unwrap();
            let reflectance = material.reflectance().rgb();
            let sent = reflectance * (sky + key.intensity.rgb() * down) / std::f32::consts::PI;
            assert!((sent / horizon - Rgb::ONE).abs().max_element() < 1e-3, "{sent} {horizon}");
            assert!(bottom == horizon && reflectance.max_element() < 0.9, "{reflectance}");
            let floor = settings.surface[0].point()[2];
            assert!(floor < 0.5 && floor > 0.4, "{floor}");
        }
    }

    #[test]
    fn a_setup_takes_the_place_of_another_and_leaves_the_rest() {
        let mut settings = bare(EmissionMode::None);
        let own = SurfaceSettings { radius: Some(3.0), ..SurfaceSettings::default() };
        assert_eq!(Setup::of(&settings), Some(Setup::Black));
        settings.surface.push(own.clone());
        assert_eq!(Setup::of(&settings), None);
        let mut setup = Setup::Black;
        for _ in Setup::iter() {
            setup = setup.next();
            setup.apply(&mut settings, &BOUNDS);
            assert_eq!(Setup::of(&settings), Some(setup));
            assert_eq!(settings.surface.iter().filter(|surface| **surface == own).count(), 1);
            assert!(settings.light.len() == 1 && settings.surface.len() <= 2);
        }
        assert_eq!(setup, Setup::Black, "around once");
        assert_eq!("night".parse(), Ok(Setup::Night));
        assert!("day".parse::<Setup>().is_err());
    }
}
