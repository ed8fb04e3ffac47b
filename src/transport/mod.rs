//! How light moves through volumes: the strategies and the paths they sample. Read `path` first.

pub mod camera;
pub mod direct;
mod distance;
pub mod emission;
mod guiding;
mod march;
pub mod observer;
pub mod path;
mod prepare;
pub mod probes;
pub mod profile;
pub mod scene;
pub mod shadow;
pub mod strategy;
pub mod toggle;
pub mod tracking;
mod transmittance;
pub mod vertex;
mod weight_window;

use std::sync::{Arc, OnceLock};

use glam::{UVec2, Vec2};

pub use scene::Scene;

use crate::math::{PathRng, Rgb, Slot};
use emission::EmissionEstimator;
use observer::{Nobody, Observer};
use path::PathContext;
use probes::{Brightness, Probes};

/// The version of the paths, raised whenever (scene, strategy, seed, pixel, sample) leads to another
/// path than before. Snapshots carry it: samples of two versions are of two series of random numbers
/// and of two estimators, so that only those of the same version are continued.
pub const PATH_VERSION: u64 = 1;

/// What one path brought to its pixel: four parts that sum to the beauty, and what else is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathSample {
    /// Volume emission seen on the camera ray.
    pub emission: Rgb,
    /// Environment and emitting surfaces seen directly.
    pub background: Rgb,
    /// Light after one scattering event or reflection.
    pub direct: Rgb,
    /// Light after more of them.
    pub indirect: Rgb,
    /// 1 − transmittance to the background; 1 on surfaces.
    pub alpha: f32,
    /// Distance of the first event or surface, if there was one.
    pub depth: Option<f32>,
    /// Tentative collisions of all walks of the path, and steps of ray marching.
    pub tracking_steps: u32,
    /// Whether the path was cut, at [`path::GUARD`] events or [`tracking::MOST_COLLISIONS`].
    pub guard_hit: bool,
}

impl PathSample {
    /// All light of the path.
    pub fn beauty(&self) -> Rgb {
        self.emission + self.background + self.direct + self.indirect
    }
}

/// Anything that can sample a pixel: film and session know nothing more.
pub trait PixelSampler: Send + Sync {
    /// The path of this sample of this pixel; the same arguments give the same path.
    fn sample(&self, pixel: UVec2, sample: u32) -> PathSample;

    /// How often probes are asked, relative to what they propose; `None` until that is found out,
    /// and where it never is.
    fn found_flights(&self) -> Option<f32> {
        None
    }
}

/// A scene framed on a film.
#[derive(Clone, Debug)]
pub struct Frame {
    scene: Arc<Scene>,
    size: UVec2,
    seed: u64,
    /// Fits the scene and the size, and so do both stay as they are.
    emission_estimator: EmissionEstimator,
    /// Those of the scene.
    probes: Option<Arc<Probes>>,
    /// What the probes think of the film.
    brightness: Brightness,
    /// Guided flights that pay; found when they are first asked for.
    flights: OnceLock<f32>,
}

impl Frame {
    /// Frames `scene` on a film of `size` pixels; `seed` chooses the random numbers of the whole
    /// picture. Probes are placed where they are asked for, and with the optimal majorant a few
    /// milliseconds go into finding how often it looks, both whatever the seed.
    pub fn new(scene: Arc<Scene>, size: UVec2, seed: u64) -> Self {
        let probes = Probes::new(&scene).map(Arc::new);
        Self::with_probes(scene, size, seed, probes)
    }

    /// The same with probes placed before, which have to be those of the scene, or without any:
    /// they change the noise of the picture and not its mean.
    pub fn with_probes(
        scene: Arc<Scene>,
        size: UVec2,
        seed: u64,
        probes: Option<Arc<Probes>>,
    ) -> Self {
        let emission_estimator = EmissionEstimator::new(&scene, size);
        let brightness =
            probes.as_ref().map(|probes| Brightness::new(probes, &scene, size)).unwrap_or_default();
        let flights = OnceLock::new();
        Self { scene, size, seed, emission_estimator, probes, brightness, flights }
    }

    /// The same with another seed; all that was found out for the picture stays found.
    pub fn with_seed(&self, seed: u64) -> Self {
        Self { seed, ..self.clone() }
    }

    /// Pixels across and down.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Follows one path and shows each of its steps to `observer`.
    pub fn trace(&self, pixel: UVec2, sample: u32, observer: &mut impl Observer) -> PathSample {
        let mut rng = if self.scene.strategy.advanced.low_discrepancy {
            PathRng::stratified(self.seed, pixel, sample)
        } else {
            PathRng::new(self.seed, pixel, sample)
        };
        let offset = Vec2::new(rng.at(Slot::PixelX), rng.at(Slot::PixelY));
        let ray = self.scene.camera.ray(self.size, pixel, offset);
        // The first sample does not wait for the pilot, so that a camera on the move never does.
        let learns = self.probes.is_some() && self.scene.strategy.learns_share();
        let flights = if learns && sample == 0 {
            prepare::guided_flights::FIRST
        } else {
            self.guided_flights()
        };
        let context = self.context(flights);
        path::trace(&self.scene, context, ray, &mut rng, observer)
    }

    fn context(&self, flights: f32) -> PathContext<'_> {
        let probes = self.probes.as_deref();
        PathContext {
            emission_estimator: &self.emission_estimator,
            probes,
            brightness: self.brightness,
            flights,
        }
    }

    /// Guided flights of each sample but the first, relative to what the probes propose: those that
    /// pay in this picture, 0 if none do. Finding out takes a tenth of a second at the first call.
    pub fn guided_flights(&self) -> f32 {
        if self.probes.is_none() || !self.scene.strategy.learns_share() {
            return 1.0;
        }
        *self.flights.get_or_init(|| {
            prepare::guided_flights::flights(&self.scene, self.size, |f| self.context(f))
        })
    }
}

impl PixelSampler for Frame {
    fn sample(&self, pixel: UVec2, sample: u32) -> PathSample {
        self.trace(pixel, sample, &mut Nobody)
    }

    fn found_flights(&self) -> Option<f32> {
        self.flights.get().copied()
    }
}
