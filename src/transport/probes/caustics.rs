//! Volume caustics: photons leave specular surfaces (metals of low roughness), with the power that
//! lights give them there, and tell probes which directions caustics come from.
//!
//! A path that scatters in a caustic gathers its light only if it is scattered towards the specular
//! surface so that the light's image is ahead. Directions to that image are drawn beside those of
//! BSDF and phase sampling, as photons have been used to guide paths since Jensen 1995 (*Importance
//! Driven Path Tracing Using the Photon Map*), about a point instead of a direction after Ruppert
//! et al. 2020 (*Robust Fitting of Parallax-Aware Mixtures for Path Guiding*). Photons only guide.

use glam::{UVec2, Vec2, Vec3A};
use rayon::prelude::*;

use super::caustic_lobes::PhotonSegment;
use super::probes::Probes;
use super::stages::{PLACED, SEED};
use crate::transport::direct;
use crate::transport::emission::EmissionEstimator;
use crate::transport::scene::Scene;
use crate::transport::vertex::Vertex;
use crate::{
    error::{Progress, Result, report},
    light::Receiver,
    math::{OrthonormalBasis, PathRng, Ray, luminance},
    sampling::warp::uniform_disk,
    surface::{self, Bsdf, Hit, Material, Shape},
};

/// Photons from specular surfaces, all together.
const RAYS: u32 = 1 << 14;
/// Most specular reflections of a photon.
const MOST_REFLECTIONS: u32 = 4;
/// Roughness α above which BSDF sampling finds the reflected light well enough.
const MOST_ALPHA: f32 = 0.3;
/// Distance at which a sun is placed, relative to the size of the probes' cube.
const FAR: f32 = 100.0;

impl Probes {
    /// Traces one of `part` of the photons and gives their caustics to the probes.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub(in crate::transport) fn find_caustics(
        &mut self,
        scene: &Scene,
        part: u32,
        progress: Progress,
    ) -> Result<()> {
        let specular_surfaces = specular_surfaces(scene);
        if specular_surfaces.is_empty() {
            return Ok(());
        }
        let mut volumes = vec![0.0; self.len()];
        for (leaf, bounds) in self.leaves() {
            volumes[leaf as usize] = bounds.size().element_product();
        }
        let tracer = PhotonTracer {
            scene,
            emission_estimator: EmissionEstimator::coarse(),
            probes: self,
            volumes,
        };
        let cast = |i: u32| {
            let surface_index = specular_surfaces[i as usize % specular_surfaces.len()];
            report(progress, PLACED)?;
            Ok(tracer.cast(surface_index, i).unwrap_or_default())
        };
        let rays = RAYS / part;
        let share = specular_surfaces.len() as f32 / rays as f32;
        let segments: Result<Vec<Vec<PhotonSegment>>> =
            (0..rays).into_par_iter().map(cast).collect();
        let mut segments = segments?.concat();
        segments.iter_mut().for_each(|segment| segment.fluence *= share);
        self.take_photon_segments(segments);
        Ok(())
    }
}

/// Indices of the specular surfaces.
fn specular_surfaces(scene: &Scene) -> Vec<u32> {
    let surfaces = scene.surfaces.iter().enumerate();
    let shiny = surfaces.filter(|(_, surface)| is_specular(surface.material));
    shiny.map(|(index, _)| index as u32).collect()
}

fn is_specular(material: Material) -> bool {
    matches!(material, Material::Conductor { alpha, reflectance }
        if alpha <= MOST_ALPHA && reflectance.max_element() > 0.0)
}

/// Traces photons off specular surfaces.
struct PhotonTracer<'s> {
    scene: &'s Scene,
    emission_estimator: EmissionEstimator,
    probes: &'s Probes,
    /// Volumes of the leaves, by node.
    volumes: Vec<f32>,
}

/// A photon on its path from a specular surface.
struct Photon {
    /// The last specular surface and the light, by their indices in the scene.
    origin: (u32, u32),
    ray: Ray,
    power: f32,
    /// Length of the path from the light to the ray's origin.
    distance: f32,
}

impl PhotonTracer<'_> {
    /// Segments of photon number `index` in the leaves; `None` if no light reaches its surface.
    fn cast(&self, surface_index: u32, index: u32) -> Option<Vec<PhotonSegment>> {
        let mut rng = PathRng::new(SEED, UVec2::new(index, 3), 0);
        let mut photon = self.lit(surface_index, &mut rng)?;
        let mut segments = Vec::new();
        for _ in 0..MOST_REFLECTIONS {
            let end = surface::intersect(&self.scene.surfaces, &photon.ray);
            let t_max = end.as_ref().map_or(f32::INFINITY, |end| end.hit.t);
            let transmittance = self.deposit(&photon, t_max, &mut segments);
            let Some(end) = end.filter(|end| is_specular(end.surface.material)) else { break };
            let Some(vertex) = Vertex::reflecting(&end, &photon.ray) else { break };
            let Some(sample) = vertex.sample(&mut rng) else { break };
            photon = Photon {
                origin: (end.index as u32, photon.origin.1),
                ray: vertex.ray(sample.direction),
                power: photon.power * transmittance * luminance(sample.weight),
                distance: photon.distance + end.hit.t,
            };
        }
        Some(segments)
    }

    /// A photon of one of the lights, reflected by a random point of a specular surface.
    fn lit(&self, surface_index: u32, rng: &mut PathRng) -> Option<Photon> {
        let surface = &self.scene.surfaces[surface_index as usize];
        let (point, normal, area) = self.point_on(&surface.shape, rng)?;
        let side = if rng.uniform() < 0.5 { normal } else { -normal };
        let hit = Hit { t: 0.0, point, normal: side };
        let from = Receiver { position: point + hit.offset() * side, normal: Some(side) };
        let estimate = direct::estimate_light(self.scene, &self.emission_estimator, &from, rng)?;
        let cosine = side.dot(estimate.direction);
        if cosine <= 0.0 {
            return None;
        }
        let bsdf = Bsdf::new(surface.material, side, estimate.direction);
        let vertex = Vertex::surface(&hit, bsdf);
        let sample = vertex.sample(rng)?;
        // Either side was chosen with probability 1/2.
        let power = 2.0 * area * cosine * luminance(estimate.radiance * sample.weight);
        Some(Photon {
            origin: (surface_index, estimate.light),
            ray: vertex.ray(sample.direction),
            power,
            distance: estimate.distance.min(FAR * self.probes.size()),
        })
    }

    /// A random point of a shape with its normal, and the area it stands for: for an infinite
    /// plane, the area near the probes.
    fn point_on(&self, shape: &Shape, rng: &mut PathRng) -> Option<(Vec3A, Vec3A, f32)> {
        let (pick, u) = (rng.uniform(), Vec2::new(rng.uniform(), rng.uniform()));
        if let Shape::Plane { point, normal } = shape {
            let (center, radius) = (self.probes.center(), self.probes.size());
            let foot = center - (center - *point).dot(*normal) * *normal;
            let frame = OrthonormalBasis::around(*normal);
            let place = radius * uniform_disk(u);
            let point = foot + place.x * frame.tangent + place.y * frame.bitangent;
            return Some((point, *normal, std::f32::consts::PI * radius * radius));
        }
        let (point, normal) = shape.point(pick, u)?;
        Some((point, normal, shape.area()?))
    }

    /// Adds the photon's fluence in each leaf along its ray; returns its transmittance, as the
    /// probes estimate it.
    fn deposit(&self, photon: &Photon, t_max: f32, segments: &mut Vec<PhotonSegment>) -> f32 {
        let ray = &photon.ray;
        let image = ray.origin - photon.distance * ray.direction;
        let medium = self.scene.world.along(*ray, t_max);
        let mut passed = 1.0;
        self.probes.visit(medium, ray, |leaf, ray_piece| {
            let (begin, mean_length) = (passed, ray_piece.absorbed());
            passed *= ray_piece.transmittance();
            let Some(leaf) = leaf else { return passed };
            let fluence = photon.power * begin * mean_length / self.volumes[leaf as usize];
            if !(fluence > 0.0 && fluence.is_finite()) {
                return passed;
            }
            match segments.last_mut() {
                Some(last) if last.leaf == leaf && last.origin == photon.origin => {
                    last.fluence += fluence;
                }
                _ => segments.push(PhotonSegment {
                    leaf,
                    origin: photon.origin,
                    fluence,
                    point: ray.at(ray_piece.middle()),
                    direction: -ray.direction,
                    image,
                }),
            }
            passed
        });
        passed
    }
}
