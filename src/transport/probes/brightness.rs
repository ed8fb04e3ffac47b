//! The light of a film after one bounce, estimated from the probes: the mean radiance that the
//! medium scatters, and its fraction beside what surfaces reflect.

use glam::{UVec2, Vec2};

use super::probes::Probes;
use super::stages::SEED;
use crate::{
    error::{Progress, Result, report},
    math::{PathRng, luminance},
    surface,
    transport::{
        direct, direct::LightSampling, emission::EmissionEstimator, scene::Scene, vertex::Vertex,
    },
};

/// Side of the grid of camera rays along which the radiance is estimated.
const SIDE: u32 = 24;

/// Mean radiance over the film after one bounce, estimated from the probes and a few light samples.
/// Determines the number of guided flights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Brightness {
    /// Mean radiance that the medium scatters into a camera ray.
    pub scattered: f32,
    /// Fraction, 0 to 1, of the light after one bounce that the medium scatters; surfaces reflect
    /// the rest, and guiding does not help it.
    pub volume_fraction: f32,
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
        let volume_fraction = scattered / (scattered + reflected);
        Ok(Self {
            scattered: scattered / (SIDE * SIDE) as f32,
            volume_fraction: if volume_fraction.is_finite() { volume_fraction } else { 1.0 },
        })
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
    let scattered = distance_pdf.as_ref().map_or(0.0, |distance_pdf| distance_pdf.in_scattered());
    let Some(vertex) = end.and_then(|end| Vertex::reflecting(&end, &ray)) else {
        return [scattered, 0.0];
    };
    let mut rng = PathRng::new(SEED, UVec2::new(index, 1), 0);
    let emission_estimator = EmissionEstimator::coarse();
    let sampling = LightSampling::one_of_each(direct::choice(&scene.strategy));
    let sample = direct::sample_lights(scene, &emission_estimator, &vertex, &sampling, &mut rng);
    let reflected = luminance(sample.contribution)
        * distance_pdf.map_or(1.0, |distance_pdf| distance_pdf.transmittance());
    [scattered, if reflected.is_finite() { reflected } else { 0.0 }]
}
