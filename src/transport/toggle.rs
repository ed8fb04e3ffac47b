//! The toggles of a [`Strategy`], one by one.

use strum::{EnumIter, IntoEnumIterator};

use super::strategy::Strategy;

/// A toggle of the strategy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, EnumIter)]
pub enum Toggle {
    /// `emission_decoupling`.
    #[default]
    EmissionDecoupling,
    /// `emission_ratio_tracking`.
    EmissionRatioTracking,
    /// `majorant_boost`.
    MajorantBoost,
    /// `nee`.
    FireAsLight,
    /// `probe_mis`.
    Probes,
}

impl Toggle {
    /// All toggles, in the order of the strategy.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::iter()
    }

    /// Name of the toggle in the window and in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::EmissionDecoupling => "Emission decoupling",
            Self::EmissionRatioTracking => "Emission ratio tracking",
            Self::MajorantBoost => "Majorant boost",
            Self::FireAsLight => "Fire as a light",
            Self::Probes => "Light probes",
        }
    }

    /// Key of the toggle in scene files.
    pub fn key(self) -> &'static str {
        match self {
            Self::EmissionDecoupling => "strategy.emission_decoupling",
            Self::EmissionRatioTracking => "strategy.emission_ratio_tracking",
            Self::MajorantBoost => "strategy.majorant_boost",
            Self::FireAsLight => "strategy.nee",
            Self::Probes => "strategy.probe_mis",
        }
    }

    /// The field of the toggle in `strategy`.
    pub fn switch(self, strategy: &mut Strategy) -> &mut bool {
        match self {
            Self::EmissionDecoupling => &mut strategy.emission_decoupling,
            Self::EmissionRatioTracking => &mut strategy.emission_ratio_tracking,
            Self::MajorantBoost => &mut strategy.majorant_boost,
            Self::FireAsLight => &mut strategy.nee,
            Self::Probes => &mut strategy.probe_mis,
        }
    }

    /// Whether the toggle is on in `strategy`.
    pub fn is_on(self, strategy: &Strategy) -> bool {
        *self.switch(&mut { *strategy })
    }

    /// `strategy` with the toggle on or off.
    pub fn set(self, strategy: &Strategy, on: bool) -> Strategy {
        let mut set = *strategy;
        *self.switch(&mut set) = on;
        set
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::strategy::Preset;

    /// All toggles set on the baseline give the full preset, and all cleared on the full one the
    /// baseline.
    #[test]
    fn the_toggles_are_all_that_presets_set() {
        let (baseline, full) = (Preset::Baseline.strategy(), Preset::Full.strategy());
        let set = |on: bool, from: Strategy| {
            Toggle::all().fold(from, |strategy, toggle| toggle.set(&strategy, on))
        };
        assert_eq!((set(true, baseline), set(false, full)), (full, baseline));
        for toggle in Toggle::all() {
            assert!(toggle.is_on(&full) && !toggle.is_on(&baseline));
            let key = toggle.key().trim_start_matches("strategy.");
            let json = serde_json::to_value(toggle.set(&baseline, true)).unwrap();
            assert_eq!(json[key], true, "{key}");
        }
    }
}
