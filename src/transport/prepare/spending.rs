//! Counts the cost of some paths of a picture by kind of work.

use super::cost::Cost;
use super::pilot_film::PilotFilm;
use super::pilot_pixel::{LEAST_BUDGET, PilotPixel};
use crate::error::{Progress, Result, report};
use crate::transport::learned_counts::BounceClass;
use crate::transport::observer::{Observer, PathStep};
use crate::transport::path_setup::PathSetup;
use crate::transport::spending::{BounceCounts, Spending, Work};

/// Most pixels whose paths are counted.
const MOST_PIXELS: u32 = 1 << 12;
/// First of the random numbers of these paths: other pilots have those before.
const FIRST_NUMBER: u32 = 32;

/// Counts how paths of the film with `setup` spend their time.
///
/// # Errors
/// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
pub(super) fn measure(
    film: PilotFilm<'_>,
    setup: &PathSetup,
    progress: Progress,
) -> Result<Spending> {
    let context = setup.context(film.emission_estimator);
    let mut sums = Sums::default();
    let mut pixels = 0;
    while sums.total < LEAST_BUDGET && pixels < MOST_PIXELS {
        report(progress, (sums.total / LEAST_BUDGET) as f32)?;
        let mut counter = Counter { cost: Cost::new(film.scene), sums: &mut sums };
        let pixel = PilotPixel::new(film.scene, film.size, pixels);
        let sample = pixel.path(context, 0, FIRST_NUMBER, &mut counter);
        let cost = counter.cost.of(&sample);
        sums.total += cost;
        pixels += 1;
    }
    Ok(sums.spending(f64::from(pixels)))
}

/// Sums over paths.
#[derive(Default)]
struct Sums {
    /// Cost of all work.
    total: f64,
    /// Cost of each kind of work but that of the paths themselves.
    cost: [f64; Work::COUNT],
    vertices: [f64; BounceClass::COUNT],
    /// Light samples of fires, of other lights, and emission walks.
    samples: [[f64; 3]; BounceClass::COUNT],
}

impl Sums {
    fn spending(mut self, paths: f64) -> Spending {
        let others: f64 = self.cost.iter().sum();
        self.cost[Work::Paths as usize] = (self.total - others).max(0.0);
        let counts = |class: usize| {
            let vertices = self.vertices[class];
            let samples = self.samples[class].map(|count| ratio(count, vertices));
            BounceCounts { vertices: ratio(vertices, paths), samples }
        };
        Spending {
            shares: self.cost.map(|cost| ratio(cost, self.total)),
            bounces: std::array::from_fn(counts),
        }
    }
}

fn ratio(part: f64, whole: f64) -> f32 {
    if whole > 0.0 { (part / whole) as f32 } else { 0.0 }
}

/// Adds the steps of a path to the sums.
struct Counter<'s, 'p> {
    cost: Cost<'s>,
    sums: &'p mut Sums,
}

impl Counter<'_, '_> {
    fn add(&mut self, work: Work) {
        self.sums.cost[work as usize] += self.cost.of_last_step();
    }

    /// Counts a sample of a kind at a class of vertices.
    fn count(&mut self, class: BounceClass, kind: usize) {
        self.sums.samples[class as usize][kind] += 1.0;
    }
}

impl Observer for Counter<'_, '_> {
    fn step(&mut self, step: PathStep) {
        self.cost.step(step);
        match step {
            PathStep::Vertex { class, .. } => self.sums.vertices[class as usize] += 1.0,
            PathStep::Light { technique, fires, .. } => {
                self.add(if fires { Work::FireSamples } else { Work::LampSamples });
                self.count(technique.class, usize::from(!fires));
            }
            PathStep::Emission { technique, .. } => {
                self.add(Work::Emission);
                self.count(technique.class, 2);
            }
            PathStep::End { own_walk: Some(_), .. } => self.add(Work::Transmittance),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::UVec2;

    use crate::error::NO_PROGRESS;
    use crate::transport::spending::Work;
    use crate::transport::tests::SCENE;
    use crate::transport::{PreparedFrame, Scene};

    /// Shares add up to all of the time, work that a strategy leaves out has none, and no vertex
    /// has more samples of a kind than one.
    #[test]
    fn shares_are_those_of_the_work_there_is() {
        for (nee, text) in [(true, ""), (false, "[strategy]\nnee = false")] {
            let scene = Scene::of_text(&format!("{text}\n{SCENE}"));
            let size = UVec2::new(32, 24);
            let frame = PreparedFrame::new(Arc::new(scene), size, 0, NO_PROGRESS).unwrap();
            let spending = frame.spending().unwrap();
            let sum: f32 = spending.shares.iter().sum();
            assert!((sum - 1.0).abs() < 1e-3, "{sum}");
            let share = |work: Work| spending.shares[work as usize];
            assert_eq!(share(Work::FireSamples) > 0.0, nee, "{spending:?}");
            assert!(share(Work::Paths) > 0.05 && share(Work::Emission) > 0.05, "{spending:?}");
            let counts = spending.bounces.iter().flat_map(|bounce| bounce.samples);
            assert!(counts.clone().all(|count| (0.0..=1.5).contains(&count)), "{spending:?}");
            assert!(counts.sum::<f32>() > 0.0 && spending.bounces[1].vertices > 0.0);
        }
    }
}
