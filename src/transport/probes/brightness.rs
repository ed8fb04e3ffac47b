//! How much light the medium scatters into a picture, and how much comes off surfaces.

use glam::{UVec2, Vec2};

use super::probes::Probes;
use super::stages::SEED;
use crate::{
    error::{Progress, Result, report},
    math::{PathRng, luminance},
    surface,
    transport::{direct, emission::EmissionEstimator, scene::Scene, vertex::Vertex},
};

/// Side of the grid of camera rays that are looked along.
const SIDE: u32 = 24;

/// The light of a film after one bounce, the mean over its pixels, as the probes and a few looks at
/// the lights tell it. It decides how often guided flights pay.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Brightness {
    /// Radiance that the medium scatters into a ray from the camera.
    pub scattered: f32,
    /// The part that has in all such light; the rest comes off surfaces, and guides don't help it.
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

    /// With so many times the guided flights.
    pub fn scaled(self, flights: f32) -> Self {
        Self { share: self.share * flights, ..self }
    }
}

/// Light that is scattered into ray number `index` and light that is reflected into it.
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
    let look = direct::sample_lights(scene, &emission_estimator, &vertex, &choice, &mut rng);
    let reflected = luminance(look.light)
        * distance_pdf.map_or(1.0, |distance_pdf| distance_pdf.transmittance());
    [scattered, if reflected.is_finite() { reflected } else { 0.0 }]
}
