//! Light that metals gather: rays from them, lit as the lights light them, that tell probes where
//! bundles of light come from.
//!
//! A path that scatters in such a bundle finds its light only if it turns to the metal so that the
//! light's image is ahead. Directions to that image are drawn beside those of chance, as photons
//! have been used to guide paths since Jensen 1995 (*Importance Driven Path Tracing Using the
//! Photon Map*), about a point instead of a direction after Ruppert et al. 2020 (*Robust Fitting of
//! Parallax-Aware Mixtures for Path Guiding*). They guide and no more.

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

/// Rays from metals, all together.
const RAYS: u32 = 1 << 14;
/// Metals a ray may be thrown by.
const MOST_METALS: u32 = 4;
/// Roughness above which a metal gathers nothing that chance would miss.
const MOST_ALPHA: f32 = 0.3;
/// How far away a sun is taken to be, relative to the probes' cube.
const FAR: f32 = 100.0;

impl Probes {
    /// Finds the bundles of light that metals throw into the medium.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub(in crate::transport) fn find_caustics(
        &mut self,
        scene: &Scene,
        progress: Progress,
    ) -> Result<()> {
        let metals = metals(scene);
        if metals.is_empty() {
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
            let metal = metals[i as usize % metals.len()];
            report(progress, PLACED)?;
            Ok(tracer.cast(metal, i).unwrap_or_default())
        };
        let share = metals.len() as f32 / RAYS as f32;
        let segments: Result<Vec<Vec<PhotonSegment>>> =
            (0..RAYS).into_par_iter().map(cast).collect();
        let mut segments = segments?.concat();
        segments.iter_mut().for_each(|segment| segment.fluence *= share);
        self.take_photon_segments(segments);
        Ok(())
    }
}

/// Indices of the surfaces that gather light.
fn metals(scene: &Scene) -> Vec<u32> {
    let surfaces = scene.surfaces.iter().enumerate();
    let shiny = surfaces.filter(|(_, surface)| gathers(surface.material));
    shiny.map(|(index, _)| index as u32).collect()
}

fn gathers(material: Material) -> bool {
    matches!(material, Material::Conductor { alpha, reflectance }
        if alpha <= MOST_ALPHA && reflectance.max_element() > 0.0)
}

/// Throws rays.
struct PhotonTracer<'s> {
    scene: &'s Scene,
    emission_estimator: EmissionEstimator,
    probes: &'s Probes,
    /// Of the leaves, by node.
    volumes: Vec<f32>,
}

/// Light on its way from a metal.
struct Photon {
    /// The metal and the light.
    origin: (u32, u32),
    ray: Ray,
    power: f32,
    /// Way from the light to the ray's origin.
    way: f32,
}

impl PhotonTracer<'_> {
    /// What ray number `index` brings to the leaves, if it is lit.
    fn cast(&self, metal: u32, index: u32) -> Option<Vec<PhotonSegment>> {
        let mut rng = PathRng::new(SEED, UVec2::new(index, 3), 0);
        let mut photon = self.lit(metal, &mut rng)?;
        let mut segments = Vec::new();
        for _ in 0..MOST_METALS {
            let end = surface::intersect(&self.scene.surfaces, &photon.ray);
            let t_max = end.as_ref().map_or(f32::INFINITY, |end| end.hit.t);
            let transmittance = self.deposit(&photon, t_max, &mut segments);
            let Some(end) = end.filter(|end| gathers(end.surface.material)) else { break };
            let Some(vertex) = Vertex::reflecting(&end, &photon.ray) else { break };
            let Some(turn) = vertex.sample(&mut rng) else { break };
            photon = Photon {
                origin: (end.index as u32, photon.origin.1),
                ray: vertex.ray(turn.direction),
                power: photon.power * transmittance * luminance(turn.weight),
                way: photon.way + end.hit.t,
            };
        }
        Some(segments)
    }

    /// Light of one of the lights that a random point of a metal throws on.
    fn lit(&self, metal: u32, rng: &mut PathRng) -> Option<Photon> {
        let surface = &self.scene.surfaces[metal as usize];
        let (point, normal, area) = self.point_on(&surface.shape, rng)?;
        let side = if rng.uniform() < 0.5 { normal } else { -normal };
        let hit = Hit { t: 0.0, point, normal: side };
        let from = Receiver { position: point + hit.offset() * side, normal: Some(side) };
        let look = direct::estimate_light(self.scene, &self.emission_estimator, &from, rng)?;
        let cosine = side.dot(look.direction);
        if cosine <= 0.0 {
            return None;
        }
        let bsdf = Bsdf::new(surface.material, side, look.direction);
        let vertex = Vertex::surface(&hit, bsdf);
        let turn = vertex.sample(rng)?;
        // Either side was chosen with probability 1/2.
        let power = 2.0 * area * cosine * luminance(look.radiance * turn.weight);
        Some(Photon {
            origin: (metal, look.light),
            ray: vertex.ray(turn.direction),
            power,
            way: look.distance.min(FAR * self.probes.size()),
        })
    }

    /// A random point of a shape with its normal, and the area it stands for: of a plane without
    /// end, what lies near the probes.
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

    /// Adds what the ray brings to each leaf on its way; returns its transmittance, as the probes
    /// think.
    fn deposit(&self, photon: &Photon, t_max: f32, segments: &mut Vec<PhotonSegment>) -> f32 {
        let ray = &photon.ray;
        let image = ray.origin - photon.way * ray.direction;
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
