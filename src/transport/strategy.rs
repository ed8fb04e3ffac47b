//! The sampling strategy: one struct is the scene file's `[strategy]`, the command line's
//! `--preset` and `--set strategy.*`, the header of a snapshot and the window's toggles.
//!
//! Every combination converges to the same picture; only noise and cost change. The doc comments
//! of the fields are the help that artists read.

use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};

/// Which sampling strategies are on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(transform = add_preset_key)]
pub struct Strategy {
    /// Collect the fire's glow at every step through the volume instead of only where a path is
    /// absorbed. Less noise wherever fire is thin. Ratio tracking replaces it when both are on.
    pub emission_decoupling: bool,
    /// Give the fire's glow a walk of its own that never stops at smoke, so that fire is seen all
    /// along the ray. Much less noise for fire in or behind smoke, for one extra walk per bounce.
    pub emission_ratio_tracking: bool,
    /// Take more steps where the fire is bright, even if there is hardly any smoke there. Much
    /// less noise in bright thin flames; costs steps inside the fire only.
    pub majorant_boost: bool,
    /// The finer choices behind the toggles.
    pub advanced: Advanced,
}

/// The finer choices behind the toggles of [`Strategy`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Advanced {
    /// How far the majorant boost may go. `clamped` never takes steps much shorter than a voxel;
    /// `literal` has no such limit, as the talk states it.
    pub boost_mode: BoostMode,
    /// Extra steps that the majorant boost takes along the brightest line through the volume.
    /// More steps, less noise; 0 boosts nothing.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub boost_amount: f32,
    /// With `boost_mode = "clamped"`: the shortest boosted step, counted in voxels.
    #[schemars(range(min = 0.01, max = 1000.0), extend("unit" = "voxels"))]
    pub boost_clamp_voxels: f32,
}

/// How the majorant boost is limited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BoostMode {
    /// The boosted majorant never asks for steps shorter than `boost_clamp_voxels`.
    #[default]
    Clamped,
    /// The talk's maximum of the two majorants, without the clamp.
    Literal,
}

/// A named set of toggles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Every strategy off.
    Baseline,
    /// The strategies for emission on.
    Emission,
    /// Every strategy on.
    #[default]
    Full,
}

/// Keys of `[strategy]` that the scene format knows but whose strategy is not there yet. They are
/// refused with a message that says so, which is another message than for a misspelled key.
pub const PLANNED_KEYS: &[&str] = &[
    "nee",
    "probe_mis",
    "integrator",
    "advanced.nee_evaluation",
    "advanced.light_selection",
    "advanced.distance",
    "advanced.probe_count",
    "advanced.probe_learning",
    "advanced.guide_all_vertices",
    "advanced.scatter_probability",
    "advanced.equiangular",
    "advanced.transmittance",
    "advanced.tracker",
    "advanced.integrator",
];

/// Values of `advanced.boost_mode` that the scene format knows but that are not there yet.
pub const PLANNED_BOOST_MODES: &[&str] = &["optimal", "stratified"];

impl Strategy {
    /// The preset whose toggles these are, whatever the advanced choices; the fuller one where
    /// two presets coincide.
    pub fn preset(&self) -> Option<Preset> {
        [Preset::Full, Preset::Emission, Preset::Baseline]
            .into_iter()
            .find(|preset| Self { advanced: self.advanced, ..preset.strategy() } == *self)
    }
}

impl Default for Strategy {
    fn default() -> Self {
        Preset::Full.strategy()
    }
}

impl Default for Advanced {
    fn default() -> Self {
        Self { boost_mode: BoostMode::default(), boost_amount: 1.0, boost_clamp_voxels: 1.0 }
    }
}

impl Preset {
    /// Every preset, the default last.
    pub const ALL: [Self; 3] = [Self::Baseline, Self::Emission, Self::Full];

    /// The toggles of this preset with default advanced choices.
    pub fn strategy(self) -> Strategy {
        let on = self != Self::Baseline;
        Strategy {
            emission_decoupling: on,
            emission_ratio_tracking: on,
            majorant_boost: on,
            advanced: Advanced::default(),
        }
    }

    /// The name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Emission => "emission",
            Self::Full => "full",
        }
    }
}

impl std::str::FromStr for Preset {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|preset| preset.name() == name).ok_or_else(|| {
            format!("there is no preset \"{name}\"; use \"baseline\", \"emission\" or \"full\"")
        })
    }
}

impl std::fmt::Display for Preset {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// `preset` is a key of the file that no field holds: it sets the toggles that the file leaves out.
fn add_preset_key(schema: &mut Schema) {
    let key = serde_json::json!({
        "description": "The toggles to start from; those written beside it override it.",
        "type": "string",
        "enum": Preset::ALL.map(Preset::name),
        "default": Preset::default().name(),
    });
    if let Some(properties) = schema.get_mut("properties").and_then(|p| p.as_object_mut()) {
        properties.insert("preset".to_owned(), key);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_recognized_whatever_the_advanced_choices() {
        let mut strategy = Preset::Baseline.strategy();
        strategy.advanced.boost_amount = 3.0;
        assert_eq!(strategy.preset(), Some(Preset::Baseline));
        strategy.majorant_boost = true;
        assert_eq!(strategy.preset(), None);
        assert_eq!(Strategy::default().preset(), Some(Preset::Full));
    }

    #[test]
    fn names_parse_back() {
        for preset in Preset::ALL {
            assert_eq!(preset.name().parse(), Ok(preset));
            let json = serde_json::to_value(preset).unwrap();
            assert_eq!(json, preset.name());
        }
        assert!("ful".parse::<Preset>().unwrap_err().contains("\"full\""));
    }
}
