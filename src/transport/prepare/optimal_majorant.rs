//! Collisions k of the optimal majorant along the brightest chord, from measured variance and
//! steps.
//!
//! At k collisions along the brightest chord a sample has a variance of about A + B/k and takes
//! about C + S k steps. The product of the two is least at k = √(B C / (A S)). All four are
//! measured on a few camera rays before the first sample, with random numbers that no picture uses
//! and costs counted in steps, so that the same scene on the same film always gets the same k.

use glam::UVec2;

use super::pilot_pixel::{PilotPixel, half_square};
use crate::error::{Progress, Result, report};
use crate::math::luminance;
use crate::transport::context::PathContext;
use crate::transport::emission::EmissionEstimator;
use crate::transport::emission::ray::RayKind;
use crate::transport::learned_counts::LearnedCounts;
use crate::transport::observer::Nobody;
use crate::transport::probes::Brightness;
use crate::transport::scene::Scene;

/// Most pixels with emission that are measured.
const MOST_PILOT_PIXELS: u32 = 192;
/// Most pixels that are searched for emission.
const MOST_SEARCHED: u32 = 4096;
/// Steps after which the measurement makes do with what it has; a segment searched counts as one.
const MOST_STEPS: u32 = 1 << 17;
/// Values of k that are measured.
const TRIED: [f32; 2] = [32.0, 256.0];
/// Cost of a path beside its steps, in steps. Measured: 5 for a camera ray that meets a fire or
/// nothing, 40 with a few vertices.
const PATH_COST: f64 = 8.0;
/// k where nothing could be measured.
const UNMEASURED: f32 = 32.0;
/// Most that the steps at k may cost, relative to all other cost: beyond this, more collisions gain
/// next to nothing.
const DEAREST: f64 = 8.0;
/// Range of k.
const RANGE: [f64; 2] = [1.0, 4096.0];

/// The k with the least variance times cost for camera rays of `scene` on a film of `size`.
///
/// # Errors
/// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
pub(in crate::transport) fn fit(scene: &Scene, size: UVec2, progress: Progress) -> Result<f32> {
    Ok(measure(scene, size, progress)?.optimum().unwrap_or(UNMEASURED))
}

/// Sums over the pilot pixels.
#[derive(Clone, Copy, Debug, Default)]
struct Measured {
    searched: u32,
    pilot_pixels: u32,
    /// Variance of the walk along one ray at each of [`TRIED`].
    walk_variance: [f64; 2],
    /// Steps of the walk along one ray at each of [`TRIED`].
    walk_steps: [f64; 2],
    /// Variance of whole samples of a pixel at the last of [`TRIED`].
    path_variance: f64,
    /// Steps of whole samples of a pixel at the last of [`TRIED`].
    path_steps: f64,
    /// Steps spent on the whole measurement.
    spent: u32,
}

fn measure(scene: &Scene, size: UVec2, progress: Progress) -> Result<Measured> {
    let mut sums = Measured::default();
    let emits = scene.world.instances().iter().any(|i| i.volume().chords().max_element() > 0.0);
    if !emits || size.min_element() == 0 {
        return Ok(sums);
    }
    while sums.pilot_pixels < MOST_PILOT_PIXELS
        && sums.searched < MOST_SEARCHED
        && sums.spent < MOST_STEPS
    {
        report(progress, sums.spent as f32 / MOST_STEPS as f32)?;
        let pilot_pixel = PilotPixel::new(scene, size, sums.searched);
        sums.searched += 1;
        if pilot_pixel.emits(&mut sums.spent) {
            sums.add(&pilot_pixel);
        }
    }
    Ok(sums)
}

impl Measured {
    fn add(&mut self, pilot_pixel: &PilotPixel) {
        self.pilot_pixels += 1;
        for (i, &k) in TRIED.iter().enumerate() {
            let [a, b] = [0, 1].map(|walk| pilot_pixel.walk(k, 2 * i as u32 + walk));
            self.walk_variance[i] += half_square(a.0 - b.0);
            self.walk_steps[i] += 0.5 * (f64::from(a.1) + f64::from(b.1));
            self.spent = self.spent.saturating_add(a.1).saturating_add(b.1);
        }
        let [a, b] = [0, 1].map(|path| pilot_pixel.traced(TRIED[1], path));
        self.path_variance += half_square(a.0 - b.0);
        self.path_steps += 0.5 * (f64::from(a.1) + f64::from(b.1));
        self.spent = self.spent.saturating_add(a.1).saturating_add(b.1);
    }

    /// The k of least variance times cost; `None` where k made no measurable difference.
    fn optimum(&self) -> Option<f32> {
        let [few, many] = TRIED.map(f64::from);
        let pilot_pixels = f64::from(self.pilot_pixels);
        let per_collision = (self.walk_steps[1] - self.walk_steps[0]) / (many - few);
        let unboosted = (self.walk_steps[0] - per_collision * few).max(0.0);
        let others = self.path_steps - self.walk_steps[1];
        // The pixels without emission cost something as well.
        let cost = PATH_COST * f64::from(self.searched) + (others + unboosted).max(0.0);
        let drop = (self.walk_variance[0] - self.walk_variance[1]) / (1.0 / few - 1.0 / many);
        if !(pilot_pixels > 0.0 && per_collision > 0.0 && drop > 0.0 && drop.is_finite()) {
            return None;
        }
        let left = |variance: f64| (variance - drop / many).max(0.0);
        let rest = left(self.path_variance).max(left(self.walk_variance[1]));
        let dearest = DEAREST * cost / per_collision;
        let best = (drop * cost / (rest * per_collision)).sqrt().min(dearest);
        best.is_finite().then(|| best.clamp(RANGE[0], RANGE[1]) as f32)
    }
}

impl PilotPixel<'_> {
    /// Whether the first ray meets anything that may emit; adds the segments it took to find out to
    /// `spent`.
    fn emits(&self, spent: &mut u32) -> bool {
        let mut medium = self.scene.world.along(self.rays[0], self.end());
        while let Some(segment) = medium.next_segment() {
            *spent += 1;
            if segment.emission_rate > 0.0 {
                return true;
            }
        }
        false
    }

    /// The emission that walk `number` gathers along the first ray, and its steps.
    fn walk(&self, k: f32, number: u32) -> (f64, u32) {
        let medium = self.scene.world.along(self.rays[0], self.end());
        let mut rng = self.rng(number);
        let gathered = EmissionEstimator::optimal(k).gather(medium, RayKind::Camera, &mut rng);
        (f64::from(luminance(gathered.emission)), gathered.collisions)
    }

    /// Luminance of a path along ray `number`, and its steps.
    fn traced(&self, k: f32, number: u32) -> (f64, u32) {
        let emission_estimator = EmissionEstimator::optimal(k);
        let counts = LearnedCounts::first(0.0);
        let context = unguided(&emission_estimator, &counts);
        let sample = self.path(context, number as usize, 7 + number, &mut Nobody);
        (f64::from(luminance(sample.beauty())), sample.tracking_steps)
    }
}

fn unguided<'s>(
    emission_estimator: &'s EmissionEstimator,
    counts: &'s LearnedCounts,
) -> PathContext<'s> {
    PathContext { emission_estimator, probes: None, brightness: Brightness::default(), counts }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::{error::NO_PROGRESS, math::PathRng, transport::path};

    const SIZE: UVec2 = UVec2::new(24, 24);

    fn fit(scene: &Scene, size: UVec2) -> f32 {
        super::fit(scene, size, NO_PROGRESS).unwrap()
    }

    fn measure(scene: &Scene, size: UVec2) -> Measured {
        super::measure(scene, size, NO_PROGRESS).unwrap()
    }

    const CAMERA: &str = r#"
        [camera]
        position = [0, -4, 0]
        target = [0, 0, 0]
        fov_x = 40
    "#;

    const FIRE: &str = r#"
        [[volume]]
        shape = "noise"
        half_size = 0.8
        frequency = 2.0
        contrast = 3.0
        density = { scale = 0.5 }
        albedo = 0.0
        emission = { mode = "source", le = [3.0, 1.0, 0.2] }
    "#;

    const SMOKE: &str = r#"
        [[volume]]
        shape = "noise"
        half_size = [1.0, 0.3, 1.0]
        translate = [0, -1.5, 0]
        frequency = 2.0
        density = { scale = 8.0 }
        albedo = 0.0
    "#;

    /// Variance of independent samples times their cost, over the whole film.
    fn variance_times_cost(scene: &Scene, k: f32) -> f64 {
        const SAMPLES: u32 = 64;
        let emission_estimator = EmissionEstimator::optimal(k);
        let counts = LearnedCounts::first(0.0);
        let context = unguided(&emission_estimator, &counts);
        let (mut variance, mut steps) = (0.0, 0.0);
        for i in 0..SIZE.element_product() {
            let pixel = UVec2::new(i % SIZE.x, i / SIZE.x);
            let (mut sum, mut squares) = (0.0, 0.0);
            for sample in 0..SAMPLES {
                let mut rng = PathRng::new(0, pixel, sample);
                let offset = Vec2::new(rng.uniform(), rng.uniform());
                let ray = scene.camera.ray(SIZE, pixel, offset);
                let sample = path::trace(scene, context, ray, &mut rng, &mut Nobody);
                let value = f64::from(luminance(sample.beauty()));
                (sum, squares) = (sum + value, squares + value * value);
                steps += f64::from(sample.tracking_steps);
            }
            variance += squares - sum * sum / f64::from(SAMPLES);
        }
        let paths = f64::from(SIZE.element_product() * SAMPLES);
        variance * (PATH_COST + steps / paths)
    }

    /// Among 1/16 to 4 times the fitted k none is better by more than a quarter, while the worst is
    /// far worse.
    #[test]
    fn no_other_k_is_much_better() {
        for (name, text) in [
            ("fire", format!("{CAMERA}{FIRE}")),
            ("fire behind smoke", format!("{CAMERA}{FIRE}{SMOKE}")),
        ] {
            let scene = Scene::of_text(&text);
            let found = fit(&scene, SIZE);
            let all = [1.0 / 16.0, 0.25, 0.5, 1.0, 2.0, 4.0]
                .map(|scale| variance_times_cost(&scene, scale * found));
            let best = all.into_iter().fold(f64::INFINITY, f64::min);
            let worst = all.into_iter().fold(0.0, f64::max);
            assert!(all[3] < 1.25 * best, "{name}: {found} gives {all:?}");
            assert!(worst > 2.0 * best, "{name}: the scan shows nothing: {all:?}");
        }
    }

    #[test]
    fn every_measurement_has_the_same_result() {
        let text = format!("{CAMERA}{FIRE}{SMOKE}");
        let found = fit(&Scene::of_text(&text), SIZE);
        let threads: Vec<_> = (0..3)
            .map(|_| {
                let text = text.clone();
                std::thread::spawn(move || fit(&Scene::of_text(&text), SIZE))
            })
            .collect();
        for thread in threads {
            assert_eq!(thread.join().unwrap(), found);
        }
        assert_ne!(found, UNMEASURED);
    }

    /// A step or a segment takes some ten nanoseconds.
    #[test]
    fn measuring_costs_milliseconds_at_most() {
        let measured = measure(&Scene::of_text(&format!("{CAMERA}{FIRE}{SMOKE}")), SIZE);
        assert!(measured.pilot_pixels > 50 && measured.spent < 2 * MOST_STEPS, "{measured:?}");

        let dark = Scene::of_text(&format!("{CAMERA}{SMOKE}"));
        assert_eq!(measure(&dark, SIZE).searched, 0);
        assert_eq!(fit(&dark, SIZE), UNMEASURED);

        let away = CAMERA.replace("[0, 0, 0]", "[0, -8, 0]");
        let unseen = Scene::of_text(&format!("{away}{FIRE}{SMOKE}"));
        let measured = measure(&unseen, SIZE);
        assert!(measured.pilot_pixels == 0 && measured.spent == 0, "{measured:?}");
        assert_eq!(fit(&unseen, SIZE), UNMEASURED);

        // Smoke fills the view and hides nothing that emits.
        let beside = FIRE.replace("[[volume]]", "[[volume]]\ntranslate = [0, -9, 0]");
        let hidden = Scene::of_text(&format!("{CAMERA}{beside}{SMOKE}"));
        let measured = measure(&hidden, SIZE);
        assert!(measured.pilot_pixels == 0 && measured.spent < 2 * MOST_STEPS, "{measured:?}");
    }

    /// Radiance that cannot be squared or that is next to nothing still gives a valid k.
    #[test]
    fn every_emission_has_a_valid_k() {
        for le in ["3e38", "1e30", "1e-30", "1e-44"] {
            for density in ["1e-30", "0.5", "1e9", "1e30"] {
                let fire = FIRE
                    .replace("[3.0, 1.0, 0.2]", le)
                    .replace("scale = 0.5", &format!("scale = {density}"));
                let scene = Scene::of_text(&format!("{CAMERA}{fire}"));
                let k = fit(&scene, UVec2::splat(4));
                assert!((1.0..=4096.0).contains(&k), "le {le}, density {density}: {k}");
            }
        }
    }
}
