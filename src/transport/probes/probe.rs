//! A probe: estimates of the light that arrives around a place, and of the medium there.

use std::f32::consts::{PI, TAU};

use glam::Vec3A;

use crate::{
    light::Receiver,
    math::{Aabb, PathRng, Ray, luminance, mean},
    sampling::warp::spherical,
    surface::occluded,
    transport::{direct, emission::EmissionEstimator, scene::Scene, shadow},
    volume::phase::henyey_greenstein,
};

/// Points in a probe at which light samples are drawn.
const POINTS: usize = 4;
/// Points that are tried until enough of them lie in a scattering medium.
const TRIES: usize = 12;
/// Indirect light assumed, relative to the direct light, until it is learned.
const SHARE_OF_INDIRECT: f32 = 0.1;
/// Largest mean cosine of indirect light: a few paths may happen to have similar directions.
const MOST_COSINE: f32 = 0.9;
/// Density assumed, relative to its upper bound, where none was found.
const LEAST_DENSITY: f32 = 0.02;

/// Estimates of the light and the medium in a probe. Rough ones will do, since they only guide.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe {
    lobes: [DirectionalLobe; POINTS],
    /// Light that was scattered or reflected before it arrives.
    indirect: Indirect,
    /// Radiance of an even environment, taken to come from everywhere.
    ambient: f32,
    /// Mean cosine of the phase function.
    g: f32,
    /// Mean extinction relative to its upper bound.
    pub(super) density: f32,
    /// Mean single-scattering albedo, 0 to 1.
    pub(super) albedo: f32,
    /// Power scattered per volume, relative to 4π.
    power: f32,
}

/// Light from one direction.
#[derive(Clone, Copy, Debug)]
struct DirectionalLobe {
    /// Unit direction towards the light.
    direction: Vec3A,
    /// ∫ L dω.
    fluence: f32,
}

/// Light that arrives after it has been scattered or reflected. As moments it can be added up.
#[derive(Clone, Copy, Debug)]
pub struct Indirect {
    /// ∫ L dω.
    fluence: f32,
    /// ∫ L ω dω, ω towards the light.
    flux: Vec3A,
    /// Unit direction of `flux`; `cosine` is the mean cosine to it, both derived from the moments.
    axis: Vec3A,
    cosine: f32,
}

/// Light that paths have found in a node of the octree.
#[derive(Clone, Copy, Debug, Default)]
pub struct PathSums {
    /// Number of the node.
    pub node: u32,
    /// Number of the paths.
    pub paths: u32,
    /// Sum of what they found.
    pub sum: Indirect,
}

impl Default for Indirect {
    fn default() -> Self {
        Self { fluence: 0.0, flux: Vec3A::ZERO, axis: Vec3A::X, cosine: 0.0 }
    }
}

impl Indirect {
    /// Light that arrives evenly from all directions.
    fn even(fluence: f32) -> Self {
        Self { fluence, ..Self::default() }
    }

    /// Adds light from a unit direction.
    pub fn add(&mut self, direction: Vec3A, fluence: f32) {
        let fluence = finite(fluence);
        self.merge(&Self { fluence, flux: fluence * direction, ..Self::default() }, 1.0);
    }

    /// The light times a factor.
    pub fn scaled(&self, factor: f32) -> Self {
        Self { fluence: factor * self.fluence, flux: factor * self.flux, ..*self }
    }

    /// Adds a multiple of another light.
    pub fn merge(&mut self, other: &Self, factor: f32) {
        self.fluence += factor * other.fluence;
        self.flux += factor * other.flux;
        if let Some(axis) = self.flux.try_normalize() {
            self.axis = axis;
            self.cosine = (self.flux.length() / self.fluence).min(MOST_COSINE);
        }
    }

    /// ∫ L ρ dω for a phase function of mean cosine `g`: Henyey-Greenstein lobes stay such when
    /// they are convolved, their mean cosines multiplied.
    #[inline]
    fn in_scattered(&self, g: f32, direction: Vec3A) -> f32 {
        self.fluence * henyey_greenstein(g * self.cosine, direction, self.axis)
    }
}

impl Probe {
    /// Replaces the assumed indirect light by the learned one.
    pub(super) fn learn(&mut self, indirect: &Indirect) {
        let before = self.radiance();
        self.indirect = *indirect;
        let grown = self.radiance() / before;
        self.power *= if grown.is_finite() { grown } else { 1.0 };
    }

    /// Estimates light and medium by light samples at points in `bounds`.
    pub(super) fn new(
        scene: &Scene,
        emission_estimator: &EmissionEstimator,
        bounds: &Aabb,
        rng: &mut PathRng,
    ) -> Self {
        let mut matter = MatterSums::default();
        let mut lobes = [DirectionalLobe { direction: Vec3A::X, fluence: 0.0 }; POINTS];
        let (mut found, mut ambient) = (0, 0.0);
        for tried in 0..TRIES {
            let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
            let point = bounds.min + u * bounds.size();
            let scatters = matter.read(scene, point);
            // The last points are taken as they come.
            if found < POINTS && (scatters || TRIES - tried <= POINTS - found) {
                lobes[found] = direct_light(scene, emission_estimator, point, rng);
                ambient += environment_light(scene, point, rng) / POINTS as f32;
                found += 1;
            }
        }
        lobes.iter_mut().for_each(|lobe| lobe.fluence /= POINTS as f32);
        let fluence: f32 = lobes.iter().map(|lobe| lobe.fluence).sum();
        let indirect = Indirect::even(SHARE_OF_INDIRECT * fluence);
        let [g, density, albedo] = matter.means();
        let mut probe = Self { lobes, indirect, ambient, g, density, albedo, power: 0.0 };
        probe.power = matter.mu_s / TRIES as f32 * probe.radiance();
        probe
    }

    /// ∫ L ρ dω back along a ray with the unit `direction`.
    #[inline]
    pub(super) fn in_scattered(&self, direction: Vec3A) -> f32 {
        let diffuse = self.ambient + self.indirect.in_scattered(self.g, direction);
        self.lobes.iter().fold(diffuse, |sum, lobe| {
            sum + lobe.fluence * henyey_greenstein(self.g, direction, lobe.direction)
        })
    }

    /// ∫ L dω of direct light, and of indirect light.
    pub(super) fn fluences(&self) -> [f32; 2] {
        [self.lobes.iter().map(|lobe| lobe.fluence).sum(), self.indirect.fluence]
    }

    /// Mean cosine of the phase function.
    pub(super) fn g(&self) -> f32 {
        self.g
    }

    /// Radiance scattered per length, averaged over directions.
    pub(super) fn power(&self) -> f32 {
        if self.power.is_finite() { self.power } else { 0.0 }
    }

    /// Radiance scattered per unit of μ_s, averaged over directions.
    pub(super) fn radiance(&self) -> f32 {
        self.ambient + self.fluences().iter().sum::<f32>() / (4.0 * PI)
    }
}

/// Sums of coefficients over the points that were tried.
#[derive(Default)]
struct MatterSums {
    majorant: f32,
    mu_t: f32,
    mu_s: f32,
    g: f32,
}

impl MatterSums {
    /// Adds the coefficients at a point; returns whether it scatters.
    fn read(&mut self, scene: &Scene, point: Vec3A) -> bool {
        let Some(at) = scene.world.matter_at(point) else { return false };
        let mu_s = mean(at.mu_s);
        self.majorant += at.majorant;
        self.mu_t += mean(at.mu_t);
        self.mu_s += mu_s;
        self.g += mu_s * at.g;
        mu_s > 0.0
    }

    /// Means of g, density (relative to its upper bound) and albedo.
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

/// Direct light at a point, by one light sample drawn as at a vertex.
fn direct_light(
    scene: &Scene,
    emission_estimator: &EmissionEstimator,
    point: Vec3A,
    rng: &mut PathRng,
) -> DirectionalLobe {
    let from = Receiver { position: point, normal: None };
    match direct::estimate_light(scene, emission_estimator, &from, rng) {
        Some(nee) => {
            DirectionalLobe { direction: nee.direction, fluence: finite(luminance(nee.radiance)) }
        }
        None => DirectionalLobe { direction: Vec3A::X, fluence: 0.0 },
    }
}

/// Radiance of an even environment, attenuated, from a random direction. One that varies is among
/// the lights.
fn environment_light(scene: &Scene, point: Vec3A, rng: &mut PathRng) -> f32 {
    let environment = scene.lights.environment();
    if environment.varies() || environment.is_black() {
        return 0.0;
    }
    let direction = spherical(1.0 - 2.0 * rng.uniform(), TAU * rng.uniform());
    let radiance = luminance(environment.radiance(direction));
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
