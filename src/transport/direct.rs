//! Next-event estimation, and the MIS-weighted radiance that scattered rays gather from lights.
//!
//! Light that both light samples and scattered rays can gather is shared by the balance heuristic.
//! The weight multiplies the radiance, never the path's throughput. Environment, emitters and suns
//! are shared light by light. Emissive volumes share one density, Σ q_v p_v over all volumes along
//! the line: the density with which light samples of any volume choose that direction. A shadow ray
//! therefore gathers the emission of all volumes, and overlaps need no special case.

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
    light::{By, ChosenLight, Light, LightChoice, LightGroup, LightSample, Receiver, Visibility},
    math::{PathRng, Ray, Rgb, Slot, mean},
    sampling::mis,
    surface::{self, Intersection, occluded},
    volume::world::MediumRay,
};

/// Shadow rays stop short of their light by this share, so that they don't meet the light itself.
const SHORT_OF_LIGHT: f32 = 1.0 - 1e-4;
/// Time of the frame, which all have that only guides paths.
const OF_FRAME: f32 = 0.0;

/// Holds what MIS needs of the vertex that a ray left: its light samples, and the density of the
/// ray's direction.
#[derive(Clone, Copy, Debug)]
pub struct PrevVertex {
    /// Receiver that light samples at the vertex are drawn for.
    pub from: Receiver,
    /// Sampling of the fires from the vertex.
    pub fires: LightSampling,
    /// Sampling of all other lights from the vertex.
    pub lamps: LightSampling,
    /// Density over solid angle of the direction that the path took, 1/sr.
    pub pdf_solid_angle: f32,
}

/// The two techniques that sample a group of lights from a vertex: light samples, and the ray that
/// leaves along the path. Their expected counts are fixed before any direction is drawn, and are
/// the ones that both MIS weights are made of.
#[derive(Clone, Copy, Debug)]
pub struct LightSampling {
    /// Choice among the lights for light samples.
    pub choice: LightChoice,
    /// Expected number of light samples.
    pub samples: f32,
    /// Expected number of times that the light along the path's own ray is gathered.
    pub rays: f32,
    /// Rough share of these lights in the irradiance at the vertex.
    pub share: f32,
}

impl LightSampling {
    /// One light sample, and one ray.
    pub fn one_of_each(choice: LightChoice) -> Self {
        Self { choice, samples: 1.0, rays: 1.0, share: 1.0 }
    }

    /// MIS weight of a light sample over the expected number of them.
    fn weight_of_sample(&self, pdf: f32, pdf_of_ray: f32) -> f32 {
        mis::mixture([self.samples, self.rays], [pdf, pdf_of_ray])
    }

    /// MIS weight of light along the ray over the expected number of times that it is gathered.
    fn weight_of_ray(&self, pdf_of_ray: f32, pdf: f32) -> f32 {
        mis::mixture([self.rays, self.samples], [pdf_of_ray, pdf])
    }
}

/// Choice among the lights that the strategy asks for, where no probe scores them.
pub fn choice(strategy: &Strategy) -> LightChoice {
    choice_among(strategy, if strategy.nee { LightGroup::All } else { LightGroup::Lamps })
}

/// Choice among a group of lights by the method that the strategy asks for, where no probe scores
/// them.
pub fn choice_among(strategy: &Strategy, among: LightGroup) -> LightChoice {
    let by = match strategy.advanced.light_selection {
        LightSelection::Hierarchy | LightSelection::Probes => By::Hierarchy,
        LightSelection::Uniform => By::Uniform,
    };
    LightChoice { among, by }
}

/// A direction drawn at a receiver towards one of the lights.
#[derive(Clone, Copy, Debug)]
struct LightDirection<'a> {
    from: &'a Receiver,
    /// Time of the path, as rays have it.
    time: f32,
    choice: &'a LightChoice,
    /// The light's index in the scene, and the probability of choosing it.
    light: (u32, f32),
    /// Unit direction towards the light.
    direction: Vec3A,
    at: LightTarget,
}

/// Target of a light sample.
#[derive(Clone, Copy, Debug)]
enum LightTarget {
    /// A light other than an emissive volume.
    Solid { light: LightSample },
    /// A point of an emissive volume.
    Volume { point: Vec3A },
}

impl<'a> LightDirection<'a> {
    /// Chooses a light by `pick`, in [0, 1), and draws a direction towards it from a receiver at a
    /// time; `None` where no light can contribute.
    fn new(
        scene: &Scene,
        (from, time): (&'a Receiver, f32),
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
                time,
                choice,
                light: chosen,
                direction,
                at: LightTarget::Volume { point },
            });
        }
        let light = light.sample(from.position, rng)?;
        let direction = light.direction;
        let at = LightTarget::Solid { light };
        Some(Self { from, time, choice, light: chosen, direction, at })
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

    /// Whether scattered rays can reach the sampled light as well, so that MIS must weight it.
    fn can_be_met(&self) -> bool {
        match &self.at {
            LightTarget::Solid { light } => light.can_be_met,
            LightTarget::Volume { .. } => true,
        }
    }

    /// Length of the shadow ray if no surface ends it.
    fn length(&self) -> f32 {
        match &self.at {
            LightTarget::Solid { light } => light.distance,
            LightTarget::Volume { .. } => f32::INFINITY,
        }
    }

    /// Sampled point of the light; `None` for the sun, which is infinitely far away.
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
        Ray { origin: self.from.position, direction: self.direction, time: self.time }
    }

    /// Radiance from the sampled direction over its density `pdf`, and the number of collisions of
    /// the shadow ray. `emission_estimator` gathers the emission of volumes.
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
            LightTarget::Volume { point } if samples_points(scene) => {
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

    /// Emission at one point of the ray, attenuated by the medium before it, over the density with
    /// which light samples of volumes choose that point (Villemin and Hery 2013): Σ q_v p_v over
    /// volume, times the squared distance.
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
        let emission = scene.world.emission_at(&ray, distance);
        if pdf_volume <= 0.0 || emission == Rgb::ZERO {
            return (Rgb::ZERO, 0);
        }
        let medium = scene.world.along(ray, distance);
        let (transmittance, collisions) = transmittance(scene, medium, rng);
        (emission * transmittance / (pdf_volume * distance * distance), collisions)
    }
}

/// Contribution of one light sample (next-event estimation).
#[derive(Clone, Copy, Debug, Default)]
pub struct NeeSample {
    /// Radiance of the sampled light at the vertex times the vertex's value and the MIS weight.
    pub contribution: Rgb,
    /// Sampled point of the light; `None` for the sun and where nothing was sampled.
    pub point: Option<Vec3A>,
    /// Tentative collisions along the shadow ray.
    pub collisions: u32,
    /// Direction and length of the shadow ray; `None` where none was followed.
    pub shadow_ray: Option<(Vec3A, f32)>,
    /// Density over solid angle of the sample, and of the path's own ray in the same direction,
    /// 1/sr; 0 where that cannot find the light.
    pub pdfs: [f32; 2],
}

/// Draws one light sample at `vertex`, as one of those that `sampling` expects.
/// `emission_estimator` gathers the emission of volumes.
pub fn sample_lights(
    scene: &Scene,
    emission_estimator: &EmissionEstimator,
    vertex: &Vertex,
    sampling: &LightSampling,
    rng: &mut PathRng,
) -> NeeSample {
    let from = vertex.receiver();
    let pick = rng.at64(Slot::LightPick);
    let drawn = LightDirection::new(scene, (&from, vertex.time), &sampling.choice, pick, rng);
    let Some(light_direction) = drawn else {
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
    let pdf_of_ray = if light_direction.can_be_met() { vertex_pdf } else { 0.0 };
    let weight = sampling.weight_of_sample(light_pdf, pdf_of_ray);
    let (radiance, collisions) =
        light_direction.radiance_over_pdf(scene, emission_estimator, light_pdf, rng);
    NeeSample {
        contribution: value * weight * radiance,
        collisions,
        shadow_ray: Some((light_direction.direction, light_direction.length())),
        pdfs: [light_pdf, pdf_of_ray],
        ..unseen
    }
}

/// A point of a light, drawn as a light sample at a receiver would be; `None` for the sun.
pub fn point_of_light(
    scene: &Scene,
    from: &Receiver,
    choice: &LightChoice,
    rng: &mut PathRng,
) -> Option<Vec3A> {
    let pick = rng.at64(Slot::LightPick);
    LightDirection::new(scene, (from, OF_FRAME), choice, pick, rng)?.point()
}

/// Estimate of the radiance that one light sends to a receiver.
#[derive(Clone, Copy, Debug)]
pub struct LightEstimate {
    /// The light's index in the scene.
    pub light: u32,
    /// Unit direction towards the light.
    pub direction: Vec3A,
    /// Distance to the light; infinite for the sun.
    pub distance: f32,
    /// Radiance over the density of the sample.
    pub radiance: Rgb,
}

/// Estimates the radiance that arrives at a receiver from lights at the time of the frame, by one
/// light sample and without scores of probes. Excludes an even environment and scattered light.
pub fn estimate_light(
    scene: &Scene,
    emission_estimator: &EmissionEstimator,
    from: &Receiver,
    rng: &mut PathRng,
) -> Option<LightEstimate> {
    let choice = choice(&scene.strategy);
    let pick = rng.at64(Slot::LightPick);
    let light_direction = LightDirection::new(scene, (from, OF_FRAME), &choice, pick, rng)?;
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

/// Visibility of the light that `pick`, in [0, 1), chooses by the hierarchy: the transmittance to a
/// receiver from a point of it, at the time of the frame.
pub fn visibility(
    scene: &Scene,
    from: &Receiver,
    pick: f64,
    rng: &mut PathRng,
) -> Option<Visibility> {
    let choice = LightChoice { by: By::Hierarchy, ..choice(&scene.strategy) };
    let light_direction = LightDirection::new(scene, (from, OF_FRAME), &choice, pick, rng)?;
    let (light, probability) = light_direction.light;
    let distance =
        light_direction.point().map_or(f32::INFINITY, |point| point.distance(from.position));
    let seen = mean(transmittance_to(scene, &light_direction.ray(), distance, rng).0);
    let guess = scene.lights.irradiance(light, from) / probability;
    Some(Visibility { light, seen, guess })
}

/// Radiance along `ray` of a sampled light other than an emissive volume, and the collisions on the
/// way.
fn radiance_of_solid(
    scene: &Scene,
    ray: &Ray,
    light: &LightSample,
    rng: &mut PathRng,
) -> (Rgb, u32) {
    let (transmittance, collisions) = transmittance_to(scene, ray, light.distance, rng);
    (light.radiance * transmittance, collisions)
}

/// Estimates the transmittance over a distance towards a light; 0 behind surfaces.
fn transmittance_to(scene: &Scene, ray: &Ray, distance: f32, rng: &mut PathRng) -> (Rgb, u32) {
    if occluded(&scene.surfaces, ray, SHORT_OF_LIGHT * distance) {
        return (Rgb::ZERO, 0);
    }
    transmittance(scene, scene.world.along(*ray, distance), rng)
}

/// Transmittance along a shadow ray, and the number of its steps.
fn transmittance(scene: &Scene, medium: MediumRay<'_>, rng: &mut PathRng) -> (Rgb, u32) {
    match scene.strategy.integrator {
        Integrator::Path => {
            shadow::transmittance(medium, scene.strategy.advanced.transmittance, rng)
        }
        Integrator::March => march::transmittance(medium, scene.strategy.advanced.march_step, rng),
    }
}

/// Whether light samples of volumes evaluate one point. Points are drawn inside of the lights only.
/// Emission beyond them, which shadow rays gather as well, shares their weights, so that it takes
/// the whole line.
fn samples_points(scene: &Scene) -> bool {
    scene.strategy.advanced.nee_evaluation == NeeEvaluation::Point
        && !scene.world.emits_beyond_lights()
}

/// Density over solid angle with which light samples of emissive volumes choose the direction of
/// `ray`.
fn pdf_of_volumes(scene: &Scene, ray: &Ray, from: &Receiver, choice: &LightChoice) -> f32 {
    let mut sum = 0.0;
    scene.world.emissive_along(ray, |instance, pdf| {
        if pdf > 0.0 {
            sum += pdf * scene.lights.probability_of_volume(instance, from, choice);
        }
    });
    sum
}

/// Weight of the volume emission gathered along a ray from a vertex: the MIS weight over the
/// expected number of emission walks; with the densities of the ray and of light samples in its
/// direction. 1 for camera rays (no previous vertex), where no other technique samples it.
pub fn weight_of_emission(
    scene: &Scene,
    ray: &Ray,
    prev_vertex: Option<&PrevVertex>,
) -> (f32, [f32; 2]) {
    let Some(PrevVertex { from, fires, pdf_solid_angle, .. }) = prev_vertex else {
        return (1.0, [1.0, 0.0]);
    };
    let pdf = match fires.samples > 0.0 {
        true => pdf_of_volumes(scene, ray, from, &fires.choice),
        false => 0.0,
    };
    (fires.weight_of_ray(*pdf_solid_angle, pdf), [*pdf_solid_angle, pdf])
}

/// Radiance that arrives at the start of `ray` from the surface it ends on or the environment
/// behind everything, the medium in between apart, MIS-weighted against light samples at the
/// previous vertex.
pub fn at_the_end(
    scene: &Scene,
    ray: &Ray,
    end: Option<&Intersection>,
    prev_vertex: Option<&PrevVertex>,
) -> Rgb {
    let shared = |radiance: Rgb, light_pdf: &dyn Fn(&PrevVertex) -> f32| match prev_vertex {
        None => radiance,
        Some(prev) => radiance * prev.lamps.weight_of_ray(prev.pdf_solid_angle, light_pdf(prev)),
    };
    match end {
        Some(end) if end.surface.emits() => shared(end.surface.emission, &|prev_vertex| {
            let PrevVertex { from, lamps, .. } = prev_vertex;
            scene.lights.pdf_of_surface(end.index, from, &lamps.choice, &end.hit)
        }),
        Some(_) => Rgb::ZERO,
        None => {
            let from = prev_vertex.map(|prev| (&prev.from, &prev.lamps.choice));
            let suns = scene.lights.suns_behind(from, ray.direction);
            let environment = environment_behind(scene, ray.direction, prev_vertex);
            suns.fold(environment, |sum, (sun, pdf)| sum + shared(sun.radiance(), &|_| pdf))
        }
    }
}

/// Radiance of the environment along a unit `direction`, MIS-weighted against light samples at the
/// previous vertex. An even environment has no light samples: where nothing but the BSDF or phase
/// function varies, sampling those is all that there is to gain.
fn environment_behind(scene: &Scene, direction: Vec3A, prev_vertex: Option<&PrevVertex>) -> Rgb {
    let environment = scene.lights.environment();
    let Some(PrevVertex { from, lamps, pdf_solid_angle, .. }) = prev_vertex else {
        return if environment.is_hidden() { Rgb::ZERO } else { environment.radiance(direction) };
    };
    let radiance = environment.radiance(direction);
    match scene.lights.pdf_of_environment(from, &lamps.choice, direction) {
        Some(pdf) => radiance * lamps.weight_of_ray(*pdf_solid_angle, pdf),
        None => radiance,
    }
}
