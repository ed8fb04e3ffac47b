//! Ranking by figures that are known.

use super::*;
use crate::render::sweep::plan::plan;
use crate::render::sweep::words::{headline, relative_time, remarks};
use crate::transport::strategy::Strategy;

const SUBSUMED: &str = "ratio tracking collects it";

/// Variance × time of 1 with a standard error of `error` is that of `cost` times as much.
fn side(cost: f64, error: f64) -> SideFigures {
    SideFigures {
        fewest_samples: 2,
        variance_of_mean: Some(cost / 3.0),
        variance_error: Some(error * cost / 3.0),
        cpu_seconds: 3.0,
        ..SideFigures::default()
    }
}

/// Factor by which each toggle reduces variance × time.
fn gain(toggle: Toggle) -> f64 {
    match toggle {
        Toggle::EmissionDecoupling => 2.5,
        Toggle::EmissionRatioTracking => 3.0,
        Toggle::MajorantBoost => 0.8,
        Toggle::FireAsLight => 1.0,
        Toggle::LightProbes => 10.0,
    }
}

fn idle(toggle: Toggle, strategy: &Strategy) -> Option<&'static str> {
    let idle = toggle == Toggle::EmissionDecoupling && strategy.emission_ratio_tracking;
    idle.then_some(SUBSUMED)
}

/// A ranking of every strategy, the cost of which is the quotient of the gains of its toggles.
fn ranking(error: f64) -> Ranking {
    let trials = plan(&Strategy::default(), &idle);
    let cost = |strategy: &Strategy| {
        let counts = |toggle: &Toggle| toggle.is_on(strategy) && idle(*toggle, strategy).is_none();
        Toggle::all().filter(counts).fold(7.0, |cost, toggle| cost / gain(toggle))
    };
    let figures = |trial: &Trial| {
        (trial.source == TrialSource::Rendered).then(|| side(cost(&trial.strategy), error))
    };
    let sides: Vec<_> = trials.iter().map(figures).collect();
    Ranking::new(&trials, &sides)
}

fn close(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < 1e-9
}

#[test]
fn the_fastest_is_first_and_twins_stand_together() {
    let ranking = ranking(0.01);
    let kinds: Vec<TrialKind> = ranking.entries.iter().map(|entry| entry.trial.kind).collect();
    assert_eq!(kinds[0], TrialKind::Without(Toggle::MajorantBoost));
    let full = kinds.iter().position(|kind| *kind == TrialKind::Full).unwrap();
    let mut equals = kinds[full..full + 3].to_vec();
    equals.retain(|kind| *kind != TrialKind::Without(Toggle::FireAsLight));
    assert_eq!(equals, [TrialKind::Full, TrialKind::Without(Toggle::EmissionDecoupling)]);
    assert_eq!(kinds.last(), Some(&TrialKind::Alone(Toggle::MajorantBoost)));
    let ratios = ranking.entries.iter().map(|entry| entry.over_baseline.unwrap().ratio);
    assert!(ratios.is_sorted_by(|a, b| a >= b));
}

/// Speed-ups are quotients of variance × time, and their errors add up in squares with that of the
/// clock.
#[test]
fn figures_are_quotients_of_variance_and_time() {
    let error = 0.04;
    let ranking = ranking(error);
    let best = ranking.entries[0];
    assert!(close(best.over_baseline.unwrap().ratio, 30.0));
    assert!(close(best.over_best.unwrap().ratio, 1.0));
    assert_eq!(best.over_best.unwrap().log_error, 0.0);
    let speed_up = best.over_baseline.unwrap();
    assert!(close(speed_up.log_error, (2.0 * error * error + 0.03 * 0.03).sqrt()));
    let find = |kind| *ranking.entries.iter().find(|entry| entry.trial.kind == kind).unwrap();
    assert!(close(find(TrialKind::Full).over_best.unwrap().ratio, 0.8));
    assert!(close(find(TrialKind::Baseline).over_best.unwrap().ratio, 1.0 / 30.0));
}

#[test]
fn each_toggle_tells_what_it_brings_and_what_is_lost_without_it() {
    let ranking = ranking(0.01);
    for worth in &ranking.worths {
        let Gain::Of(alone) = worth.alone else { panic!("{worth:?}") };
        assert!(close(alone.ratio, gain(worth.toggle)), "{worth:?}");
        match (worth.toggle, worth.left_out) {
            (Toggle::EmissionDecoupling, left_out) => {
                assert_eq!(left_out, Gain::Nothing(SUBSUMED));
            }
            // Without ratio tracking, decoupling counts.
            (Toggle::EmissionRatioTracking, Gain::Of(out)) => assert!(close(out.ratio, 2.5 / 3.0)),
            (toggle, Gain::Of(out)) => assert!(close(out.ratio, 1.0 / gain(toggle)), "{worth:?}"),
            _ => panic!("{worth:?}"),
        }
    }
}

/// With small errors the best is clearly better than everything on; with larger ones everything on
/// is as good and stays on; with huge ones no difference is significant.
#[test]
fn what_cannot_be_told_apart_is_said_to_be() {
    let of = |error| {
        let ranking = ranking(error);
        (ranking.best().unwrap().trial.kind, headline(&ranking), remarks(&ranking))
    };
    let (kind, headline, remarks) = of(0.01);
    assert_eq!(kind, TrialKind::Without(Toggle::MajorantBoost));
    let expected = "Leave on full without majorant boost: 1/30 of baseline's time for \
                    the same noise";
    assert_eq!(headline, expected);
    let expected = [
        "Alone, these are faster than baseline: light probes (1/10 of its time), emission ratio \
         tracking (1/3 of its time) and emission decoupling (1/2.5 of its time)",
        "Full takes longer without light probes (10 times as long) and emission ratio tracking (1.2 \
         times as long)",
    ];
    assert_eq!(remarks, expected);

    let (kind, headline, remarks) = of(0.1);
    assert_eq!(kind, TrialKind::Full);
    assert!(headline.starts_with("Leave on full: about 1/25"), "{headline}");
    let expected = "No measurable difference: full without majorant boost and full without \
                    fire as a light";
    assert_eq!(remarks[0], expected);

    let (kind, _, remarks) = of(0.5);
    assert_eq!(kind, TrialKind::Without(Toggle::MajorantBoost));
    assert!(remarks[0].starts_with("Too early to tell the difference: full"), "{remarks:?}");
}

#[test]
fn without_figures_there_is_nothing_to_rank() {
    let trials = plan(&Strategy::default(), &idle);
    let nothing = Ranking::new(&trials, &vec![None; trials.len()]);
    assert_eq!((nothing.leave_on, nothing.entries.len()), (None, trials.len()));
    assert!(headline(&nothing).starts_with("There are too few samples"));
    assert!(nothing.worths.iter().all(|worth| worth.alone == Gain::Unknown));

    // One strategy has not come far enough: it may be the best.
    let mut sides = vec![Some(side(1.0, 0.01)); trials.len()];
    (sides[0], sides[3]) = (None, Some(side(0.5, 0.01)));
    let ranking = Ranking::new(&trials, &sides);
    assert_eq!((ranking.leave_on, ranking.entries[0].trial.kind), (None, trials[3].kind));
    assert!(headline(&ranking).starts_with("There are too few samples"));

    // It can't be rendered, so that nobody waits for it.
    let mut trials = trials;
    trials[0].source = TrialSource::Refused("on purpose");
    let ranking = Ranking::new(&trials, &sides);
    let text = headline(&ranking);
    assert!(text.contains("emission ratio tracking alone: the fastest"), "{text}");
    assert_eq!(ranking.entries.last().unwrap().trial.kind, TrialKind::Baseline);
}

#[test]
fn no_noise_is_less_than_any() {
    let trials = plan(&Strategy::default(), &idle);
    let mut sides = vec![Some(side(1.0, 0.01)); trials.len()];
    sides[1] = Some(SideFigures { variance_of_mean: Some(0.0), ..side(1.0, 0.0) });
    let ranking = Ranking::new(&trials, &sides);
    assert_eq!(ranking.best().unwrap().trial.kind, TrialKind::Full);
    assert_eq!(headline(&ranking), "Leave on full: it has no noise");
}

#[test]
fn where_nothing_helps_it_says_so() {
    let trials = plan(&Strategy::default(), &idle);
    let equal = vec![Some(side(1.0, 0.01)); trials.len()];
    let text = headline(&Ranking::new(&trials, &equal));
    assert_eq!(text, "No strategy is measurably faster than baseline");
    let remarks = remarks(&Ranking::new(&trials, &equal));
    assert!(
        remarks.iter().any(|remark| remark.starts_with("Alone, no toggle is measurably faster"))
    );
    assert!(remarks.iter().any(|remark| remark.starts_with("Full is not measurably slower")));
    let vague = vec![Some(side(1.0, 0.5)); trials.len()];
    let text = headline(&Ranking::new(&trials, &vague));
    assert!(text.starts_with("It is too early to tell"), "{text}");
    // All toggles idle: one strategy is all there is.
    let trials = plan(&Strategy::default(), &|_, _| Some("nothing glows"));
    let mut sides = vec![None; trials.len()];
    sides[0] = Some(side(1.0, 0.01));
    let text = headline(&Ranking::new(&trials, &sides));
    assert_eq!(text, "No toggle changes anything in this shot");
}

#[test]
fn times_are_written_relative_to_another() {
    let text = |ratio, log_error| relative_time(&SpeedUp { ratio, log_error });
    assert_eq!(text(41.2, 0.052), "1/41 ± 5.2 %");
    assert_eq!(text(1.3, 0.03), "0.77 ± 3 %");
    assert_eq!(text(0.25, 0.031), "4 ± 3.1 %");
    assert_eq!(text(1.0, 0.0), "1");
}
