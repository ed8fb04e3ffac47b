//! Which toggles change nothing in the scene at hand, and why.

use crate::scene::Settings;
use crate::scene::settings::{Albedo, EmissionMode, VolumeSettings};

/// A toggle of the strategy panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toggle {
    /// `emission_decoupling`.
    EmissionDecoupling,
    /// `emission_ratio_tracking`.
    EmissionRatioTracking,
    /// `majorant_boost`.
    MajorantBoost,
}

/// Why `toggle` makes no difference to noise or cost in this scene; `None` where it does.
pub fn no_effect(toggle: Toggle, settings: &Settings) -> Option<&'static str> {
    let strategy = &settings.strategy;
    if !settings.volume.iter().any(emits) {
        return Some("no volume in this scene emits light.");
    }
    match toggle {
        Toggle::EmissionRatioTracking => None,
        Toggle::EmissionDecoupling if strategy.emission_ratio_tracking => {
            Some("ratio tracking already collects the glow, in a walk of its own.")
        }
        Toggle::EmissionDecoupling => None,
        Toggle::MajorantBoost if strategy.advanced.boost_amount <= 0.0 => {
            Some("the boost amount is 0.")
        }
        Toggle::MajorantBoost
            if !strategy.emission_decoupling && !strategy.emission_ratio_tracking =>
        {
            Some("it needs decoupling or ratio tracking, which read the glow at every step.")
        }
        Toggle::MajorantBoost => None,
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
            let glows = |stop: &[f32; 4]| stop[1..].iter().any(|&value| value > 0.0);
            emission.intensity() > 0.0 && emission.stops().iter().any(glows)
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
        for toggle in
            [Toggle::EmissionDecoupling, Toggle::EmissionRatioTracking, Toggle::MajorantBoost]
        {
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
