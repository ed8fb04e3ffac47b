//! The pilot pass, which finds before the second sample of a pixel how many samples of each
//! technique pay in a picture.
//!
//! Probes cost time along every ray, and each guided flight is a path. Inside of smoke with a lamp
//! in it they lower the noise a hundred times; a cloud under an even sky, or fire that hardly
//! scatters, is as noisy without them and takes half of the time. The same goes for light samples,
//! emission walks and transmittances. So the pilot pass tries a few scales of the number of guided
//! flights on some pixels, each with every way to gather the light at the end of rays, and takes
//! the one with the least variance times cost. Before and after that it learns the counts of the
//! rest.
//!
//! Costs are counted, not timed, and the random numbers are none of the picture's, so that the same
//! scene on the same film always gets the same counts. The picture is unbiased with any of them.

use glam::UVec2;

use super::light_counts;
use super::trial::{RayEnds, Trial};
use crate::error::{Progress, Result};
use crate::transport::context::PathContext;
use crate::transport::learned_counts::LearnedCounts;
use crate::transport::scene::Scene;
use crate::transport::strategy::{RayEnd, Strategy};

/// Scales that the pilot pass tries, relative to the number of flights that the probes propose.
const TRIED: [f32; 4] = [0.0, 0.06, 0.25, 1.0];
/// The scale that first samples use, which do not wait for the pilot pass.
const FIRST_SCALE: f32 = 0.25;
/// Factor by which guided flights must lower variance times cost against none, which the pilot pass
/// measures to a fifth.
const MARGIN: f64 = 0.8;
/// Factor by which another way to gather the light at the end of rays must lower variance times
/// cost against the first.
const MARGIN_OF_ENDS: f64 = 0.95;

/// The counts of first samples; `guides` says whether probes guide distances.
pub(in crate::transport) fn first(strategy: &Strategy, guides: bool) -> LearnedCounts {
    let scale = if guides && strategy.learns_share() { FIRST_SCALE } else { 1.0 };
    let counts = LearnedCounts::first(scale);
    match strategy.advanced.ray_end {
        RayEnd::Transmittance => counts.with_all_by_transmittance(1.0),
        RayEnd::Arrival => counts.with_all_by_transmittance(0.0),
        // Without a walk of its own for emission, nothing estimates transmittances on the way.
        RayEnd::Learned if !strategy.gathers_whole_rays() => counts.with_all_by_transmittance(0.0),
        RayEnd::Learned => counts,
    }
}

/// The counts with the least variance times cost for `scene` on a film of `size`; `context` is that
/// of first samples.
///
/// # Errors
/// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
pub(in crate::transport) fn learn(
    scene: &Scene,
    size: UVec2,
    context: PathContext<'_>,
    progress: Progress,
) -> Result<LearnedCounts> {
    let first = *context.counts;
    if size.min_element() == 0 {
        return Ok(first);
    }
    let learns_flights = scene.strategy.learns_share() && context.probes.is_some();
    // Without guided flights first, since the price of paths decides how many of them pay.
    let without = if learns_flights { 0.0 } else { first.guided_flights };
    let first = first.with_guided_flights(without);
    let first = light_counts::learn(scene, size, context.with_counts(&first), progress)?;
    let learns_ends = learns_ends(scene);
    if !learns_flights && !learns_ends {
        return Ok(first);
    }
    let scales = if learns_flights { &TRIED[..] } else { &[without] };
    let trials = trials(scene, size, context.with_counts(&first), scales, progress)?;
    let counts = best(&trials, first, scales, learns_ends);
    if counts.guided_flights == without {
        return Ok(counts);
    }
    light_counts::learn(scene, size, context.with_counts(&counts), progress)
}

/// Whether there is a choice how the light at the end of rays is gathered.
fn learns_ends(scene: &Scene) -> bool {
    let strategy = &scene.strategy;
    let shines = scene.lights.environment.max_element() > 0.0
        || scene.lights.has_suns()
        || scene.surfaces.iter().any(|surface| surface.emits());
    let asks = strategy.advanced.ray_end == RayEnd::Learned;
    shines && asks && strategy.gathers_whole_rays() && !strategy.marches()
}

/// Trials of several scales of guided flights, side by side.
fn trials(
    scene: &Scene,
    size: UVec2,
    context: PathContext<'_>,
    scales: &[f32],
    progress: Progress,
) -> Result<Vec<Trial>> {
    let trial = |guided_flights: f32| {
        let counts = context.counts.with_guided_flights(guided_flights);
        Trial::new(scene, size, context.with_counts(&counts), progress)
    };
    let trial = &trial;
    let mut trials: Vec<Option<Result<Trial>>> = scales.iter().map(|_| None).collect();
    // Threads of their own: a worker that waits here for others might take up a sample meanwhile
    // that waits for this.
    std::thread::scope(|scope| {
        for (done, &scale) in trials.iter_mut().zip(scales) {
            let work = move || *done = Some(trial(scale));
            // Where the system refuses a thread, this one does the work below.
            let _ = std::thread::Builder::new().name("pilot".to_owned()).spawn_scoped(scope, work);
        }
    });
    let done = trials.into_iter().zip(scales);
    done.map(|(done, &scale)| done.unwrap_or_else(|| trial(scale))).collect()
}

/// The counts of the trial with the least variance times cost: without guided flights, and with the
/// first way to gather the light at the end of rays, unless another one is clearly better.
fn best(
    trials: &[Trial],
    first: LearnedCounts,
    scales: &[f32],
    learns_ends: bool,
) -> LearnedCounts {
    // In a fire that hardly scatters, direct emission is most of the noise, and no scale lowers it.
    let emission = trials.iter().map(|trial| trial.emission).sum::<f64>() / trials.len() as f64;
    let usual = RayEnds::of(&first);
    let (mut least, mut best) = (f64::INFINITY, first);
    for (&guided_flights, trial) in scales.iter().zip(trials) {
        for ends in RayEnds::all().filter(|&ends| learns_ends || ends == usual) {
            let margin = if guided_flights > 0.0 || scales.len() == 1 { 1.0 } else { MARGIN };
            let margin_of_ends = if ends == usual { MARGIN_OF_ENDS } else { 1.0 };
            let (variance, cost) = trial.of(ends);
            let product = (variance + emission) * cost * margin * margin_of_ends;
            if product < least {
                least = product;
                best = ends.applied(first.with_guided_flights(guided_flights));
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

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
        Trial { variance: all(variance), emission: 1.0, cost: all(cost) }
    }

    /// Each scale is selected where it has the least variance times cost.
    #[test]
    fn the_least_variance_times_cost_is_best() {
        for (variances, costs, scale) in [
            ([1.0, 1.0, 1.0, 1.0], [1.0, 2.0, 3.0, 4.0], 0.0),
            ([9.0, 1.0, 0.9, 0.8], [1.0, 2.0, 3.0, 4.0], 0.06),
            ([9.0, 9.0, 1.0, 0.9], [1.0, 2.0, 3.0, 4.0], 0.25),
            ([99.0, 50.0, 20.0, 1.0], [1.0, 2.0, 3.0, 4.0], 1.0),
            // Variance that no scale lowers makes the cheapest share best.
            ([0.3, 0.2, 0.1, 0.0], [1.0, 2.0, 3.0, 4.0], 0.0),
            // Hardly better than none is not clearly better.
            ([1.0, 0.9, 2.0, 2.0], [1.0, 1.0, 1.0, 1.0], 0.0),
            ([1.0, 0.2, 2.0, 2.0], [1.0, 1.0, 1.0, 1.0], 0.06),
            ([f64::NAN; 4], [1.0; 4], FIRST_SCALE),
        ] {
            let trials: Vec<Trial> = (0..4).map(|i| trial(variances[i], costs[i])).collect();
            let first = LearnedCounts::first(FIRST_SCALE);
            let best = best(&trials, first, &TRIED, true);
            assert_eq!(best.guided_flights, scale, "{variances:?}");
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
        for (factor, learns, ends) in
            [(0.5, true, other), (0.97, true, usual), (1.5, true, usual), (0.5, false, usual)]
        {
            let mut trial = trial(1.0, 1.0);
            trial.variance[RayEnds::COUNT - 1] = factor;
            trial.emission = 0.0;
            let best = best(&[trial], first, &[1.0], learns);
            assert_eq!(RayEnds::of(&best), ends, "{factor} {learns}");
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
