//! The path: camera, flights through the medium, scattering and reflection, light on the way.
//!
//! | what the ray from a vertex gathers | settings without ratio tracking | with ratio tracking |
//! |---|---|---|
//! | ε on the ray | the scattering walk's own, up to its event | the emission walk, whole ray |
//! | the end of the ray | when the scattering walk gets there | with the emission walk's T |
//!
//! With ratio tracking the scattering walk gathers neither, so that nothing counts twice.
//! Every combination of toggles has the same mean.

use super::{
    PathSample,
    direct::{self, Departure},
    emission::{Errand, Gatherer},
    observer::{Observer, Step},
    scene::Scene,
    tracking::{self, Event, Flight},
    vertex::Vertex,
};
use crate::{
    math::{PathRng, Ray, Rgb, mean},
    surface::{self, Bsdf, Intersection, Material},
    volume::world::MediumRay,
};

/// Most scattering events and reflections of any path. A path that gets here is counted.
pub const GUARD: u32 = 100_000;
/// Scattering events and reflections before roulette may end a path.
const ROULETTE_AFTER: u32 = 3;

/// Follows one path from the camera along `ray`; `gatherer` is the emission's own walk.
pub fn trace(
    scene: &Scene,
    gatherer: &Gatherer,
    ray: Ray,
    rng: &mut PathRng,
    observer: &mut impl Observer,
) -> PathSample {
    let mut path = Path {
        scene,
        gatherer,
        ray,
        throughput: Rgb::ONE,
        scatters: 0,
        departure: None,
        sample: PathSample::default(),
    };
    while path.advance(rng, observer) {}
    path.sample
}

struct Path<'s> {
    scene: &'s Scene,
    gatherer: &'s Gatherer,
    ray: Ray,
    throughput: Rgb,
    /// Scattering events and reflections so far.
    scatters: u32,
    /// None for the camera ray.
    departure: Option<Departure>,
    sample: PathSample,
}

impl Path<'_> {
    /// One ray and the vertex at its end; false when the path is over.
    fn advance(&mut self, rng: &mut PathRng, observer: &mut impl Observer) -> bool {
        let scene = self.scene;
        let end = surface::intersect(&scene.surfaces, &self.ray);
        let t_max = end.map_or(f32::INFINITY, |end| end.hit.t);
        observer.step(Step::Ray { ray: &self.ray, t_max, throughput: self.throughput });

        let medium = scene.world.along(self.ray, t_max);
        let coverage = scene
            .strategy
            .emission_ratio_tracking
            .then(|| self.gather_by_ratio_tracking(medium.clone(), end.as_ref(), rng, observer));
        if coverage.is_some() && self.is_last_ray() {
            return false;
        }
        let flight = tracking::scatter(medium, &scene.strategy, self.throughput, rng);
        self.count(flight.collisions);
        if flight.emission != Rgb::ZERO {
            let weight = direct::weight_of_emission(scene, &self.ray, self.departure.as_ref());
            self.gather_emission(weight * flight.emission, observer);
        }
        self.throughput *= flight.weight;
        if !self.throughput.is_finite() {
            // Leads nowhere, and is counted with the sample it spoils.
            self.sample.indirect += self.throughput;
            return false;
        }
        if self.scatters == 0 {
            self.note_first_event(&flight, end.as_ref(), coverage);
        }

        let vertex = match flight.event {
            Event::Absorbed { t, .. } => {
                observer.step(Step::Absorbed { point: self.ray.at(t) });
                return false;
            }
            Event::Scattered { t, phase } => {
                Vertex::volume(self.ray.at(t), self.ray.direction, phase)
            }
            Event::Reached => {
                if !scene.strategy.emission_ratio_tracking {
                    let departure = self.departure.as_ref();
                    let radiance = direct::at_the_end(scene, &self.ray, end.as_ref(), departure);
                    self.gather_end(radiance, observer);
                }
                match end.and_then(|end| reflecting(&end, &self.ray)) {
                    Some(vertex) => vertex,
                    None => return false,
                }
            }
        };
        self.turn(&vertex, rng, observer)
    }

    /// The emission walk over the whole ray, and what lies at its end through the same T, which is
    /// returned.
    fn gather_by_ratio_tracking(
        &mut self,
        medium: MediumRay,
        end: Option<&Intersection>,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) -> Rgb {
        let errand = if self.departure.is_none() { Errand::Camera } else { Errand::Scattered };
        let glow = self.gatherer.gather(medium, errand, rng);
        self.count(glow.collisions);
        let departure = self.departure.as_ref();
        let radiance = direct::at_the_end(self.scene, &self.ray, end, departure);
        if glow.emission != Rgb::ZERO {
            let weight = direct::weight_of_emission(self.scene, &self.ray, departure);
            self.gather_emission(weight * glow.emission, observer);
        }
        self.gather_end(glow.transmittance * radiance, observer);
        glow.transmittance
    }

    /// Whether the path may not turn any more: its last ray still gathers, both halves of the MIS
    /// of the last vertex being due.
    fn is_last_ray(&self) -> bool {
        self.scene.max_scatters > 0 && self.scatters == self.scene.max_scatters
    }

    /// Next-event estimation at a vertex, then a new direction; false when the path ends there.
    fn turn(&mut self, vertex: &Vertex, rng: &mut PathRng, observer: &mut impl Observer) -> bool {
        if self.is_last_ray() {
            return false;
        }
        if self.scatters == GUARD {
            self.sample.guard_hit = true;
            return false;
        }
        self.scatters += 1;
        rng.enter_vertex(self.scatters);
        observer.step(Step::Vertex { vertex, throughput: self.throughput });
        let (light, collisions) = direct::sample_lights(self.scene, self.gatherer, vertex, rng);
        self.count(collisions);
        let light = self.throughput * light;
        observer.step(Step::Light { contribution: light });
        self.add_scattered(light);

        if self.sample.guard_hit {
            return false;
        }
        let Some(turn) = vertex.sample(rng) else { return false };
        self.throughput *= turn.weight;
        self.ray = vertex.ray(turn.direction);
        let (from, pdf_solid_angle) = (vertex.receiver(), turn.pdf_solid_angle);
        self.departure = Some(Departure { from, pdf_solid_angle });
        self.survives(rng)
    }

    /// Counts the collisions of a walk, and notes a walk that was cut.
    fn count(&mut self, collisions: u32) {
        self.sample.tracking_steps = self.sample.tracking_steps.saturating_add(collisions);
        self.sample.guard_hit |= collisions >= tracking::MOST_COLLISIONS;
    }

    /// Russian roulette on the throughput, compensated.
    fn survives(&mut self, rng: &mut PathRng) -> bool {
        let survival = self.throughput.max_element().min(1.0);
        if self.scatters < ROULETTE_AFTER || survival >= 1.0 {
            return survival > 0.0;
        }
        let survives = rng.uniform() < survival;
        if survives {
            self.throughput /= survival;
        }
        survives
    }

    fn gather_emission(&mut self, emission: Rgb, observer: &mut impl Observer) {
        let contribution = self.throughput * emission;
        if self.scatters == 0 {
            self.sample.emission += contribution;
        } else {
            self.add_scattered(contribution);
        }
        observer.step(Step::Emission { contribution });
    }

    fn gather_end(&mut self, radiance: Rgb, observer: &mut impl Observer) {
        let contribution = self.throughput * radiance;
        if self.scatters == 0 {
            self.sample.background += contribution;
        } else {
            self.add_scattered(contribution);
        }
        observer.step(Step::End { contribution });
    }

    fn add_scattered(&mut self, contribution: Rgb) {
        if self.scatters == 1 {
            self.sample.direct += contribution;
        } else {
            self.sample.indirect += contribution;
        }
    }

    /// Coverage and depth of the camera ray; `transmittance` is the emission walk's, if it had one.
    fn note_first_event(
        &mut self,
        flight: &Flight,
        end: Option<&Intersection>,
        transmittance: Option<Rgb>,
    ) {
        let (opacity, depth) = match (&flight.event, end) {
            (Event::Absorbed { real: false, .. }, _) => (1.0, None),
            (Event::Absorbed { t, .. } | Event::Scattered { t, .. }, _) => (1.0, Some(*t)),
            (Event::Reached, Some(end)) => (1.0, Some(end.hit.t)),
            (Event::Reached, None) => (1.0 - mean(flight.weight), None),
        };
        let smooth = transmittance.filter(|_| end.is_none()).map(|t| 1.0 - mean(t));
        (self.sample.alpha, self.sample.depth) = (smooth.unwrap_or(opacity), depth);
    }
}

/// The vertex on the surface at the end of `ray`; `None` on black ones.
fn reflecting(end: &Intersection, ray: &Ray) -> Option<Vertex> {
    let material = end.surface.material;
    (material != Material::Black)
        .then(|| Vertex::surface(&end.hit, Bsdf::new(material, end.hit.normal, -ray.direction)))
}
