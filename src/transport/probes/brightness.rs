//! Mean in-scattered radiance over a film, estimated from the probes, and its share among surface
//! reflection.

use glam::{UVec2, Vec2};

use super::probes::Probes;
use super::stages::SEED;
use crate::{
    error::{Progress, Result, report},
    math::{PathRng, luminance},
    surface,
    transport::{direct, emission::EmissionEstimator, scene::Scene, vertex::Vertex},
};

/// Side of the grid of camera rays along which the radiance is estimated.
const SIDE: u32 = 24;

/// Mean radiance over the film after one bounce, estimated from the probes and a few light samples.
/// Determines the number of guided flights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Brightness {
    /// Mean radiance that the medium scatters into a camera ray.
    pub scattered: f32,
    /// Share, 0 to 1, of in-scattered radiance in all of it; the rest is reflected by surfaces, and
    /// guiding does not help it.
    pub share: f32,
}

impl Brightness {
    /// Brightness of a film of `size` pixels.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn new(probes: &Probes, scene: &Scene, size: UVec2, progress: Progress) -> Result<Self> {
        let (mut scattered, mut reflected) = (0.0, 0.0);
        for i in 0..SIDE * SIDE {
            report(progress, i as f32 / (SIDE * SIDE) as f32)?;
            let [one, other] = light_along(probes, scene, size, i);
            scattered += one;
            reflected += other;
        }
        let share = scattered / (scattered + reflected);
        Ok(Self {
            scattered: scattered / (SIDE * SIDE) as f32,
            share: if share.is_finite() { share } else { 1.0 },
        })
    }

    /// The brightness that allocates `flights` times as many guided flights.
    pub fn scaled(self, flights: f32) -> Self {
        Self { share: self.share * flights, ..self }
    }
}

/// Radiance that is scattered into ray number `index`, and radiance that is reflected into it.
fn light_along(probes: &Probes, scene: &Scene, size: UVec2, index: u32) -> [f32; 2] {
    let cell = UVec2::new(index % SIDE, index / SIDE).as_vec2() + Vec2::splat(0.5);
    let place = cell / SIDE as f32 * size.as_vec2();
    let ray = scene.camera.ray(size, place.as_uvec2(), place.fract());
    let end = surface::intersect(&scene.surfaces, &ray);
    let t_max = end.as_ref().map_or(f32::INFINITY, |end| end.hit.t);
    let distance_pdf = probes.along(scene.world.along(ray, t_max), &ray);
    let scattered = distance_pdf.as_ref().map_or(0.0, |distance_pdf| distance_pdf.light());
    let Some(vertex) = end.and_then(|end| Vertex::reflecting(&end, &ray)) else {
        return [scattered, 0.0];
    };
    let mut rng = PathRng::new(SEED, UVec2::new(index, 1), 0);
    let (emission_estimator, choice) =
        (EmissionEstimator::coarse(), direct::choice(&scene.strategy));
    let sample = direct::sample_lights(scene, &emission_estimator, &vertex, &choice, &mut rng);
    let reflected = luminance(sample.light)
        * distance_pdf.map_or(1.0, |distance_pdf| distance_pdf.transmittance());
    [scattered, if reflected.is_finite() { reflected } else { 0.0 }]
}
