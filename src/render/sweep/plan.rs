//! Plan of a sweep: every toggle alone and left out, and which of these need not be rendered.

use crate::transport::strategy::{Preset, Strategy};
use crate::transport::toggle::Toggle;

/// Reason why a toggle makes no difference to noise or cost beside the rest of a strategy; `None`
/// where it does.
pub type Idle<'a> = dyn Fn(Toggle, &Strategy) -> Option<&'static str> + 'a;

/// Kind of a trial: baseline, full, one toggle alone or left out, or the strategy as set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrialKind {
    /// Every toggle off.
    Baseline,
    /// Every toggle on.
    Full,
    /// One toggle on.
    Alone(Toggle),
    /// One toggle off.
    Without(Toggle),
    /// The strategy as it is set, if it equals none of the others.
    AsSet,
}

impl TrialKind {
    /// Name of the kind within a sentence.
    pub fn name(self) -> String {
        let lower = |toggle: Toggle| toggle.name().to_lowercase();
        match self {
            Self::Baseline => "baseline".to_owned(),
            Self::Full => "full".to_owned(),
            Self::Alone(toggle) => format!("{} alone", lower(toggle)),
            Self::Without(toggle) => format!("full without {}", lower(toggle)),
            Self::AsSet => "the toggles as set".to_owned(),
        }
    }

    /// Name of the kind at the beginning of a line.
    pub fn title(self) -> String {
        let name = self.name();
        let mut letters = name.chars();
        letters
            .next()
            .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }
}

/// Source of a trial's figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrialSource {
    /// The trial is rendered.
    Rendered,
    /// The figures of another trial that does the same in this scene.
    SameAs {
        /// The other trial.
        twin: TrialKind,
        /// Reason why both do the same.
        why: &'static str,
    },
    /// No figures: the strategy cannot be rendered, for this reason.
    Refused(&'static str),
}

/// A strategy to try.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Kind of the trial.
    pub kind: TrialKind,
    /// Strategy of the trial, with its toggles.
    pub strategy: Strategy,
    /// Source of the trial's figures.
    pub source: TrialSource,
}

/// The trials of a sweep around `strategy`, whose integrator and finer choices all of them share.
/// Two strategies that differ only in toggles that `idle` gives a reason for are rendered once.
pub fn plan(strategy: &Strategy, idle: &Idle<'_>) -> Vec<Trial> {
    let [baseline, full] =
        [Preset::Baseline, Preset::Full].map(|preset| strategy.with_toggles_of(preset));
    let mut wanted = vec![(TrialKind::Baseline, baseline), (TrialKind::Full, full)];
    wanted.extend(
        Toggle::all().map(|toggle| (TrialKind::Alone(toggle), toggle.set(&baseline, true))),
    );
    wanted
        .extend(Toggle::all().map(|toggle| (TrialKind::Without(toggle), toggle.set(&full, false))));
    if wanted.iter().all(|(_, other)| other != strategy) {
        wanted.push((TrialKind::AsSet, *strategy));
    }
    let mut trials = Vec::with_capacity(wanted.len());
    for (kind, strategy) in wanted {
        let source = source(&trials, &strategy, idle);
        trials.push(Trial { kind, strategy, source });
    }
    trials
}

fn source(earlier: &[Trial], strategy: &Strategy, idle: &Idle<'_>) -> TrialSource {
    if let Some(reason) = strategy.tracker_refusal() {
        return TrialSource::Refused(reason);
    }
    let effective = effective(strategy, idle);
    let is_twin = |trial: &Trial| {
        trial.source == TrialSource::Rendered && self::effective(&trial.strategy, idle) == effective
    };
    match earlier.iter().find(|trial| is_twin(trial)) {
        Some(Trial { kind, strategy: other, .. }) => {
            TrialSource::SameAs { twin: *kind, why: why(other, strategy, idle) }
        }
        None => TrialSource::Rendered,
    }
}

/// `strategy` with those toggles off that change nothing beside the others.
fn effective(strategy: &Strategy, idle: &Idle<'_>) -> Strategy {
    let idle_toggles = Toggle::all().filter(|toggle| idle(*toggle, strategy).is_some());
    idle_toggles.fold(*strategy, |effective, toggle| toggle.set(&effective, false))
}

/// Reason why two strategies do the same: the one for which the toggle they differ in is idle.
fn why(a: &Strategy, b: &Strategy, idle: &Idle<'_>) -> &'static str {
    let differing = Toggle::all().filter(|toggle| toggle.is_on(a) != toggle.is_on(b));
    let reason = |toggle: Toggle| {
        let on = if toggle.is_on(a) { a } else { b };
        idle(toggle, on)
    };
    differing.into_iter().find_map(reason).unwrap_or("the toggles that differ have no effect here.")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::strategy::Tracker;

    const SUBSUMED: &str = "ratio tracking collects it";
    const DARK: &str = "nothing glows";

    fn subsumed(toggle: Toggle, strategy: &Strategy) -> Option<&'static str> {
        let idle = toggle == Toggle::EmissionDecoupling && strategy.emission_ratio_tracking;
        idle.then_some(SUBSUMED)
    }

    fn find(trials: &[Trial], kind: TrialKind) -> &Trial {
        trials.iter().find(|trial| trial.kind == kind).unwrap()
    }

    #[test]
    fn every_toggle_is_tried_alone_and_left_out() {
        let set = Strategy::default();
        let trials = plan(&set, &|_, _| None);
        assert_eq!(trials.len(), 12);
        assert!(trials.iter().all(|trial| trial.source == TrialSource::Rendered));
        for toggle in Toggle::all() {
            let on = |kind| {
                let strategy = find(&trials, kind).strategy;
                Toggle::all().filter(|toggle| toggle.is_on(&strategy)).collect::<Vec<_>>()
            };
            assert_eq!(on(TrialKind::Alone(toggle)), [toggle]);
            let left = on(TrialKind::Without(toggle));
            assert!(left.len() == 4 && !left.contains(&toggle));
        }
    }

    #[test]
    fn what_is_set_is_tried_too_and_its_finer_choices_are_everywhere() {
        let mut set = Toggle::LightProbes.set(&Preset::Baseline.strategy(), true);
        set.advanced.boost_amount = 7.0;
        assert_eq!(plan(&set, &|_, _| None).len(), 12);
        set.nee = true;
        let trials = plan(&set, &|_, _| None);
        assert_eq!((trials.len(), find(&trials, TrialKind::AsSet).strategy), (13, set));
        assert!(trials.iter().all(|trial| trial.strategy.advanced == set.advanced));
    }

    #[test]
    fn what_changes_nothing_is_rendered_once() {
        let trials = plan(&Strategy::default(), &subsumed);
        let toggle = Toggle::EmissionDecoupling;
        let twin = find(&trials, TrialKind::Without(toggle)).source;
        assert_eq!(twin, TrialSource::SameAs { twin: TrialKind::Full, why: SUBSUMED });
        assert_eq!(find(&trials, TrialKind::Alone(toggle)).source, TrialSource::Rendered);

        // Smoke without emission leaves one strategy and the baseline.
        let dark = |toggle, _: &Strategy| (toggle != Toggle::LightProbes).then_some(DARK);
        let trials = plan(&Strategy::default(), &dark);
        let rendered = trials.iter().filter(|trial| trial.source == TrialSource::Rendered);
        assert_eq!(
            rendered.map(|trial| trial.kind).collect::<Vec<_>>(),
            [TrialKind::Baseline, TrialKind::Full]
        );
        let twin = |kind| find(&trials, kind).source;
        assert_eq!(
            twin(TrialKind::Alone(Toggle::LightProbes)),
            TrialSource::SameAs { twin: TrialKind::Full, why: DARK }
        );
        assert_eq!(
            twin(TrialKind::Without(Toggle::LightProbes)),
            TrialSource::SameAs { twin: TrialKind::Baseline, why: DARK }
        );
        assert_eq!(
            twin(TrialKind::Alone(Toggle::FireAsLight)),
            TrialSource::SameAs { twin: TrialKind::Baseline, why: DARK }
        );
    }

    #[test]
    fn what_cannot_be_rendered_says_why() {
        let mut set = Preset::Emission.strategy();
        set.advanced.tracker = Tracker::Decomposition;
        let trials = plan(&set, &|_, _| None);
        let refused = |kind| matches!(find(&trials, kind).source, TrialSource::Refused(_));
        assert!(refused(TrialKind::Baseline) && refused(TrialKind::Full));
        assert!(!refused(TrialKind::Without(Toggle::LightProbes)));
    }

    #[test]
    fn names_fit_into_sentences() {
        let kind = TrialKind::Without(Toggle::MajorantBoost);
        assert_eq!(kind.name(), "full without majorant boost");
        assert_eq!(kind.title(), "Full without majorant boost");
        assert_eq!(TrialKind::Alone(Toggle::FireAsLight).title(), "Fire as a light alone");
    }
}
