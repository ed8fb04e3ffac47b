//! Pilot pixels: pixels sampled before the picture to measure variance and cost.

use glam::{UVec2, Vec2};

use crate::transport::context::PathContext;
use crate::transport::observer::Observer;
use crate::transport::path;
use crate::transport::sample::PathSample;
use crate::transport::scene::Scene;
use crate::{
    math::{PathRng, Ray},
    surface,
};

/// Fixed seed, which with the sample numbers used here no picture is likely to have.
const SEED: u64 = 0x6f70_7469_6d61_6c21;

/// Cost that one set of pilot paths is worth for each pixel of the film, in tracking steps of one
/// of two paths at each pilot pixel: about as much as an eighth of a sample.
const BUDGET_PER_PIXEL: f64 = 16.0;
/// Least cost of a set of pilot paths.
pub(in crate::transport) const LEAST_BUDGET: f64 = 16_384.0;
/// Most cost of a set of pilot paths.
const MOST_BUDGET: f64 = 262_144.0;

/// Cost that one set of pilot paths may take for a film of `size`.
pub(in crate::transport) fn budget(size: UVec2) -> f64 {
    let pixels = f64::from(size.x) * f64::from(size.y);
    (BUDGET_PER_PIXEL * pixels).clamp(LEAST_BUDGET, MOST_BUDGET)
}

/// A pixel and two rays through it.
pub(in crate::transport) struct PilotPixel<'s> {
    pub(in crate::transport) scene: &'s Scene,
    pixel: UVec2,
    pub(in crate::transport) rays: [Ray; 2],
}

impl<'s> PilotPixel<'s> {
    /// Pilot pixel number `index` of a sequence that covers the film evenly (Roberts 2018, R₂).
    pub(in crate::transport) fn new(scene: &'s Scene, size: UVec2, index: u32) -> Self {
        const STEP: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];
        let place = STEP.map(|step| (0.5 + step * f64::from(index)).fract() as f32);
        let pixel = (Vec2::from_array(place) * size.as_vec2()).as_uvec2().min(size - UVec2::ONE);
        let mut rng = PathRng::new(SEED, pixel, u32::MAX);
        let rays = [(); 2].map(|()| {
            let offset = Vec2::new(rng.uniform(), rng.uniform());
            scene.camera_ray(size, pixel, offset, &mut rng)
        });
        Self { scene, pixel, rays }
    }

    /// Ray parameter at which a surface ends the first ray; infinite without one.
    pub(in crate::transport) fn end(&self) -> f32 {
        surface::intersect(&self.scene.surfaces, &self.rays[0])
            .map_or(f32::INFINITY, |end| end.hit.t)
    }

    /// Whether the first ray meets any of the medium.
    pub(in crate::transport) fn meets_medium(&self) -> bool {
        self.scene.world.along(self.rays[0], self.end()).extent().is_some()
    }

    /// Random numbers for measurement `number` at this pixel; each number has its own.
    pub(in crate::transport) fn rng(&self, number: u32) -> PathRng {
        PathRng::new(SEED, self.pixel, u32::MAX - 1 - number)
    }

    /// A path along one of the rays.
    pub(in crate::transport) fn path(
        &self,
        context: PathContext<'_>,
        ray: usize,
        number: u32,
        observer: &mut impl Observer,
    ) -> PathSample {
        path::trace(self.scene, context, self.rays[ray], &mut self.rng(number), observer)
    }
}

/// Half the square of the difference of two independent estimates, which is their variance on
/// average.
pub(in crate::transport) fn half_square(difference: f64) -> f64 {
    0.5 * difference * difference
}
