//! Toggles that change nothing in the scene at hand, each with the reason.

use crate::scene::Settings;
use crate::scene::settings::{
    Albedo, EmissionMode, MaterialKind, MaterialSettings, SurfaceSettings, VolumeSettings,
    VolumeShape,
};
use crate::transport::effective::SceneFacts;
use crate::transport::strategy::Strategy;
use crate::transport::toggle::Toggle;

/// Reason why `toggle` makes no difference to noise or cost in this scene; `None` where it does.
pub fn no_effect(toggle: Toggle, settings: &Settings) -> Option<&'static str> {
    toggle.idle(&settings.strategy, facts(settings))
}

/// [`no_effect`] if the scene had another strategy.
pub fn no_effect_with(
    toggle: Toggle,
    settings: &Settings,
    strategy: &Strategy,
) -> Option<&'static str> {
    toggle.idle(strategy, facts(settings))
}

/// Properties of the scene of `settings` that decide which toggles have an effect, as far as they
/// can be known before it is built. A property that is false here is false in the built scene.
fn facts(settings: &Settings) -> SceneFacts {
    let volumes = || settings.volume.iter();
    SceneFacts {
        emits: volumes().any(emits),
        emits_without_borders: volumes().any(|volume| emits(volume) && has_no_borders(volume)),
        scatters: volumes().any(scatters),
        reflects: settings.surface.iter().any(reflects),
    }
}

fn has_no_borders(volume: &VolumeSettings) -> bool {
    volume.shape == Some(VolumeShape::Everywhere)
}

fn scatters(volume: &VolumeSettings) -> bool {
    let albedo_is_black = match &volume.albedo {
        Albedo::Gray(value) => *value <= 0.0,
        Albedo::Rgb(rgb) => rgb.iter().all(|&value| value <= 0.0),
        Albedo::Grid(_) => false,
    };
    !albedo_is_black && !volume.density.scale.is_black()
}

/// Whether the surface reflects light.
fn reflects(surface: &SurfaceSettings) -> bool {
    match &surface.material {
        Some(material) => {
            material.kind != MaterialKind::Black && !material.reflectance().is_black()
        }
        None => {
            surface.emission.is_black() && !MaterialSettings::default().reflectance().is_black()
        }
    }
}

/// Whether light comes out of the volume itself.
pub(super) fn emits(volume: &VolumeSettings) -> bool {
    let emission = &volume.emission;
    if emission.color().is_black() {
        return false;
    }
    match emission.mode {
        EmissionMode::None => false,
        EmissionMode::Grid => emission.scale() > 0.0,
        EmissionMode::Constant => !emission.value().is_black(),
        EmissionMode::Source => {
            !emission.le().is_black() && !volume.density.scale.is_black() && absorbs(&volume.albedo)
        }
        EmissionMode::Blackbody => emission.intensity() > 0.0 && emission.kelvin_scale() > 0.0,
        EmissionMode::Ramp => {
            let emits = |stop: &[f32; 4]| stop[1..].iter().any(|&value| value > 0.0);
            emission.intensity() > 0.0 && emission.stops().iter().any(emits)
        }
    }
}

fn absorbs(albedo: &Albedo) -> bool {
    match albedo {
        Albedo::Gray(value) => *value < 1.0,
        Albedo::Rgb(rgb) => rgb.iter().any(|&value| value < 1.0),
        Albedo::Grid(_) => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::settings::Color;
    use crate::transport::strategy::Preset;

    fn scene(mode: EmissionMode, preset: Preset) -> Settings {
        let mut volume = VolumeSettings::default();
        volume.emission.mode = mode;
        Settings { volume: vec![volume], strategy: preset.strategy(), ..Settings::default() }
    }

    #[test]
    fn smoke_alone_makes_every_emission_toggle_idle() {
        let settings = scene(EmissionMode::None, Preset::Full);
        for toggle in [
            Toggle::EmissionDecoupling,
            Toggle::EmissionRatioTracking,
            Toggle::MajorantBoost,
            Toggle::FireAsLight,
        ] {
            assert!(no_effect(toggle, &settings).unwrap().contains("emits"));
        }
    }

    #[test]
    fn fire_as_a_light_needs_something_to_light() {
        let mut settings = scene(EmissionMode::Constant, Preset::Full);
        settings.volume[0].albedo = Albedo::Gray(0.0);
        let idle = |settings: &Settings| no_effect(Toggle::FireAsLight, settings);
        assert!(idle(&settings).unwrap().contains("seen directly"));
        let mut lit = settings.clone();
        lit.volume[0].albedo = Albedo::Gray(0.3);
        assert_eq!(idle(&lit), None);
        lit.volume[0].density.scale = Color::Gray(0.0);
        assert!(idle(&lit).is_some(), "an albedo without density scatters nothing");

        let mut floor = SurfaceSettings::default();
        settings.surface = vec![floor.clone()];
        assert_eq!(idle(&settings), None, "a surface without material is diffuse");
        floor.emission = Color::Gray(1.0);
        settings.surface = vec![floor.clone()];
        assert!(idle(&settings).is_some(), "a lamp without material is black");
        let black = MaterialSettings { kind: MaterialKind::Black, ..Default::default() };
        floor.material = Some(black);
        settings.surface = vec![floor.clone()];
        assert!(idle(&settings).is_some());
        floor.material = Some(MaterialSettings::default());
        settings.surface = vec![floor];
        assert_eq!(idle(&settings), None);
    }

    #[test]
    fn a_source_without_absorption_is_dark() {
        let mut settings = scene(EmissionMode::Source, Preset::Full);
        assert!(emits(&settings.volume[0]));
        settings.volume[0].albedo = Albedo::Gray(1.0);
        assert!(!emits(&settings.volume[0]));
        settings.volume[0].albedo = Albedo::Gray(0.0);
        settings.volume[0].emission.le = Some(Color::Gray(0.0));
        assert!(!emits(&settings.volume[0]));
    }
}
