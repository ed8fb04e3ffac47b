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
    /// Collect the fire's emission at every tracking step instead of only where a path is absorbed.
    /// Less noise wherever fire is thin. Ratio tracking replaces it when both are on.
    pub emission_decoupling: bool,
    /// Collect the fire's emission by a ratio-tracking walk of its own that smoke never stops, so
    /// that fire is seen all along the ray. Much less noise for fire in or behind smoke, at the
    /// cost of one extra walk per bounce.
    pub emission_ratio_tracking: bool,
    /// Take more tracking steps where the fire is bright, even if there is hardly any smoke. Much
    /// less noise in bright thin flames; the extra steps are inside the fire only.
    pub majorant_boost: bool,
    /// Treat burning volumes as lights: at every bounce, sample the fire directly as well
    /// (next-event estimation, combined by MIS). Much less noise wherever fire lights smoke, floors
    /// or walls.
    pub nee: bool,
    /// Guide paths to scatter where the light is: probes placed through the smoke estimate how
    /// brightly it is lit. Paths that promise much light are split, others end by Russian roulette.
    /// Much less noise for torches in mist and other lights inside thin smoke.
    pub probe_mis: bool,
    /// How light transport is computed. `path` is path tracing, unbiased whatever else is set;
    /// `march` is ray marching, the old system, kept for comparison: its pictures are biased, and
    /// stay so however long they render. It collects emission at every step and scatters by a table
    /// of its own, so that decoupling, ratio tracking, the boost, the probes and their advanced
    /// settings have no effect with it. All other keys keep their meaning.
    pub integrator: Integrator,
    /// The advanced settings behind the toggles.
    pub advanced: Advanced,
}

/// The advanced settings behind the toggles of [`Strategy`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Advanced {
    /// How the majorant boost places its steps. `stratified` spreads them evenly along the ray and
    /// estimates the transmittance to them separately; `optimal` places them where they reduce
    /// noise most; `clamped` takes more where the fire is bright, never much shorter than a voxel;
    /// `literal` is the same without that limit, as in the talk. The first two are walks of their
    /// own; decoupling without ratio tracking uses `clamped` in their place.
    pub boost_mode: BoostMode,
    /// Extra steps that the majorant boost takes along the brightest line through the volume. More
    /// steps give less noise; 0 is no boost. With `boost_mode = "optimal"` the most efficient
    /// number is found before the render starts: 32 then takes that number, 64 twice as many.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub boost_amount: f32,
    /// With `boost_mode = "clamped"`, or where that is used in place of another mode: the shortest
    /// boosted step, in voxels.
    #[schemars(range(min = 0.01, max = 1000.0), extend("unit" = "voxels"))]
    pub boost_clamp_voxels: f32,
    /// How next-event estimation samples the fire. `line` collects emission all along the shadow
    /// ray; `point` evaluates one point, which is cheaper and noisier. Unbounded glowing fog always
    /// uses `line`.
    pub nee_evaluation: NeeEvaluation,
    /// How next-event estimation selects a light. `hierarchy` (a light tree) prefers bright and
    /// near lights; `uniform` selects every light with the same probability; `probes` prefers
    /// lights that probes in the smoke see as bright, which takes longer to prepare, also with the
    /// toggle off. Where nothing scatters there are no probes, and `hierarchy` is used.
    pub light_selection: LightSelection,
    /// With the probes on: how the distance to the first scattering event of a camera ray is
    /// sampled. `mis` combines probe guiding and null-collision sampling by MIS, so that it is good
    /// wherever one of them is; `probes` uses probe guiding alone, `null` null-collision sampling
    /// alone.
    pub distance: Distance,
    /// With `integrator = "march"`: the step length. Shorter steps have less bias. In volumes
    /// without voxels a majorant cell counts as four.
    #[schemars(range(min = 0.05, max = 100.0), extend("unit" = "voxels"))]
    pub march_step: f32,
    /// With the probes on: how often camera rays are made to scatter. `light` lets rays scatter
    /// more often where more light is scattered towards the camera: much less noise around lamps
    /// and fires, for more time there. `even` treats all rays about equally.
    pub scatter_probability: ScatterProbability,
    /// How shadow rays estimate transmittance. `marching` is unbiased ray marching with evenly
    /// spread samples; `residual` is residual ratio tracking against the local minimum; `ratio` is
    /// ratio tracking. All three are unbiased.
    pub transmittance: TransmittanceEstimator,
    /// How light at the end of a ray - the environment, lamps in view - is collected. `arrival`
    /// waits for a path to get there; `transmittance` collects it along every ray, through the
    /// transmittance of all smoke on the way; `learned` finds out in a pilot pass which of the two
    /// has less noise for its time, for camera rays and for later ones. Where fire is rendered
    /// without ratio tracking, `learned` is `arrival`.
    pub ray_end: RayEnd,
    /// How null-collision sampling draws distances. `delta` is delta tracking: it reads the density
    /// at each step; `decomposition` is decomposition tracking: it skips reads below the local
    /// minimum, but needs ratio tracking for emission and excludes the probes; `spectral` is
    /// spectral tracking: it draws collisions in colored smoke regardless of the path's color, with
    /// more noise. The last two are for comparison.
    pub tracker: Tracker,
    /// The approximate number of light probes. More probes resolve the light better and take longer
    /// to place.
    #[schemars(range(min = 64, max = 1_000_000))]
    pub probe_count: u32,
    /// With the probes on: let them learn indirect light, scattered or reflected, from a few paths
    /// before the render starts. Takes longer to prepare.
    pub probe_learning: bool,
    /// With the probes on: find out in a pilot pass, before the second sample, how often guiding is
    /// worth its cost in this shot, and switch it off where it gains nothing. Without it, the
    /// probes guide as often as they propose.
    pub share_learning: bool,
    /// Use the probes at the first bounces as well, not only along camera rays.
    pub guide_all_vertices: bool,
    /// With the probes on: also use equiangular sampling, towards the point that light comes from.
    /// Resolves the light around lamps and fires that are closer to the ray than the probes are
    /// apart.
    pub equiangular: bool,
    /// With the probes on: also guide the direction of scattered paths towards the light scattered
    /// around lamps and fires.
    pub guide_directions: bool,
    /// With the probes on: also guide paths to metals that reflect light into the smoke, found by
    /// photons traced before the render starts. Resolves volume caustics, and costs nothing where
    /// there are none.
    pub guide_caustics: bool,
    /// Use low-discrepancy samples instead of independent random ones. Less noise at no cost; off
    /// for comparison.
    pub low_discrepancy: bool,
}

/// How light is followed through volumes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Path tracing with the strategies that are on: unbiased.
    #[default]
    Path,
    /// Ray marching, the old system: biased, for comparison.
    March,
}

/// How the majorant boost places its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BoostMode {
    /// Spreads the steps evenly along the fire and estimates the transmittance to them separately.
    #[default]
    Stratified,
    /// Places the steps where they reduce noise most for their cost.
    Optimal,
    /// Takes more steps where the fire is bright, none much shorter than a voxel.
    Clamped,
    /// Takes as many steps as the brightness asks for, without that limit, as in the talk.
    Literal,
}

/// How next-event estimation evaluates a volume as a light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NeeEvaluation {
    /// Collects emission all along the shadow ray. Less noise per sample.
    #[default]
    Line,
    /// Evaluates the emission at one point. Cheaper, and noisier in and near the fire.
    Point,
}

/// How next-event estimation selects a light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LightSelection {
    /// Prefers lights that are bright, near and in front. Best with many lights.
    #[default]
    Hierarchy,
    /// Selects each light with the same probability, however weak or far.
    Uniform,
    /// Prefers lights that are visible from nearby probes. Less noise where walls hide the others.
    Probes,
}

/// How the distance to a scattering event is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distance {
    /// Probe guiding and null-collision sampling, combined by MIS.
    #[default]
    Mis,
    /// Probe guiding alone.
    Probes,
    /// Null-collision sampling alone.
    Null,
}

/// How often camera rays are made to scatter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ScatterProbability {
    /// More often where more light is scattered towards the camera.
    #[default]
    Light,
    /// About equally often.
    Even,
}

/// How shadow rays estimate transmittance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TransmittanceEstimator {
    /// Unbiased ray marching: reads the density at evenly spread places.
    #[default]
    Marching,
    /// Residual ratio tracking: reads the density at random where it exceeds the local minimum.
    Residual,
    /// Ratio tracking: reads the density at random places.
    Ratio,
}

/// How light at the end of a ray is collected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RayEnd {
    /// In the way that has less noise for its time, as a pilot pass finds out.
    #[default]
    Learned,
    /// Where a path gets there.
    Arrival,
    /// Along every ray, through the transmittance of what is in front of it.
    Transmittance,
}

/// How null-collision sampling draws distances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Tracker {
    /// Delta tracking: reads the density at each step and weighs colors by the path.
    #[default]
    Delta,
    /// Decomposition tracking: skips reads below the local minimum of the density.
    Decomposition,
    /// Spectral tracking: reads the density at each step, regardless of the path's color.
    Spectral,
}

/// A named set of toggles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// All strategies off.
    Baseline,
    /// The strategies for emission on.
    Emission,
    /// All strategies on.
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

    /// This strategy with the toggles of a preset; the integrator and the advanced choices stay.
    pub fn with_toggles_of(&self, preset: Preset) -> Self {
        Self { integrator: self.integrator, advanced: self.advanced, ..preset.strategy() }
    }

    /// Whether the emission is gathered all along a ray, wherever it scatters, and with it the
    /// transmittance of the ray.
    pub fn gathers_whole_rays(&self) -> bool {
        self.emission_ratio_tracking || self.marches()
    }

    /// Whether rays are marched, in place of all tracking.
    pub fn marches(&self) -> bool {
        self.integrator == Integrator::March
    }

    /// Whether the picture converges to a biased result, however many samples it has: with ray
    /// marching.
    pub fn is_biased(&self) -> bool {
        self.marches()
    }

    /// Reason why the tracker cannot be combined with the rest, and how to fix that; `None` where
    /// it can.
    pub fn tracker_refusal(&self) -> Option<&'static str> {
        self.refusal_of(self.advanced.tracker)
    }

    /// [`Strategy::tracker_refusal`] for `tracker` in place of the strategy's own.
    pub fn refusal_of(&self, tracker: Tracker) -> Option<&'static str> {
        if tracker != Tracker::Decomposition || self.marches() {
            return None;
        }
        if self.probe_mis && self.advanced.distance != Distance::Null {
            return Some(
                "decomposition tracking scatters without reading the medium there, so the probes \
                 cannot weight its distances; turn the probes off (probe_mis = false) or use \
                 null-collision sampling alone (distance = \"null\")",
            );
        }
        if !self.emission_ratio_tracking {
            return Some(
                "decomposition tracking leaves most of the medium unread, so it cannot collect \
                 emission on the way; turn ratio tracking on (emission_ratio_tracking = true) or \
                 set tracker = \"delta\"",
            );
        }
        None
    }

    /// Whether a pilot pass decides the number of guided flights; only where null-collision
    /// sampling is an alternative.
    pub fn learns_share(&self) -> bool {
        self.guides() && self.advanced.share_learning && self.advanced.distance == Distance::Mis
    }

    /// Whether probes guide scattering.
    pub fn guides(&self) -> bool {
        self.probe_mis && self.advanced.distance != Distance::Null && !self.marches()
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
            ray_end: RayEnd::default(),
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
        "description": "The toggles to start from; toggles that are set beside it override it.",
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
