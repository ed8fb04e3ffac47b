//! Toggles that change nothing in the scene at hand, each with the reason.

use crate::scene::Settings;
use crate::scene::settings::{
    Albedo, EmissionMode, MaterialKind, MaterialSettings, SurfaceSettings, VolumeSettings,
};
use crate::transport::strategy::{Distance, NeeEvaluation, Strategy};
use crate::transport::toggle::Toggle;

/// Reason why most toggles are idle with ray marching.
const MARCHING: &str =
    "ray marching (Advanced) collects emission and samples distances in its own way.";

/// Reason why `toggle` makes no difference to noise or cost in this scene; `None` where it does.
pub fn no_effect(toggle: Toggle, settings: &Settings) -> Option<&'static str> {
    let strategy = &settings.strategy;
    if strategy.marches() && toggle != Toggle::FireAsLight {
        return Some(MARCHING);
    }
    if toggle == Toggle::LightProbes {
        return probes_without_effect(settings);
    }
    if !settings.volume.iter().any(emits) {
        return Some("no volume in this scene emits light.");
    }
    match toggle {
        Toggle::EmissionRatioTracking => None,
        Toggle::EmissionDecoupling if strategy.emission_ratio_tracking => {
            Some("ratio tracking already collects the emission, by a walk of its own.")
        }
        Toggle::EmissionDecoupling => None,
        Toggle::MajorantBoost if strategy.advanced.boost_amount <= 0.0 => {
            Some("the boost amount is 0.")
        }
        Toggle::MajorantBoost if !reads_emission_in_steps(settings) => Some(
            "it needs decoupling, ratio tracking or fire as a light (line), which collect emission \
             at every step.",
        ),
        Toggle::MajorantBoost => None,
        Toggle::FireAsLight if !turns_light(settings) => {
            Some("nothing in this scene scatters or reflects light, so fire is only seen directly.")
        }
        Toggle::FireAsLight | Toggle::LightProbes => None,
    }
}

/// [`no_effect`] if the scene had another strategy.
pub fn no_effect_with(
    toggle: Toggle,
    settings: &Settings,
    strategy: &Strategy,
) -> Option<&'static str> {
    no_effect(toggle, &Settings { strategy: *strategy, ..settings.clone() })
}

fn probes_without_effect(settings: &Settings) -> Option<&'static str> {
    if settings.strategy.advanced.distance == Distance::Null {
        Some("distances are drawn by null-collision sampling alone (Advanced).")
    } else if !settings.volume.iter().any(scatters) {
        Some("no volume in this scene scatters light.")
    } else {
        None
    }
}

/// Whether some walk reads emission at every step, which is what the boost adds steps to.
fn reads_emission_in_steps(settings: &Settings) -> bool {
    let strategy = &settings.strategy;
    strategy.emission_decoupling
        || strategy.emission_ratio_tracking
        || (strategy.nee
            && strategy.advanced.nee_evaluation == NeeEvaluation::Line
            && turns_light(settings))
}

/// Whether light can change its direction: only there does a path sample lights.
fn turns_light(settings: &Settings) -> bool {
    settings.volume.iter().any(scatters) || settings.surface.iter().any(reflects)
}

fn scatters(volume: &VolumeSettings) -> bool {
    let albedo_is_black = match &volume.albedo {
        Albedo::Gray(value) => *value <= 0.0,
        Albedo::Rgb(rgb) => rgb.iter().all(|&value| value <= 0.0),
        Albedo::Grid(_) => false,
    };
    !albedo_is_black && !volume.density.scale.is_black()
}

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
pub fn emits(volume: &VolumeSettings) -> bool {
    let emission = &volume.emission;
    match emission.mode {
        EmissionMode::None => false,
        EmissionMode::Grid => emission.scale() > 0.0 && !emission.color().is_black(),
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
    use crate::transport::strategy::{Integrator, Preset};

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
    fn each_toggle_knows_which_other_one_it_depends_on() {
        let mut settings = scene(EmissionMode::Constant, Preset::Baseline);
        assert_eq!(no_effect(Toggle::EmissionDecoupling, &settings), None);
        assert!(no_effect(Toggle::MajorantBoost, &settings).unwrap().contains("needs"));
        settings.strategy.emission_ratio_tracking = true;
        assert!(no_effect(Toggle::EmissionDecoupling, &settings).unwrap().contains("ratio"));
        assert_eq!(no_effect(Toggle::MajorantBoost, &settings), None);
        settings.strategy.advanced.boost_amount = 0.0;
        assert!(no_effect(Toggle::MajorantBoost, &settings).is_some());
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
    fn looking_at_the_fire_along_a_line_is_a_walk_to_boost() {
        let mut settings = scene(EmissionMode::Constant, Preset::Baseline);
        settings.volume[0].albedo = Albedo::Gray(0.3);
        let idle = |settings: &Settings| no_effect(Toggle::MajorantBoost, settings).is_some();
        assert!(idle(&settings));
        settings.strategy.nee = true;
        assert!(!idle(&settings));
        settings.strategy.advanced.nee_evaluation = NeeEvaluation::Point;
        assert!(idle(&settings));
        settings.strategy.advanced.nee_evaluation = NeeEvaluation::Line;
        settings.volume[0].albedo = Albedo::Gray(0.0);
        assert!(idle(&settings), "nothing here looks at the fire");
    }

    #[test]
    fn ray_marching_leaves_fire_as_a_light_alone() {
        let mut settings = scene(EmissionMode::Constant, Preset::Full);
        settings.volume[0].albedo = Albedo::Gray(0.3);
        settings.strategy.integrator = Integrator::March;
        for toggle in [
            Toggle::EmissionDecoupling,
            Toggle::EmissionRatioTracking,
            Toggle::MajorantBoost,
            Toggle::LightProbes,
        ] {
            assert!(no_effect(toggle, &settings).unwrap().contains("ray marching"), "{toggle:?}");
        }
        assert_eq!(no_effect(Toggle::FireAsLight, &settings), None);
        settings.volume[0].albedo = Albedo::Gray(0.0);
        assert!(no_effect(Toggle::FireAsLight, &settings).is_some());
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
