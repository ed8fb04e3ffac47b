//! The toggles of a [`Strategy`], one by one. A variant is the label of the window as one word.
//!
//! | key in `[strategy]` | label | term of the literature |
//! |---|---|---|
//! | `emission_decoupling` | Emission decoupling | collision estimator of the emission |
//! | `emission_ratio_tracking` | Emission ratio tracking | line integration by ratio tracking |
//! | `majorant_boost` | Majorant boost | importance sampling of the emission |
//! | `nee` | Fire as a light | next-event estimation to emissive volumes, with MIS |
//! | `probe_mis` | Light probes | path guiding with splitting and Russian roulette |

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
    LightProbes,
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
            Self::LightProbes => "Light probes",
        }
    }

    /// Key of the toggle in scene files.
    pub fn key(self) -> &'static str {
        match self {
            Self::EmissionDecoupling => "strategy.emission_decoupling",
            Self::EmissionRatioTracking => "strategy.emission_ratio_tracking",
            Self::MajorantBoost => "strategy.majorant_boost",
            Self::FireAsLight => "strategy.nee",
            Self::LightProbes => "strategy.probe_mis",
        }
    }

    /// The field of the toggle in `strategy`.
    pub fn switch(self, strategy: &mut Strategy) -> &mut bool {
        match self {
            Self::EmissionDecoupling => &mut strategy.emission_decoupling,
            Self::EmissionRatioTracking => &mut strategy.emission_ratio_tracking,
            Self::MajorantBoost => &mut strategy.majorant_boost,
            Self::FireAsLight => &mut strategy.nee,
            Self::LightProbes => &mut strategy.probe_mis,
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
