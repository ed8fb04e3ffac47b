//! The pilot pass, which finds before the second sample of a pixel how many samples of each
//! technique pay in a picture.
//!
//! Probes cost time along every ray, and each guided flight is a path. Inside of smoke with a lamp
//! in it they lower the noise a hundred times; a cloud under an even sky, or fire that hardly
//! scatters, is as noisy without them and takes half of the time. The same goes for light samples,
//! emission walks and transmittances. So the pilot pass tries a few scales of the number of guided
//! flights on some pixels, each with every way to gather the light at the end of rays, and takes
//! the one with the least variance times cost. Before and after that it learns the counts of the
//! rest. Only where a short trial with few probes promises something are all of them placed.
//!
//! Costs are counted, not timed, and the random numbers are none of the picture's, so that the same
//! scene on the same film always gets the same counts. The picture is unbiased with any of them.

use rayon::prelude::*;

use super::SceneProbes;
use super::light_counts;
use super::pilot_film::PilotFilm;
use super::pilot_pixel::{LEAST_BUDGET, budget};
use super::spending;
use super::trial::{RayEnds, Trial};
use crate::error::{Progress, Result};
use crate::transport::context::PathContext;
use crate::transport::learned_counts::LearnedCounts;
use crate::transport::path_setup::{Guides, PathSetup};
use crate::transport::scene::Scene;
use crate::transport::strategy::{LightSelection, RayEnd, Strategy};

/// Guidance of paths that the pilot pass tries: the scale of the number of guided flights, relative
/// to the number that the probes propose, and whether directions are guided.
type Guidance = (f32, bool);

/// The guidance of strategies that do not learn any: as much as the probes propose.
const PROPOSED: Guidance = (1.0, true);
/// No guidance at all.
const UNGUIDED: Guidance = (0.0, false);
/// Guided directions without guided flights, which is enough for caustics.
const DIRECTIONS: Guidance = (0.0, true);
/// Guidance of first samples, which do not wait for the pilot pass, if any.
const FIRST: Guidance = (0.25, true);
/// Guidance that is tried with all probes, beside none.
const TRIED: [Guidance; 3] = [(0.06, true), FIRST, PROPOSED];
/// Trials with few probes that show whether all of them are placed: the part of the cost of a trial
/// with all, and the factor of variance times cost, against none, below which they go on.
const PROMISING: [(f64, f64); 2] = [(0.25, 1.5), (1.0, 0.9)];
/// Factor by which guidance must lower variance times cost against none, which the pilot pass
/// measures to a fifth.
const MARGIN: f64 = 0.8;
/// Factor by which no guidance, or another way to gather the light at the end of rays, must lower
/// variance times cost in a very short trial for first samples.
const MARGIN_OF_FIRST: f64 = 0.33;
/// Factor by which another way to gather the light at the end of rays must lower variance times
/// cost against the first.
const MARGIN_OF_ENDS: f64 = 0.95;

/// The counts of a strategy for which nothing is learned.
pub(in crate::transport) fn unlearned(strategy: &Strategy) -> LearnedCounts {
    let counts = LearnedCounts::first(1.0);
    match strategy.advanced.ray_end {
        RayEnd::Transmittance => counts.with_all_by_transmittance(1.0),
        RayEnd::Arrival => counts.with_all_by_transmittance(0.0),
        // Without a walk of its own for emission, nothing estimates transmittances on the way.
        RayEnd::Learned if !strategy.gathers_whole_rays() => counts.with_all_by_transmittance(0.0),
        RayEnd::Learned => counts,
    }
}

/// The setup of first samples: few probes, and what a very short trial finds best.
///
/// # Errors
/// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
pub(in crate::transport) fn first(
    film: PilotFilm<'_>,
    probes: Option<&SceneProbes>,
    progress: Progress,
) -> Result<PathSetup> {
    let PilotFilm { scene, size, emission_estimator } = film;
    let guides = match probes {
        Some(probes) => Some(Guides::new(probes.coarse(), scene, size, progress)?),
        None => None,
    };
    let counts = unlearned(&scene.strategy);
    let mut setup = PathSetup { guides, counts, spending: None };
    let learns_guidance = learns_guidance(scene, probes);
    if size.min_element() == 0 || !(learns_guidance || learns_ends(scene)) {
        return Ok(setup);
    }
    let tried = if learns_guidance { &[FIRST, UNGUIDED][..] } else { &[PROPOSED] };
    let context = setup.context(emission_estimator);
    let trials = trials(film, context, tried, LEAST_BUDGET, progress)?;
    let margins = [MARGIN_OF_FIRST; 2];
    setup.counts = best(&trials, setup.counts, (tried, margins), learns_ends(scene));
    Ok(setup)
}

/// The setup with the least variance times cost, for all samples but those of `first`, which is the
/// setup of first samples.
///
/// # Errors
/// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
pub(in crate::transport) fn learn(
    film: PilotFilm<'_>,
    first: &PathSetup,
    probes: Option<&SceneProbes>,
    progress: Progress,
) -> Result<PathSetup> {
    let PilotFilm { scene, size, emission_estimator } = film;
    if size.min_element() == 0 {
        return Ok(first.clone());
    }
    let mut setup = first.clone();
    let learns_guidance = learns_guidance(scene, probes);
    if learns_guidance {
        // Without guidance first, since the price of paths decides how much of it pays.
        setup.counts = with(&setup.counts, UNGUIDED);
    } else if let Some(probes) = probes {
        setup.guides = Some(film.guides(probes, progress)?);
    }
    let context = setup.context(emission_estimator);
    setup.counts = light_counts::learn(scene, size, context, progress)?;
    let mut tried = vec![if learns_guidance { UNGUIDED } else { PROPOSED }];
    if let Some(probes) = probes.filter(|_| learns_guidance) {
        tried.extend(promising(film, &setup, progress)?);
        if tried.len() > 1 {
            setup.guides = Some(film.guides(probes, progress)?);
        }
    }
    if tried.len() > 1 || learns_ends(scene) {
        let context = setup.context(emission_estimator);
        let trials = trials(film, context, &tried, budget(size), progress)?;
        let margins = [MARGIN, MARGIN_OF_ENDS];
        setup.counts = best(&trials, setup.counts, (&tried, margins), learns_ends(scene));
    }
    if learns_guidance && setup.counts.guided_directions {
        let context = setup.context(emission_estimator);
        setup.counts = light_counts::learn(scene, size, context, progress)?;
    } else if learns_guidance && scene.strategy.advanced.light_selection != LightSelection::Probes {
        setup.guides = None;
    }
    setup.spending = Some(spending::measure(film, &setup, progress)?);
    Ok(setup)
}

/// Guidance that is worth a trial with all probes, by trials with the few of `setup`: a short one,
/// then one that knows better.
fn promising(film: PilotFilm<'_>, setup: &PathSetup, progress: Progress) -> Result<Vec<Guidance>> {
    let has_caustics = setup.guides.as_ref().is_some_and(|g| g.probes.has_caustics());
    let directions = has_caustics.then_some(DIRECTIONS);
    let tried: Vec<Guidance> = [UNGUIDED, FIRST].into_iter().chain(directions).collect();
    let context = setup.context(film.emission_estimator);
    for (part, factor) in PROMISING {
        let trials = trials(film, context, &tried, part * budget(film.size), progress)?;
        let product = |trial: &Trial| trial.least(learns_ends(film.scene), &setup.counts);
        let least = trials[1..].iter().map(product).fold(f64::INFINITY, f64::min);
        if least >= factor * product(&trials[0]) {
            return Ok(Vec::new());
        }
    }
    Ok(directions.into_iter().chain(TRIED).collect())
}

/// Whether there is a choice how much the paths are guided.
fn learns_guidance(scene: &Scene, probes: Option<&SceneProbes>) -> bool {
    probes.is_some() && scene.strategy.guides() && scene.strategy.learns_share()
}

fn with(counts: &LearnedCounts, (flights, directions): Guidance) -> LearnedCounts {
    counts.with_guidance(flights, directions)
}

/// Whether there is a choice how the light at the end of rays is gathered.
fn learns_ends(scene: &Scene) -> bool {
    let strategy = &scene.strategy;
    let shines = !scene.lights.environment().is_black()
        || scene.lights.has_suns()
        || scene.surfaces.iter().any(|surface| surface.emits());
    let asks = strategy.advanced.ray_end == RayEnd::Learned;
    shines && asks && strategy.gathers_whole_rays() && !strategy.marches()
}

/// Trials of several kinds of guidance, each of the given cost.
fn trials(
    film: PilotFilm<'_>,
    context: PathContext<'_>,
    tried: &[Guidance],
    budget: f64,
    progress: Progress,
) -> Result<Vec<Trial>> {
    let trial = |&guidance: &Guidance| {
        let counts = with(context.counts, guidance);
        Trial::new(film, context.with_counts(&counts), budget, progress)
    };
    let trials: Result<Vec<Trial>> = tried.par_iter().map(trial).collect();
    let mut trials = trials?;
    Trial::heed_missed_light(&mut trials);
    Ok(trials)
}

/// The counts of the trial with the least variance times cost: those of the first of `tried`, and
/// with the first way to gather the light at the end of rays, unless another one is better by its
/// margin.
fn best(
    trials: &[Trial],
    first: LearnedCounts,
    (tried, [margin, margin_of_ends]): (&[Guidance], [f64; 2]),
    learns_ends: bool,
) -> LearnedCounts {
    // In a fire that hardly scatters, direct emission is most of the noise, and no scale lowers it.
    let emission = trials.iter().map(|trial| trial.emission).sum::<f64>() / trials.len() as f64;
    let usual = RayEnds::of(&first);
    let (mut least, mut best) = (f64::INFINITY, first);
    for (index, (&guidance, trial)) in tried.iter().zip(trials).enumerate() {
        for ends in RayEnds::all().filter(|&ends| learns_ends || ends == usual) {
            let margin = if index == 0 { margin } else { 1.0 };
            let of_ends = if ends == usual { margin_of_ends } else { 1.0 };
            let (variance, cost) = trial.of(ends);
            let product = (variance + emission) * cost * margin * of_ends;
            if product < least {
                least = product;
                best = ends.applied(with(&first, guidance));
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::UVec2;

    use super::*;
    use crate::error::NO_PROGRESS;
    use crate::transport::PreparedFrame;

    const SIZE: UVec2 = UVec2::new(48, 32);

    /// A cloud under an even sky.
    const CLOUD: &str = r#"
        [camera]
        position = [0, -4, 0]
        target = [0, 0, 0]
        [environment]
        radiance = 1.0
        [[volume]]
        shape = "noise"
        half_size = 1.0
        frequency = 2.0
        density = { scale = 6.0 }
        albedo = 0.999
        phase = { g = 0.8 }
    "#;

    /// A small lamp inside of thin smoke.
    const LAMP: &str = r#"
        [camera]
        position = [0, -4, 0]
        target = [0, 0, 0]
        [[volume]]
        shape = "box"
        half_size = 1.0
        density = { scale = 0.3 }
        albedo = 0.9
        [[light]]
        type = "sphere"
        center = [0.1, 0.1, 0.1]
        radius = 0.01
        radiance = 100.0
    "#;

    fn frame(text: &str) -> PreparedFrame {
        PreparedFrame::new(Arc::new(Scene::of_text(text)), SIZE, 0, NO_PROGRESS).unwrap()
    }

    #[test]
    fn probes_are_asked_where_that_pays() {
        assert_eq!(frame(CLOUD).guided_flights(), 0.0);
        assert!(frame(LAMP).guided_flights() >= 0.25);
        for (key, flights) in [("share_learning = false", 1.0), ("distance = 'probes'", 1.0)] {
            let text = format!("{CLOUD}\n[strategy.advanced]\n{key}");
            assert_eq!(frame(&text).guided_flights(), flights, "{key}");
        }
    }

    fn trial(variance: f64, cost: f64) -> Trial {
        let all = |value| [value; RayEnds::COUNT];
        let light = [1.0, variance];
        let doubt = all(0.0);
        Trial {
            variance: all(variance),
            doubt,
            emission: 1.0,
            cost: all(cost),
            light,
            pixels: 100.0,
        }
    }

    /// Each guidance is selected where it has the least variance times cost.
    #[test]
    fn the_least_variance_times_cost_is_best() {
        let tried = [UNGUIDED, TRIED[0], TRIED[1], TRIED[2]];
        for (variances, costs, chosen) in [
            ([1.0, 1.0, 1.0, 1.0], [1.0, 2.0, 3.0, 4.0], 0),
            ([9.0, 1.0, 0.9, 0.8], [1.0, 2.0, 3.0, 4.0], 1),
            ([9.0, 9.0, 1.0, 0.9], [1.0, 2.0, 3.0, 4.0], 2),
            ([99.0, 50.0, 20.0, 1.0], [1.0, 2.0, 3.0, 4.0], 3),
            // Variance that no scale lowers makes the cheapest share best.
            ([0.3, 0.2, 0.1, 0.0], [1.0, 2.0, 3.0, 4.0], 0),
            // Hardly better than none is not clearly better.
            ([1.0, 0.9, 2.0, 2.0], [1.0, 1.0, 1.0, 1.0], 0),
            ([1.0, 0.2, 2.0, 2.0], [1.0, 1.0, 1.0, 1.0], 1),
            ([f64::NAN; 4], [1.0; 4], 2),
        ] {
            let trials: Vec<Trial> = (0..4).map(|i| trial(variances[i], costs[i])).collect();
            let first = with(&LearnedCounts::first(1.0), FIRST);
            let best = best(&trials, first, (&tried, [MARGIN, MARGIN_OF_ENDS]), true);
            let guidance = (best.guided_flights, best.guided_directions);
            assert_eq!(guidance, tried[chosen], "{variances:?}");
        }
    }

    /// A trial that misses light which another one has found is no less noisy for that.
    #[test]
    fn light_that_a_trial_misses_is_noise() {
        let found = Trial { light: [1.0, 0.5], ..trial(0.5, 1.0) };
        for (mean, raised) in [(0.2, true), (0.95, false), (1.0, false)] {
            let missed = Trial { light: [mean, 0.0], ..trial(0.0, 1.0) };
            let mut trials = [missed, found.clone()];
            Trial::heed_missed_light(&mut trials);
            let variance = trials[0].variance[0];
            assert_eq!(variance > 100.0 * 0.6 * 0.6, raised, "{mean}: {variance}");
            assert_eq!(trials[1].variance, found.variance, "{mean}");
        }
    }

    /// Another way to gather the light at the end of rays is taken where it is clearly better, and
    /// only where there is a choice.
    #[test]
    fn ray_ends_are_gathered_in_the_better_way() {
        let first = LearnedCounts::first(1.0);
        let usual = RayEnds::of(&first);
        let other = RayEnds::all().nth(RayEnds::COUNT - 1).unwrap();
        assert_ne!(usual, other);
        for (factor, doubt, learns, ends) in [
            (0.5, 0.0, true, other),
            (0.5, 0.3, true, usual),
            (0.97, 0.0, true, usual),
            (1.5, 0.0, true, usual),
            (0.5, 0.0, false, usual),
        ] {
            let mut trial = trial(1.0, 1.0);
            trial.doubt[RayEnds::COUNT - 1] = doubt;
            trial.variance[RayEnds::COUNT - 1] = factor;
            trial.emission = 0.0;
            let best = best(&[trial], first, (&[FIRST], [MARGIN, MARGIN_OF_ENDS]), learns);
            assert_eq!(RayEnds::of(&best), ends, "{factor} {doubt} {learns}");
        }
    }

    /// The pilot pass has the same result on any thread, however many run at once.
    #[test]
    fn every_pilot_pass_has_the_same_result() {
        use rayon::prelude::*;
        let expected = *frame(LAMP).counts().unwrap();
        let found: Vec<_> =
            (0..3).into_par_iter().map(|_| *frame(LAMP).counts().unwrap()).collect();
        assert!(found.iter().all(|counts| *counts == expected), "{expected:?}, {found:?}");
    }
}
