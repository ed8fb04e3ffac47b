//! The part of a strategy that acts in a scene.
//!
//! A toggle that changes nothing there is idle, and has one position whatever its setting: two
//! strategies that differ in idle toggles only have the same effective strategy, and so the same
//! paths, bit for bit. That is how "no effect here" is true where the window says so.

use super::strategy::{Distance, NeeEvaluation, Strategy};
use super::toggle::Toggle;

/// Reason why most toggles are idle with ray marching.
const MARCHING: &str =
    "ray marching (Advanced) collects emission and samples distances in its own way.";

/// Properties of a scene that decide which toggles have an effect in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneFacts {
    /// Whether any volume emits light.
    pub emits: bool,
    /// Whether any volume without borders emits light. Such a volume is not sampled as a light.
    pub emits_without_borders: bool,
    /// Whether any volume scatters light.
    pub scatters: bool,
    /// Whether any surface reflects light.
    pub reflects: bool,
}

impl SceneFacts {
    /// Whether light can change its direction: only there does a path sample lights.
    fn turns_light(self) -> bool {
        self.scatters || self.reflects
    }
}

impl Toggle {
    /// Reason why the toggle changes neither noise nor cost beside the rest of `strategy`; `None`
    /// where it may.
    pub fn idle(self, strategy: &Strategy, facts: SceneFacts) -> Option<&'static str> {
        if strategy.marches() && self != Self::FireAsLight {
            return Some(MARCHING);
        }
        if self == Self::LightProbes {
            return probes_idle(strategy, facts);
        }
        if !facts.emits {
            return Some("no volume in this scene emits light.");
        }
        match self {
            Self::EmissionDecoupling if strategy.emission_ratio_tracking => {
                Some("ratio tracking already collects the emission, by a walk of its own.")
            }
            Self::MajorantBoost if strategy.advanced.boost_amount <= 0.0 => {
                Some("the boost amount is 0.")
            }
            Self::MajorantBoost if !reads_emission_in_steps(strategy, facts) => Some(
                "it needs decoupling, ratio tracking or fire as a light (line), which collect \
                 emission at every step.",
            ),
            Self::FireAsLight if !facts.turns_light() => Some(
                "nothing in this scene scatters or reflects light, so fire is only seen directly.",
            ),
            _ => None,
        }
    }

    /// The position of the toggle where it is idle. Without fire, the emission is nobody's
    /// business: as with ratio tracking, the scattering walk does not stop for it.
    fn idle_position(self, strategy: &Strategy, facts: SceneFacts) -> bool {
        self == Self::EmissionRatioTracking && !facts.emits && !strategy.marches()
    }
}

impl Strategy {
    /// The strategy with every idle toggle in its one position.
    pub fn effective(&self, facts: SceneFacts) -> Self {
        let idle = Toggle::all().filter(|toggle| toggle.idle(self, facts).is_some());
        idle.fold(*self, |effective, toggle| {
            toggle.set(&effective, toggle.idle_position(self, facts))
        })
    }
}

fn probes_idle(strategy: &Strategy, facts: SceneFacts) -> Option<&'static str> {
    if strategy.advanced.distance == Distance::Null {
        Some("distances are drawn by null-collision sampling alone (Advanced).")
    } else if !facts.scatters {
        Some("no volume in this scene scatters light.")
    } else {
        None
    }
}

/// Whether some walk reads emission at every step, which is what the boost adds steps to.
fn reads_emission_in_steps(strategy: &Strategy, facts: SceneFacts) -> bool {
    let samples_lines =
        strategy.advanced.nee_evaluation == NeeEvaluation::Line || facts.emits_without_borders;
    strategy.emission_decoupling
        || strategy.emission_ratio_tracking
        || (strategy.nee && samples_lines && facts.turns_light())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::strategy::{Advanced, Integrator, Preset};

    const FIRE: SceneFacts =
        SceneFacts { emits: true, emits_without_borders: false, scatters: true, reflects: true };

    fn combinations() -> impl Iterator<Item = Strategy> {
        (0..32).map(|bits: u32| {
            Toggle::all().enumerate().fold(Strategy::default(), |strategy, (index, toggle)| {
                toggle.set(&strategy, bits >> index & 1 == 1)
            })
        })
    }

    /// Whatever else is set, an idle toggle has no part in the effective strategy, and an effective
    /// strategy is its own.
    #[test]
    fn idle_toggles_have_one_position() {
        let facts = (0..16).map(|bits: u32| {
            let [emits, emits_without_borders, scatters, reflects] =
                [0, 1, 2, 3].map(|bit| bits >> bit & 1 == 1);
            SceneFacts { emits, emits_without_borders, scatters, reflects }
        });
        for facts in facts {
            for set in combinations() {
                for integrator in [Integrator::Path, Integrator::March] {
                    let strategy = Strategy { integrator, ..set };
                    let effective = strategy.effective(facts);
                    assert_eq!(effective.effective(facts), effective, "{facts:?} {strategy:?}");
                    for toggle in Toggle::all() {
                        let [on, off] = [true, false].map(|on| toggle.set(&strategy, on));
                        let [idle_on, idle_off] =
                            [&on, &off].map(|strategy| toggle.idle(strategy, facts).is_some());
                        assert_eq!(idle_on, idle_off, "{toggle:?} {facts:?} {strategy:?}");
                        let same = on.effective(facts) == off.effective(facts);
                        assert_eq!(idle_on, same, "{toggle:?} {facts:?} {strategy:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn without_fire_all_emission_toggles_are_one_strategy() {
        let smoke = SceneFacts { emits: false, ..FIRE };
        let probes = [true, false];
        for probe_mis in probes {
            let mut effective = combinations()
                .filter(|strategy| strategy.probe_mis == probe_mis)
                .map(|strategy| strategy.effective(smoke));
            let first = effective.next().unwrap();
            assert!(effective.all(|other| other == first));
            assert_eq!(first.probe_mis, probe_mis);
        }
    }

    #[test]
    fn each_toggle_knows_which_other_one_it_depends_on() {
        let idle = |toggle: Toggle, strategy: &Strategy| toggle.idle(strategy, FIRE);
        let mut strategy = Preset::Baseline.strategy();
        assert_eq!(idle(Toggle::EmissionDecoupling, &strategy), None);
        assert!(idle(Toggle::MajorantBoost, &strategy).unwrap().contains("needs"));
        strategy.nee = true;
        assert_eq!(idle(Toggle::MajorantBoost, &strategy), None, "shadow rays read in steps");
        strategy.advanced.nee_evaluation = NeeEvaluation::Point;
        assert!(idle(Toggle::MajorantBoost, &strategy).is_some());
        let endless = SceneFacts { emits_without_borders: true, ..FIRE };
        assert_eq!(Toggle::MajorantBoost.idle(&strategy, endless), None);
        strategy.emission_ratio_tracking = true;
        assert!(idle(Toggle::EmissionDecoupling, &strategy).unwrap().contains("ratio"));
        assert_eq!(idle(Toggle::MajorantBoost, &strategy), None);
        strategy.advanced.boost_amount = 0.0;
        assert!(idle(Toggle::MajorantBoost, &strategy).is_some());
        let advanced = Advanced { distance: Distance::Null, ..Advanced::default() };
        assert!(idle(Toggle::LightProbes, &Strategy { advanced, ..strategy }).is_some());
    }

    #[test]
    fn ray_marching_leaves_fire_as_a_light_alone() {
        let strategy = Strategy { integrator: Integrator::March, ..Strategy::default() };
        let dark = SceneFacts { scatters: false, reflects: false, ..FIRE };
        for toggle in Toggle::all() {
            let is_light = toggle == Toggle::FireAsLight;
            assert_eq!(toggle.idle(&strategy, FIRE).is_none(), is_light, "{toggle:?}");
            assert!(toggle.idle(&strategy, dark).is_some(), "{toggle:?}");
        }
    }
}
