//! The figures of a sweep: which strategy needs least time for the same noise, and how well that
//! is known.

use super::plan::{Trial, TrialKind, TrialSource};
use crate::render::compare::{SideFigures, SpeedUp};
use crate::transport::toggle::Toggle;

/// A trial with its figures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RankedTrial {
    /// The trial.
    pub trial: Trial,
    /// Noise and cost: the trial's own, or those of the one that does the same; `None` where it
    /// could not be rendered.
    pub side: Option<SideFigures>,
    /// Speed-up over the baseline; `None` while nothing is known of it.
    pub over_baseline: Option<SpeedUp>,
    /// Speed-up over the best trial, so at most 1.
    pub over_best: Option<SpeedUp>,
}

/// Gain of a toggle in a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worth {
    /// The toggle.
    pub toggle: Toggle,
    /// Speed-up of the toggle alone over the baseline.
    pub alone: Gain,
    /// Speed-up of everything without the toggle over everything, so below 1 where it helps.
    pub left_out: Gain,
}

/// Gain of a toggle beside the rest of a strategy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gain {
    /// Speed-up at the same noise.
    Of(SpeedUp),
    /// No gain, for this reason.
    Nothing(&'static str),
    /// The gain is not known.
    Unknown,
}

/// The result of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranking {
    /// The trials, the fastest first. A trial that does the same as another follows it; trials of
    /// which nothing is known come last.
    pub entries: Vec<RankedTrial>,
    /// The number of the entry to leave on; none while something is not known yet.
    pub leave_on: Option<usize>,
    /// Gain of each toggle, in the order of the strategy.
    pub worths: Vec<Worth>,
}

/// Speed-up of a film over itself.
const SAME: SpeedUp = SpeedUp { ratio: 1.0, log_error: 0.0 };

impl Ranking {
    /// Ranks `trials` by the figures of those that were rendered.
    pub fn new(trials: &[Trial], sides: &[Option<SideFigures>]) -> Self {
        let all = Figures { trials, sides };
        let known = (0..trials.len()).filter(|&number| all.cost(number).is_some());
        let by_cost = |a: &usize, b: &usize| all.key(*a).total_cmp(&all.key(*b));
        let best = known.clone().min_by(by_cost);
        let mut order: Vec<usize> = (0..trials.len()).collect();
        // Sorting is stable, and a twin comes behind the trial that was rendered for both.
        order.sort_by(by_cost);
        let entry = |&number: &usize| RankedTrial {
            trial: trials[number],
            side: all.side(number),
            over_baseline: all.speed_up(all.find(TrialKind::Baseline), Some(number)),
            over_best: all.speed_up(best, Some(number)),
        };
        let entries: Vec<RankedTrial> = order.iter().map(entry).collect();
        // What is not known yet may be the best of all.
        let all_known = entries.iter().all(|entry| entry.is_known() || !entry.is_rendered());
        let leave_on = best.filter(|_| all_known).map(|_| leave_on(&entries));
        Self { entries, leave_on, worths: Toggle::all().map(|toggle| all.worth(toggle)).collect() }
    }

    /// The entry to leave on.
    pub fn best(&self) -> Option<&RankedTrial> {
        self.leave_on.and_then(|number| self.entries.get(number))
    }
}

/// Trial to leave on: everything on where nothing is known to be faster, else the faster one.
fn leave_on(entries: &[RankedTrial]) -> usize {
    let is_it =
        |entry: &RankedTrial| entry.trial.kind == TrialKind::Full && entry.is_as_good_as_best();
    entries.iter().position(is_it).unwrap_or(0)
}

impl RankedTrial {
    /// Whether no difference from the best is known, although one as large as a half would be.
    pub fn is_as_good_as_best(&self) -> bool {
        self.over_best.is_some_and(|speed_up| !speed_up.is_clear() && !speed_up.is_vague())
    }

    /// Whether the trial may well be the best or far from it, as its figures are too uncertain.
    pub fn is_vague(&self) -> bool {
        self.over_best.is_some_and(|speed_up| speed_up.is_vague())
    }

    /// Whether noise and cost of the trial are known.
    fn is_known(&self) -> bool {
        self.side.is_some_and(|side| side.is_noiseless() || side.variance_times_time().is_some())
    }

    /// Whether the trial was rendered itself.
    pub fn is_rendered(&self) -> bool {
        self.trial.source == TrialSource::Rendered
    }
}

/// Figures by the numbers of their trials.
struct Figures<'a> {
    trials: &'a [Trial],
    sides: &'a [Option<SideFigures>],
}

impl Figures<'_> {
    /// The trial that was rendered for this one.
    fn rendered(&self, number: usize) -> usize {
        match self.trials[number].source {
            TrialSource::SameAs { twin, .. } => self.find(twin).unwrap_or(number),
            _ => number,
        }
    }

    fn side(&self, number: usize) -> Option<SideFigures> {
        self.sides.get(self.rendered(number)).copied().flatten()
    }

    /// Variance times time; 0 where there is no noise.
    fn cost(&self, number: usize) -> Option<f64> {
        let side = self.side(number)?;
        match side.is_noiseless() {
            true => Some(0.0),
            false => side.variance_times_time().map(|(cost, _)| cost),
        }
    }

    /// Sort key of a trial.
    fn key(&self, number: usize) -> f64 {
        self.cost(number).unwrap_or(f64::INFINITY)
    }

    fn find(&self, kind: TrialKind) -> Option<usize> {
        self.trials.iter().position(|trial| trial.kind == kind)
    }

    /// Speed-up from one trial to another, if both have figures.
    fn speed_up(&self, from: Option<usize>, to: Option<usize>) -> Option<SpeedUp> {
        let (from, to) = (from?, to?);
        let speed_up = SpeedUp::new(&self.side(from)?, &self.side(to)?)?;
        Some(if self.rendered(from) == self.rendered(to) { SAME } else { speed_up })
    }

    fn worth(&self, toggle: Toggle) -> Worth {
        let gain = |from, to| self.gain(self.find(from), self.find(to));
        Worth {
            toggle,
            alone: gain(TrialKind::Baseline, TrialKind::Alone(toggle)),
            left_out: gain(TrialKind::Full, TrialKind::Without(toggle)),
        }
    }

    /// Gain of going from one trial to another.
    fn gain(&self, from: Option<usize>, to: Option<usize>) -> Gain {
        let (Some(from), Some(to)) = (from, to) else { return Gain::Unknown };
        match self.trials[to].source {
            TrialSource::SameAs { why, .. } if self.rendered(to) == self.rendered(from) => {
                Gain::Nothing(why)
            }
            _ => self.speed_up(Some(from), Some(to)).map_or(Gain::Unknown, Gain::Of),
        }
    }
}

#[cfg(test)]
mod tests;
