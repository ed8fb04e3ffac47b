//! The findings of a sweep in words.

use super::plan::TrialSource;
use super::ranking::{Gain, RankedTrial, Ranking, Worth};
use crate::format::{one_part_of, percent, rounded};
use crate::render::compare::SpeedUp;
use crate::transport::spending::Work;

/// Share of the time below which work is not worth a word.
const LEAST_SHARE: f32 = 0.01;
/// Most names in a row before the rest is counted.
const MOST_NAMES: usize = 4;

/// The strategy to leave on and its gain, without a full stop.
pub fn headline(ranking: &Ranking) -> String {
    let Some(best) = ranking.best() else {
        return "There are too few samples to rank the strategies; allow more time for each"
            .to_owned();
    };
    if ranking.entries.iter().filter(|entry| entry.is_rendered()).count() == 1 {
        return "No toggle changes anything in this shot".to_owned();
    }
    let name = best.trial.kind.name();
    match &best.over_baseline {
        _ if best.side.is_some_and(|side| side.is_noiseless()) => {
            format!("Leave on {name}: it has no noise")
        }
        None => format!("Leave on {name}: the fastest; it cannot be compared with baseline"),
        Some(speed_up) if speed_up.is_clear() => {
            let share = speed_up.share();
            format!("Leave on {name}: {share} of baseline's time for the same noise")
        }
        Some(_) if ranking.entries.iter().any(RankedTrial::is_vague) => {
            "It is too early to tell whether any strategy is faster than baseline; allow more time \
             for each"
                .to_owned()
        }
        Some(_) => "No strategy is measurably faster than baseline".to_owned(),
    }
}

/// The strategies that can't be told from it, the gain of each toggle alone and the loss without
/// it, one sentence each without a full stop.
pub fn remarks(ranking: &Ranking) -> Vec<String> {
    let mut remarks = not_told_apart(ranking);
    remarks.extend(brought_alone(ranking));
    remarks.extend(lost(ranking));
    remarks.extend(spent(ranking));
    remarks
}

/// Sentence on how the best strategy spends its time; `None` where that is not known.
fn spent(ranking: &Ranking) -> Option<String> {
    let best = ranking.best()?;
    let spending = best.side?.spending?;
    let mut parts: Vec<(f32, Work)> = spending
        .shares
        .into_iter()
        .zip(Work::ALL)
        .filter(|(share, _)| *share >= LEAST_SHARE)
        .collect();
    parts.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    let named =
        |(share, work): &(f32, Work)| format!("{} ({})", work.name(), percent(f64::from(*share)));
    let names: Vec<String> = parts.iter().map(named).collect();
    let name = best.trial.kind.title();
    (!names.is_empty()).then(|| format!("{name} spends its time on {}", listed(&names)))
}

/// Sentence on the toggles that gain on their own; `None` where no such gain is known.
fn brought_alone(ranking: &Ranking) -> Option<String> {
    let known = gains(ranking, |worth| worth.alone)?;
    let mut faster: Vec<_> = known.into_iter().filter(|(_, it)| it.ratio > 1.0).collect();
    faster.sort_by(|(_, a), (_, b)| b.ratio.total_cmp(&a.ratio));
    let named = |(name, it): &(String, SpeedUp)| format!("{name} ({} of its time)", it.share());
    let names: Vec<String> = faster.iter().map(named).collect();
    Some(match names.is_empty() {
        true => "Alone, no toggle is measurably faster than baseline".to_owned(),
        false => format!("Alone, these are faster than baseline: {}", listed(&names)),
    })
}

/// Sentence on the toggles without which everything is slower.
fn lost(ranking: &Ranking) -> Option<String> {
    let known = gains(ranking, |worth| worth.left_out)?;
    let mut slower: Vec<_> = known.into_iter().filter(|(_, it)| it.ratio < 1.0).collect();
    slower.sort_by(|(_, a), (_, b)| a.ratio.total_cmp(&b.ratio));
    let named = |(name, it): &(String, SpeedUp)| {
        format!("{name} ({} times as long)", rounded(1.0 / it.ratio, 2))
    };
    let names: Vec<String> = slower.iter().map(named).collect();
    Some(match names.is_empty() {
        true => "Full is not measurably slower without any one toggle".to_owned(),
        false => format!("Full takes longer without {}", listed(&names)),
    })
}

/// Toggles by name whose gain is clear; none where no gain is known at all.
fn gains(ranking: &Ranking, gain: fn(&Worth) -> Gain) -> Option<Vec<(String, SpeedUp)>> {
    let known = ranking.worths.iter().filter_map(|worth| match gain(worth) {
        Gain::Of(speed_up) => Some((worth.toggle.name().to_lowercase(), speed_up)),
        Gain::Nothing(_) | Gain::Unknown => None,
    });
    let known: Vec<_> = known.collect();
    let clear = |(_, speed_up): &(String, SpeedUp)| speed_up.is_clear();
    (!known.is_empty()).then(|| known.into_iter().filter(clear).collect())
}

/// Sentences on the strategies that can't be told from the one to leave on.
fn not_told_apart(ranking: &Ranking) -> Vec<String> {
    let names = |is_meant: fn(&RankedTrial) -> bool| {
        let others = ranking.entries.iter().enumerate().filter(|(number, entry)| {
            Some(*number) != ranking.leave_on && entry.is_rendered() && is_meant(entry)
        });
        others.map(|(_, entry)| entry.trial.kind.name()).collect::<Vec<_>>()
    };
    let groups = [
        ("No measurable difference", names(RankedTrial::is_as_good_as_best)),
        ("Too early to tell the difference", names(RankedTrial::is_vague)),
    ];
    let told = groups.into_iter().filter(|(_, names)| !names.is_empty());
    told.map(|(what, names)| format!("{what}: {}", listed(&names))).collect()
}

/// Names as a sentence lists them, with commas and "and".
fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] if names.len() <= MOST_NAMES => {
            format!("{} and {last}", first.join(", "))
        }
        _ => {
            let rest = names.len() - (MOST_NAMES - 1);
            format!("{} and {rest} more", names[..MOST_NAMES - 1].join(", "))
        }
    }
}

/// The time for the same noise relative to what `speed_up` is over, with its standard error.
pub fn relative_time(speed_up: &SpeedUp) -> String {
    let ratio = speed_up.ratio;
    let time = match ratio >= 2.0 {
        true => one_part_of(ratio),
        false => rounded(1.0 / ratio, 2),
    };
    match speed_up.log_error > 0.0 {
        true => format!("{time} ± {}", percent(speed_up.log_error)),
        false => time,
    }
}

/// Reason why an entry has no figures of its own; `None` where it has.
pub fn note(entry: &RankedTrial) -> Option<String> {
    match entry.trial.source {
        TrialSource::Rendered => None,
        TrialSource::SameAs { twin, why } => Some(format!("same as {}: {why}", twin.name())),
        TrialSource::Refused(why) => Some(format!("cannot be rendered: {why}")),
    }
}
