//! The pilot pass, which measures before the second sample of a pixel how many guided flights pay
//! in a picture.
//!
//! Probes cost time along every ray, and each guided flight is a path. Inside of smoke with a lamp
//! in it they lower the noise a hundred times; a cloud under an even sky, or fire that hardly
//! scatters, is as noisy without them and takes half of the time. So the pilot pass tries a few
//! scales of the number of guided flights on some pixels, and takes the one with the least variance
//! times cost.
//!
//! Costs are counted, not timed, and the random numbers are none of the picture's, so that the same
//! scene on the same film always gets the same scale. The picture is unbiased with any of them.

use glam::UVec2;

use super::cost::Cost;
use super::pilot_pixel::{PilotPixel, half_square};
use crate::transport::context::PathContext;
use crate::transport::scene::Scene;
use crate::{
    error::{Progress, Result, report},
    math::luminance,
};

/// Scales that the pilot pass tries, relative to the number of flights that the probes propose.
const TRIED: [f32; 4] = [0.0, 0.06, 0.25, 1.0];
/// The scale that first samples use, which do not wait for the pilot pass.
pub(in crate::transport) const FIRST: f32 = 0.25;
/// Cost spent on each scale, in tracking steps of one of two paths at each pixel.
const BUDGET: f64 = 131_072.0;
/// Most pixels that a scale is tried on.
const MOST_PILOT_PIXELS: u32 = 1 << 14;
/// Cost of reading the probes along a ray, in tracking steps. Measured as the rest is.
const GUIDE_COST: f64 = 26.0;
/// Factor by which guided flights must lower variance times cost against none, which the pilot pass
/// measures to a fifth.
const MARGIN: f64 = 0.8;

/// The scale of guided flights with the least variance times cost for `scene` on a film of `size`;
/// `context` builds the context of a scale.
///
/// # Errors
/// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
pub(in crate::transport) fn flights_scale<'s>(
    scene: &Scene,
    size: UVec2,
    context: impl Fn(f32) -> PathContext<'s> + Sync,
    progress: Progress,
) -> Result<f32> {
    if size.min_element() == 0 {
        return Ok(FIRST);
    }
    let mut trials = TRIED.map(|_| None);
    // Threads of their own: a worker that waits here for others might take up a sample meanwhile
    // that waits for this.
    std::thread::scope(|scope| {
        for (trial, scale) in trials.iter_mut().zip(TRIED) {
            let context = context(scale);
            let work = move || *trial = Some(ScaleTrial::new(scene, size, context, progress));
            // Where the system refuses a thread, this one does the work below.
            let _ = std::thread::Builder::new().name("pilot".to_owned()).spawn_scoped(scope, work);
        }
    });
    let mut done = [ScaleTrial::default(); TRIED.len()];
    for ((done, trial), scale) in done.iter_mut().zip(trials).zip(TRIED) {
        *done = trial.unwrap_or_else(|| ScaleTrial::new(scene, size, context(scale), progress))?;
    }
    Ok(best(&done))
}

/// The scale with the least variance times cost, or none where it is not clearly better.
fn best(trials: &[ScaleTrial; TRIED.len()]) -> f32 {
    // In a fire that hardly scatters, direct emission is most of the noise, and no scale lowers it.
    let emission = trials.iter().map(|trial| trial.emission).sum::<f64>() / trials.len() as f64;
    let (mut least, mut best) = (f64::INFINITY, FIRST);
    for (scale, trial) in TRIED.into_iter().zip(trials) {
        let margin = if scale > 0.0 { 1.0 } else { MARGIN };
        let product = (trial.scattered + emission) * trial.cost * margin;
        if product < least {
            (least, best) = (product, scale);
        }
    }
    best
}

/// Measurements of one scale.
#[derive(Clone, Copy, Debug, Default)]
struct ScaleTrial {
    /// Mean over the pixels of the variance of the light that is scattered or reflected to them.
    scattered: f64,
    /// Mean over the pixels of the variance of the emission that is seen directly.
    emission: f64,
    /// Mean cost of a sample, in steps.
    cost: f64,
}

impl ScaleTrial {
    fn new(
        scene: &Scene,
        size: UVec2,
        context: PathContext<'_>,
        progress: Progress,
    ) -> Result<Self> {
        let (mut trial, mut pilot_pixels) = (Self::default(), 0);
        while trial.cost < BUDGET && pilot_pixels < MOST_PILOT_PIXELS {
            report(progress, (trial.cost / BUDGET) as f32)?;
            let pilot_pixel = PilotPixel::new(scene, size, pilot_pixels);
            let guides = if context.flights_scale > 0.0 && pilot_pixel.meets_medium() {
                GUIDE_COST
            } else {
                0.0
            };
            let [a, b] = [0, 1].map(|number| {
                let mut cost = Cost::default();
                let sample = pilot_pixel.path(context, 0, number, &mut cost);
                trial.cost += 0.5 * (cost.of(&sample) + guides);
                [sample.direct + sample.indirect, sample.emission]
                    .map(|light| f64::from(luminance(light)))
            });
            trial.scattered += half_square(a[0] - b[0]);
            trial.emission += half_square(a[1] - b[1]);
            pilot_pixels += 1;
        }
        let pilot_pixels = f64::from(pilot_pixels);
        let Self { scattered, emission, cost } = trial;
        Ok(Self {
            scattered: scattered / pilot_pixels,
            emission: emission / pilot_pixels,
            cost: cost / pilot_pixels,
        })
    }
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

    /// Each scale is selected where it has the least variance times cost.
    #[test]
    fn the_least_variance_times_cost_is_best() {
        let trial = |scattered, cost| ScaleTrial { scattered, emission: 1.0, cost };
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
            ([f64::NAN; 4], [1.0; 4], FIRST),
        ] {
            let trials = std::array::from_fn(|i| trial(variances[i], costs[i]));
            assert_eq!(best(&trials), scale, "{variances:?}");
        }
    }

    /// The pilot pass has the same result on any thread, however many run at once.
    #[test]
    fn every_pilot_pass_has_the_same_result() {
        use rayon::prelude::*;
        let expected = frame(LAMP).guided_flights();
        let found: Vec<f32> =
            (0..3).into_par_iter().map(|_| frame(LAMP).guided_flights()).collect();
        assert!(found.iter().all(|flights| *flights == expected), "{expected}, {found:?}");
    }
}
