//! Next-event estimation, and the radiance a ray finds with its share of the MIS.
//!
//! What both a look at a light and a scattered ray can find is shared by the balance heuristic.
//! The weight multiplies the radiance found, never the path's throughput. Environment, emitters
//! and suns are shared light by light. Emissive volumes share one density, Σ q_v p_v over all of
//! them along the line: that is how often any look at any of them goes there, so that a look
//! gathers the emission of all, and where they overlap nothing needs to be kept apart.

use glam::Vec3A;

use super::{
    emission::{EmissionEstimator, ray::RayKind},
    march,
    scene::Scene,
    shadow,
    strategy::{Integrator, LightSelection, NeeEvaluation, Strategy},
    vertex::Vertex,
};
use crate::{
    light::{By, ChosenLight, Light, LightChoice, LightSample, Receiver, Visibility},
    math::{PathRng, Ray, Rgb, Slot, mean},
    sampling::mis,
    surface::{self, Intersection, occluded},
    volume::world::MediumRay,
};

/// Shadow rays stop short of their light by this share, so that they don't meet the light itself.
const SHORT_OF_LIGHT: f32 = 1.0 - 1e-4;

/// The vertex a ray left from and the density over solid angle it was drawn with there.
#[derive(Clone, Copy, Debug)]
pub struct PrevVertex {
    /// Where looks at lights would have gone from.
    pub from: Receiver,
    /// How they would have been chosen.
    pub choice: LightChoice,
    /// Density of the direction it took.
    pub pdf_solid_angle: f32,
}

/// Which lights take part, by the toggles, and how one is chosen where no probes have a say.
pub fn choice(strategy: &Strategy) -> LightChoice {
    let by = match strategy.advanced.light_selection {
        LightSelection::Hierarchy | LightSelection::Probes => By::Hierarchy,
        LightSelection::Uniform => By::Uniform,
    };
    LightChoice { volumes: strategy.nee, by }
}

/// A direction drawn at a receiver towards one of the lights.
#[derive(Clone, Copy, Debug)]
struct LightDirection<'a> {
    from: &'a Receiver,
    choice: &'a LightChoice,
    /// The light's index in the scene, and the probability of choosing it.
    light: (u32, f32),
    /// Unit direction towards it.
    direction: Vec3A,
    at: LightTarget,
}

/// What is looked at.
#[derive(Clone, Copy, Debug)]
enum LightTarget {
    /// A light with a place of its own.
    Solid { light: LightSample },
    /// A point of an emissive volume.
    Volume { point: Vec3A },
}

impl<'a> LightDirection<'a> {
    /// Chooses a light by `pick`, in [0, 1), and draws a direction towards it; `None` where there
    /// is nothing to look at.
    fn new(
        scene: &Scene,
        from: &'a Receiver,
        choice: &'a LightChoice,
        pick: f64,
        rng: &mut PathRng,
    ) -> Option<Self> {
        let ChosenLight { index, light, probability } = scene.lights.choose(from, choice, pick)?;
        let chosen = (index, probability);
        if let Light::Volume(instance) = light {
            let pick = rng.at64(Slot::LightCell);
            let u = [Slot::LightX, Slot::LightY, Slot::LightZ].map(|slot| rng.at(slot)).into();
            let volume = &scene.world.instances()[*instance as usize];
            let point = volume.sample_emission(pick, u)?;
            let direction = (point - from.position).try_normalize()?;
            return Some(Self {
                from,
                choice,
                light: chosen,
                direction,
                at: LightTarget::Volume { point },
            });
        }
        let light = light.sample(from.position, rng)?;
        let direction = light.direction;
        Some(Self { from, choice, light: chosen, direction, at: LightTarget::Solid { light } })
    }

    /// Density over solid angle of the direction, the choice of the light included.
    fn pdf_solid_angle(&self, scene: &Scene) -> f32 {
        match &self.at {
            LightTarget::Solid { light } => self.light.1 * light.pdf,
            LightTarget::Volume { .. } => {
                pdf_of_volumes(scene, &self.ray(), self.from, self.choice)
            }
        }
    }

    /// Whether scattered rays meet what is looked at as well, so that MIS must share it.
    fn can_be_met(&self) -> bool {
        match &self.at {
            LightTarget::Solid { light } => light.can_be_met,
            LightTarget::Volume { .. } => true,
        }
    }

    /// The point that is looked at; `None` for the sun, which is nowhere.
    fn point(&self) -> Option<Vec3A> {
        match &self.at {
            LightTarget::Solid { light } if light.distance.is_finite() => {
                Some(self.from.position + light.distance * light.direction)
            }
            LightTarget::Solid { .. } => None,
            LightTarget::Volume { point } => Some(*point),
        }
    }

    fn ray(&self) -> Ray {
        Ray::new(self.from.position, self.direction)
    }

    /// The radiance that comes from there over the density of looking there, which is `pdf`, and
    /// the collisions of the walk towards it. `emission_estimator` looks at volumes.
    fn radiance_over_pdf(
        &self,
        scene: &Scene,
        emission_estimator: &EmissionEstimator,
        pdf: f32,
        rng: &mut PathRng,
    ) -> (Rgb, u32) {
        let ray = self.ray();
        match &self.at {
            LightTarget::Solid { light } => {
                let (radiance, collisions) = radiance_of_solid(scene, &ray, light, rng);
                (radiance / pdf, collisions)
            }
            LightTarget::Volume { point } if looks_at_points(scene) => {
                self.emission_at_point(scene, (*point - ray.origin).length(), rng)
            }
            LightTarget::Volume { .. } => {
                let end = surface::intersect(&scene.surfaces, &ray);
                let t_max = end.map_or(f32::INFINITY, |end| end.hit.t);
                let gathered =
                    emission_estimator.gather(scene.world.along(ray, t_max), RayKind::Light, rng);
                (gathered.emission / pdf, gathered.collisions)
            }
        }
    }

    /// The emission at one point of the ray through the medium before it, over the density with
    /// which looks at volumes end there (Villemin and Hery 2013): Σ q_v p_v over volume, times the
    /// squared distance.
    fn emission_at_point(&self, scene: &Scene, distance: f32, rng: &mut PathRng) -> (Rgb, u32) {
        let ray = self.ray();
        if occluded(&scene.surfaces, &ray, distance) {
            return (Rgb::ZERO, 0);
        }
        let point = ray.at(distance);
        let mut pdf_volume = 0.0;
        scene.world.emissive_along(&ray, |instance, _| {
            let q = scene.lights.probability_of_volume(instance, self.from, self.choice);
            let volume = &scene.world.instances()[instance as usize];
            pdf_volume += q * volume.emission_pdf_at(point);
        });
        let emission = scene.world.emission_at(point, ray.direction);
        if pdf_volume <= 0.0 || emission == Rgb::ZERO {
            return (Rgb::ZERO, 0);
        }
        let medium = scene.world.along(ray, distance);
        let (transmittance, collisions) = transmittance(scene, medium, rng);
        (emission * transmittance / (pdf_volume * distance * distance), collisions)
    }
}

/// What a look at the lights brings.
#[derive(Clone, Copy, Debug, Default)]
pub struct NeeSample {
    /// Light that a sampled light sends to the vertex and on along the path.
    pub light: Rgb,
    /// The point of the light that was looked at, if it is somewhere.
    pub point: Option<Vec3A>,
    /// Collisions of the walk towards it.
    pub collisions: u32,
}

/// Looks from `vertex` at one of the lights. `emission_estimator` looks at volumes.
pub fn sample_lights(
    scene: &Scene,
    emission_estimator: &EmissionEstimator,
    vertex: &Vertex,
    choice: &LightChoice,
    rng: &mut PathRng,
) -> NeeSample {
    let from = vertex.receiver();
    let pick = rng.at64(Slot::LightPick);
    let Some(light_direction) = LightDirection::new(scene, &from, choice, pick, rng) else {
        return NeeSample::default();
    };
    let unseen = NeeSample { point: light_direction.point(), ..NeeSample::default() };
    let (value, vertex_pdf) = vertex.eval(light_direction.direction);
    if value.max_element() <= 0.0 {
        return unseen;
    }
    let light_pdf = light_direction.pdf_solid_angle(scene);
    if light_pdf <= 0.0 {
        return unseen;
    }
    let weight =
        if light_direction.can_be_met() { mis::balance(light_pdf, vertex_pdf) } else { 1.0 };
    let (found, collisions) =
        light_direction.radiance_over_pdf(scene, emission_estimator, light_pdf, rng);
    NeeSample { light: value * weight * found, collisions, ..unseen }
}

/// A point of a light, chosen as a look from a receiver would; `None` where that is nowhere.
pub fn point_of_light(
    scene: &Scene,
    from: &Receiver,
    choice: &LightChoice,
    rng: &mut PathRng,
) -> Option<Vec3A> {
    let pick = rng.at64(Slot::LightPick);
    LightDirection::new(scene, from, choice, pick, rng)?.point()
}

/// What a glance finds.
#[derive(Clone, Copy, Debug)]
pub struct LightEstimate {
    /// The light's index in the scene.
    pub light: u32,
    /// Unit direction towards it.
    pub direction: Vec3A,
    /// Distance to it; infinite for the sun.
    pub distance: f32,
    /// Its radiance over the density of the look.
    pub radiance: Rgb,
}

/// An estimate of the light that arrives at a receiver, by one look at one of the lights, whatever
/// probes may say. Lights are all that is found: not the environment, not what has scattered.
pub fn estimate_light(
    scene: &Scene,
    emission_estimator: &EmissionEstimator,
    from: &Receiver,
    rng: &mut PathRng,
) -> Option<LightEstimate> {
    let choice = choice(&scene.strategy);
    let pick = rng.at64(Slot::LightPick);
    let light_direction = LightDirection::new(scene, from, &choice, pick, rng)?;
    let pdf = light_direction.pdf_solid_angle(scene);
    (pdf > 0.0).then(|| LightEstimate {
        light: light_direction.light.0,
        direction: light_direction.direction,
        distance: light_direction
            .point()
            .map_or(f32::INFINITY, |point| point.distance(from.position)),
        radiance: light_direction.radiance_over_pdf(scene, emission_estimator, pdf, rng).0,
    })
}

/// How much of the light that `pick`, in [0, 1), chooses by the hierarchy gets to a receiver: the
/// transmittance from a point of it.
pub fn visibility(
    scene: &Scene,
    from: &Receiver,
    pick: f64,
    rng: &mut PathRng,
) -> Option<Visibility> {
    let choice = LightChoice { volumes: scene.strategy.nee, by: By::Hierarchy };
    let light_direction = LightDirection::new(scene, from, &choice, pick, rng)?;
    let (light, probability) = light_direction.light;
    let distance =
        light_direction.point().map_or(f32::INFINITY, |point| point.distance(from.position));
    let seen = mean(transmittance_to(scene, &light_direction.ray(), distance, rng).0);
    let guess = scene.lights.irradiance(light, from) / probability;
    Some(Visibility { light, seen, guess })
}

/// What a light with a place of its own sends along `ray`.
fn radiance_of_solid(
    scene: &Scene,
    ray: &Ray,
    light: &LightSample,
    rng: &mut PathRng,
) -> (Rgb, u32) {
    let (transmittance, collisions) = transmittance_to(scene, ray, light.distance, rng);
    (light.radiance * transmittance, collisions)
}

/// An estimate of the transmittance to a light at a distance; 0 behind surfaces.
fn transmittance_to(scene: &Scene, ray: &Ray, distance: f32, rng: &mut PathRng) -> (Rgb, u32) {
    if occluded(&scene.surfaces, ray, SHORT_OF_LIGHT * distance) {
        return (Rgb::ZERO, 0);
    }
    transmittance(scene, scene.world.along(*ray, distance), rng)
}

/// Transmittance on the way to a light, and the steps it took.
fn transmittance(scene: &Scene, medium: MediumRay<'_>, rng: &mut PathRng) -> (Rgb, u32) {
    match scene.strategy.integrator {
        Integrator::Path => {
            shadow::transmittance(medium, scene.strategy.advanced.transmittance, rng)
        }
        Integrator::March => march::transmittance(medium, scene.strategy.advanced.march_step, rng),
    }
}

/// Whether looks at volumes take one point of them. Points are drawn inside of the lights only.
/// Glow beyond them, which lines of sight bring as well, shares their weights, so that it takes
/// the line.
fn looks_at_points(scene: &Scene) -> bool {
    scene.strategy.advanced.nee_evaluation == NeeEvaluation::Point
        && !scene.world.emits_beyond_lights()
}

/// Density over solid angle with which a look at some emissive volume goes along `ray`.
fn pdf_of_volumes(scene: &Scene, ray: &Ray, from: &Receiver, choice: &LightChoice) -> f32 {
    let mut sum = 0.0;
    scene.world.emissive_along(ray, |instance, pdf| {
        if pdf > 0.0 {
            sum += pdf * scene.lights.probability_of_volume(instance, from, choice);
        }
    });
    sum
}

/// The MIS weight of the volume emission found along a ray that scattering sent; 1 for camera rays
/// (no departure), where nothing else could have found it.
pub fn weight_of_emission(scene: &Scene, ray: &Ray, prev_vertex: Option<&PrevVertex>) -> f32 {
    match prev_vertex {
        Some(prev_vertex) if scene.strategy.nee => {
            let PrevVertex { from, choice, pdf_solid_angle } = prev_vertex;
            mis::balance(*pdf_solid_angle, pdf_of_volumes(scene, ray, from, choice))
        }
        _ => 1.0,
    }
}

/// Radiance that arrives at the start of `ray` from the surface it ends on or the environment
/// behind everything, the medium in between apart, weighted by what light samples at its departure
/// find of the same.
pub fn at_the_end(
    scene: &Scene,
    ray: &Ray,
    end: Option<&Intersection>,
    prev_vertex: Option<&PrevVertex>,
) -> Rgb {
    let shared = |radiance: Rgb, light_pdf: &dyn Fn(&PrevVertex) -> f32| match prev_vertex {
        None => radiance,
        Some(prev_vertex) => {
            radiance * mis::balance(prev_vertex.pdf_solid_angle, light_pdf(prev_vertex))
        }
    };
    match end {
        Some(end) if end.surface.emits() => shared(end.surface.emission, &|prev_vertex| {
            let PrevVertex { from, choice, .. } = prev_vertex;
            scene.lights.pdf_of_surface(end.index, from, choice, &end.hit)
        }),
        Some(_) => Rgb::ZERO,
        None => {
            let from = prev_vertex.map(|prev_vertex| (&prev_vertex.from, &prev_vertex.choice));
            let suns = scene.lights.suns_behind(from, ray.direction);
            suns.fold(scene.lights.environment, |sum, (sun, pdf)| {
                sum + shared(sun.radiance(), &|_| pdf)
            })
        }
    }
}
