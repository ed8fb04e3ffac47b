//! All volumes of a scene behind one majorant structure: a hierarchy over the placed volumes gives
//! each one's interval along a ray, each walks its own cells inside, and where they overlap the
//! stretches are cut at every border and the majorants added.

mod along;
mod emissive;

use std::sync::Arc;

pub use along::MediumRay;
use along::VolumeEntry;
use emissive::Emissive;
use glam::{Affine3A, Vec3A};
use smallvec::SmallVec;

use super::{Region, Volume};
use crate::math::{Aabb, Bvh, Ray, Rgb};

/// Up to this many volumes are tried one by one, which costs less than a hierarchy.
const FEW: usize = 3;

/// A volume placed in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    volume: Arc<Volume>,
    world_from_local: Affine3A,
    local_from_world: Affine3A,
    bounds: Aabb,
    /// World volume of a unit of the volume's own.
    world_volume: f64,
    /// Turns a bound of lum ε into collisions per length along the brightest chord.
    emission_rate: f32,
    voxel_rate: f32,
}

impl Instance {
    /// Places `volume`. The placement must be invertible.
    pub fn new(volume: Arc<Volume>, world_from_local: Affine3A) -> Self {
        let columns = world_from_local.matrix3;
        let lengths =
            Vec3A::new(columns.x_axis.length(), columns.y_axis.length(), columns.z_axis.length());
        let chord = (volume.chords() * lengths).max_element();
        let emission_rate = if chord > 0.0 { 1.0 / chord } else { 0.0 };
        let voxel_rate = volume.voxel().map_or(0.0, |v| 1.0 / (v * lengths.min_element()));
        let bounds = match volume.region() {
            Region::Everywhere => Aabb::centered(Vec3A::INFINITY),
            region => region.bounds().transformed(&world_from_local),
        };
        let local_from_world = world_from_local.inverse();
        let world_volume = columns.as_dmat3().determinant().abs();
        Self {
            volume,
            world_from_local,
            local_from_world,
            bounds,
            world_volume,
            emission_rate,
            voxel_rate,
        }
    }

    /// The volume that is placed.
    pub fn volume(&self) -> &Arc<Volume> {
        &self.volume
    }

    /// From the volume's space to the world.
    pub fn world_from_local(&self) -> &Affine3A {
        &self.world_from_local
    }

    /// World volume of a unit of the volume's own.
    pub fn world_volume(&self) -> f64 {
        self.world_volume
    }

    /// A ray of the world in the volume's space; its parameter stays the world's.
    fn local_ray(&self, ray: &Ray) -> Ray {
        Ray::new(
            self.local_from_world.transform_point3a(ray.origin),
            self.local_from_world.transform_vector3a(ray.direction),
        )
    }

    /// A box around it in the world; infinite for a volume without borders.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }
}

/// Every volume of a scene.
#[derive(Clone, Debug, Default)]
pub struct World {
    instances: Vec<Instance>,
    bounded: Bvh,
    /// Indices of the bounded instances, in the hierarchy's order.
    bounded_indices: Vec<u32>,
    unbounded: Vec<u32>,
    emissive: Emissive,
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
        Self { instances, bounded, bounded_indices, unbounded, emissive }
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

    /// Whether both have the same volumes in the same places, as scenes built from one cache do
    /// while only other things change.
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
        MediumRay::new(self, ray, entries)
    }

    /// ε at a point; `along` is any unit direction.
    pub fn emission_at(&self, point: Vec3A, along: Vec3A) -> Rgb {
        let mut medium = self.around(point, along);
        match medium.next_segment() {
            Some(segment) => medium.emission(segment.t0),
            None => Rgb::ZERO,
        }
    }

    /// What extinguishes and scatters at a point; `None` where there is nothing.
    pub fn matter_at(&self, point: Vec3A) -> Option<Matter> {
        let mut medium = self.around(point, Vec3A::X);
        let segment = medium.next_segment()?;
        let (mu_t, mu_s) = medium.extinction(segment.t0);
        let g = medium.phase(segment.t0).mean_cosine();
        Some(Matter { majorant: segment.majorant, mu_t, mu_s, g })
    }

    /// The medium along a ray so short that it is a point.
    fn around(&self, point: Vec3A, along: Vec3A) -> MediumRay<'_> {
        let reach = point.abs().max_element().max(1.0) * (8.0 * f32::EPSILON);
        self.along(Ray::new(point, along), reach)
    }
}

/// What extinguishes and scatters at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matter {
    /// Upper bound of μ_t around it, 1/length.
    pub majorant: f32,
    /// Extinction, 1/length.
    pub mu_t: Rgb,
    /// Scattering, 1/length.
    pub mu_s: Rgb,
    /// Mean cosine of the scattering.
    pub g: f32,
}
