//! All volumes of a scene behind one majorant structure: a hierarchy over the placed volumes gives
//! each one's interval along a ray, each walks its own cells inside, and where they overlap the
//! segments are cut at every border and the majorants added.

mod along;
mod emissive;
mod instance;

use std::sync::Arc;

use glam::Vec3A;
use smallvec::SmallVec;

pub use along::MediumRay;
pub use instance::Instance;

use super::region::Region;
use crate::math::{Aabb, Bvh, Ray, Rgb};
use along::VolumeEntry;
use emissive::Emissive;
use instance::FEW;

/// Every volume of a scene.
#[derive(Clone, Debug, Default)]
pub struct World {
    instances: Vec<Instance>,
    bounded: Bvh,
    /// Indices of the bounded instances, in the hierarchy's order.
    bounded_indices: Vec<u32>,
    unbounded: Vec<u32>,
    emissive: Emissive,
    /// Seconds that the shutter is open.
    open: f32,
}

impl World {
    /// Gathers the placed volumes.
    pub fn new(instances: Vec<Instance>) -> Self {
        let (mut bounded_indices, mut unbounded) = (Vec::new(), Vec::new());
        for (index, instance) in instances.iter().enumerate() {
            if instance.volume.region() == &Region::Everywhere {
                unbounded.push(index as u32);
            } else if !instance.bounds.is_empty() {
                bounded_indices.push(index as u32);
            }
        }
        let boxes: Vec<Aabb> =
            bounded_indices.iter().map(|&i| instances[i as usize].bounds).collect();
        let (bounded, emissive) = (Bvh::new(&boxes), Emissive::new(&instances));
        let moving = instances.iter().filter_map(|instance| instance.volume.motion());
        let open = moving.map(|motion| motion.shutter().open).reduce(f32::min).unwrap_or(0.0);
        Self { instances, bounded, bounded_indices, unbounded, emissive, open }
    }

    /// Seconds that the shutter is open, half of them before the time of the frame: the bounds of
    /// all volumes hold for so long. 0 where nothing moves, or all is seen at one moment.
    pub fn open_seconds(&self) -> f32 {
        self.open
    }

    /// The placed volumes.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// The box around all volumes that have borders; `None` where there is none.
    pub fn finite_bounds(&self) -> Option<Aabb> {
        let bounds = self.instances.iter().map(|instance| *instance.bounds());
        bounds.filter(|bounds| bounds.size().is_finite()).reduce(|all, one| all.union(&one))
    }

    /// Whether both worlds have the same volumes in the same places, as scenes built from one cache
    /// do while only other things change.
    pub fn has_volumes_of(&self, other: &Self) -> bool {
        let same = |(a, b): (&Instance, &Instance)| {
            Arc::ptr_eq(&a.volume, &b.volume) && a.world_from_local == b.world_from_local
        };
        self.instances.len() == other.instances.len()
            && std::iter::zip(&self.instances, &other.instances).all(same)
    }

    /// The medium along `ray` up to `t_max`, which may be infinite.
    pub fn along(&self, ray: Ray, t_max: f32) -> MediumRay<'_> {
        let mut entries = SmallVec::new();
        let mut enter = |index: u32| {
            let instance = &self.instances[index as usize];
            entries.extend(VolumeEntry::new(instance, index, &ray, t_max));
        };
        self.unbounded.iter().for_each(|&index| enter(index));
        if self.bounded_indices.len() <= FEW {
            self.bounded_indices.iter().for_each(|&index| enter(index));
        } else {
            self.bounded.visit(&ray, t_max, |item, t_max| {
                enter(self.bounded_indices[item as usize]);
                t_max
            });
        }
        MediumRay::new(&self.instances, ray, entries)
    }

    /// Whether any volume emits.
    pub fn emits(&self) -> bool {
        self.emissive.any()
    }

    /// Whether anything emits outside of the volumes that are sampled as lights: media without
    /// borders.
    pub fn emits_beyond_lights(&self) -> bool {
        self.emissive.has_unsampled()
    }

    /// Indices of the instances that can be sampled as lights, ascending.
    pub fn emissive(&self) -> &[u32] {
        self.emissive.indices()
    }

    /// Calls `visit` with each emissive instance that light samples can reach along the whole of
    /// `ray`, whose direction is a unit vector, and its [`Instance::emission_pdf_along`], above
    /// zero.
    pub fn emissive_along(&self, ray: &Ray, visit: impl FnMut(u32, f32)) {
        self.emissive.along(&self.instances, ray, visit);
    }

    /// ε at parameter `t` of a ray, at its time.
    pub fn emission_at(&self, ray: &Ray, t: f32) -> Rgb {
        let mut medium = self.around(Ray { origin: ray.at(t), ..*ray });
        match medium.next_segment() {
            Some(segment) => medium.emission(segment.t0),
            None => Rgb::ZERO,
        }
    }

    /// Extinction and scattering at a point at the time of the frame; `None` in empty space.
    pub fn matter_at(&self, point: Vec3A) -> Option<Matter> {
        let mut medium = self.around(Ray::new(point, Vec3A::X));
        let segment = medium.next_segment()?;
        let (mu_t, mu_s) = medium.extinction(segment.t0);
        let g = medium.phase(segment.t0).mean_cosine();
        Some(Matter { majorant: segment.majorant, mu_t, mu_s, g })
    }

    /// The medium along a ray so short that it is a point.
    fn around(&self, ray: Ray) -> MediumRay<'_> {
        let reach = ray.origin.abs().max_element().max(1.0) * (8.0 * f32::EPSILON);
        self.along(ray, reach)
    }
}

/// Extinction and scattering at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matter {
    /// Upper bound of μ_t around the point, 1/length.
    pub majorant: f32,
    /// Extinction μ_t, 1/length.
    pub mu_t: Rgb,
    /// Scattering μ_s, 1/length.
    pub mu_s: Rgb,
    /// Mean cosine of the phase function.
    pub g: f32,
}
