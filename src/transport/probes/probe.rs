//! What a probe knows: the light that arrives around a place, and the matter there.

use std::f32::consts::{PI, TAU};

use glam::Vec3A;

use crate::{
    light::Receiver,
    math::{Aabb, PathRng, Ray, luminance, mean},
    sampling::warp::spherical,
    surface::occluded,
    transport::{direct, emission::Gatherer, scene::Scene, shadow},
    volume::phase::henyey_greenstein,
};

/// Points in a probe from which lights are looked at.
const POINTS: usize = 4;
/// Points that are tried for matter until so many have some.
const TRIES: usize = 12;
/// Share of the light found that is taken to have scattered about and come from everywhere.
const SHARE_OF_AMBIENT: f32 = 0.1;
/// Density guessed, relative to its upper bound, where none was found.
const LEAST_DENSITY: f32 = 0.02;

/// What a probe knows of its surroundings. Its numbers guide, so that rough ones will do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe {
    lobes: [Lobe; POINTS],
    /// Radiance taken to come from everywhere.
    ambient: f32,
    /// Mean cosine of the scattering.
    g: f32,
    /// Mean extinction relative to its upper bound.
    pub(super) density: f32,
    /// Share of it that scatters.
    pub(super) albedo: f32,
    /// Power scattered per volume, relative to 4π.
    power: f32,
}

/// Light from one direction.
#[derive(Clone, Copy, Debug)]
struct Lobe {
    /// Unit, towards where it comes from.
    direction: Vec3A,
    /// ∫ L dω.
    fluence: f32,
}

impl Probe {
    /// Looks at the lights from points in `bounds`.
    pub(super) fn new(
        scene: &Scene,
        gatherer: &Gatherer,
        bounds: &Aabb,
        rng: &mut PathRng,
    ) -> Self {
        let mut matter = Matter::default();
        let mut lobes = [Lobe { direction: Vec3A::X, fluence: 0.0 }; POINTS];
        let (mut found, mut ambient) = (0, 0.0);
        for tried in 0..TRIES {
            let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
            let point = bounds.min + u * bounds.size();
            let scatters = matter.read(scene, point);
            // The last points are taken as they come.
            if found < POINTS && (scatters || TRIES - tried <= POINTS - found) {
                lobes[found] = look(scene, gatherer, point, rng);
                ambient += from_everywhere(scene, point, rng) / POINTS as f32;
                found += 1;
            }
        }
        lobes.iter_mut().for_each(|lobe| lobe.fluence /= POINTS as f32);
        let fluence: f32 = lobes.iter().map(|lobe| lobe.fluence).sum();
        let ambient = ambient + SHARE_OF_AMBIENT * fluence / (4.0 * PI);
        let [g, density, albedo] = matter.means();
        let power = matter.mu_s / TRIES as f32 * (fluence / (4.0 * PI) + ambient);
        Self { lobes, ambient, g, density, albedo, power }
    }

    /// ∫ L ρ dω back along a ray with the unit `direction`.
    #[inline]
    pub(super) fn in_scattered(&self, direction: Vec3A) -> f32 {
        self.lobes.iter().fold(self.ambient, |sum, lobe| {
            sum + lobe.fluence * henyey_greenstein(self.g, direction, lobe.direction)
        })
    }

    /// Mean cosine of the scattering.
    pub(super) fn g(&self) -> f32 {
        self.g
    }

    /// Radiance it scatters per length, whatever the direction.
    pub(super) fn power(&self) -> f32 {
        if self.power.is_finite() { self.power } else { 0.0 }
    }

    /// Radiance scattered per unit of μ_s, whatever the direction.
    pub(super) fn radiance(&self) -> f32 {
        let fluence: f32 = self.lobes.iter().map(|lobe| lobe.fluence).sum();
        self.ambient + fluence / (4.0 * PI)
    }
}

/// Sums over the points that were tried.
#[derive(Default)]
struct Matter {
    majorant: f32,
    mu_t: f32,
    mu_s: f32,
    g: f32,
}

impl Matter {
    /// Adds what is at a point; whether it scatters.
    fn read(&mut self, scene: &Scene, point: Vec3A) -> bool {
        let Some(at) = scene.world.matter_at(point) else { return false };
        let mu_s = mean(at.mu_s);
        self.majorant += at.majorant;
        self.mu_t += mean(at.mu_t);
        self.mu_s += mu_s;
        self.g += mu_s * at.g;
        mu_s > 0.0
    }

    /// g, density and albedo.
    fn means(&self) -> [f32; 3] {
        let share = |part: f32, whole: f32, least: f32| {
            let share = part / whole;
            if share.is_finite() { share.max(least) } else { least }
        };
        [
            share(self.g, self.mu_s, -1.0).clamp(-0.99, 0.99),
            share(self.mu_t, self.majorant, LEAST_DENSITY).min(1.0),
            share(self.mu_s, self.mu_t, 0.0),
        ]
    }
}

/// Light of one of the lights, drawn as a vertex there would draw it.
fn look(scene: &Scene, gatherer: &Gatherer, point: Vec3A, rng: &mut PathRng) -> Lobe {
    let from = Receiver { position: point, normal: None };
    match direct::glance(scene, gatherer, &from, rng) {
        Some((direction, radiance)) => Lobe { direction, fluence: finite(luminance(radiance)) },
        None => Lobe { direction: Vec3A::X, fluence: 0.0 },
    }
}

/// Radiance of the environment from a random direction.
fn from_everywhere(scene: &Scene, point: Vec3A, rng: &mut PathRng) -> f32 {
    let radiance = luminance(scene.lights.environment);
    if radiance <= 0.0 {
        return 0.0;
    }
    let direction = spherical(1.0 - 2.0 * rng.uniform(), TAU * rng.uniform());
    let ray = Ray::new(point, direction);
    if occluded(&scene.surfaces, &ray, f32::INFINITY) {
        return 0.0;
    }
    let medium = scene.world.along(ray, f32::INFINITY);
    finite(radiance * mean(shadow::ratio(medium, rng).0))
}

fn finite(value: f32) -> f32 {
    if value.is_finite() { value.max(0.0) } else { 0.0 }
}
