//! The sampling strategy: one struct is the scene file's `[strategy]`, the command line's
//! `--preset` and `--set strategy.*`, the header of a snapshot and the window's toggles.
//!
//! Every combination converges to the same picture, ray marching apart; only noise and cost change.
//! The doc comments of the fields are the help that artists read.

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
    /// Treat burning volumes as lights: at every bounce, look straight at the fire as well as in a
    /// random direction. Much less noise wherever fire lights smoke, floors or walls.
    pub nee: bool,
    /// Scatter where light is: probes spread over the smoke know how bright it is lit and send
    /// paths there, split those that will bring much and end some that won't. Much less noise for
    /// torches in mist and other lights inside of thin smoke.
    pub probe_mis: bool,
    /// How light is followed through volumes. `path` is right on average, whatever else is set;
    /// `march` is ray marching, the old system, kept for comparison: its pictures are biased, and
    /// stay so however long they render. It collects the fire's glow at every step and scatters by
    /// a table of its own, so that decoupling, ratio tracking, the boost, the probes and their finer
    /// choices change nothing with it. All other keys mean what they always do.
    pub integrator: Integrator,
    /// The finer choices behind the toggles.
    pub advanced: Advanced,
}

/// The finer choices behind the toggles of [`Strategy`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Advanced {
    /// How the majorant boost places its steps. `stratified` spreads them evenly along the ray and
    /// measures the smoke in front of them apart; `optimal` takes them where they lower the noise
    /// most; `clamped` takes more where the fire is bright, never much shorter than a voxel;
    /// `literal` is the same without that limit, as the talk states it. The first two are walks of
    /// their own; decoupling without ratio tracking takes `clamped` in their place.
    pub boost_mode: BoostMode,
    /// Extra steps that the majorant boost takes along the brightest line through the volume.
    /// More steps, less noise; 0 boosts nothing. With `boost_mode = "optimal"` the number that pays
    /// best is found before the render starts: there 32 takes as many as were found, 64 twice
    /// that.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub boost_amount: f32,
    /// With `boost_mode = "clamped"` or where that stands in: the shortest boosted step, counted in
    /// voxels.
    #[schemars(range(min = 0.01, max = 1000.0), extend("unit" = "voxels"))]
    pub boost_clamp_voxels: f32,
    /// What a look at the fire brings back. `line` gathers its glow all along the line of sight;
    /// `point` takes one point of it, which is cheaper and noisier; where fog without borders glows,
    /// it is the line all the same.
    pub nee_evaluation: NeeEvaluation,
    /// How a bounce chooses the light it looks at. `hierarchy` prefers what is bright and near;
    /// `uniform` gives every light the same chance; `probes` prefers what is seen to be bright from
    /// probes all over the smoke, whose placing takes longer for that, also with the toggle off.
    /// Where nothing scatters there are none, and the hierarchy chooses.
    pub light_selection: LightSelection,
    /// How far a ray from the camera goes before it scatters, with the probes on. `mis` takes the
    /// distances of the probes and of chance in turn and weighs both, so that it is good wherever
    /// one of them is; `probes` takes those of the probes alone, `null` those of chance alone.
    pub distance: Distance,
    /// With `integrator = "march"`: the length of a step. Shorter steps, less bias; where nothing has
    /// voxels, each cell of the majorants counts as four.
    #[schemars(range(min = 0.05, max = 100.0), extend("unit" = "voxels"))]
    pub march_step: f32,
    /// How often a ray from the camera scatters, with the probes on. `light` makes those scatter
    /// more often into which more light is scattered: much less noise around lamps and fires, for
    /// more time there. `even` gives all rays about the same.
    pub scatter_probability: ScatterProbability,
    /// How much light gets through to where a bounce looks at a lamp. `marching` reads the smoke at
    /// evenly spread places; `residual` reads it at random where it is denser than it is at least
    /// nearby; `ratio` reads it at random. All three are right on average.
    pub transmittance: TransmittanceEstimator,
    /// How the distances of chance are found. `delta` reads the smoke at each step; `decomposition`
    /// does without where the smoke is at least as dense for certain, but needs glow to have its own
    /// walk (ratio tracking) and knows no probes; `spectral` chooses the steps in colored smoke
    /// whatever the color of the path, with more noise. The last two are there for comparison.
    pub tracker: Tracker,
    /// How many probes there are, about. More of them know the light better, and take longer to
    /// place.
    #[schemars(range(min = 64, max = 1_000_000))]
    pub probe_count: u32,
    /// With the probes on: let them learn from a few paths, before the picture begins, what light
    /// comes to them after it has scattered or come off surfaces. Takes longer to prepare.
    pub probe_learning: bool,
    /// With the probes on: find out, before the second sample, how often to ask them in this shot:
    /// as often as pays, down to not at all where they cost more than they bring. Off, they are
    /// asked as often as they propose.
    pub share_learning: bool,
    /// Ask the probes at the first bounces as well, not only along the rays from the camera.
    pub guide_all_vertices: bool,
    /// With the probes on: also scatter near the point that light comes from, by equal angles of
    /// view. Finds the light around lamps and fires that are nearer to the ray than probes can
    /// tell.
    pub equiangular: bool,
    /// With the probes on: also send paths that have scattered towards the glow around the lights.
    pub guide_directions: bool,
    /// With the probes on: also send paths to metals that throw light into the smoke, by rays that
    /// set out from the metals before the picture begins. Finds the bright bundles of light off
    /// mirrors, and costs nothing where there are none.
    pub guide_caustics: bool,
    /// Spread the samples of a pixel evenly instead of at random. Less noise at no cost; off it
    /// shows what independent samples would bring.
    pub low_discrepancy: bool,
}

/// How light is followed through volumes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// By paths that are right on average, with the strategies that are on.
    #[default]
    Path,
    /// By ray marching, the old system: biased, for comparison.
    March,
}

/// How the majorant boost places its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BoostMode {
    /// Spreads the steps evenly along the fire and measures the smoke in front of them apart.
    #[default]
    Stratified,
    /// Takes the steps where they lower the noise most for what they cost.
    Optimal,
    /// Takes more steps where the fire is bright, but never much shorter ones than a voxel.
    Clamped,
    /// Takes as many as the brightness asks for, as the talk states it, without that limit.
    Literal,
}

/// How a volume seen from a vertex as a light is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NeeEvaluation {
    /// Gathers its glow all along the line of sight. Less noise for each look.
    #[default]
    Line,
    /// Takes its glow at one point. Cheaper, and noisier in and near the fire.
    Point,
}

/// How a vertex chooses among the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LightSelection {
    /// Prefers lights that are bright, near and in front. Best with many lights.
    #[default]
    Hierarchy,
    /// Gives each light the same chance, however weak or far.
    Uniform,
    /// Prefers lights that probes nearby have seen. Less noise where walls hide the others.
    Probes,
}

/// How the distance to a scattering event is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distance {
    /// By probes or by chance, weighed together.
    #[default]
    Mis,
    /// By probes alone.
    Probes,
    /// By chance alone: null-collision tracking.
    Null,
}

/// How often rays from the camera scatter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ScatterProbability {
    /// The more often, the more light is scattered into them.
    #[default]
    Light,
    /// About equally often.
    Even,
}

/// How shadow rays estimate transmittance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TransmittanceEstimator {
    /// Unbiased ray marching: reads the smoke at evenly spread places.
    #[default]
    Marching,
    /// Residual ratio tracking: reads at random what is denser than the thinnest smoke nearby.
    Residual,
    /// Ratio tracking: reads the smoke at random.
    Ratio,
}

/// How the scattering walk draws distances by chance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Tracker {
    /// Reads the smoke at each step and heeds the color of the path.
    #[default]
    Delta,
    /// Does not read it where it is at least as dense for certain.
    Decomposition,
    /// Reads it at each step, whatever the color of the path.
    Spectral,
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

impl Strategy {
    /// The preset whose toggles these are, whatever the integrator and the advanced choices; the
    /// fuller one where two presets coincide.
    pub fn preset(&self) -> Option<Preset> {
        [Preset::Full, Preset::Emission, Preset::Baseline]
            .into_iter()
            .find(|preset| self.with_toggles_of(*preset) == *self)
    }

    /// With the toggles of a preset; the integrator and the advanced choices stay.
    pub fn with_toggles_of(&self, preset: Preset) -> Self {
        Self { integrator: self.integrator, advanced: self.advanced, ..preset.strategy() }
    }

    /// Whether a ray's emission and its end are gathered all along it, wherever it scatters.
    pub fn gathers_whole_rays(&self) -> bool {
        self.emission_ratio_tracking || self.is_biased()
    }

    /// Whether the picture is another one than the right one, however many samples it has.
    pub fn is_biased(&self) -> bool {
        self.integrator == Integrator::March
    }

    /// Why the tracker is refused beside the rest, and how to mend that; `None` where it is not.
    pub fn tracker_refusal(&self) -> Option<&'static str> {
        self.refusal_of(self.advanced.tracker)
    }

    /// [`Strategy::tracker_refusal`] if `tracker` were chosen.
    pub fn refusal_of(&self, tracker: Tracker) -> Option<&'static str> {
        if tracker != Tracker::Decomposition || self.is_biased() {
            return None;
        }
        if self.probe_mis && self.advanced.distance != Distance::Null {
            return Some(
                "decomposition scatters without reading the medium there, so that probes cannot \
                 weigh its distances; turn the probes off (probe_mis = false) or choose distances by \
                 chance alone (distance = \"null\")",
            );
        }
        if !self.emission_ratio_tracking {
            return Some(
                "decomposition passes most of the medium unread, so that it cannot collect glow on \
                 the way; turn ratio tracking on (emission_ratio_tracking = true) or set tracker = \
                 \"delta\"",
            );
        }
        None
    }

    /// Whether a pilot decides how often the probes are asked; not where nothing else is.
    pub fn learns_share(&self) -> bool {
        self.guides() && self.advanced.share_learning && self.advanced.distance == Distance::Mis
    }

    /// Whether probes say where paths scatter.
    pub fn guides(&self) -> bool {
        self.probe_mis && self.advanced.distance != Distance::Null && !self.is_biased()
    }
}

impl Default for Strategy {
    fn default() -> Self {
        Preset::Full.strategy()
    }
}

impl Default for Advanced {
    fn default() -> Self {
        Self {
            boost_mode: BoostMode::default(),
            boost_amount: 32.0,
            boost_clamp_voxels: 1.0,
            nee_evaluation: NeeEvaluation::default(),
            light_selection: LightSelection::default(),
            distance: Distance::default(),
            march_step: 1.0,
            scatter_probability: ScatterProbability::default(),
            transmittance: TransmittanceEstimator::default(),
            tracker: Tracker::default(),
            probe_count: 4096,
            probe_learning: true,
            share_learning: true,
            guide_all_vertices: false,
            equiangular: true,
            guide_directions: true,
            guide_caustics: true,
            low_discrepancy: true,
        }
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
            nee: on,
            probe_mis: self == Self::Full,
            integrator: Integrator::default(),
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
